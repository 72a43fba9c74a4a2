#include "viewer/window/panel_change.h"

#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

namespace kerf {
namespace {

/// Triangles that are nearer to each other share a rectangle: each costs a copy of its own.
constexpr int kNear_px = 12;
/// So do rectangles that then hold fewer pixels more: a draw call, a copy and a transfer of their
/// own cost a software renderer about as much. Of a program that runs fast, each line that is shown
/// has several words that change.
constexpr std::int64_t kSpare_px = 4000;

/// The scissor rectangle that the OpenGL back end of Dear ImGui makes of a clip rectangle: position
/// and size are cut off to whole pixels separately.
ScreenRect scissor_of(const ImVec4& clip, glm::ivec2 window_px) {
  const auto left = static_cast<int>(clip.x);
  const auto bottom = static_cast<int>(static_cast<float>(window_px.y) - clip.w);
  return {{left, bottom},
          {left + static_cast<int>(clip.z - clip.x), bottom + static_cast<int>(clip.w - clip.y)}};
}

ImVec4 clip_of(const ScreenRect& rect, glm::ivec2 window_px) {
  return {static_cast<float>(rect.min.x), static_cast<float>(window_px.y - rect.max.y),
          static_cast<float>(rect.max.x), static_cast<float>(window_px.y - rect.min.y)};
}

bool same(const ImDrawVert& a, const ImDrawVert& b) {
  return a.pos.x == b.pos.x && a.pos.y == b.pos.y && a.uv.x == b.uv.x && a.uv.y == b.uv.y &&
         a.col == b.col;
}

/// All pixels that triangles with these corners can touch.
ScreenRect rect_around(const ImVec2& low, const ImVec2& high, glm::ivec2 window_px) {
  const auto floor_of = [](float value) { return static_cast<int>(std::floor(value)); };
  return {{floor_of(low.x), window_px.y - floor_of(high.y) - 1},
          {floor_of(high.x) + 1, window_px.y - floor_of(low.y)}};
}

void extend(ImVec2* low, ImVec2* high, const ImVec2& at) {
  *low = {std::min(low->x, at.x), std::min(low->y, at.y)};
  *high = {std::max(high->x, at.x), std::max(high->y, at.y)};
}

/// Where a command of the list draws at all: mostly far less than its clip rectangle. Lines of text
/// have the whole panel for that.
ScreenRect drawn_rect(const ImDrawList& list, const ImDrawCmd& command, glm::ivec2 window_px) {
  if (command.ElemCount == 0) return {};
  const ImDrawIdx* const index = list.IdxBuffer.Data + command.IdxOffset;
  const ImDrawVert* const vertices = list.VtxBuffer.Data + command.VtxOffset;
  ImVec2 low = vertices[index[0]].pos, high = low;
  for (unsigned i = 1; i < command.ElemCount; ++i) extend(&low, &high, vertices[index[i]].pos);
  return rect_around(low, high, window_px).common(scissor_of(command.ClipRect, window_px));
}

ScreenRect with_border(const ScreenRect& rect, int border_px) {
  return {rect.min - glm::ivec2(border_px), rect.max + glm::ivec2(border_px)};
}

/// An array in Dear ImGui up to 1.89.7, a vector of its own since.
template <class Lists>
void put_lists(Lists& lists, std::vector<ImDrawList*>& touched) {
  if constexpr (std::is_pointer_v<Lists>) {
    lists = touched.data();
  } else {
    lists.resize(0);
    for (ImDrawList* const list : touched) lists.push_back(list);
  }
}

}  // namespace

bool PanelChange::Triangle::operator==(const Triangle& other) const {
  return same(corners[0], other.corners[0]) && same(corners[1], other.corners[1]) &&
         same(corners[2], other.corners[2]) && clip.x == other.clip.x && clip.y == other.clip.y &&
         clip.z == other.clip.z && clip.w == other.clip.w && texture == other.texture;
}

ScreenRect PanelChange::Triangle::rect(glm::ivec2 window_px) const {
  ImVec2 low = corners[0].pos, high = corners[0].pos;
  for (const ImDrawVert& corner : corners) extend(&low, &high, corner.pos);
  return rect_around(low, high, window_px)
      .common(scissor_of(clip, window_px))
      .common(ScreenRect::whole(window_px));
}

PanelChange::Triangles PanelChange::triangles_of(const ImDrawList& list) {
  Triangles triangles;
  triangles.reserve(static_cast<std::size_t>(list.IdxBuffer.Size / 3));
  for (const ImDrawCmd& command : list.CmdBuffer) {
    const ImDrawIdx* index = list.IdxBuffer.Data + command.IdxOffset;
    const ImDrawVert* vertices = list.VtxBuffer.Data + command.VtxOffset;
    for (unsigned i = 0; i + 2 < command.ElemCount; i += 3) {
      triangles.push_back({{vertices[index[i]], vertices[index[i + 1]], vertices[index[i + 2]]},
                           command.ClipRect,
                           command.GetTexID()});
    }
  }
  return triangles;
}

void PanelChange::find(const ImDrawData& data, glm::ivec2 window_px,
                       std::vector<ScreenRect>* changed) {
  const std::vector<Triangles> before = std::exchange(lists_, {});
  for (int i = 0; i < data.CmdListsCount; ++i) lists_.push_back(triangles_of(*data.CmdLists[i]));
  // A list is a panel; a new one may stand anywhere among them.
  if (before.size() != lists_.size()) {
    *changed = {ScreenRect::whole(window_px)};
    return;
  }
  ScreenRect run;  // of neighbours in the order of drawing
  const auto add = [&](const Triangle& triangle) {
    const ScreenRect rect = triangle.rect(window_px);
    if (rect.empty()) return;
    if (!with_border(run, kNear_px).intersects(rect)) {
      add_apart(run, changed, kSpare_px);
      run = {};
    }
    run.extend(rect);
  };
  for (std::size_t list = 0; list < lists_.size(); ++list) {
    const Triangles& older = before[list];
    const Triangles& newer = lists_[list];
    const auto [older_begin, newer_begin] =
        std::mismatch(older.begin(), older.end(), newer.begin(), newer.end());
    const auto [older_end, newer_end] =
        std::mismatch(older.rbegin(), std::make_reverse_iterator(older_begin), newer.rbegin(),
                      std::make_reverse_iterator(newer_begin));
    const bool is_paired = older.size() == newer.size();
    auto pair = newer_begin;
    for (auto at = older_begin; at != older_end.base(); ++at) {
      if (is_paired && *at == *pair++) continue;
      add(*at);
      if (is_paired) add(*std::prev(pair));
    }
    if (is_paired) continue;
    for (auto at = newer_begin; at != newer_end.base(); ++at) add(*at);
  }
  add_apart(run, changed, kSpare_px);
}

void draw_panels_in(const std::vector<ScreenRect>& rects, glm::ivec2 window_px, ImDrawData* data) {
  std::vector<ImVector<ImDrawCmd>> whole(static_cast<std::size_t>(data->CmdListsCount));
  std::vector<ImDrawList*> touched;
  for (int i = 0; i < data->CmdListsCount; ++i) {
    ImDrawList& list = *data->CmdLists[i];
    ImVector<ImDrawCmd>& commands = whole[static_cast<std::size_t>(i)];
    commands.swap(list.CmdBuffer);
    for (const ImDrawCmd& command : commands) {
      const ScreenRect drawn = drawn_rect(list, command, window_px);
      for (const ScreenRect& rect : rects) {
        const ScreenRect clip = drawn.common(rect);
        if (clip.empty()) continue;
        list.CmdBuffer.push_back(command);
        list.CmdBuffer.back().ClipRect = clip_of(clip, window_px);
      }
    }
    if (!list.CmdBuffer.empty()) touched.push_back(&list);
  }
  // Vertices of lists that are not drawn are not sent to the card.
  ImDrawData part = *data;
  put_lists(part.CmdLists, touched);
  part.CmdListsCount = static_cast<int>(touched.size());
  if (!touched.empty()) ImGui_ImplOpenGL3_RenderDrawData(&part);
  for (int i = 0; i < data->CmdListsCount; ++i) {
    data->CmdLists[i]->CmdBuffer.swap(whole[static_cast<std::size_t>(i)]);
  }
}

}  // namespace kerf
