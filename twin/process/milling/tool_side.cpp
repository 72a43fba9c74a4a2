#include "twin/process/milling/tool_side.h"

#include <algorithm>
#include <cmath>

namespace kerf {

bool is_ball_end(const Cutter& cutter) {
  const double radius = cutter.radius_mm();
  for (const double part : {0.2, 0.5, 0.8, 0.99}) {
    const double ball = radius * (1 - std::sqrt(1 - part * part));
    if (std::abs(cutter.height_mm(part * radius) - ball) > 1e-9 * radius) return false;
  }
  return true;
}

ToolSide ToolSide::of(const Cutter& cutter) {
  ToolSide side;
  side.is_ball = is_ball_end(cutter);
  const double radius = cutter.radius_mm(), inner = 0.5 * radius, outer = 0.99 * radius;
  const double high = cutter.height_mm(outer);
  const double slope = (high - cutter.height_mm(inner)) / (outer - inner);
  if (slope <= 0) return side;
  const double flat = outer - high / slope;
  if (flat < -1e-9 * radius) return side;
  for (const double part : {0.05, 0.2, 0.35, 0.6, 0.8, 0.9}) {
    const double even = std::max(0.0, slope * (part * radius - flat));
    if (std::abs(cutter.height_mm(part * radius) - even) > 1e-9 * radius) return side;
  }
  side.slope = slope, side.flat_mm = std::max(0.0, flat);
  return side;
}

/// A ball is lowest where its sphere, cut along the way, leans as the way does; a cone where its
/// side does, or where its flat end leaves the point.
std::optional<double> ToolSide::lowest_mm(double rise, double beside_mm, double half_mm,
                                          double margin_mm) const {
  if (is_ball) return -rise * half_mm / std::sqrt(1 + rise * rise);
  if (slope <= 0) return std::nullopt;
  const double steeper = slope * slope - rise * rise;
  if (steeper <= 0) return std::copysign(half_mm, -rise);
  const double lowest = -rise * beside_mm / std::sqrt(steeper), end_mm = flat_mm + margin_mm;
  const double end2 = end_mm * end_mm - beside_mm * beside_mm;
  return lowest * lowest < end2 ? std::copysign(std::sqrt(end2), -rise) : lowest;
}

}  // namespace kerf
