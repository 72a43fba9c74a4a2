// stock/cutter/cutting_edge.h - a cutter's profile as what cuts: its edge as points, its point.
#pragma once

#include <cmath>
#include <vector>

#include "base/portable_math.h"
#include "stock/cutter/cutter.h"

namespace kerf {

/// Of whose flutes nobody has said it: as most end mills have it.
inline constexpr double kUsualHelix_deg = 30;

/// r and z from the tip up, mm; so close that chords of arcs do not count.
inline std::vector<Vec2> edge_points(const Cutter& cutter) {
  constexpr int kArcPoints = 64;
  std::vector<Vec2> points;
  for (const ProfilePiece& piece : cutter.profile()) {
    if (points.empty()) points.emplace_back(piece.r0, piece.z0);
    if (piece.kind == ProfilePiece::Kind::kArc) {
      const Vec2 center(piece.center_r, piece.center_z);
      const double from = portable::atan2(piece.z0 - center.y, piece.r0 - center.x);
      const double to = portable::atan2(piece.z1 - center.y, piece.r1 - center.x);
      for (int k = 1; k < kArcPoints; ++k) {
        const double angle = from + (to - from) * k / kArcPoints;
        points.push_back(center + piece.radius * Vec2(portable::cos(angle), portable::sin(angle)));
      }
    }
    points.emplace_back(piece.r1, piece.z1);
  }
  return points;
}

/// The angle of its point, where that is a cone; 180: it is none.
inline double point_deg(const Cutter& cutter) {
  const ProfilePiece& first = cutter.profile().front();
  const double rise = first.z1 - first.z0, wide = first.r1 - first.r0;
  const bool is_cone = first.kind == ProfilePiece::Kind::kLine && rise > 0 && wide > 0;
  return is_cone ? 2 * portable::atan2(wide, rise) * 180 / kPi : 180;
}

}  // namespace kerf
