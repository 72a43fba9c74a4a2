#include "twin/process/milling/engagement_scan.h"

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
  /// What the move has removed.
  double cut(const Cutter& cutter, const CutMove& move) {
    std::vector<CutReport> reports;
    stock_->cut(cutter, std::span(&move, 1), reports);
    stock_->finish(reports);
    return reports.at(0).removed_mm3;
  }
  void run(const Cutter& cutter, const CutMove& move, double bin_mm = 0.5) {
    ASSERT_TRUE(EngagementScan::takes(cutter, move));
    heights_ = stock_->snapshot()->height_grid();
    EngagementScan::Lanes lanes;
    lanes.bin_mm = bin_mm;
    lanes.gap_mm = lanes.step_mm = EngagementScan::kLeastGapBins * bin_mm;
    scan_.run_lanes(*heights_, cutter, move, 0, 1, lanes);
    cost_ = scan_.run_part(0, 1, static_cast<int>(scan_.bins_mm3().size()));
  }
  /// The only stretch: from and to in mm of a way of that length.
  void expect_span(double length_mm, double from_mm, double to_mm, double within_mm) {
    ASSERT_EQ(scan_.spans().size(), 1U);
    EXPECT_NEAR(scan_.spans()[0].from * length_mm, from_mm, within_mm);
    EXPECT_NEAR(scan_.spans()[0].to * length_mm, to_mm, within_mm);
  }
  double sum_mm3() const {
    return std::accumulate(scan_.bins_mm3().begin(), scan_.bins_mm3().end(), 0.0);
  }

  std::unique_ptr<ZMap> stock_;
  std::shared_ptr<const HeightGrid> heights_;
  EngagementScan scan_;  ///< spans() by lanes, bins_mm3() by all cells
  EngagementScan::Cost cost_;
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

/// 0.6 and 2 mm wide: where the material is level cells are looked at more closely.
TEST_F(EngagementScanTest, NarrowGroovesAreFinerThanCells) {
  const double half = std::acos(0.98);
  const struct {
    const char* shape;
    double deep_mm, section_mm2;
  } cases[] = {{"vee:10:90", 0.3, 0.09}, {"ball:10", 0.1, 25 * (half - 0.98 * std::sin(half))}};
  for (const auto& each : cases) {
    SCOPED_TRACE(each.shape);
    const Cutter cutter = parse_shape(each.shape).value();
    for (const double y : {15.0, 15.07, 15.125}) {
      run(cutter, line({-20, y, -each.deep_mm}, {70, y, -each.deep_mm}));
      scan_.run_part(0.5, 0.7, 20);
      const double mm3 = std::accumulate(scan_.bins_mm3().begin() + 1, scan_.bins_mm3().end(), 0.0);
      EXPECT_NEAR(mm3 / (18 * 19 / 20.0), each.section_mm2, 0.03 * each.section_mm2) << y;
    }
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
  ASSERT_EQ(scan_.spans().size(), 2U);
  EXPECT_NEAR(scan_.spans()[0].from * 90, 15, 0.02);
  EXPECT_NEAR(scan_.spans()[0].to * 90, 40, kCell_mm / 2);
  EXPECT_NEAR(scan_.spans()[1].from * 90, 45, kCell_mm / 2);
  EXPECT_NEAR(scan_.spans()[1].to * 90, 70, 0.02);
}

/// Where it stopped before it goes on, and what it has cut it does not cut again.
TEST_F(EngagementScanTest, ASlotIsGoneOnWith) {
  const Cutter flat = parse_shape("flat:10").value();
  cut(flat, line({-20, 15, -2}, {20, 15, -2}));
  run(flat, line({-20, 15, -2}, {20, 15, -2}));
  EXPECT_TRUE(scan_.spans().empty());
  EXPECT_EQ(sum_mm3(), 0);
  run(flat, line({-20, 15, -2}, {30, 15, -2}));
  expect_span(50, 40, 50, kCell_mm / 2);
}

/// What is removed is what a model of fine cells removes, whichever way it goes. One of the same
/// cells removes 0.8 % less of the bull-nosed cutter's plunge, which is 109.35 mm3.
TEST_F(EngagementScanTest, VolumesAreThoseOfAFineModel) {
  for (const char* shape : {"flat:6", "ball:6", "bull:6:1", "vee:6:90"}) {
    const Cutter cutter = parse_shape(shape).value();
    for (const CutMove& move :
         {line({5, 5, -2}, {40, 20, -3}), line({20, 15, 2}, {20, 15, -4}),
          line({40, 5, 1}, {10, 25, -1}), turn({20, 15, -1}, {20, 15, -3}, {15, 15, 0}, 2 * kPi),
          turn({40, 5, -2}, {30, 15, -2}, {30, 5, 0}, kPi / 2)}) {
      SCOPED_TRACE(shape);
      make("box:0,0,-10:50,30,0", kCell_mm);
      run(cutter, move);
      make("box:0,0,-10:50,30,0", kCell_mm / 5);
      const double removed = cut(cutter, move);
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

/// In a block 50 x 30 x 10 mm through which that cutter has gone along X25, 2.5 mm deep.
bool in_grooved_block(const Cutter& cutter, const Vec3& p) {
  if (!(p.x > 0 && p.x < 50 && p.y > 0 && p.y < 30 && p.z > -10 && p.z < 0)) return false;
  const double beside = std::abs(p.x - 25);
  return beside >= cutter.radius_mm() || p.z < -2.5 + cutter.height_mm(beside);
}

/// Right before any place of the cutter that goes forward is material of the grooved block.
bool meets_material(const Cutter& cutter, const CutMove& move, double part) {
  constexpr int kRings = 24, kTurn = 720, kWalls = 8;
  constexpr double kAhead_mm = 1e-4;
  Vec3 tip = move.from_mm + part * (move.to_mm - move.from_mm), ahead = move.to_mm - move.from_mm;
  if (move.arc) {
    const Vec2 arm = Vec2(move.from_mm - move.arc->center_mm);
    const double angle = std::atan2(arm.y, arm.x) + part * move.arc->sweep_rad;
    const Vec2 out(std::cos(angle), std::sin(angle));
    tip = Vec3(Vec2(move.arc->center_mm) + glm::length(arm) * out, tip.z);
    ahead = Vec3(glm::length(arm) * move.arc->sweep_rad * Vec2(-out.y, out.x), ahead.z);
  }
  ahead = glm::normalize(ahead);
  const double radius = cutter.radius_mm();
  for (int k = 0; k < kTurn; ++k) {
    const Vec2 out(std::cos(2 * kPi * k / kTurn), std::sin(2 * kPi * k / kTurn));
    for (int ring = 1; ring <= kRings + kWalls; ++ring) {
      const bool wall = ring > kRings;
      const double r = wall ? radius : radius * (ring - 0.5) / kRings, d = radius / kRings / 4;
      const double rise = (cutter.height_mm(r + d) - cutter.height_mm(r - d)) / (2 * d);
      const Vec3 normal = wall ? Vec3(out, 0) : Vec3(rise * out, -1);
      if (glm::dot(normal, ahead) <= 1e-9) continue;
      const double height = cutter.height_mm(r) + (wall ? (ring - kRings - 0.9) * 0.5 : 0);
      if (in_grooved_block(cutter, tip + Vec3(r * out, height) + kAhead_mm * ahead)) return true;
    }
  }
  return false;
}

/// Stretches longer than half a mm on which it does, and are as far from each other.
std::vector<WaySpan> met_spans(const Cutter& cutter, const CutMove& move, double length_mm) {
  const auto edge = [&](double in, double out) {
    while (std::abs(out - in) * length_mm > 0.005) {
      const double middle = 0.5 * (in + out);
      (meets_material(cutter, move, middle) ? in : out) = middle;
    }
    return in;
  };
  std::vector<WaySpan> spans;
  const int places = static_cast<int>(std::ceil(length_mm * 2));
  double before = 0;
  bool met = false;
  for (int k = 0; k <= places; ++k) {
    const double part = static_cast<double>(k) / places;
    const bool meets = meets_material(cutter, move, part);
    if (meets && !met) spans.push_back({k == 0 ? 0 : edge(part, before), part});
    if (!meets && met) spans.back().to = edge(before, part);
    if (meets) spans.back().to = part;
    met = meets;
    before = part;
  }
  return spans;
}

/// Within a cell and a half.
TEST_F(EngagementScanTest, LanesSeeWhereTheFrontMeetsMaterial) {
  for (const char* shape : {"flat:6", "ball:6", "bull:6:1", "vee:6:90"}) {
    const Cutter cutter = parse_shape(shape).value();
    for (const CutMove& move :
         {line({-5, 5, -2}, {40, 20, -3}), line({40, 5, 1}, {10, 25, -1}),
          line({20, -5, -2}, {21, 40, -2}), turn({20, 15, -1}, {20, 15, -3}, {15, 15, 0}, 2 * kPi),
          turn({60, 5, -2}, {50, 15, -2}, {50, 5, 0}, kPi / 2)}) {
      SCOPED_TRACE(shape);
      SCOPED_TRACE(move.to_mm.x);
      make("box:0,0,-10:50,30,0", 0.1);
      cut(cutter, line({25, 0, -2.5}, {25, 30, -2.5}));
      run(cutter, move);
      const double length_mm =
          move.arc ? 10 * std::abs(move.arc->sweep_rad) : glm::length(move.to_mm - move.from_mm);
      const std::vector<WaySpan> met = met_spans(cutter, move, length_mm);
      ASSERT_EQ(scan_.spans().size(), met.size());
      for (std::size_t i = 0; i < met.size(); ++i) {
        EXPECT_NEAR(scan_.spans()[i].from * length_mm, met[i].from * length_mm, 0.15);
        EXPECT_NEAR(scan_.spans()[i].to * length_mm, met[i].to * length_mm, 0.15);
      }
    }
  }
}

/// The move before stopped in a wall at X20, 1 mm before its end: what is left of it beside the
/// round front, 0.17 mm wide, is removed on the first mm, however long the steps are. The next
/// wall, at X26, is met 3 mm before the cutter's middle comes there.
TEST_F(EngagementScanTest, WhatStandsRightAheadIsSeen) {
  make("box:0,0,-10:50,30,0", 0.05);
  const Cutter flat = parse_shape("flat:6").value();
  cut(parse_shape("flat:5").value(), line({23.5, -10, -2}, {23.5, 40, -2}));
  cut(flat, line({-5, 15, -2}, {20, 15, -2}));
  EngagementScan::Lanes lanes;
  lanes.bin_mm = 0.1875;
  lanes.gap_mm = 0.5625;
  lanes.step_mm = 6 * lanes.gap_mm;
  lanes.count = 13;
  heights_ = stock_->snapshot()->height_grid();
  scan_.run_lanes(*heights_, flat, line({20, 15, -2}, {30, 15, -2}), 0, 1, lanes);
  ASSERT_EQ(scan_.spans().size(), 2U);
  EXPECT_NEAR(scan_.spans()[0].from * 10, 0, 0.05);
  EXPECT_NEAR(scan_.spans()[0].to * 10, 1, 0.05);
  EXPECT_NEAR(scan_.spans()[1].from * 10, 3, 0.05);
  EXPECT_NEAR(scan_.spans()[1].to * 10, 10, 0.05);
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
      scan_.run_lanes(*stock_->height_grid(), cutter, held, 0, 1, lanes);
      double length = 0;
      for (const WaySpan& span : scan_.spans()) length += span.to - span.from;
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
    run(flat, move);
    EXPECT_LT(cost_.looks, 0.25 * 320 * 20 / 0.01);
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
