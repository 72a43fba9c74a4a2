// viewer/window/path_store.h - the toolpath on the graphics card. For the sources of viewer/ only.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <glm/vec4.hpp>
#include <memory>
#include <vector>

#include "viewer/gl_objects.h"
#include "viewer/scene.h"
#include "viewer/window/screen_rect.h"

namespace kerf {

/// Colours of traverse, feed and planned segments; alpha 0 hides them.
struct PathColors {
  std::array<glm::vec4, 3> past{};
  std::array<glm::vec4, 3> future{};
  bool operator==(const PathColors&) const = default;
};

/// A path of more than kDrawnVertices vertices is drawn through every 2nd, 4th, ... of them: ten
/// million lines are more than pixels.
class PathStore {
 public:
  static constexpr std::size_t kDrawnVertices = 1'000'000;

  static Result<PathStore> create();

  void set_chunk_count(std::uint32_t count);
  void offer(std::shared_ptr<const PathChunk> chunk);
  void clear();

  /// Uploads chunks until `budget_bytes` are used up, but at least one. Appends the boxes of what
  /// came or changed. Returns the bytes.
  std::size_t upload(std::size_t budget_bytes, std::vector<Box>* changed_mm);
  bool has_waiting() const { return !waiting_.empty(); }

  /// Appends the box of the segments that turn from future to past or back.
  void set_past(std::uint64_t vertices, std::vector<Box>* changed_mm);

  void project(const Projection& projection);
  void draw(const ScreenRect& rect, const PathColors& colors) const;

  std::size_t gpu_bytes() const { return gpu_bytes_; }

 private:
  struct Chunk {
    std::shared_ptr<const PathChunk> values;  ///< null until uploaded
    GlVertexArray array;
    GlBuffer vertices;
    Box box_mm;
    ScreenRect rect;
  };

  explicit PathStore(GlProgram program) : program_(std::move(program)) {}
  void load(Chunk* chunk, std::shared_ptr<const PathChunk> values);
  std::size_t stride() const;

  GlProgram program_;
  std::vector<Chunk> chunks_;
  std::deque<std::shared_ptr<const PathChunk>> waiting_;
  std::uint64_t past_vertices_ = 0;
  std::size_t vertex_count_ = 0;
  std::size_t drawn_stride_ = 1;
  std::size_t gpu_bytes_ = 0;
  Box dropped_mm_;
  Projection projection_;
};

}  // namespace kerf
