#include "twin/optimize/cut_limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "stock/cutter/shape_spec.h"

namespace kerf {
namespace {

CutLimits tool(const char* shape, const std::optional<Material>& material = std::nullopt) {
  return CutLimits(parse_shape(shape).value(), material);
}

double most_feed(const CutLimits& limits, const FeedAims& aims, const EngagementLook& look,
                 double rpm) {
  return CutLimits::most_feed(aims, limits.place(look, rpm));
}

EngagementLook look(double angle_deg, double wide_mm, double deep_mm) {
  EngagementLook out;
  out.angle_rad = out.exit_rad = angle_deg * kPi / 180;
  out.wide_mm = wide_mm;
  out.deep_mm = deep_mm;
  return out;
}

double chip_share(const CutLimits& limits, const EngagementLook& look) {
  return limits.place(look, 1000).at_1mm[CutLimit::kChip];
}

TEST(CutLimits, AFlatToolHasTheFeedPerToothAsItsThickestChip) {
  const CutLimits limits = tool("flat:10:teeth=2");
  // In a slot, and with half of it: 0.05 mm x 2 teeth x 3000 rpm.
  FeedAims aims;
  aims.most[CutLimit::kChip] = 0.05;
  EXPECT_NEAR(most_feed(limits, aims, look(180, 10, 4), 3000), 300, 1e-9);
  EXPECT_NEAR(most_feed(limits, aims, look(90, 5, 4), 3000), 300, 1e-9);
  // A quarter: sin 60 degrees.
  EXPECT_NEAR(most_feed(limits, aims, look(60, 2.5, 4), 3000), 300 / std::sqrt(0.75), 1e-9);
  EXPECT_NEAR(CutLimits::loads(limits.place(look(60, 2.5, 4), 3000), 300)[CutLimit::kChip],
              0.05 * std::sqrt(0.75), 1e-12);
}

TEST(CutLimits, ABallHasThinnerChipsWhereItIsShallow) {
  const CutLimits limits = tool("ball:6:teeth=2");
  // 0.5 mm up a radius of 3 mm: sin(kappa) = sqrt(1 - (2.5 / 3)^2).
  const double lead = std::sqrt(1 - 2.5 * 2.5 / 9);
  EXPECT_NEAR(chip_share(limits, look(180, 3, 0.5)), lead, 0.02);
  // The arc is 64 chords: the last one leans by half of 1.4 degrees.
  EXPECT_NEAR(chip_share(limits, look(180, 6, 3)), 1, 1e-4);
  EXPECT_NEAR(chip_share(limits, look(180, 6, 5)), 1, 1e-9);
}

TEST(CutLimits, AConeHasItsAngle) {
  const CutLimits limits = tool("vee:10:90:teeth=2");
  EXPECT_NEAR(chip_share(limits, look(180, 4, 2)), std::sqrt(0.5), 1e-6);
}

TEST(CutLimits, ABullNoseIsUprightAboveItsCorner) {
  const CutLimits limits = tool("bull:10:1:teeth=2");
  EXPECT_NEAR(chip_share(limits, look(180, 10, 0.5)), std::sqrt(0.75), 0.02);
  EXPECT_NEAR(chip_share(limits, look(180, 10, 1.1)), 1, 1e-9);
}

TEST(CutLimits, TheRateIsTheSectionTimesTheFeed) {
  const CutLimits limits = tool("flat:10");
  FeedAims aims;
  aims.most[CutLimit::kRate] = 100;  // mm3/s over 10 x 4 mm2
  EXPECT_NEAR(most_feed(limits, aims, look(180, 10, 4), 3000), 150, 1e-9);
  EXPECT_NEAR(CutLimits::loads(limits.place(look(180, 10, 4), 3000), 150)[CutLimit::kRate], 100,
              1e-9);
  // The least of all limits; without a spindle, or teeth, chips limit nothing.
  aims.most[CutLimit::kChip] = 0.01;
  EXPECT_NEAR(most_feed(limits, aims, look(180, 10, 4), 3000), 150, 1e-9);
  const CutLimits toothed = tool("flat:10:teeth=2");
  EXPECT_NEAR(most_feed(toothed, aims, look(180, 10, 4), 3000), 60, 1e-9);
  EXPECT_NEAR(most_feed(toothed, aims, look(180, 10, 4), 0), 150, 1e-9);
}

TEST(CutLimits, StraightDownTheDiscCounts) {
  const CutLimits limits = tool("flat:10:teeth=2");
  EngagementLook down = look(360, 10, 4);
  down.is_plunge = true;
  FeedAims aims;
  aims.most[CutLimit::kRate] = 100;
  EXPECT_NEAR(most_feed(limits, aims, down, 3000), 60 * 100 / (kPi * 25), 1e-9);
}

/// kc = 1000 N/mm2 whatever the chip: power is kc times the rate, force goes with the feed.
Material plain_material() {
  Material out;
  out.name = "plain";
  out.kc11_n_per_mm2 = {1000, 1000, 1000};
  return out;
}

TEST(CutLimits, PowerIsTheSpecificForceTimesTheRate) {
  const CutLimits limits = tool("flat:10:teeth=2", plain_material());
  const PerLimit<double> loads = CutLimits::loads(limits.place(look(180, 10, 4), 3000), 300);
  // 40 mm2 x 5 mm/s x 1000 N/mm2 = 200 W.
  EXPECT_NEAR(loads[CutLimit::kPower], 0.2, 0.002);
  FeedAims aims;
  aims.most[CutLimit::kPower] = 0.1;
  EXPECT_NEAR(most_feed(limits, aims, look(180, 10, 4), 3000), 150, 1.5);
}

TEST(CutLimits, WhatIsAllowedIsWhatTheFeedThenHas) {
  Material steel = plain_material();
  steel.kc11_n_per_mm2 = {1500, 1800, 2200};
  steel.mc = 0.2;
  const CutLimits limits = tool("ball:6:teeth=3:shank=6:holder=20x40:stickout=30", steel);
  for (const CutLimit limit : {CutLimit::kForce, CutLimit::kPower, CutLimit::kDeflection}) {
    FeedAims aims;
    const CutLimits::Place place = limits.place(look(120, 4, 1.5), 8000);
    aims.most[limit] = 0.3 * CutLimits::loads(place, 2000)[limit];
    const double feed = CutLimits::most_feed(aims, place);
    EXPECT_GT(feed, 0) << key_of(limit);
    EXPECT_LT(feed, 0.3 * 2000) << key_of(limit);  // thin chips are harder
    EXPECT_NEAR(CutLimits::loads(place, feed)[limit] / *aims.most[limit], 1, 1e-9) << key_of(limit);
  }
}

TEST(CutLimits, WithoutAimsNothingIsLimited) {
  EXPECT_EQ(most_feed(tool("flat:10:teeth=2"), {}, look(180, 10, 4), 3000),
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace kerf
