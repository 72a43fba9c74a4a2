// viewer/window/path_thinning.h - a toolpath through fewer of its vertices. For the sources of
// viewer/ only; knows no OpenGL.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "viewer/scene.h"

namespace kerf {

/// Places in `vertices` of those that stay, ascending: the first, the last, those at which the kind
/// changes, and so many others that what is left out lies within `tolerance_mm` of the chord that
/// takes its place. So does all of the path between, and no place of a chord is further from it.
/// Each chord reaches about as far as it can; none replaces segments of two kinds, or is longer
/// than kLongestChord tolerances: where the tool is, a whole chord is drawn anew. `vertices` is not
/// empty. O(n log k), k being the segments that a chord replaces.
inline constexpr double kLongestChord = 256.0;
std::vector<std::uint32_t> thinned_path(std::span<const PathVertex> vertices, double tolerance_mm);

/// A path through fewer vertices that is nowhere further than the tolerance from it.
struct PathLevel {
  double tolerance_mm = 0.0;
  std::vector<std::uint32_t> kept;  ///< As of thinned_path().
};

/// From the finest to the coarsest. Tolerances are kFinestLevel_mm times a power of kLevelStep, and
/// those levels are left out that have more than half of the vertices of the next finer one: all
/// together have no more vertices than `vertices`.
inline constexpr double kFinestLevel_mm = 0.005;
inline constexpr double kLevelStep = 2.0;
std::vector<PathLevel> path_levels(std::span<const PathVertex> vertices);

}  // namespace kerf
