// Turning tools in space: how wide they are taken, and how near they come to boxes, against points.
#include "twin/process/turning/tool_plates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "stock/cutter/shape_spec.h"
#include "twin/collision/solid.h"

namespace kerf {
namespace {

const CarriedBody& part_of(const std::vector<CarriedBody>& bodies, ToolPart part) {
  for (const CarriedBody& body : bodies)
    if (body.part == part) return body;
  ADD_FAILURE();
  return bodies.front();
}

TEST(ToolPlates, AShankIsTakenToBothSidesOfTheCentre) {
  const auto bodies = standing_bodies(*parse_shape("turn:0.4:2:85:5:holder=20x100"));
  ASSERT_EQ(bodies.size(), 2U);
  const Box box = part_of(bodies, ToolPart::kHolder).whole.box_mm;
  EXPECT_NEAR(box.min.y, -20, 1e-9);
  EXPECT_NEAR(box.max.y, 20, 1e-9);
  EXPECT_NEAR(box.max.x, 100, 1e-4);
  EXPECT_NEAR(box.max.z, 25, 1e-4);  // f
  EXPECT_NEAR(box.min.z, 5, 1e-4);
  EXPECT_NEAR(part_of(bodies, ToolPart::kCutter).whole.box_mm.max.y, 20, 1e-9);
}

TEST(ToolPlates, ABarIsAsHighAsItIsThick) {
  const auto bodies = standing_bodies(*parse_shape("bore:0.4:16:80:f=11"));
  EXPECT_NEAR(part_of(bodies, ToolPart::kHolder).whole.box_mm.max.y, 8, 1e-4);
}

TEST(ToolPlates, ABareInsertIsAPlate) {
  const auto bodies = standing_bodies(*parse_shape("turn:0.4:2:85:5"));
  ASSERT_EQ(bodies.size(), 1U);
  EXPECT_NEAR(bodies[0].whole.box_mm.max.y, kBarePlate_mm, 1e-9);
  EXPECT_TRUE(bodies[0].stands);
  EXPECT_LT(bodies[0].thin.box_mm.max.y, kBarePlate_mm - 0.009);
}

TEST(ToolPlates, ADrillTurnsAboutItsAxis) {
  const auto bodies = standing_bodies(*parse_shape("drill:8:118"));
  ASSERT_FALSE(bodies.empty());
  EXPECT_FALSE(bodies[0].stands);
}

/// Straight on, without turning.
class Slide final : public RigidWay {
 public:
  Slide(const Vec3& from, const Vec3& to) : from_(from), to_(to) {}
  Pose pose(double t) const override {
    Pose pose;
    pose.rotation = glm::dmat3(1);
    pose.origin_mm = from_ + t * (to_ - from_);
    return pose;
  }
  double slack_mm(double, double, double) const override { return 0; }
  double turning_mm(double, double, double) const override { return 0; }
  double travel_mm(double a, double b, double) const override {
    return (b - a) * glm::length(to_ - from_);
  }

 private:
  Vec3 from_, to_;
};

double apart(double low, double high, double other_low, double other_high) {
  return std::max({0.0, low - other_high, other_low - high});
}

/// Of a convex polygon, (z, x), from a box in that plane, by points of both outlines; 0 where a
/// point of one lies in the other.
double plane_gap(const std::vector<Vec2>& polygon, const Vec2& low, const Vec2& high) {
  constexpr int kPoints = 60;
  double least = 1e300;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    for (int k = 0; k < kPoints; ++k) {
      const Vec2 p = a + (k / double{kPoints}) * (b - a);
      const Vec2 off(std::max({0.0, low.x - p.x, p.x - high.x}),
                     std::max({0.0, low.y - p.y, p.y - high.y}));
      least = std::min(least, glm::length(off));
    }
    for (const Vec2& corner : {low, high, Vec2(low.x, high.y), Vec2(high.x, low.y)}) {
      const double t = std::clamp(glm::dot(corner - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
      least = std::min(least, glm::distance(corner, a + t * (b - a)));
    }
  }
  const Vec2 middle = 0.5 * (low + high);
  bool holds = true;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    if ((b - a).x * (middle - a).y - (b - a).y * (middle - a).x < 0) holds = false;
  }
  return holds ? 0 : least;
}

TEST(ToolPlates, DistancesAgreeWithPoints) {
  // The insert's corners as they are: 10 mm edges at 85 and 5 degrees, no nose.
  const auto bodies = standing_bodies(*parse_shape("turn:0:2:85:5"));
  const CarriedPieces& plate = bodies[0].whole;
  ASSERT_EQ(plate.pieces.size(), 1U);
  std::vector<Vec2> polygon;
  for (std::size_t i = 0; i < plate.pieces[0].corners.size(); i += 2)
    polygon.emplace_back(plate.pieces[0].corners[i].z, plate.pieces[0].corners[i].x);
  std::mt19937 random(5);  // NOLINT(cert-msc51-cpp)
  const auto number = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int apart_count = 0, touching = 0;
  for (int n = 0; n < 120; ++n) {
    const Vec3 low(number(-15, 10), number(-12, 6), number(-15, 10));
    const Vec3 high = low + Vec3(number(2, 15), number(2, 15), number(2, 15));
    BlankBody box;
    box.bounds_mm = {low, high};
    const SolidPointer still = Solid::of_bodies(std::span(&box, 1));
    const Vec3 from(number(-25, 25), number(-8, 8), number(-25, 25));
    const Vec3 to = from + Vec3(number(-20, 20), number(-4, 4), number(-20, 20));
    double expected = 1e300;
    constexpr int kSteps = 400;
    for (int k = 0; k <= kSteps; ++k) {
      const Vec3 at = from + (k / double{kSteps}) * (to - from);
      std::vector<Vec2> here;
      for (const Vec2& p : polygon) here.push_back(p + Vec2(at.z, at.x));
      const double flat = plane_gap(here, {low.z, low.x}, {high.z, high.x});
      expected = std::min(expected, std::hypot(flat, apart(at.y - kBarePlate_mm,
                                                           at.y + kBarePlate_mm, low.y, high.y)));
    }
    Vec3 guess{0};
    const auto gap = least_gap(plate.pieces[0], Slide(from, to), *still, 100, 100, guess);
    ASSERT_TRUE(gap);
    // Points are no nearer than the bodies, and by no more than their steps farther.
    EXPECT_LT(gap->mm, expected + 0.003) << n;
    EXPECT_GT(gap->mm, expected - 0.1) << n;
    const bool touches = first_touch(plate.pieces[0], Slide(from, to), *still, guess).has_value();
    EXPECT_EQ(touches, gap->mm <= 0.002) << n;
    ++(touches ? touching : apart_count);
  }
  EXPECT_GT(apart_count, 10);
  EXPECT_GT(touching, 10);
}

TEST(ToolPlates, DepthIsThatOfTheThinnerPlate) {
  const auto bodies = standing_bodies(*parse_shape("groove:3:edge=10"));
  // The blade's front goes 1 mm into a wall that begins at X-20; half its width of 3 is more.
  BlankBody box;
  box.bounds_mm = {{-40, -50, -50}, {-20, 50, 50}};
  const SolidPointer wall = Solid::of_bodies(std::span(&box, 1));
  EXPECT_NEAR(bodies[0].depth_mm(Slide({0, 0, 0}, {-21, 0, 0}), *wall, 0), 1, 0.02);
  EXPECT_NEAR(bodies[0].depth_mm(Slide({0, 0, 0}, {-19.5, 0, 0}), *wall, 0), 0, 0.02);
}

}  // namespace
}  // namespace kerf
