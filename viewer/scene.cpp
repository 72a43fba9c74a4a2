#include "viewer/scene.h"

#include <algorithm>
#include <map>
#include <utility>

namespace kerf {
namespace {

/// Of elements with the same key only the last stays.
template <class Element, class Key>
void keep_last(std::vector<std::shared_ptr<const Element>>* elements, Key key) {
  std::map<std::uint32_t, std::shared_ptr<const Element>> last;
  for (auto& element : *elements) last[key(*element)] = std::move(element);
  elements->clear();
  for (auto& [index, element] : last) elements->push_back(std::move(element));
}

template <class Value>
void replace_if(std::shared_ptr<const Value>* older, std::shared_ptr<const Value> newer) {
  if (newer) *older = std::move(newer);
}

}  // namespace

std::vector<LineSegment> box_outline(const Box& box) {
  std::vector<LineSegment> lines;
  if (box.empty()) return lines;
  const auto corner = [&box](unsigned bits) {
    return glm::vec3(static_cast<float>((bits & 1u) ? box.max.x : box.min.x),
                     static_cast<float>((bits & 2u) ? box.max.y : box.min.y),
                     static_cast<float>((bits & 4u) ? box.max.z : box.min.z));
  };
  for (unsigned from = 0; from < 8; ++from) {
    for (const unsigned axis : {1u, 2u, 4u}) {
      if ((from & axis) == 0) lines.push_back({corner(from), corner(from | axis)});
    }
  }
  return lines;
}

void merge(SceneUpdate* older, SceneUpdate newer) {
  if (newer.clears) {
    older->clears = true;
    older->patches.clear();
    older->path.clear();
    older->path_chunk_count.reset();
    older->findings.reset();
    older->heights.reset();
    older->cut_moves.reset();
  }
  older->patches.insert(older->patches.end(), newer.patches.begin(), newer.patches.end());
  keep_last(&older->patches, [](const MeshPatch& patch) { return patch.tile; });
  if (newer.path_chunk_count) {
    const std::uint32_t count = *newer.path_chunk_count;
    std::erase_if(older->path, [count](const auto& chunk) { return chunk->index >= count; });
    older->path_chunk_count =
        older->path_chunk_count ? std::min(*older->path_chunk_count, count) : count;
  }
  older->path.insert(older->path.end(), newer.path.begin(), newer.path.end());
  keep_last(&older->path, [](const PathChunk& chunk) { return chunk.index; });
  replace_if(&older->heights, std::move(newer.heights));
  replace_if(&older->cut_moves, std::move(newer.cut_moves));
  replace_if(&older->draw_mode, std::move(newer.draw_mode));
  replace_if(&older->job, std::move(newer.job));
  replace_if(&older->setup, std::move(newer.setup));
  replace_if(&older->tool_shape, std::move(newer.tool_shape));
  replace_if(&older->findings, std::move(newer.findings));
  replace_if(&older->program, std::move(newer.program));
  replace_if(&older->timeline, std::move(newer.timeline));
  replace_if(&older->curves, std::move(newer.curves));
  replace_if(&older->machine, std::move(newer.machine));
  replace_if(&older->fixtures, std::move(newer.fixtures));
  replace_if(&older->colors, std::move(newer.colors));
  replace_if(&older->picked, std::move(newer.picked));
  replace_if(&older->entry, std::move(newer.entry));
  replace_if(&older->moment, std::move(newer.moment));
}

}  // namespace kerf
