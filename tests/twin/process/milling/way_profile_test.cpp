// Arcs whose digits make them spirals by a hair, as circles.
#include "twin/process/milling/way_profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

constexpr Vec2 kCenter{5, -3};

/// From an angle of 0.4 on, 20 mm from the centre at its begin and so much more at its end.
CutMove arc_of(double sweep_rad, double off_mm, double side) {
  const auto at = [&](double angle, double radius) {
    return Vec3(kCenter + radius * Vec2(std::cos(angle), std::sin(angle)), 1);
  };
  CutMove move;
  move.from_mm = at(0.4, 20);
  move.to_mm = at(0.4 + side * sweep_rad, 20 + off_mm) + Vec3(0, 0, -2);
  move.arc = CutArc{Vec3(kCenter, 0), {0, 0, 1}, side * sweep_rad};
  return move;
}

/// Farthest from the arc as it is written, at the same part of the way.
double farthest_mm(const CutMove& move, const CutMove& circle) {
  double most = 0;
  for (int k = 0; k <= 50; ++k) {
    const double part = k / 50.0;
    const Vec2 middle(move.arc->center_mm), other(circle.arc->center_mm);
    const Vec3 is = part_of(circle, 0, part).to_mm;
    const Vec3 was = part_of(move, 0, part).to_mm;
    EXPECT_NEAR(is.z, was.z, 1e-9);
    most = std::max(most, std::abs(glm::length(Vec2(was) - other) - glm::length(Vec2(is) - other)));
  }
  return most;
}

double roundness_mm(const CutMove& move) {
  const Vec2 center(move.arc->center_mm);
  return std::abs(glm::length(Vec2(move.from_mm) - center) -
                  glm::length(Vec2(move.to_mm) - center));
}

TEST(AsCircle, IsRoundAndNearWhatIsWritten) {
  for (const double side : {-1.0, 1.0}) {
    for (const double off : {-0.04, -0.002, 0.002, 0.04}) {
      for (const double sweep : {0.1, 1.0, kPi - 1e-4, kPi, kPi + 1e-4, 4.0, 5.5, 6.2}) {
        const CutMove move = arc_of(sweep, off, side), circle = as_circle(move);
        EXPECT_LT(roundness_mm(circle), 1e-9);
        EXPECT_EQ(circle.arc->sweep_rad, move.arc->sweep_rad);
        const double share = sweep < kPi + 0.01 ? 0.11 : 0.51;
        EXPECT_LE(farthest_mm(move, circle), share * std::abs(off) + 1e-9) << sweep << ' ' << off;
      }
    }
  }
}

TEST(AsCircle, LeavesCirclesSpiralsAndOtherPlanes) {
  CutMove line;
  line.to_mm = {10, 0, 0};
  EXPECT_FALSE(as_circle(line).arc);
  for (const double off : {0.0, 0.06, -3.0}) {
    const CutMove move = arc_of(2, off, 1), same = as_circle(move);
    EXPECT_EQ(same.from_mm, move.from_mm);
    EXPECT_EQ(same.to_mm, move.to_mm);
    EXPECT_EQ(same.arc->center_mm, move.arc->center_mm);
  }
  CutMove upright = arc_of(2, 0.01, 1);
  upright.arc->axis = {0, 1, 0};
  EXPECT_EQ(as_circle(upright).arc->center_mm, upright.arc->center_mm);
}

}  // namespace
}  // namespace kerf
