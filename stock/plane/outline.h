// stock/plane/outline.h - plane outlines of workpieces and of pieces of them, as chains of points.
#pragma once

#include <string>
#include <vector>

#include "base/geometry.h"
#include "base/result.h"

namespace kerf {

/// Closed chains of points, mm; the last is joined to the first. Of rings within rings every other
/// one bounds a hole, whichever way they turn. Arcs are chords.
struct PlaneOutline {
  std::vector<std::vector<Vec2>> rings;
  /// Where each ring begins in the file it was read from; empty if it is from nowhere.
  std::vector<int> lines;
};

/// What outlines of drawings and sheets are kept to: 0.1 um.
inline constexpr double kOutlineUnit_mm = 1e-4;

/// Four corners.
PlaneOutline rectangle_outline(const Vec2& low_mm, const Vec2& high_mm);

/// Error if the outline bounds no area, with the place: no ring, a ring of less than
/// three corners or of no area, a coordinate that is no number or beyond 100 m, edges of one ring
/// or of two that cross or lie on each other. Corners may touch.
///     ring 1 (line 12) crosses itself at X10.5 Y20
///     ring 1 (line 12) and ring 2 (line 30) cross at X10.5 Y20
/// Corners are looked at in whole steps of `unit_mm`, beyond 2^30 of which nothing may lie.
/// O((n + k) log n) for n edges of which k pairs overlap in x.
Done check_outline(const PlaneOutline& outline, double unit_mm = kOutlineUnit_mm);

}  // namespace kerf
