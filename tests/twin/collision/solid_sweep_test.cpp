// Whole bodies against each other: the trees against all pairs of pieces, and against figures
// worked out by hand.
#include "twin/collision/solid_sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "base/triangle_mesh.h"

namespace kerf {
namespace {

/// Straight, and turning evenly about an axis through the body's origin.
class TurningWay final : public RigidWay {
 public:
  TurningWay(const Vec3& from, const Vec3& to, const Vec3& axis, double degrees)
      : from_(from), to_(to), axis_(axis), degrees_(degrees) {}
  Pose pose(double t) const override {
    Pose out = turn(axis_, t * degrees_);
    out.origin_mm = from_ + t * (to_ - from_);
    return out;
  }
  double slack_mm(double from, double to, double reach_mm) const override {
    const double turned = radians() * (to - from);
    return turned * turned * reach_mm / 8;
  }
  double turning_mm(double from, double to, double reach_mm) const override {
    return radians() * (to - from) * reach_mm;
  }
  double travel_mm(double from, double to, double reach_mm) const override {
    return (glm::length(to_ - from_) + radians() * reach_mm) * (to - from);
  }

 private:
  double radians() const { return std::abs(degrees_) * kPi / 180; }
  Vec3 from_, to_, axis_;
  double degrees_;
};

/// A ball of triangles, about -1 .. 1 times `radius`, uneven.
SolidPointer lump(double radius, std::uint32_t seed, int rings = 8) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> draw(0.8f, 1.0f);
  TriangleMesh mesh;
  const int around = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int k = 0; k < around; ++k) {
      const double up = kPi * i / rings, turned = 2 * kPi * k / around;
      const float r = static_cast<float>(radius) * draw(random);
      mesh.positions_mm.emplace_back(r * std::sin(up) * std::cos(turned),
                                     r * std::sin(up) * std::sin(turned), r * std::cos(up));
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int k = 0; k < around; ++k) {
      const auto at = [&](int ring, int place) {
        return static_cast<std::uint32_t>(ring * around + place % around);
      };
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
  return Solid::of_mesh(mesh);
}

SolidPointer solid_of(std::string_view spec) {
  return Solid::of_bodies(parse_blank(spec).value().bodies);
}

double gap_of_all_pairs(const Solid& moving, const Pose& pose, const Solid& still) {
  double least = std::numeric_limits<double>::infinity();
  for (const Convex& a : moving.pieces())
    for (const Convex& b : still.pieces())
      least = std::min(least, gap_of({a, pose, pose}, b, least, 1e-4).high_mm);
  return least;
}

TEST(SolidSweep, TheGapOfTwoMeshesIsThatOfTheirNearestTriangles) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> draw(-1, 1);
  const auto a = lump(10, 1), b = lump(14, 2);
  for (int i = 0; i < 12; ++i) {
    Pose pose = turn(glm::normalize(Vec3{draw(random), draw(random), 1}), 90 * draw(random));
    pose.origin_mm = 34.0 * glm::normalize(Vec3{draw(random), draw(random), draw(random)});
    const double gap = gap_at(*a, pose, *b, std::numeric_limits<double>::infinity());
    const double all = gap_of_all_pairs(*a, pose, *b);
    EXPECT_LE(gap, all + 1e-9);
    EXPECT_NEAR(gap, all, 2e-3);
    EXPECT_EQ(gap_at(*a, pose, *b, 0.5), 0.5) << "as far as asked for";
  }
}

/// What is seen at a thousand places of the way is never nearer than the least gap.
TEST(SolidSweep, NothingOnTheWayComesNearer) {
  std::mt19937 random(10);
  std::uniform_real_distribution<double> draw(-1, 1);
  const auto a = lump(6, 5, 3), b = lump(9, 6, 3);
  int touching = 0;
  for (int i = 0; i < 20; ++i) {
    const Vec3 from{25 * draw(random), 25 * draw(random), 20 + 5 * draw(random)};
    const Vec3 to{25 * draw(random), 25 * draw(random), 14 + 10 * draw(random)};
    const TurningWay way(from, to, glm::normalize(Vec3{draw(random), draw(random), 1}),
                         170 * draw(random));
    double seen = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= 100; ++k)
      seen = std::min(seen, gap_of_all_pairs(*a, way.pose(k / 100.0), *b));
    const auto least = least_gap(*a, way, *b, 1e6);
    ASSERT_TRUE(least);
    EXPECT_LE(least->mm, seen + kWayExact_mm);
    // Between two of these places it comes nearer by less than it goes.
    EXPECT_GE(least->mm, seen - way.travel_mm(0, 1 / 100.0, 6) - 2 * kWayExact_mm);
    EXPECT_NEAR(gap_of_all_pairs(*a, way.pose(least->t), *b), least->mm, 0.02);
    const auto first = first_touch(*a, way, *b, 0);
    EXPECT_EQ(first.has_value(), least->mm <= 0);
    if (!first) continue;
    ++touching;
    for (double t = 0; t < *first - 1e-3; t += 0.01)
      EXPECT_GT(gap_of_all_pairs(*a, way.pose(t), *b), 0) << t << " of " << *first;
  }
  EXPECT_GT(touching, 2);
}

TEST(SolidSweep, ASwingingBarMeetsAPostWhereTheyAre) {
  // A bar from 0 to 100 along X, 10 wide, turns about Z; a post of 6 mm stands 80 out at 60
  // degrees.
  const auto bar = solid_of("box:0,-5,0:100,5,10");
  const double angle = 60 * kPi / 180;
  BlankBody body;
  body.kind = BlankBody::Kind::kCylinder;
  body.diameter_mm = 6;
  body.center_mm = {80 * std::cos(angle), 80 * std::sin(angle), 5};
  body.bounds_mm.extend(body.center_mm - Vec3{3, 3, 20});
  body.bounds_mm.extend(body.center_mm + Vec3{3, 3, 20});
  const auto post = Solid::of_bodies({&body, 1});
  const TurningWay way(Vec3(0.0), Vec3(0.0), {0, 0, 1}, 90);
  const auto first = first_touch(*bar, way, *post, 0);
  ASSERT_TRUE(first);
  // Its edge is 5 from the line through the middle, the post's middle 3 from the edge.
  const double expected_deg = 60 - std::asin(8.0 / 80) * 180 / kPi;
  EXPECT_NEAR(*first * 90 * kPi / 180 * 80, expected_deg * kPi / 180 * 80, 2 * kWayExact_mm);
  // All of it: until the post's surface is 5 - 5 below.
  EXPECT_NEAR(touch_depth_mm(*bar, way, *post, 0), 5, 0.02);
  const TurningWay less(Vec3(0.0), Vec3(0.0), {0, 0, 1}, expected_deg - 0.02);
  EXPECT_FALSE(first_touch(*bar, less, *post, 0));
  EXPECT_NEAR(least_gap(*bar, less, *post, 1)->mm, 80 * 0.02 * kPi / 180, 0.004);
}

TEST(SolidSweep, WhatLiesInAClosedMeshIsEnclosed) {
  const auto outer = lump(50, 1);
  EXPECT_FALSE(outer->is_closed()) << "its poles have several corners in one place";
  const auto ring = solid_of("tube:0,0,-20:20:80:60");
  EXPECT_FALSE(has_triangles(*solid_of("box:0,0,0:1,1,1+cylinder:0,0,0:5:2")));
  EXPECT_TRUE(has_triangles(*ring));
  TriangleMesh box;
  for (const float z : {-10.f, 10.f})
    for (const float y : {-10.f, 10.f})
      for (const float x : {-10.f, 10.f}) box.positions_mm.emplace_back(x, y, z);
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  const auto closed = Solid::of_mesh(box);
  ASSERT_TRUE(closed->is_closed());
  const auto small = solid_of("box:-1,-1,-1:1,1,1");
  EXPECT_TRUE(encloses_any(*closed, shift({5, 0, 0}), *small));
  EXPECT_FALSE(encloses_any(*closed, shift({15, 0, 0}), *small));
  EXPECT_TRUE(encloses_any(*closed, shift({3, 3, 3}), *lump(2, 4)));
}

}  // namespace
}  // namespace kerf
