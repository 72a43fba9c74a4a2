#include "viewer/scene.h"

#include <algorithm>
#include <cassert>
#include <limits>
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

SourceFile::SourceFile(std::string path, std::string text)
    : path_(std::move(path)), text_(std::move(text)) {
  assert(text_.size() <= std::numeric_limits<std::uint32_t>::max());
  for (std::size_t start = 0; start < text_.size();) {
    starts_.push_back(static_cast<std::uint32_t>(start));
    const std::size_t end = text_.find('\n', start);
    if (end == std::string::npos) break;
    start = end + 1;
  }
  starts_.shrink_to_fit();
}

std::string_view SourceFile::line(int number) const {
  if (number < 1 || number > line_count()) return {};
  const auto index = static_cast<std::size_t>(number - 1);
  const std::size_t end = index + 1 < starts_.size() ? starts_[index + 1] : text_.size();
  std::string_view text = std::string_view(text_).substr(starts_[index], end - starts_[index]);
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.remove_suffix(1);
  return text;
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
