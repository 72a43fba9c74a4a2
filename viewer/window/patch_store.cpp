#include "viewer/window/patch_store.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace kerf {
namespace {

/// Patches with fewer vertices have 16-bit indices on the card.
constexpr std::size_t kShortIndexVertices = 65536;

std::size_t bytes_of(const MeshPatch& patch) {
  const std::size_t index_bytes = patch.vertices.size() < kShortIndexVertices ? 2 : 4;
  return patch.vertices.size() * sizeof(MeshVertex) + patch.indices.size() * index_bytes;
}

bool same(const MeshVertex& a, const MeshVertex& b) {
  return a.position_mm == b.position_mm && a.normal == b.normal;
}

bool same_content(const MeshPatch& a, const MeshPatch& b) {
  return a.version == b.version && a.level == b.level;
}

void extend(Box* box, const MeshPatch& patch, std::size_t corner) {
  box->extend(Vec3(patch.vertices[patch.indices[corner]].position_mm));
}

Box box_of(const MeshPatch& patch) {
  Box box;
  for (const MeshVertex& vertex : patch.vertices) box.extend(Vec3(vertex.position_mm));
  return box;
}

/// Same triangles between other vertices: those with a vertex that moved or turned.
Box moved_box(const MeshPatch& before, const MeshPatch& after, std::size_t index_count) {
  Box box;
  const auto moved = [&](std::size_t corner) {
    const std::uint32_t v = after.indices[corner];
    return !same(before.vertices[v], after.vertices[v]);
  };
  for (std::size_t t = 0; t + 2 < index_count; t += 3) {
    if (!moved(t) && !moved(t + 1) && !moved(t + 2)) continue;
    for (std::size_t corner = t; corner < t + 3; ++corner) {
      extend(&box, before, corner);
      extend(&box, after, corner);
    }
  }
  return box;
}

/// Other triangles: all but those that both lists begin and end with.
Box exchanged_box(const MeshPatch& before, std::size_t before_end, const MeshPatch& after,
                  std::size_t after_end) {
  const auto same_triangle = [&](std::size_t a, std::size_t b) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!same(before.vertices[before.indices[a + k]], after.vertices[after.indices[b + k]])) {
        return false;
      }
    }
    return true;
  };
  std::size_t first = 0;
  while (first < std::min(before_end, after_end) && same_triangle(first, first)) first += 3;
  while (std::min(before_end, after_end) > first && same_triangle(before_end - 3, after_end - 3)) {
    before_end -= 3;
    after_end -= 3;
  }
  Box box;
  for (std::size_t corner = first; corner < before_end; ++corner) extend(&box, before, corner);
  for (std::size_t corner = first; corner < after_end; ++corner) extend(&box, after, corner);
  return box;
}

std::size_t index_count(const MeshPatch& patch, bool with_skirts) {
  return (with_skirts ? patch.indices.size() : patch.skirt_begin) / 3 * 3;
}

}  // namespace

Box changed_box(const MeshPatch* before, const MeshPatch& after, bool with_skirts) {
  if (!before) return box_of(after);
  const std::size_t before_end = index_count(*before, with_skirts);
  const std::size_t after_end = index_count(after, with_skirts);
  const bool same_triangles = before->vertices.size() == after.vertices.size() &&
                              before_end == after_end && before->indices == after.indices;
  return same_triangles ? moved_box(*before, after, after_end)
                        : exchanged_box(*before, before_end, after, after_end);
}

void PatchStore::offer(std::shared_ptr<const MeshPatch> patch) {
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
    const Box changed = changed_box(tile.patch.get(), *next->second, draws_skirts());
    if (!changed.empty()) changed_mm->push_back(changed);
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
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(MeshVertex), nullptr);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 4, GL_INT_2_10_10_10_REV, GL_TRUE, sizeof(MeshVertex),
                        reinterpret_cast<const void*>(offsetof(MeshVertex, normal)));
  const bool is_short = patch->vertices.size() < kShortIndexVertices;
  const GLenum index_type = is_short ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT;
  const bool keeps_indices =
      tile->patch && tile->index_type == index_type && tile->patch->indices == patch->indices;
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, tile->indices.name());
  if (!keeps_indices && is_short) {
    const std::vector<std::uint16_t> shorts(patch->indices.begin(), patch->indices.end());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(shorts.size() * 2), shorts.data(),
                 GL_DYNAMIC_DRAW);
  } else if (!keeps_indices) {
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(patch->indices.size() * 4),
                 patch->indices.data(), GL_DYNAMIC_DRAW);
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
  tile->rect = covered_rect(tile->box_mm, projection_);
  tile->patch = std::move(patch);
  bounds_mm_.extend(tile->box_mm);
}

void PatchStore::project(const Projection& projection) {
  projection_ = projection;
  for (auto& [number, tile] : tiles_) tile.rect = covered_rect(tile.box_mm, projection);
}

std::size_t PatchStore::draw(const ScreenRect& rect) const {
  std::size_t triangles = 0;
  for (const auto& [number, tile] : tiles_) {
    if (!tile.rect.intersects(rect)) continue;
    glBindVertexArray(tile.array.name());
    const std::size_t count = index_count(*tile.patch, draws_skirts());
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(count), tile.index_type, nullptr);
    triangles += count / 3;
  }
  return triangles;
}

}  // namespace kerf
