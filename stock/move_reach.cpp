#include "stock/move_reach.h"

#include <algorithm>
#include <cmath>

namespace kerf {
namespace {

bool holds(const Box& box, const Vec3& p) {  // not true of NaN
  return p.x >= box.min.x && p.x <= box.max.x && p.y >= box.min.y && p.y <= box.max.y &&
         p.z >= box.min.z && p.z <= box.max.z;
}

bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool arc_in_reach(const CutArc& arc, const Box& box) {
  const Vec3 from_blank = arc.center_mm - 0.5 * (box.min + box.max);
  const double farthest =
      std::max({std::abs(from_blank.x), std::abs(from_blank.y), std::abs(from_blank.z)});
  return is_finite(arc.center_mm) && farthest <= kFarthestMoveCenter_mm && is_finite(arc.axis) &&
         std::abs(arc.sweep_rad) <= 2 * kPi * kMostMoveTurns;
}

/// Keeps the part with sign * (p[axis] - limit) >= 0; false if there is none. The new end is at the
/// limit exactly: of numbers this far apart a share of the way would have no digits left.
bool clip(int axis, double limit, int sign, CutMove& move) {
  const auto beyond = [&](const Vec3& p) { return sign * p[axis] < sign * limit; };
  const bool from = beyond(move.from_mm), to = beyond(move.to_mm);
  if (from && to) return false;
  if (!from && !to) return true;
  Vec3& out = from ? move.from_mm : move.to_mm;
  const Vec3& in = from ? move.to_mm : move.from_mm;
  // Halved, since the difference of two numbers may be infinite where they are not.
  const double share =
      (0.5 * limit - 0.5 * in[axis]) / (0.5 * out[axis] - 0.5 * in[axis]);  // from `in`
  for (int other = 0; other < 3; ++other) {
    if (out[other] != in[other]) out[other] = (1 - share) * in[other] + share * out[other];
  }
  out[axis] = limit;
  return true;
}

}  // namespace

std::optional<CutMove> within_reach(const CutMove& move, const Box& blank, double reach_mm) {
  const Box box{blank.min - Vec3(reach_mm), blank.max + Vec3(reach_mm)};
  const bool axes = is_finite(move.axis_from) && is_finite(move.axis_to);
  if (!axes || (move.arc && !arc_in_reach(*move.arc, box))) return std::nullopt;
  if (holds(box, move.from_mm) && holds(box, move.to_mm)) return move;
  if (move.arc || move.axis_from != move.axis_to) return std::nullopt;
  if (!is_finite(move.from_mm) || !is_finite(move.to_mm)) return std::nullopt;
  CutMove part = move;
  for (int axis = 0; axis < 3; ++axis) {
    if (!clip(axis, box.min[axis], 1, part) || !clip(axis, box.max[axis], -1, part)) {
      return std::nullopt;
    }
  }
  return part;
}

}  // namespace kerf
