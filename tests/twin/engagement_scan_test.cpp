#include "twin/engagement_scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"

namespace kerf {
namespace {

constexpr double kCell_mm = 0.25;

/// A block 50 x 30 x 10 mm with its top at Z0.
class EngagementScanTest : public testing::Test {
 protected:
  EngagementScanTest() { make("box:0,0,-10:50,30,0", kCell_mm); }
  void make(const std::string& blank, double cell_mm) {
    ZMapOptions options;
    options.blank = parse_blank(blank).value();
    options.cell_mm = cell_mm;
    stock_ = std::move(ZMap::create(options).value());
  }
  static CutMove line(Vec3 from, Vec3 to) {
    CutMove move;
    move.from_mm = from;
    move.to_mm = to;
    return move;
  }
  static CutMove turn(Vec3 from, Vec3 to, Vec3 center, double sweep_rad) {
    CutMove move = line(from, to);
    move.arc = CutArc{center, {0, 0, 1}, sweep_rad};
    return move;
  }
  void cut(const Cutter& cutter, const CutMove& move) {
    std::vector<CutReport> reports;
    stock_->cut(cutter, std::span(&move, 1), reports);
    stock_->finish(reports);
  }
  void run(const Cutter& cutter, const CutMove& move, double bin_mm = 0.5) {
    ASSERT_TRUE(EngagementScan::takes(cutter, move));
    scan_.run(*stock_->snapshot()->height_grid(), cutter, move, 0, 1, bin_mm);
    EngagementScan::Lanes lanes;
    lanes.bin_mm = bin_mm;
    lanes.gap_mm = lanes.step_mm = EngagementScan::kLeastGapBins * bin_mm;
    lanes_.run_lanes(*stock_->snapshot()->height_grid(), cutter, move, 0, 1, lanes);
  }
  /// The only stretch: from and to in mm of a way of that length.
  void expect_span(double length_mm, double from_mm, double to_mm, double within_mm) {
    for (const EngagementScan* scan : {&scan_, &lanes_}) {
      SCOPED_TRACE(scan == &scan_ ? "all cells" : "lanes");
      ASSERT_EQ(scan->spans().size(), 1U);
      EXPECT_NEAR(scan->spans()[0].from * length_mm, from_mm, within_mm);
      EXPECT_NEAR(scan->spans()[0].to * length_mm, to_mm, within_mm);
    }
  }
  double sum_mm3() const {
    return std::accumulate(scan_.bins_mm3().begin(), scan_.bins_mm3().end(), 0.0);
  }

  std::unique_ptr<ZMap> stock_;
  EngagementScan scan_, lanes_;
};

/// Flat and bull-nosed ones meet the block with their full radius, a ball of R5 with
/// sqrt(25 - 9) = 4 mm at a depth of 2, a vee of 90 degrees with its depth; all leave the walls
/// where their middle leaves the block.
TEST_F(EngagementScanTest, SlotsBeginAndEndWhereTheBlankDoes) {
  const CutMove slot = line({-20, 15, -2}, {70, 15, -2});
  const struct {
    const char* shape;
    double reach_mm, section_mm2;
  } cases[] = {{"flat:10", 5, 20},
               {"bull:10:1", 5, 10 + 8 + kPi / 2},
               {"ball:10", 4, 25 * std::acos(0.6) - 12},
               {"vee:10:90", 2, 4}};
  for (const auto& each : cases) {
    SCOPED_TRACE(each.shape);
    run(parse_shape(each.shape).value(), slot);
    expect_span(90, 20 - each.reach_mm, 70, 0.02);
    // Half way through, over 10 mm.
    double mm3 = 0;
    for (std::size_t bin = 80; bin < 100; ++bin) mm3 += scan_.bins_mm3()[bin];
    EXPECT_NEAR(mm3 / 10, each.section_mm2, 0.005 * each.section_mm2);
  }
}

/// The corner of the block is met where the circle comes to it: sqrt(25 - 9) = 4 mm before it.
TEST_F(EngagementScanTest, TheCornerOfABlockIsMetWhereItIs) {
  run(parse_shape("flat:10").value(), line({-20, -3, -2}, {70, -3, -2}));
  expect_span(90, 16, 70, 0.02);
}

/// A way of 10 mm through the middle of the block is open: to its wall, and from where the front
/// meets the other wall. Walls that were cut are known to half a cell.
TEST_F(EngagementScanTest, AnAirGapIsNotCut) {
  const Cutter flat = parse_shape("flat:10").value();
  cut(flat, line({25, -10, -2}, {25, 40, -2}));
  run(flat, line({-20, 15, -2}, {70, 15, -2}));
  for (const EngagementScan* scan : {&scan_, &lanes_}) {
    ASSERT_EQ(scan->spans().size(), 2U);
    EXPECT_NEAR(scan->spans()[0].from * 90, 15, 0.02);
    EXPECT_NEAR(scan->spans()[0].to * 90, 40, kCell_mm / 2);
    EXPECT_NEAR(scan->spans()[1].from * 90, 45, kCell_mm / 2);
    EXPECT_NEAR(scan->spans()[1].to * 90, 70, 0.02);
  }
}

/// Where it stopped before it goes on, and what it has cut it does not cut again.
TEST_F(EngagementScanTest, ASlotIsGoneOnWith) {
  const Cutter flat = parse_shape("flat:10").value();
  cut(flat, line({-20, 15, -2}, {20, 15, -2}));
  run(flat, line({-20, 15, -2}, {20, 15, -2}));
  EXPECT_TRUE(scan_.spans().empty());
  EXPECT_TRUE(lanes_.spans().empty());
  EXPECT_EQ(sum_mm3(), 0);
  run(flat, line({-20, 15, -2}, {30, 15, -2}));
  expect_span(50, 40, 50, kCell_mm / 2);
}

/// What is removed is what the model removes, whichever way it goes.
TEST_F(EngagementScanTest, VolumesAreThoseOfTheModel) {
  for (const char* shape : {"flat:6", "ball:6", "bull:6:1", "vee:6:90"}) {
    const Cutter cutter = parse_shape(shape).value();
    for (const CutMove& move :
         {line({5, 5, -2}, {40, 20, -3}), line({20, 15, 2}, {20, 15, -4}),
          line({40, 5, 1}, {10, 25, -1}), turn({20, 15, -1}, {20, 15, -3}, {15, 15, 0}, 2 * kPi),
          turn({40, 5, -2}, {30, 15, -2}, {30, 5, 0}, kPi / 2)}) {
      SCOPED_TRACE(shape);
      make("box:0,0,-10:50,30,0", kCell_mm);
      const double before = stock_->remaining_mm3();
      run(cutter, move);
      cut(cutter, move);
      const double removed = before - stock_->remaining_mm3();
      EXPECT_NEAR(sum_mm3(), removed, 0.005 * removed);
    }
  }
}

/// From Z0 to Z-4 of a way from Z6 to Z-4: the last 0.4 of it, evenly.
TEST_F(EngagementScanTest, APlungeCutsFromTheTopOn) {
  run(parse_shape("flat:6").value(), line({20, 15, 6}, {20, 15, -4}));
  expect_span(10, 6, 10, 0.001);
  for (std::size_t bin = 12; bin < 20; ++bin) {
    EXPECT_NEAR(scan_.bins_mm3()[bin], kPi * 9 / 2, 0.01 * kPi * 9 / 2) << bin;
  }
}

/// Lanes see the same stretches as all cells, within a cell and a half, for a tenth of the looks.
TEST_F(EngagementScanTest, LanesSeeWhatAllCellsTell) {
  for (const char* shape : {"flat:6", "ball:6", "bull:6:1", "vee:6:90"}) {
    const Cutter cutter = parse_shape(shape).value();
    for (const CutMove& move :
         {line({-5, 5, -2}, {40, 20, -3}), line({40, 5, 1}, {10, 25, -1}),
          line({20, -5, -2}, {21, 40, -2}), turn({20, 15, -1}, {20, 15, -3}, {15, 15, 0}, 2 * kPi),
          turn({60, 5, -2}, {50, 15, -2}, {50, 5, 0}, kPi / 2)}) {
      SCOPED_TRACE(shape);
      make("box:0,0,-10:50,30,0", 0.1);
      cut(cutter, line({25, 0, -2.5}, {25, 30, -2.5}));
      run(cutter, move);
      const double length_mm =
          move.arc ? 10 * std::abs(move.arc->sweep_rad) : glm::length(move.to_mm - move.from_mm);
      ASSERT_EQ(lanes_.spans().size(), scan_.spans().size());
      for (std::size_t i = 0; i < scan_.spans().size(); ++i) {
        EXPECT_NEAR(lanes_.spans()[i].from * length_mm, scan_.spans()[i].from * length_mm, 0.15);
        EXPECT_NEAR(lanes_.spans()[i].to * length_mm, scan_.spans()[i].to * length_mm, 0.15);
      }
    }
  }
}

/// A model may hold the last move back; its heights do not have it then.
TEST_F(EngagementScanTest, WhatIsHeldBackIsCut) {
  EngagementScan::Lanes lanes;
  lanes.bin_mm = 0.5;
  lanes.gap_mm = lanes.step_mm = 1.5;
  for (const char* shape : {"flat:10", "ball:10"}) {
    SCOPED_TRACE(shape);
    const Cutter cutter = parse_shape(shape).value();
    for (const double end_z : {-2.0, -3.0}) {
      const CutMove held = line({-20, 15, -2}, {20, 15, end_z});
      lanes.held = &held;
      lanes_.run_lanes(*stock_->height_grid(), cutter, held, 0, 1, lanes);
      double length = 0;
      for (const EngagementScan::Span& span : lanes_.spans()) length += span.to - span.from;
      EXPECT_LT(length * 40, 0.5);
    }
  }
}

/// Of many cells some are looked at, and stand for the others.
TEST_F(EngagementScanTest, LongWaysAreSampled) {
  make("box:0,0,-10:300,100,0", 0.1);
  const Cutter flat = parse_shape("flat:20").value();
  for (const Vec3 end : {Vec3{320, 50, -2}, Vec3{300, 90, -2}}) {
    const CutMove move = line({-20, 30, -2}, end);
    EngagementScan::Cost cost = scan_.run(*stock_->height_grid(), flat, move, 0, 1, 0.5);
    EXPECT_LT(cost.looks, 0.25 * 320 * 20 / 0.01);
    const std::span<const double> bins = scan_.bins_mm3();
    const double bin_mm = glm::length(move.to_mm - move.from_mm) / static_cast<double>(bins.size());
    double mm3 = 0;
    for (std::size_t bin = 100; bin < 110; ++bin) mm3 += bins[bin];
    EXPECT_NEAR(mm3 / (10 * bin_mm), 20 * 2, 0.01 * 40);
  }
}

TEST_F(EngagementScanTest, DoesNotTakeWhatHeightsCannotTell) {
  const CutMove level = line({0, 0, -1}, {10, 0, -1});
  const Cutter flat = parse_shape("flat:6").value();
  EXPECT_TRUE(EngagementScan::takes(flat, level));
  EXPECT_FALSE(EngagementScan::takes(parse_shape("tslot:16:4:8").value(), level));
  CutMove tilted = level;
  tilted.axis_from = tilted.axis_to = glm::normalize(Vec3(1, 0, 2));
  EXPECT_FALSE(EngagementScan::takes(flat, tilted));
  EXPECT_TRUE(EngagementScan::takes(flat, turn({5, 0, 0}, {5, 0, -1}, {0, 0, 0}, 2 * kPi)));
  EXPECT_FALSE(EngagementScan::takes(flat, turn({5, 0, 0}, {5, 0, -2}, {0, 0, 0}, 4 * kPi)));
  EXPECT_FALSE(EngagementScan::takes(flat, turn({5, 0, 0}, {0, 8, 0}, {0, 0, 0}, kPi / 2)));
}

}  // namespace
}  // namespace kerf
