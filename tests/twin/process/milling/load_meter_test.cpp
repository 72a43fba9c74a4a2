#include "twin/process/milling/load_meter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"

namespace kerf {
namespace {

constexpr double kCell_mm = 0.1;

/// A block 40 x 40 x 10 mm with its top at Z0, and a flat cutter of 4 mm at 10 mm/s.
class LoadMeterTest : public testing::Test {
 protected:
  LoadMeterTest() {
    ZMapOptions options;
    options.blank = parse_blank("box:0,0,-10:40,40,0").value();
    options.cell_mm = kCell_mm;
    stock_ = std::move(ZMap::create(options).value());
    meter_ = std::make_unique<LoadMeter>(*stock_);
  }
  static CutMove line(Vec3 from, Vec3 to) {
    CutMove move;
    move.from_mm = from;
    move.to_mm = to;
    return move;
  }
  /// From rest to rest at 10 mm/s and 250 mm/s2: v / a longer than without ramps.
  static double duration_s(const CutMove& move) {
    return glm::length(move.to_mm - move.from_mm) / kSpeed + kSpeed / 250;
  }
  MotionLoad measure(const CutMove& move) {
    meter_->reach(cutter_, move, duration_s(move), kSpeed);
    return meter_->measure(cutter_, move, 0);
  }
  void cut(const CutMove& move) {
    std::vector<CutReport> reports;
    stock_->cut(cutter_, std::span(&move, 1), reports);
    stock_->finish(reports);
  }

  static constexpr double kSpeed = 10;
  const Cutter cutter_ = parse_shape("flat:4").value();
  std::unique_ptr<ZMap> stock_;
  std::unique_ptr<LoadMeter> meter_;
};

/// It cuts from X-2 to X40, where its widest leaves the walls: blanks end where cells do.
TEST_F(LoadMeterTest, ASlotThroughABlockIsCutToItsLastSliver) {
  const std::string digest = stock_->digest();
  const MotionLoad load = measure(line({-5, 20, -2}, {45, 20, -2}));
  EXPECT_NEAR(load.cut_s, 42 / kSpeed, 0.001);
  EXPECT_NEAR(load.peak_mm3_per_s, 4 * 2 * kSpeed, 0.002 * 80);
  EXPECT_EQ(stock_->digest(), digest);
}

/// Its last 5 mm take 0.5 s, and half of what braking takes longer: 10 / 250 / 2 = 0.02 s.
TEST_F(LoadMeterTest, BrakingInMaterialIsCuttingTime) {
  const MotionLoad load = measure(line({20, 20, 30}, {20, 20, -5}));
  EXPECT_NEAR(load.cut_s, 0.52, 0.0052);
  EXPECT_NEAR(load.peak_mm3_per_s, kPi * 4 * kSpeed, 0.01 * kPi * 40);
}

TEST_F(LoadMeterTest, AWayThatIsFreeIsNotCut) {
  const CutMove slot = line({-5, 20, -2}, {25, 20, -2});
  cut(slot);
  EXPECT_EQ(measure(slot).cut_s, 0);
  // The second half of the longer way is material: from X25, where the round front stands already.
  const MotionLoad rest = measure(line({5, 20, -2}, {35, 20, -2}));
  EXPECT_NEAR(rest.cut_s, 1 + 0.02, 0.01 + 0.002 * 30 / kSpeed);
  EXPECT_NEAR(rest.peak_mm3_per_s, 80, 0.8);
}

/// A motion that is blended with its neighbours has the time that they leave it: 6 mm in 0.05 s are
/// no 120 mm/s where the planner goes no faster than 60.
TEST_F(LoadMeterTest, ABlendedMoveIsNoFasterThanThePlanner) {
  cut(line({-5, 20, -2}, {20, 20, -2}));
  const CutMove move = line({20, 20, -2}, {26, 20, -2});
  const MotionReach reach = meter_->reach(cutter_, move, 0.05, 60);
  EXPECT_NEAR(reach.speed_per_mm, 60.0 / 6, 1e-9);
  const MotionLoad load = meter_->measure(cutter_, move, 0);
  EXPECT_NEAR(load.peak_mm3_per_s, 4 * 2 * 60, 0.01 * 480);
  EXPECT_NEAR(load.cut_s, 0.05, 0.0005);
}

/// The box of the blank, drawn out by the cutter: X-2 to X42 of a way from X-20 to X60.
TEST_F(LoadMeterTest, ReachIsWhereTheBlankWas) {
  const CutMove move = line({-20, 20, -2}, {60, 20, -2});
  const MotionReach reach = meter_->reach(cutter_, move, duration_s(move), kSpeed);
  EXPECT_NEAR(reach.part.seconds, 4.4, 1e-9);
  EXPECT_NEAR(reach.part.way_mm, 44, 1e-9);
  EXPECT_TRUE(reach.part.known);
  EXPECT_TRUE(reach.part.enters);
  // Its middle comes to X40.
  EXPECT_NEAR(reach.part.leaves_s, 4.2, 1e-9);
  EXPECT_NEAR(reach.part.leaves_mm, 42, 1e-9);
  EXPECT_NEAR(reach.speed_per_mm, kSpeed / 44, 1e-9);
  EXPECT_NEAR(reach.side_mm2_per_s, 4 * kSpeed, 1e-9);
  EXPECT_EQ(reach.disc_mm3_per_s, 0);
  const CutMove above = line({-20, 20, 0}, {60, 20, 0}), beside = line({-9, 1, -2}, {-3, 9, -2});
  EXPECT_EQ(meter_->reach(cutter_, above, duration_s(above), kSpeed).part.seconds, 0);
  EXPECT_EQ(meter_->reach(cutter_, beside, duration_s(beside), kSpeed).part.seconds, 0);
}

/// Half of the way is in the air: with 300 of them as with a few, though looking at all
/// of them closely would cost more than cutting them.
TEST_F(LoadMeterTest, ManyMovesAreMeasuredAsWellAsFew) {
  cut(line({20, 20, -2}, {45, 20, -2}));
  // From X-2 to where the round end of the slot leaves the widest: X20, to a part of a cell's
  // chord.
  const CutMove move = line({-5, 20, -2}, {45, 20, -2}), back = line({45, 20, 5}, {-5, 20, 5});
  double cut_s = 0;
  for (int n = 0; n < 300; ++n) {
    meter_->reach(cutter_, back, duration_s(back), kSpeed);
    meter_->reach(cutter_, move, duration_s(move), kSpeed);
    cut_s += meter_->measure(cutter_, move, 80).cut_s;
  }
  EXPECT_NEAR(cut_s, 300 * 2.2, 300 * (kCell_mm / 2 + std::sqrt(4 * kCell_mm / 2)) / kSpeed);
}

/// Short moves are looked at while that costs next to nothing. Those that last always are, and as
/// well when there is nothing left to spend: an hour has no more than 7200 of them.
TEST_F(LoadMeterTest, ShortMovesArePaidForByCutting) {
  cut(line({20, 20, -2}, {45, 20, -2}));
  const CutMove move = line({-5, 20, -2}, {45, 20, -2}), back = line({45, 20, 5}, {-5, 20, 5});
  constexpr int kMost = 200'000;
  int short_ones = 0;
  double last_s = 0;
  for (; meter_->affords_short() && short_ones < kMost; ++short_ones) {
    meter_->reach(cutter_, back, duration_s(back), kSpeed);
    meter_->reach(cutter_, move, duration_s(move), kSpeed);
    last_s = meter_->measure(cutter_, move, 80).cut_s;
  }
  EXPECT_GT(short_ones, 10);
  EXPECT_LT(short_ones, kMost);
  EXPECT_NEAR(last_s, 2.2, (kCell_mm / 2 + std::sqrt(4 * kCell_mm / 2)) / kSpeed);
}

}  // namespace
}  // namespace kerf
