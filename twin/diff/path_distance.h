// twin/diff/path_distance.h - how far two ways of a tool are apart, however they are divided.
#pragma once

#include <optional>
#include <span>

#include "twin/diff/diff_steps.h"

namespace kerf {

/// Where two ways are farthest apart.
struct PathDistance {
  double mm = 0;  ///< with angles and slides as lengths: WayTolerance
  Vec3 at_mm{0};  ///< on one of them
  SourceRef a, b;
};

/// How far axes that turn may be off, as lengths.
inline constexpr double kTurnLever_mm = 50;

/// Each way goes on through its steps, all of which have_way(). An arc and its chords are as far
/// apart as the chords' middles are; a line divided in three is no farther from the whole one than
/// rounding. The greatest distance of a point of either way from the other one, points taken in
/// order: who turns back, or goes round twice, is told from who does not. Points: ends, quarters
/// of lines, arcs every 5 degrees; nearest points are exact. What is beyond `enough_mm` (as near is
/// the same to the caller) may be told as more than it is, up to the distance of ends.
/// O(steps of both).
PathDistance path_distance(std::span<const DiffStep> a, std::span<const DiffStep> b,
                           double enough_mm);

}  // namespace kerf
