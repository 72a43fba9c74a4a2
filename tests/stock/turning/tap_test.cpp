// A tap on the axis: what it leaves in a hole, against what a gauge finds and against a sum of
// slices.
#include "stock/turning/tap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/turning/thread_gauge.h"
#include "stock/turning/turning_stock.h"

namespace kerf {
namespace {

TurningStock drilled(double hole_mm) {
  return TurningStock(*TurnedPart::create(tube_profile(-40, 0, 30, hole_mm)));
}

double tap(TurningStock& stock, double lead_mm, double low_z_mm = -15) {
  CutMove in, out;
  in.from_mm = out.to_mm = {0, 0, 5};
  in.to_mm = out.from_mm = {0, 0, low_z_mm};
  in.lead_mm = out.lead_mm = lead_mm;
  const double before = stock.remaining_mm3();
  std::vector<CutReport> reports;
  stock.cut(*parse_shape("flat:8"), std::vector<CutMove>{in, out}, reports);
  return before - stock.remaining_mm3();
}

TEST(Tap, LeavesAThreadOfItsDiameterAndPitch) {
  TurningStock stock = drilled(6.8);
  tap(stock, 1.25);
  const std::vector<MeasuredThread> threads = measure_threads(stock.part());
  ASSERT_EQ(threads.size(), 1U);
  const MeasuredThread& t = threads[0];
  EXPECT_TRUE(t.is_internal);
  EXPECT_TRUE(t.is_right_hand);
  EXPECT_EQ(t.starts, 1);
  EXPECT_NEAR(t.pitch_mm(), 1.25, 1e-9);
  EXPECT_NEAR(t.major_mm, 8, 1e-3);
  EXPECT_NEAR(t.minor_mm, 6.8, 1e-3);
  EXPECT_NEAR(t.angle_rad, kPi / 3, 1e-4);
  // Its last turn ends at the tip.
  EXPECT_NEAR(t.low_z_mm, -15 + 1.25 / 2, 0.02);
}

TEST(Tap, LeftHand) {
  TurningStock stock = drilled(6.8);
  tap(stock, -1.25);
  const std::vector<MeasuredThread> threads = measure_threads(stock.part());
  ASSERT_EQ(threads.size(), 1U);
  EXPECT_FALSE(threads[0].is_right_hand);
}

/// The groove over a turn: a trapezoid from r to R as it goes round. By slices of r, each the width
/// there times its circumference over the pitch.
TEST(Tap, RemovesTheGroove) {
  constexpr double kPitch = 1.25, kOuter = 4, kHole = 3.4, kSlices = 4000;
  TurningStock shorter = drilled(6.8), longer = drilled(6.8);
  // What the ends do is the same in both.
  const double grown = tap(longer, kPitch, -20) - tap(shorter, kPitch, -10);
  double per_mm = 0;
  for (int i = 0; i < static_cast<int>(kSlices); ++i) {
    const double dr = (kOuter - kHole) / kSlices, r = kHole + (i + 0.5) * dr;
    const double width = kPitch / 8 + 2 * std::tan(kPi / 6) * (kOuter - r);
    per_mm += width * 2 * kPi * r / kPitch * dr;
  }
  EXPECT_NEAR(grown, 10 * per_mm, 1e-4 * 10 * per_mm);
}

TEST(Tap, TwiceIsOnce) {
  TurningStock stock = drilled(6.8);
  const double first = tap(stock, 1.25);
  EXPECT_GT(first, 10);
  EXPECT_NEAR(tap(stock, 1.25), 0, 1e-6);
}

TEST(Tap, ANarrowHoleIsClearedToItsCore) {
  TurningStock stock = drilled(5);
  tap(stock, 1.25);
  const std::vector<MeasuredThread> threads = measure_threads(stock.part());
  ASSERT_EQ(threads.size(), 1U);
  EXPECT_NEAR(threads[0].minor_mm, 8 - 2 * 0.61343 * 1.25, 1e-3);
}

TEST(Tap, WithoutALeadItIsADrill) {
  TurningStock stock = drilled(6.8);
  EXPECT_NEAR(tap(stock, 0), kPi * (16 - 3.4 * 3.4) * 15, 1e-3);
  EXPECT_TRUE(stock.part().threads().empty());
}

TEST(Tap, APitchTooLargeForItsDiameterIsNone) {
  EXPECT_FALSE(tap_tools(8, 7, 100));
  EXPECT_TRUE(tap_tools(8, 6, 100));
}

}  // namespace
}  // namespace kerf
