#include "twin/process/turning/turn_steps.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/portable_math.h"

namespace kerf {

TurnMove turn_part(const TurnMove& move, double a, double b) {
  TurnMove part = move;
  if (!move.arc) {
    part.from_mm = move.from_mm + a * (move.to_mm - move.from_mm);
    part.to_mm = b == 1 ? move.to_mm : move.from_mm + b * (move.to_mm - move.from_mm);
    return part;
  }
  const Vec2 from = move.from_mm - move.arc->center_mm, to = move.to_mm - move.arc->center_mm;
  const double start = portable::atan2(from.y, from.x);
  const auto place = [&](double t) {
    const double angle = start + t * move.arc->sweep_rad;
    const double r = glm::length(from) + t * (glm::length(to) - glm::length(from));
    return move.arc->center_mm + r * Vec2(portable::cos(angle), portable::sin(angle));
  };
  if (a > 0) part.from_mm = place(a);
  if (b < 1) part.to_mm = place(b);
  part.arc->sweep_rad = (b - a) * move.arc->sweep_rad;
  return part;
}

double turn_way_mm(const TurnMove& move) {
  if (!move.arc) return glm::distance(move.from_mm, move.to_mm);
  return std::abs(move.arc->sweep_rad) * std::max(glm::distance(move.from_mm, move.arc->center_mm),
                                                  glm::distance(move.to_mm, move.arc->center_mm));
}

}  // namespace kerf
