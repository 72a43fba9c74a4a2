#include "viewer/window/patch_store.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <glm/common.hpp>
#include <limits>
#include <type_traits>
#include <utility>

#include "viewer/window/mesh_buffers.h"
#include "viewer/window/patch_change.h"

namespace kerf {
namespace {

/// Patches with fewer vertices have 16-bit indices on the card.
constexpr std::size_t kShortIndexVertices = 65536;

std::size_t bytes_of(const MeshPatch& patch) {
  const std::size_t index_bytes = patch.vertices.size() < kShortIndexVertices ? 2 : 4;
  return patch.vertices.size() * sizeof(MeshVertex) + patch.indices.size() * index_bytes +
         patch.cut_by.size() * sizeof(std::uint32_t) + patch.deviation_mm.size() * sizeof(float);
}

bool same_content(const MeshPatch& a, const MeshPatch& b) {
  return a.version == b.version && a.level == b.level && a.cut_by.empty() == b.cut_by.empty() &&
         a.deviation_mm.empty() == b.deviation_mm.empty();
}

Box box_of(const MeshPatch& patch) {
  Box box;
  for (const MeshVertex& vertex : patch.vertices) box.extend(Vec3(vertex.position_mm));
  return box;
}

std::size_t index_count(const MeshPatch& patch, bool with_skirts) {
  return (with_skirts ? patch.indices.size() : patch.skirt_begin) / 3 * 3;
}

/// Triangles that follow each other in a patch lie near each other: of a tile that a rectangle
/// cuts, only those runs of this many indices are drawn whose boxes it meets.
constexpr std::size_t kRunIndices = 3 * 512;

std::vector<Box> run_boxes_of(const MeshPatch& patch) {
  std::vector<Box> boxes;
  for (std::size_t begin = 0; begin < patch.indices.size(); begin += kRunIndices) {
    glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    const std::size_t end = std::min(begin + kRunIndices, patch.indices.size());
    for (std::size_t i = begin; i < end; ++i) {
      const glm::vec3& at = patch.vertices[patch.indices[i]].position_mm;
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
    boxes.push_back({Vec3(low), Vec3(high)});
  }
  return boxes;
}

/// The card takes a triangle's move from its last corner. A wall belongs to the move that cut what
/// lies below it, so triangles are turned until their lowest corner comes last; of equally low ones
/// that which was cut last.
std::vector<std::uint32_t> turned_indices(const MeshPatch& patch) {
  std::vector<std::uint32_t> turned = patch.indices;
  const auto is_below = [&patch](std::uint32_t a, std::uint32_t b) {
    const float za = patch.vertices[a].position_mm.z, zb = patch.vertices[b].position_mm.z;
    if (za != zb) return za < zb;
    // Plus one: kNotCut comes before all moves.
    return patch.cut_by[a] + 1 > patch.cut_by[b] + 1;
  };
  for (std::size_t t = 0; t + 2 < turned.size(); t += 3) {
    const auto corners = turned.begin() + static_cast<std::ptrdiff_t>(t);
    const auto lowest = std::min_element(corners, corners + 3, is_below);
    std::rotate(corners, lowest == corners + 2 ? corners : lowest + 1, corners + 3);
  }
  return turned;
}

/// For the vertex array bound now.
void load_indices(GLuint buffer, const std::vector<std::uint32_t>& indices, bool is_short) {
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer);
  if (is_short) {
    const std::vector<std::uint16_t> shorts(indices.begin(), indices.end());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(shorts.size() * 2), shorts.data(),
                 GL_DYNAMIC_DRAW);
  } else {
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * 4),
                 indices.data(), GL_DYNAMIC_DRAW);
  }
}

/// Values of vertices behind a buffer of their own, as integers or as floats; none: no buffer.
template <class Value>
void load_values(GLuint attribute, const std::vector<Value>& values,
                 std::optional<GlBuffer>* buffer) {
  if (values.empty()) {
    glDisableVertexAttribArray(attribute);
    buffer->reset();
    return;
  }
  if (!*buffer) buffer->emplace();
  glBindBuffer(GL_ARRAY_BUFFER, (*buffer)->name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(values.size() * sizeof(Value)),
               values.data(), GL_DYNAMIC_DRAW);
  glEnableVertexAttribArray(attribute);
  if constexpr (std::is_integral_v<Value>) {
    glVertexAttribIPointer(attribute, 1, GL_UNSIGNED_INT, 0, nullptr);
  } else {
    glVertexAttribPointer(attribute, 1, GL_FLOAT, GL_FALSE, 0, nullptr);
  }
}

bool has(const MeshPatch& patch, VertexData data) {
  switch (data) {
    case VertexData::kCutBy:
      return !patch.cut_by.empty();
    case VertexData::kDeviation:
      return !patch.deviation_mm.empty();
    case VertexData::kNone:
      break;
  }
  return true;
}

}  // namespace

void PatchStore::offer(std::shared_ptr<const MeshPatch> patch) {
  assert(patch->cut_by.empty() || patch->cut_by.size() == patch->vertices.size());
  assert(patch->deviation_mm.empty() || patch->deviation_mm.size() == patch->vertices.size());
  const auto known = tiles_.find(patch->tile);
  const bool is_known = known != tiles_.end() && same_content(*known->second.patch, *patch);
  const auto waiting = waiting_.find(patch->tile);
  if (waiting != waiting_.end()) {
    waiting_bytes_ -= bytes_of(*waiting->second);
    if (is_known) {
      // Back to what is shown already, before what came between was.
      waiting_.erase(waiting);
      std::erase(waiting_order_, patch->tile);
      return;
    }
    waiting_bytes_ += bytes_of(*patch);
    waiting->second = std::move(patch);
  } else if (!is_known) {
    waiting_bytes_ += bytes_of(*patch);
    waiting_order_.push_back(patch->tile);
    waiting_.emplace(patch->tile, std::move(patch));
  }
}

void PatchStore::clear() {
  tiles_.clear();
  waiting_.clear();
  waiting_order_.clear();
  waiting_bytes_ = 0;
  gpu_bytes_ = 0;
  tiles_by_level_.clear();
  bounds_mm_ = {};
}

std::size_t PatchStore::upload(std::size_t budget_bytes, std::vector<Box>* changed_mm) {
  std::size_t bytes = 0;
  while (!waiting_order_.empty()) {
    const auto next = waiting_.find(waiting_order_.front());
    const std::size_t size = bytes_of(*next->second);
    if (bytes > 0 && bytes + size > budget_bytes) break;
    Tile& tile = tiles_[next->first];
    // First what the tile covers on the screen; only if there is anything, which part of it.
    const ScreenRect covered = covered_rect(box_of(*next->second), projection_);
    if (!tile.rect.empty() || !covered.empty()) {
      const Box changed = changed_box(tile.patch.get(), *next->second, draws_skirts());
      if (!changed.empty()) changed_mm->push_back(changed);
    }
    load(&tile, std::move(next->second));
    bytes += size;
    waiting_bytes_ -= size;
    waiting_.erase(next);
    waiting_order_.pop_front();
  }
  return bytes;
}

void PatchStore::load(Tile* tile, std::shared_ptr<const MeshPatch> patch) {
  glBindVertexArray(tile->array.name());
  glBindBuffer(GL_ARRAY_BUFFER, tile->vertices.name());
  glBufferData(GL_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(patch->vertices.size() * sizeof(MeshVertex)),
               patch->vertices.data(), GL_DYNAMIC_DRAW);
  point_to_mesh_vertices();
  load_values(2, patch->cut_by, &tile->cut_by);
  load_values(3, patch->deviation_mm, &tile->deviations);
  const bool is_short = patch->vertices.size() < kShortIndexVertices;
  const GLenum index_type = is_short ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT;
  const bool keeps_indices = tile->patch && tile->patch->cut_by.empty() && patch->cut_by.empty() &&
                             tile->index_type == index_type &&
                             tile->patch->indices == patch->indices;
  if (!keeps_indices && patch->cut_by.empty()) {
    load_indices(tile->indices.name(), patch->indices, is_short);
  } else if (!keeps_indices) {
    load_indices(tile->indices.name(), turned_indices(*patch), is_short);
  }
  if (tile->patch && --tiles_by_level_[tile->patch->level] == 0) {
    tiles_by_level_.erase(tile->patch->level);
  }
  ++tiles_by_level_[patch->level];
  gpu_bytes_ -= tile->gpu_bytes;
  tile->gpu_bytes = bytes_of(*patch);
  gpu_bytes_ += tile->gpu_bytes;
  tile->index_type = index_type;
  tile->box_mm = box_of(*patch);
  tile->run_boxes_mm = run_boxes_of(*patch);
  tile->rect = covered_rect(tile->box_mm, projection_);
  tile->patch = std::move(patch);
  bounds_mm_.extend(tile->box_mm);
}

void PatchStore::project(const Projection& projection) {
  projection_ = projection;
  for (auto& [number, tile] : tiles_) tile.rect = covered_rect(tile.box_mm, projection);
}

std::size_t PatchStore::draw(const ScreenRect& rect, VertexData data, bool having) const {
  std::size_t triangles = 0;
  for (const auto& [number, tile] : tiles_) {
    if (!tile.rect.intersects(rect) || has(*tile.patch, data) != having) continue;
    glBindVertexArray(tile.array.name());
    triangles += draw_runs(tile, rect);
  }
  return triangles;
}

std::size_t PatchStore::draw_runs(const Tile& tile, const ScreenRect& rect) const {
  const std::size_t end = index_count(*tile.patch, draws_skirts());
  const std::size_t index_bytes = tile.index_type == GL_UNSIGNED_SHORT ? 2 : 4;
  const bool is_whole = tile.rect.common(rect) == tile.rect;
  std::size_t triangles = 0;
  std::size_t begin = 0, seen_end = 0;
  const auto draw_seen = [&] {
    if (seen_end <= begin) return;
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(seen_end - begin), tile.index_type,
                   reinterpret_cast<const void*>(begin * index_bytes));
    triangles += (seen_end - begin) / 3;
  };
  for (std::size_t run = 0; run * kRunIndices < end; ++run) {
    const std::size_t run_begin = run * kRunIndices;
    if (!is_whole && !covered_rect(tile.run_boxes_mm[run], projection_).intersects(rect)) continue;
    if (run_begin != seen_end) {
      draw_seen();
      begin = run_begin;
    }
    seen_end = std::min(run_begin + kRunIndices, end);
  }
  draw_seen();
  return triangles;
}

}  // namespace kerf
