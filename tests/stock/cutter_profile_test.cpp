#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "base/geometry.h"
#include "stock/cutter/cutter.h"
#include "stock/cutter/cutting_shank.h"
#include "stock/cutter/shape_spec.h"

namespace kerf {
namespace {

/// Rounding of a handful of double operations on numbers below 100.
constexpr double kRounding_mm = 1e-12;

ProfilePiece line(double r0, double z0, double r1, double z1) {
  ProfilePiece piece;
  piece.r0 = r0;
  piece.z0 = z0;
  piece.r1 = r1;
  piece.z1 = z1;
  return piece;
}

ProfilePiece arc(double r0, double z0, double r1, double z1, double center_r, double center_z,
                 bool convex) {
  ProfilePiece piece = line(r0, z0, r1, z1);
  piece.kind = ProfilePiece::Kind::kArc;
  piece.center_r = center_r;
  piece.center_z = center_z;
  piece.radius = std::hypot(r0 - center_r, z0 - center_z);
  piece.convex = convex;
  return piece;
}

std::string error_of(std::vector<ProfilePiece> pieces) {
  const Result<Cutter> cutter = Cutter::from_profile("test", std::move(pieces));
  return cutter ? "no error" : cutter.error();
}

Cutter shape(const char* spec) {
  Result<Cutter> cutter = parse_shape(spec);
  EXPECT_TRUE(cutter) << cutter.error();
  return *cutter;
}

/// Heights of a whole cutter against a formula, at radii that hit pieces' ends and lie between.
template <class Formula>
void expect_heights(const Cutter& cutter, Formula formula) {
  constexpr int kSteps = 1000;
  for (int i = 0; i <= kSteps; ++i) {
    const double r = cutter.radius_mm() * i / kSteps;
    ASSERT_NEAR(cutter.height_mm(r), formula(r), kRounding_mm) << cutter.spec() << " at r " << r;
  }
  const double beyond = std::nextafter(cutter.radius_mm(), 1e9);
  EXPECT_EQ(cutter.height_mm(beyond), std::numeric_limits<double>::infinity());
}

TEST(CutterHeight, FlatIsZero) {
  expect_heights(shape("flat:10"), [](double) { return 0.0; });
  expect_heights(shape("tslot:20:3:8"), [](double) { return 0.0; });
  expect_heights(shape("drill:8:180"), [](double) { return 0.0; });
}

TEST(CutterHeight, BallIsSphere) {
  const auto sphere = [](double r) { return 5 - std::sqrt(std::max(0.0, 25 - r * r)); };
  expect_heights(shape("ball:10"), sphere);
  expect_heights(shape("bull:10:5"), sphere);
  expect_heights(shape("lollipop:10:4"), sphere);
}

TEST(CutterHeight, BallNearTheTipKeepsItsDigits) {
  // R - sqrt(R^2 - r^2) would give 0 or noise: r^2 / 2R is right to the last digits.
  const double r = 1e-7;
  EXPECT_NEAR(shape("ball:10").height_mm(r) / (r * r / 10), 1, 1e-12);
}

TEST(CutterHeight, BullHasFlatThenQuarterCircle) {
  expect_heights(shape("bull:10:2"), [](double r) {
    return r <= 3 ? 0.0 : 2 - std::sqrt(std::max(0.0, 4 - (r - 3) * (r - 3)));
  });
}

TEST(CutterHeight, VeeAndDrillAreCones) {
  expect_heights(shape("vee:10:90"), [](double r) { return r; });
  const double cot30 = std::sqrt(3.0);
  expect_heights(shape("vee:10:60:1"),
                 [&](double r) { return r <= 0.5 ? 0.0 : (r - 0.5) * cot30; });
  const double cot59 = 1 / std::tan(59 * kPi / 180);
  expect_heights(shape("drill:8:118"), [&](double r) { return r * cot59; });
}

TEST(CutterHeight, TaperIsTipArcAndCone) {
  const double angle = 5 * kPi / 180;
  const double radius = 1.5;
  const double r1 = radius * std::cos(angle);
  const double z1 = radius * (1 - std::sin(angle));
  const Cutter cutter = shape("taper:3:5:1.5:flute=12");
  EXPECT_NEAR(cutter.radius_mm(), r1 + (12 - z1) * std::tan(angle), kRounding_mm);
  expect_heights(cutter, [&](double r) {
    if (r <= r1) return radius - std::sqrt(radius * radius - r * r);
    return z1 + (r - r1) / std::tan(angle);
  });
}

TEST(CutterHeight, TaperMeetsItsCornerTangentially) {
  for (const char* spec : {"taper:3:5:1.5", "taper:6:10:1", "taper:2:45:0.5", "taper:4:1:2"}) {
    const Cutter cutter = shape(spec);
    const auto pieces = cutter.profile();
    const ProfilePiece& corner = pieces[pieces.size() - 2];
    const ProfilePiece& cone = pieces.back();
    ASSERT_EQ(corner.kind, ProfilePiece::Kind::kArc) << spec;
    // The radius to the joint is square to the cone.
    const double dot = (corner.r1 - corner.center_r) * (cone.r1 - cone.r0) +
                       (corner.z1 - corner.center_z) * (cone.z1 - cone.z0);
    EXPECT_NEAR(dot, 0, 1e-9) << spec;
    EXPECT_EQ(corner.r1, cone.r0) << spec;
    EXPECT_EQ(corner.z1, cone.z0) << spec;
  }
}

TEST(CutterHeight, TaperEndsAtThreeTipDiametersUnlessFlutesSayOtherwise) {
  EXPECT_EQ(shape("taper:4:10").profile().back().z1, 12);
  EXPECT_EQ(shape("taper:4:10").flute_length_mm(), 12);
  EXPECT_EQ(shape("taper:4:10:flute=20").profile().back().z1, 20);
}

TEST(CutterHeight, IsEvenInTheRadius) {
  EXPECT_EQ(shape("ball:10").height_mm(-3), shape("ball:10").height_mm(3));
}

TEST(CutterProfile, HollowArcAndVerticalStep) {
  // Corner-rounding cutter: shaft of radius 4, quarter circle about (7, 0), collar.
  const Result<Cutter> cutter = Cutter::from_profile(
      "rounding",
      {line(0, 0, 4, 0), arc(4, 0, 7, 3, 7, 0, false), line(7, 3, 7, 5), line(7, 5, 8, 5)});
  ASSERT_TRUE(cutter) << cutter.error();
  EXPECT_EQ(cutter->height_mm(4), 0);
  EXPECT_NEAR(cutter->height_mm(5.5), std::sqrt(9 - 1.5 * 1.5), kRounding_mm);
  EXPECT_EQ(cutter->height_mm(7), 3);  // the lower end of the step
  EXPECT_EQ(cutter->height_mm(7.5), 5);
}

TEST(CutterProfile, JoinsWithinToleranceExactly) {
  const Result<Cutter> cutter =
      Cutter::from_profile("gap", {line(0, 0, 2, 0), line(2.0000005, 1e-7, 3, 1)});
  ASSERT_TRUE(cutter) << cutter.error();
  EXPECT_LT(cutter->height_mm(2.0000002), 1e-6);
}

TEST(CutterProfile, NamesWhatIsWrong) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error_of({}), "profile: has no pieces; at least one is needed");
  EXPECT_EQ(error_of({line(1, 0, 2, 0)}),
            "profile piece 1: starts at R1 Z0, but must start at R0 Z0");
  EXPECT_EQ(error_of({line(0, 0, 2, 0), line(2, 0.5, 3, 1)}),
            "profile piece 2: starts at R2 Z0.5, but must start at R2 Z0");
  EXPECT_EQ(error_of({line(0, 0, 2, 0), line(2, 0, 1, 1)}),
            "profile piece 2: the radius falls from 2 to 1 mm; it must not fall from the tip "
            "upward");
  EXPECT_EQ(error_of({line(0, 0, nan, 0)}),
            "profile piece 1: nan is not allowed; coordinates are at most 10000 mm");
  EXPECT_EQ(error_of({line(0, 0, 2e4, 0)}),
            "profile piece 1: 20000 is not allowed; coordinates are at most 10000 mm");
  EXPECT_EQ(error_of({line(0, 0, 0, 0)}), "profile piece 1: has no length");
  EXPECT_EQ(error_of({line(0, 1, 2, 1)}),
            "profile: the lowest point is at Z1; it must be at Z0, the tip");
  EXPECT_EQ(error_of({line(0, 0, 2, -1)}),
            "profile: the lowest point is at Z-1; it must be at Z0, the tip");
  EXPECT_EQ(error_of({line(0, 0, 0, 1)}), "profile: the last radius is 0; it must be above 0");
}

TEST(CutterProfile, NamesWhatIsWrongWithAnArc) {
  ProfilePiece loose = arc(0, 0, 5, 5, 0, 5, true);
  loose.radius = 4;
  EXPECT_EQ(error_of({loose}),
            "profile piece 1: the inner end is 5 mm from the centre, but the arc radius is 4 mm");
  loose.radius = 0;
  EXPECT_EQ(error_of({loose}),
            "profile piece 1: the arc radius is 0; must be above 0 and at most 1000000 (mm)");
  EXPECT_EQ(error_of({arc(0, 0, 3, 9, 0, 5, true)}),
            "profile piece 1: the arc turns back past the outer end; split or shorten it");
  EXPECT_EQ(error_of({arc(0, 0, 5, 5, 5, 0, true)}),
            "profile piece 1: the arc turns back past the outer end; split or shorten it");
  EXPECT_EQ(error_of({arc(0, 0, 6, 0, 3, 4, true)}),
            "profile: the lowest point is at Z-1; it must be at Z0, the tip");
}

TEST(CuttingShank, CarriesTheProfileOn) {
  const Cutter cutter = *parse_shape("ball:6:flute=9:shank=4x3+10x5+8:holder=20x10");
  ASSERT_TRUE(has_wider_shank(cutter));
  const std::optional<Cutter> wider = with_cutting_shank(cutter);
  ASSERT_TRUE(wider);
  // The neck of 4 mm is within the ball's cylinder, the shank of 8 within that of the 10.
  EXPECT_DOUBLE_EQ(wider->radius_mm(), 5);
  EXPECT_DOUBLE_EQ(wider->height_mm(2), cutter.height_mm(2));
  EXPECT_NEAR(wider->height_mm(3), 3, kRounding_mm);
  EXPECT_NEAR(wider->height_mm(3.01), 12, kRounding_mm);
  EXPECT_NEAR(wider->height_mm(5), 12, kRounding_mm);
  EXPECT_EQ(wider->flute_length_mm(), cutter.flute_length_mm());
  EXPECT_EQ(wider->holder().size(), 1u);
  EXPECT_NE(wider->spec(), cutter.spec());
}

TEST(CuttingShank, IsNoneWhereNothingIsWider) {
  for (const char* shape : {"flat:6:flute=10:shank=6", "flat:6:flute=10:shank=3", "flat:6:shank=8",
                            "tslot:20:4:8:flute=4"}) {
    EXPECT_FALSE(with_cutting_shank(*parse_shape(shape))) << shape;
    EXPECT_FALSE(has_wider_shank(*parse_shape(shape))) << shape;
  }
  const Cutter slot = *parse_shape("tslot:20:4:8:flute=8:shank=12");
  EXPECT_TRUE(has_wider_shank(slot));
  EXPECT_FALSE(with_cutting_shank(slot));
}

}  // namespace
}  // namespace kerf
