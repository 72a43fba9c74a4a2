// viewer/window/body_mark.h - how bodies are marked that touch each other. For the sources of
// viewer/ only.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "viewer/scene.h"

namespace kerf {

enum class BodyMark : std::uint8_t { kNone, kNear, kTouches };

/// What is marked is at least so opaque, and shines through the workpiece with that.
inline constexpr float kLeastMarkedOpacity = 0.75f, kHiddenMarkOpacity = 0.35f;

inline glm::vec3 color_of(BodyMark mark, const glm::vec3& unmarked) {
  switch (mark) {
    case BodyMark::kTouches:
      return {0.90f, 0.10f, 0.08f};
    case BodyMark::kNear:
      return {0.96f, 0.60f, 0.10f};
    case BodyMark::kNone:
      break;
  }
  return unmarked;
}

inline BodyMark mark_of(const SceneContact& contact) {
  return contact.is_near ? BodyMark::kNear : BodyMark::kTouches;
}

using ToolMarks = std::array<BodyMark, kToolPieceCount>;

/// By ToolPiece.
inline ToolMarks tool_marks(std::span<const SceneContact> contacts) {
  ToolMarks marks{};
  for (const SceneContact& contact : contacts) {
    if (!contact.piece) continue;
    BodyMark& mark = marks[static_cast<std::size_t>(*contact.piece)];
    mark = std::max(mark, mark_of(contact));
  }
  return marks;
}

inline void add_mark(BodyMark mark, std::size_t body, std::vector<BodyMark>* marks) {
  marks->resize(std::max(marks->size(), body + 1));
  (*marks)[body] = std::max((*marks)[body], mark);
}

/// By fixture, as far as there are marked ones.
inline std::vector<BodyMark> fixture_marks(std::span<const SceneContact> contacts) {
  std::vector<BodyMark> marks;
  for (const SceneContact& contact : contacts)
    if (contact.fixture) add_mark(mark_of(contact), *contact.fixture, &marks);
  return marks;
}

/// By link of the machine, likewise.
inline std::vector<BodyMark> link_marks(std::span<const SceneContact> contacts) {
  std::vector<BodyMark> marks;
  for (const SceneContact& contact : contacts)
    for (const std::size_t link : contact.links) add_mark(mark_of(contact), link, &marks);
  return marks;
}

}  // namespace kerf
