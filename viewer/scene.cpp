#include "viewer/scene.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace kerf {
namespace {

constexpr int kRimSegments = 64;

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

std::vector<std::shared_ptr<const PathChunk>> path_chunks(const std::vector<PathVertex>& vertices) {
  std::vector<std::shared_ptr<const PathChunk>> chunks;
  for (std::size_t first = 0; first + 1 < vertices.size(); first += kPathChunkSegments) {
    const std::size_t count = std::min(kPathChunkSegments + 1, vertices.size() - first);
    const auto begin = vertices.begin() + static_cast<std::ptrdiff_t>(first);
    chunks.push_back(std::make_shared<const PathChunk>(
        PathChunk{static_cast<std::uint32_t>(chunks.size()),
                  {begin, begin + static_cast<std::ptrdiff_t>(count)}}));
  }
  return chunks;
}

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

std::vector<LineSegment> cylinder_outline(const Vec3& base_mm, char axis, double radius_mm,
                                          double height_mm) {
  const int along = axis == 'X' ? 0 : axis == 'Y' ? 1 : 2;
  const auto rim = [&](int step, double height) {
    const double angle = 2.0 * kPi * step / kRimSegments;
    Vec3 p = base_mm;
    p[along] += height;
    p[(along + 1) % 3] += radius_mm * std::cos(angle);
    p[(along + 2) % 3] += radius_mm * std::sin(angle);
    return glm::vec3(p);
  };
  std::vector<LineSegment> lines;
  for (int step = 0; step < kRimSegments; ++step) {
    lines.push_back({rim(step, 0.0), rim(step + 1, 0.0)});
    lines.push_back({rim(step, height_mm), rim(step + 1, height_mm)});
    if (step % (kRimSegments / 4) == 0) lines.push_back({rim(step, 0.0), rim(step, height_mm)});
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
  replace_if(&older->road, std::move(newer.road));
  replace_if(&older->job, std::move(newer.job));
  replace_if(&older->setup, std::move(newer.setup));
  replace_if(&older->tool_shape, std::move(newer.tool_shape));
  replace_if(&older->findings, std::move(newer.findings));
  replace_if(&older->program, std::move(newer.program));
  replace_if(&older->timeline, std::move(newer.timeline));
  replace_if(&older->machine, std::move(newer.machine));
  replace_if(&older->colors, std::move(newer.colors));
  replace_if(&older->picked, std::move(newer.picked));
  replace_if(&older->moment, std::move(newer.moment));
}

}  // namespace kerf
