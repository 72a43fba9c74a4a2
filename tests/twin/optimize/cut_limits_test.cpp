#include "twin/optimize/cut_limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "stock/cutter/shape_spec.h"

namespace kerf {
namespace {

Cutter cutter_of(const char* shape) { return parse_shape(shape).value(); }

EngagementLook look(double angle_deg, double wide_mm, double deep_mm) {
  EngagementLook out;
  out.angle_rad = angle_deg * kPi / 180;
  out.wide_mm = wide_mm;
  out.deep_mm = deep_mm;
  return out;
}

TEST(CutLimits, AFlatToolHasTheFeedPerToothAsItsThickestChip) {
  const CutLimits limits(cutter_of("flat:10:teeth=2"));
  // In a slot, and with half of it: 0.05 mm x 2 teeth x 3000 rpm.
  FeedAims aims;
  aims.most[0] = 0.05;
  EXPECT_NEAR(limits.most_feed(aims, look(180, 10, 4), 3000), 300, 1e-9);
  EXPECT_NEAR(limits.most_feed(aims, look(90, 5, 4), 3000), 300, 1e-9);
  // A quarter: sin 60 degrees.
  EXPECT_NEAR(limits.most_feed(aims, look(60, 2.5, 4), 3000), 300 / std::sqrt(0.75), 1e-9);
  EXPECT_NEAR(load_of(limits.loads(look(60, 2.5, 4), 3000, 300), CutLimit::kChip),
              0.05 * std::sqrt(0.75), 1e-12);
}

TEST(CutLimits, ABallHasThinnerChipsWhereItIsShallow) {
  const CutLimits limits(cutter_of("ball:6:teeth=2"));
  // 0.5 mm up a radius of 3 mm: sin(kappa) = sqrt(1 - (2.5 / 3)^2).
  const double lead = std::sqrt(1 - 2.5 * 2.5 / 9);
  EXPECT_NEAR(limits.chip_share(look(180, 3, 0.5)), lead, 0.02);
  EXPECT_NEAR(limits.chip_share(look(180, 6, 3)), 1, 1e-9);
  EXPECT_NEAR(limits.chip_share(look(180, 6, 5)), 1, 1e-9);
}

TEST(CutLimits, AConeHasItsAngle) {
  const CutLimits limits(cutter_of("vee:10:90:teeth=2"));
  EXPECT_NEAR(limits.chip_share(look(180, 4, 2)), std::sqrt(0.5), 1e-6);
}

TEST(CutLimits, ABullNoseIsUprightAboveItsCorner) {
  const CutLimits limits(cutter_of("bull:10:1:teeth=2"));
  EXPECT_NEAR(limits.chip_share(look(180, 10, 0.5)), std::sqrt(0.75), 0.02);
  EXPECT_NEAR(limits.chip_share(look(180, 10, 1.1)), 1, 1e-9);
}

TEST(CutLimits, TheRateIsTheSectionTimesTheFeed) {
  const CutLimits limits(cutter_of("flat:10"));
  FeedAims aims;
  aims.most[1] = 100;  // mm3/s over 10 x 4 mm2
  EXPECT_NEAR(limits.most_feed(aims, look(180, 10, 4), 3000), 150, 1e-9);
  EXPECT_NEAR(load_of(limits.loads(look(180, 10, 4), 3000, 150), CutLimit::kRate), 100, 1e-9);
  // The least of all limits; without a spindle, or teeth, chips limit nothing.
  aims.most[0] = 0.01;
  EXPECT_NEAR(limits.most_feed(aims, look(180, 10, 4), 3000), 150, 1e-9);
  const CutLimits toothed(cutter_of("flat:10:teeth=2"));
  EXPECT_NEAR(toothed.most_feed(aims, look(180, 10, 4), 3000), 60, 1e-9);
  EXPECT_NEAR(toothed.most_feed(aims, look(180, 10, 4), 0), 150, 1e-9);
}

TEST(CutLimits, StraightDownTheDiscCounts) {
  const CutLimits limits(cutter_of("flat:10:teeth=2"));
  EngagementLook down = look(360, 10, 4);
  down.is_plunge = true;
  FeedAims aims;
  aims.most[1] = 100;
  EXPECT_NEAR(limits.most_feed(aims, down, 3000), 60 * 100 / (kPi * 25), 1e-9);
}

TEST(CutLimits, WithoutAimsNothingIsLimited) {
  EXPECT_EQ(CutLimits(cutter_of("flat:10:teeth=2")).most_feed({}, look(180, 10, 4), 3000),
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace kerf
