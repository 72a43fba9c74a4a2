#include "twin/collision/convex.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

namespace kerf {
namespace {

struct Cylinder {
  std::vector<RoundedDisc> discs;
  Convex solid;
  Cylinder(double radius, double low, double high) : discs{{radius, low, 0}, {radius, high, 0}} {
    solid.kind = Convex::Kind::kRevolved;
    solid.discs = discs;
  }
};

struct BoxSolid {
  std::array<Vec3, 2> corners;
  Convex solid;
  BoxSolid(const Vec3& low, const Vec3& high) : corners{low, high} {
    solid.kind = Convex::Kind::kBox;
    solid.corners = corners;
  }
};

double gap(const Convex& moving, const Vec3& from, const Vec3& to, const Convex& still) {
  const ConvexGap gap = gap_of({moving, shift(from), shift(to)}, still, 1e9, 1e-7);
  EXPECT_NEAR(gap.low_mm, gap.high_mm, 2e-6);
  return gap.low_mm;
}

TEST(Convex, DistancesOfCylindersAndBoxesAreThoseOfTheClosedForm) {
  const Cylinder tool(5, 0, 50);
  const BoxSolid block({20, -10, -10}, {40, 10, 10});
  // Beside a face, above it, across an edge (10 high, 5 aside), and over a corner.
  EXPECT_NEAR(gap(tool.solid, {0, 0, 0}, {0, 0, 0}, block.solid), 15, 1e-6);
  EXPECT_NEAR(gap(tool.solid, {30, 0, 12}, {30, 0, 12}, block.solid), 2, 1e-6);
  EXPECT_NEAR(gap(tool.solid, {12, 0, 14}, {12, 0, 14}, block.solid), 5, 1e-6);
  const double corner = std::hypot(14 - 0.0, 24 - 10.0) - 5;
  EXPECT_NEAR(gap(tool.solid, {6, 24, 3}, {6, 24, 3}, block.solid), corner, 1e-5);
  EXPECT_NEAR(gap(tool.solid, {6, 24, 13}, {6, 24, 13}, block.solid), std::hypot(corner, 3), 1e-5);
  EXPECT_EQ(gap(tool.solid, {16, 0, 0}, {16, 0, 0}, block.solid), 0);
}

TEST(Convex, AWayIsAsNearAsItsNearestPlace) {
  const Cylinder tool(5, 0, 50);
  const BoxSolid block({20, -10, -10}, {40, 10, 10});
  // It passes the corner at X20 Y10: |24 - 10| up, and across at the nearest.
  EXPECT_NEAR(gap(tool.solid, {-100, 17, 0}, {100, 17, 0}, block.solid), 2, 1e-6);
  EXPECT_EQ(gap(tool.solid, {-100, 0, 5}, {100, 0, 5}, block.solid), 0);
  EXPECT_NEAR(gap(tool.solid, {-100, 0, 10.5}, {100, 0, 10.5}, block.solid), 0.5, 1e-6);
  // Past a wall of 0.2 mm in one move.
  const BoxSolid wall({0, -50, 0}, {0.2, 50, 10});
  EXPECT_EQ(gap(tool.solid, {-1000, 0, 5}, {1000, 0, 5}, wall.solid), 0);
}

TEST(Convex, RoundedDiscsAreBallsAndBullNoses) {
  const std::vector<RoundedDisc> ball{{0, 3, 3}, {3, 20, 0}};
  Convex solid;
  solid.kind = Convex::Kind::kRevolved;
  solid.discs = ball;
  const BoxSolid floor({-50, -50, -10}, {50, 50, 0});
  EXPECT_NEAR(gap(solid, {0, 0, 0.25}, {0, 0, 0.25}, floor.solid), 0.25, 1e-6);
  const BoxSolid edge({2, -50, -10}, {50, 50, 3 - std::sqrt(9 - 4.0)});
  // The edge at X2 lies on the ball.
  EXPECT_NEAR(gap(solid, {-1, 0, 0}, {-1, 0, 0}, edge.solid), std::hypot(3, std::sqrt(5.0)) - 3,
              1e-5);
}

TEST(Convex, IsThinnerByWhatIsTakenOff) {
  const Cylinder tool(5, 0, 50);
  std::vector<RoundedDisc> discs;
  std::array<Vec3, 2> corners;
  const Convex thin = eroded(tool.solid, 0.5, discs, corners);
  const Box box = thin.box_mm();
  EXPECT_NEAR(box.min.z, 0.5, 1e-12);
  EXPECT_NEAR(box.max.x, 4.5, 1e-12);
  EXPECT_NEAR(half_thickness_mm(tool.solid), 5, 1e-12);
}

/// The least distance of points of the one surface from the other solid, told by closed form.
double sampled(const Cylinder& tool, const Vec3& tip, const Vec3& axis, const BoxSolid& block) {
  const Vec3 helper = std::abs(axis.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 side = glm::normalize(glm::cross(helper, axis)), other = glm::cross(axis, side);
  double least = 1e9;
  const double radius = tool.discs[0].radius_mm;
  const double low = tool.discs[0].along_mm, high = tool.discs[1].along_mm;
  const auto look = [&](double r, double angle, double z) {
    const Vec3 p = tip + z * axis + r * (std::cos(angle) * side + std::sin(angle) * other);
    least = std::min(least, glm::length(p - glm::clamp(p, block.corners[0], block.corners[1])));
  };
  for (int i = 0; i < 720; ++i) {
    const double angle = 2 * kPi * i / 720;
    for (int k = 0; k <= 100; ++k) look(radius, angle, low + (high - low) * k / 100);
    for (int k = 0; k <= 40; ++k) {
      look(radius * k / 40, angle, low);
      look(radius * k / 40, angle, high);
    }
  }
  return least;
}

TEST(Convex, TiltedCylindersAreAsFarAsTheirPoints) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  const Cylinder tool(4, 0, 30);
  const BoxSolid block({-10, -8, -6}, {10, 8, 6});
  int apart = 0;
  for (int i = 0; i < 150; ++i) {
    const Vec3 axis = glm::normalize(Vec3{unit(random), unit(random), unit(random)});
    const Vec3 tip = 30.0 * Vec3{unit(random), unit(random), unit(random)};
    Pose pose;
    const Vec3 helper = std::abs(axis.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 side = glm::normalize(glm::cross(helper, axis));
    pose.rotation = glm::dmat3(side, glm::cross(axis, side), axis);
    pose.origin_mm = tip;
    const ConvexGap gap = gap_of({tool.solid, pose, pose}, block.solid, 1e9, 1e-7);
    const double brute = sampled(tool, tip, axis, block);
    // Points of the surface are no nearer than the solid, and 0.31 mm apart.
    EXPECT_LE(gap.low_mm, brute + 1e-6);
    EXPECT_GE(gap.low_mm, brute - 0.35);
    if (gap.low_mm > 0) ++apart;
  }
  EXPECT_GT(apart, 80);
}

}  // namespace
}  // namespace kerf
