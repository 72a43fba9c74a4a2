#include "viewer/window/path_thinning.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace kerf {
namespace {

/// Whether the vertices between `begin` and `end` are within the tolerance of the chord, and that
/// is no longer than it may be.
bool is_chord(std::span<const PathVertex> vertices, std::size_t begin, std::size_t end,
              double tolerance_mm) {
  const Vec3 from(vertices[begin].position_mm);
  const Vec3 chord = Vec3(vertices[end].position_mm) - from;
  const double length2 = glm::dot(chord, chord);
  const double longest_mm = kLongestChord * tolerance_mm;
  if (length2 > longest_mm * longest_mm) return false;
  const double per_length2 = length2 > 0.0 ? 1.0 / length2 : 0.0;
  const double limit = tolerance_mm * tolerance_mm;
  for (std::size_t i = begin + 1; i < end; ++i) {
    const Vec3 at = Vec3(vertices[i].position_mm) - from;
    const Vec3 off = at - std::clamp(glm::dot(at, chord) * per_length2, 0.0, 1.0) * chord;
    if (glm::dot(off, off) > limit) return false;
  }
  return true;
}

/// To where a chord from `begin` may reach: `last` at most.
std::size_t end_of_chord(std::span<const PathVertex> vertices, std::size_t begin, std::size_t last,
                         double tolerance_mm) {
  std::size_t good = begin + 1;
  std::size_t bad = last + 1;
  for (std::size_t reach = 2; good < last; reach *= 2) {
    const std::size_t end = std::min(begin + reach, last);
    if (!is_chord(vertices, begin, end, tolerance_mm)) {
      bad = end;
      break;
    }
    good = end;
  }
  while (good + 1 < bad) {
    const std::size_t middle = good + (bad - good) / 2;
    (is_chord(vertices, begin, middle, tolerance_mm) ? good : bad) = middle;
  }
  return good;
}

}  // namespace

std::vector<std::uint32_t> thinned_path(std::span<const PathVertex> vertices, double tolerance_mm) {
  std::vector<std::uint32_t> kept{0};
  std::size_t last = 0;  // vertex up to which the segments are of one kind
  std::size_t at = 0;
  while (at + 1 < vertices.size()) {
    if (last <= at) {
      last = at + 1;
      while (last + 1 < vertices.size() && vertices[last + 1].kind == vertices[last].kind) ++last;
    }
    at = end_of_chord(vertices, at, last, tolerance_mm);
    kept.push_back(static_cast<std::uint32_t>(at));
  }
  return kept;
}

std::vector<PathLevel> path_levels(std::span<const PathVertex> vertices) {
  std::vector<PathLevel> levels;
  if (vertices.empty()) return levels;
  Box box;
  for (const PathVertex& vertex : vertices) box.extend(Vec3(vertex.position_mm));
  const double size_mm = glm::length(box.size());
  std::vector<PathVertex> finer(vertices.begin(), vertices.end());
  double used_mm = 0.0;
  // With a tolerance of its size, anything of one kind is a line.
  for (double tolerance_mm = kFinestLevel_mm; tolerance_mm < kLevelStep * size_mm;
       tolerance_mm *= kLevelStep) {
    // What is thinned already may leave the path by its own tolerance.
    std::vector<std::uint32_t> kept = thinned_path(finer, tolerance_mm - used_mm);
    if (2 * kept.size() > finer.size()) continue;
    for (std::size_t i = 0; i < kept.size(); ++i) finer[i] = finer[kept[i]];
    finer.resize(kept.size());
    if (!levels.empty()) {
      for (std::uint32_t& place : kept) place = levels.back().kept[place];
    }
    levels.push_back({tolerance_mm, std::move(kept)});
    used_mm = tolerance_mm;
  }
  return levels;
}

}  // namespace kerf
