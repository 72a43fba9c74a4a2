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

constexpr std::size_t kRunIndices = 3 * 512;

Box box_of(const MeshPatch& patch, std::size_t begin, std::size_t end) {
  glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  for (std::size_t i = begin; i < end; ++i) {
    const glm::vec3& at = patch.vertices[patch.indices[i]].position_mm;
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
  return {Vec3(low), Vec3(high)};
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

/// After so many the card begins to draw. Where that is a processor, it has to keep a quarter of a
/// kilobyte of each until then.
constexpr std::size_t kFlushedTriangles = 16'384;

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
    const bool is_other_level = !tile.patch || tile.patch->level != next->second->level;
    const bool will_draw_skirts = meets_other_level(*next->second);
    if (!tile.rect.empty() || !covered.empty()) {
      const Box changed =
          changed_box(tile.patch.get(), *next->second, tile.draws_skirts || will_draw_skirts);
      if (!changed.empty()) changed_mm->push_back(changed);
    }
    load(&tile, std::move(next->second));
    tile.draws_skirts = will_draw_skirts;
    if (is_other_level) {
      for_tiles_beside(*tile.patch, [&](Tile& beside) {
        const bool did = std::exchange(beside.draws_skirts, meets_other_level(*beside.patch));
        if (did != beside.draws_skirts) changed_mm->push_back(beside.box_mm);
      });
    }
    bytes += size;
    waiting_bytes_ -= size;
    waiting_.erase(next);
    waiting_order_.pop_front();
  }
  return bytes;
}

template <class With>
void PatchStore::for_tiles_beside(const MeshPatch& patch, const With& with) {
  const std::uint32_t row = patch.tiles_in_row;
  if (row == 0) return;
  const auto tell = [&](std::uint32_t number) {
    const auto found = tiles_.find(number);
    if (found != tiles_.end() && found->second.patch) with(found->second);
  };
  const std::uint32_t tile = patch.tile;
  if (tile >= row) tell(tile - row);
  if (tile % row > 0) tell(tile - 1);
  if (tile % row + 1 < row) tell(tile + 1);
  tell(tile + row);
}

bool PatchStore::meets_other_level(const MeshPatch& patch) {
  bool does = false;
  for_tiles_beside(patch, [&](const Tile& beside) { does |= beside.patch->level != patch.level; });
  return does;
}

/// The last ones are those of the skirts alone.
std::vector<PatchStore::Run> PatchStore::runs_of(const MeshPatch& patch) {
  std::vector<Run> runs;
  const auto add = [&](std::size_t begin, std::size_t end) {
    for (; begin < end; begin += kRunIndices) {
      const std::size_t run_end = std::min(begin + kRunIndices, end);
      runs.push_back({begin, run_end, box_of(patch, begin, run_end)});
    }
  };
  add(0, patch.skirt_begin);
  add(patch.skirt_begin, patch.indices.size());
  return runs;
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
  gpu_bytes_ -= tile->gpu_bytes;
  tile->gpu_bytes = bytes_of(*patch);
  gpu_bytes_ += tile->gpu_bytes;
  tile->index_type = index_type;
  tile->box_mm = box_of(*patch);
  tile->runs = runs_of(*patch);
  tile->rect = covered_rect(tile->box_mm, projection_);
  tile->patch = std::move(patch);
  bounds_mm_.extend(tile->box_mm);
}

void PatchStore::project(const Projection& projection) {
  projection_ = projection;
  for (auto& [number, tile] : tiles_) tile.rect = covered_rect(tile.box_mm, projection);
}

std::size_t PatchStore::draw(const ScreenRect& rect, VertexData data, bool having) const {
  std::size_t triangles = 0, flushed = 0;
  for (const auto& [number, tile] : tiles_) {
    if (!tile.rect.intersects(rect) || has(*tile.patch, data) != having) continue;
    glBindVertexArray(tile.array.name());
    triangles += draw_runs(tile, rect);
    if (triangles < flushed + kFlushedTriangles) continue;
    glFlush();
    flushed = triangles;
  }
  return triangles;
}

std::size_t PatchStore::draw_runs(const Tile& tile, const ScreenRect& rect) const {
  const std::size_t index_bytes = tile.index_type == GL_UNSIGNED_SHORT ? 2 : 4;
  const bool is_whole = tile.rect.common(rect) == tile.rect;
  std::size_t triangles = 0;
  std::size_t begin = 0, end = 0;
  const auto draw_seen = [&] {
    if (end <= begin) return;
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(end - begin), tile.index_type,
                   reinterpret_cast<const void*>(begin * index_bytes));
    triangles += (end - begin) / 3;
  };
  for (const Run& run : tile.runs) {
    if (run.begin >= tile.patch->skirt_begin && !tile.draws_skirts) break;
    if (!is_whole && !covered_rect(run.box_mm, projection_).intersects(rect)) continue;
    if (run.begin != end) {
      draw_seen();
      begin = run.begin;
    }
    end = run.end;
  }
  draw_seen();
  return triangles;
}

}  // namespace kerf
