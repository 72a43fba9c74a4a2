// tests/stock/turning/turning_samples.h - inserts, moves and volumes that several tests need.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "stock/cutter/insert_shape.h"
#include "stock/turning/turned_part.h"

namespace kerf::turning_test {

inline TurnMove line(const Vec2& from, const Vec2& to, std::uint64_t id = 0) {
  return {from, to, std::nullopt, id};
}
/// By a share of a turn, counter-clockwise with z to the right.
inline TurnMove arc(const Vec2& from, const Vec2& center, double turns, std::uint64_t id = 0) {
  const Vec2 d = from - center;
  const double angle = std::atan2(d.y, d.x) + 2 * kPi * turns;
  const double r = std::hypot(d.x, d.y);
  const Vec2 to = center + r * Vec2(std::cos(angle), std::sin(angle));
  return {from, to, TurnArc{center, 2 * kPi * turns}, id};
}

inline double radians(double degrees) { return degrees * kPi / 180; }

/// A right-hand tool: cuts toward -z, its front flank leans back by 5 degrees, its back by 35.
inline InsertOutline right_hand(double radius_mm) {
  return *nose_insert({radius_mm, 2, radians(85), radians(30), 12});
}
/// A disc about the controlled point.
inline InsertOutline round_insert(double radius_mm) {
  return *nose_insert({radius_mm, 9, 0, 0, 10});
}

inline double cylinder_mm3(double diameter, double length) {
  return kPi / 4 * diameter * diameter * length;
}
inline double cone_mm3(double r0, double r1, double length) {
  return kPi / 3 * length * (r0 * r0 + r0 * r1 + r1 * r1);
}

/// Along a way, each from where the last one ended.
inline double cut_along(TurnedPart& part, const TurningTool& tool, const std::vector<Vec2>& way) {
  double removed = 0;
  for (std::size_t i = 1; i < way.size(); ++i)
    removed += part.cut(tool, line(way[i - 1], way[i], i)).removed_mm3;
  return removed;
}

}  // namespace kerf::turning_test
