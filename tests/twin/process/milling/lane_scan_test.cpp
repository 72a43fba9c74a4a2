#include "twin/process/milling/lane_scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "stock/cutter/shape_spec.h"
#include "stock/octree/octree.h"

namespace kerf {
namespace {

constexpr double kCell_mm = 0.25;

/// A block 50 x 30 x 20 mm with its top at Z0.
class LaneScanTest : public testing::Test {
 protected:
  LaneScanTest() {
    OctreeOptions options;
    options.blank = parse_blank("box:0,0,-20:50,30,0").value();
    options.cell_mm = kCell_mm;
    stock_ = std::move(Octree::create(options).value());
  }
  static CutMove line(Vec3 from, Vec3 to, Vec3 axis = {0, 0, 1}) {
    CutMove move;
    move.from_mm = from;
    move.to_mm = to;
    move.axis_from = move.axis_to = glm::normalize(axis);
    return move;
  }
  void cut(const Cutter& cutter, const CutMove& move) {
    std::vector<CutReport> reports;
    stock_->cut(cutter, std::span(&move, 1), reports);
  }
  void run(const Cutter& cutter, const CutMove& move) {
    length_mm_ = glm::length(move.to_mm - move.from_mm);
    LaneScan::Grain grain;
    grain.bin_mm = 0.5;
    grain.gap_mm = grain.step_mm = 1;
    scan_.run(*stock_, stock_->bounds_mm(), kCell_mm, cutter, move, grain);
  }
  void expect_span(std::size_t number, double from_mm, double to_mm, double within_mm) {
    ASSERT_GT(scan_.spans().size(), number);
    EXPECT_NEAR(scan_.spans()[number].from * length_mm_, from_mm, within_mm);
    EXPECT_NEAR(scan_.spans()[number].to * length_mm_, to_mm, within_mm);
  }
  double rate(double from_mm, double to_mm) const {
    double mm3 = 0;
    const double bin_mm = length_mm_ / static_cast<double>(scan_.bins_mm3().size());
    for (std::size_t b = 0; b < scan_.bins_mm3().size(); ++b) {
      const double middle = (static_cast<double>(b) + 0.5) * bin_mm;
      if (middle > from_mm && middle < to_mm) mm3 += scan_.bins_mm3()[b];
    }
    return mm3 / (to_mm - from_mm);
  }

  std::unique_ptr<Octree> stock_;
  LaneScan scan_;
  double length_mm_ = 0;
};

/// As EngagementScanTest.SlotsBeginAndEndWhereTheBlankDoes.
TEST_F(LaneScanTest, SlotsBeginAndEndWhereTheBlankDoes) {
  const struct {
    const char* shape;
    double reach_mm, section_mm2;
  } cases[] = {{"flat:10", 5, 20},
               {"bull:10:1", 5, 10 + 8 + kPi / 2},
               {"ball:10", 4, 25 * std::acos(0.6) - 12},
               {"vee:10:90", 2, 4}};
  for (const auto& each : cases) {
    SCOPED_TRACE(each.shape);
    run(parse_shape(each.shape).value(), line({-20, 15, -2}, {70, 15, -2}));
    ASSERT_EQ(scan_.spans().size(), 1U);
    expect_span(0, 20 - each.reach_mm, 70, 0.1);
    EXPECT_NEAR(rate(40, 60), each.section_mm2, 0.04 * each.section_mm2);
  }
}

TEST_F(LaneScanTest, WhatIsCutIsNotCutAgain) {
  for (const char* shape : {"flat:10", "bull:10:1", "ball:10", "vee:10:90"}) {
    SCOPED_TRACE(shape);
    const Cutter cutter = parse_shape(shape).value();
    for (const CutMove& move : {line({-20, 7, -2}, {30, 23, -3}), line({-20, 15, -4}, {30, 15, -4}),
                                line({-20, 15, -5}, {30, 15, -5}, {0.3, -0.2, 1})}) {
      cut(cutter, move);
      run(cutter, move);
      EXPECT_TRUE(scan_.spans().empty());
    }
  }
  const Cutter flat = parse_shape("flat:10").value();
  run(flat, line({-20, 15, -5}, {70, 15, -5}, {0.3, -0.2, 1}));
  ASSERT_EQ(scan_.spans().size(), 1U);
}

/// A way of 10 mm through the middle of the block is open.
TEST_F(LaneScanTest, AnAirGapIsNotCut) {
  const Cutter flat = parse_shape("flat:10").value();
  cut(flat, line({25, -10, -2}, {25, 40, -2}));
  run(flat, line({-20, 15, -2}, {70, 15, -2}));
  ASSERT_EQ(scan_.spans().size(), 2U);
  expect_span(0, 15, 40, 0.1);
  expect_span(1, 45, 70, 0.1);
}

/// ae 2: its front meets the block sqrt(25 - 9) = 4 mm before its middle does.
TEST_F(LaneScanTest, ASideIsCut) {
  run(parse_shape("flat:10").value(), line({-20, -3, -5}, {70, -3, -5}));
  ASSERT_EQ(scan_.spans().size(), 1U);
  expect_span(0, 16, 70, 0.1);
}

TEST_F(LaneScanTest, APlungeCutsFromTheTopOn) {
  run(parse_shape("flat:6").value(), line({20, 15, 6}, {20, 15, -4}));
  ASSERT_EQ(scan_.spans().size(), 1U);
  expect_span(0, 6, 10, 0.02);
  EXPECT_NEAR(rate(7, 9.5), kPi * 9, 0.04 * kPi * 9);
}

/// A flat cutter that leans by 30 degrees across its way, its edge 2 mm deep: on the top of the
/// block its end is 4 mm from the deepest point, 1 mm from its middle: it meets the side sqrt(25 -
/// 1) mm before that.
/// By 30 degrees forward: the ball's centre is 2.5 mm before its tip and 2.33 above the top, so the
/// ball reaches the top 4.42 mm before that, the wall above it 4.43, and nothing is left 47.5 mm
/// on.
TEST_F(LaneScanTest, ALeaningBallIsMetWhereItsSideIs) {
  const Vec3 axis(0.5, 0, std::sqrt(0.75));
  run(parse_shape("ball:10").value(), line({-20, 15, -2}, {70, 15, -2}, axis));
  ASSERT_EQ(scan_.spans().size(), 1U);
  expect_span(0, 20 - 6.93, 67.5, 0.1);
  const double high = 5 * std::sqrt(0.75) - 2, half = std::sqrt(25 - high * high);
  const double section_mm2 = 25 * std::acos(high / 5) - high * half;
  EXPECT_NEAR(rate(40, 60), section_mm2, 0.04 * section_mm2);
}

TEST_F(LaneScanTest, ALeaningCutterIsMetWhereItsEdgeIs) {
  const double lean = kPi / 6, deep_mm = 2;
  const Vec3 axis(0, -std::sin(lean), std::cos(lean));
  const double tip_z = 5 * std::sin(lean) - deep_mm;
  run(parse_shape("flat:10").value(), line({-20, 15, tip_z}, {70, 15, tip_z}, axis));
  ASSERT_EQ(scan_.spans().size(), 1U);
  expect_span(0, 20 - std::sqrt(25.0 - 1), 70, 0.1);
}

}  // namespace
}  // namespace kerf
