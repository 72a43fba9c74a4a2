// What EngagementScan says against exact geometry.
#include "tests/twin/process/milling/engagement_oracle.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "tests/base/sanitized.h"
#include "twin/process/milling/engagement_scan.h"

namespace kerf {
namespace {

constexpr double kOracleCell_mm = 0.1;

/// Moves at random, of all upright tools, each over what those before have left.
class EngagementOracleTest : public testing::TestWithParam<const char*> {};

TEST_P(EngagementOracleTest, AnglesAreThoseOfExactGeometry) {
  const std::string shape = GetParam();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  const Cutter cutter = parse_shape(shape).value();
  const Cutter other = parse_shape("flat:5").value();
  EngagementErrors off, brief;
  const int rounds = kIsSanitized ? 2 : 6;
  for (int round = 0; round < rounds; ++round) {
    ZMapOptions options;
    options.blank = parse_blank("box:0,0,-10:40,30,0").value();
    options.cell_mm = kOracleCell_mm;
    const std::unique_ptr<ZMap> stock = std::move(ZMap::create(options).value());
    stock->keep_cut_ids(true);
    EngagementOracle oracle(stock->bounds_mm());
    PastWays ways;
    EngagementScan scan;
    Vec3 at{40 * unit(random), 30 * unit(random), -1 - 3 * unit(random)};
    for (std::uint64_t n = 0; n < 24; ++n) {
      const bool by_other = n % 6 == 5;
      CutMove move;
      move.id = n;
      move.from_mm = at;
      const double kind = unit(random);
      const double turned = 2 * kPi * unit(random), length = 3 + 25 * unit(random);
      move.to_mm = at + Vec3(length * std::cos(turned), length * std::sin(turned), 0);
      move.to_mm.x = std::clamp(move.to_mm.x, -3.0, 43.0);
      move.to_mm.y = std::clamp(move.to_mm.y, -3.0, 33.0);
      if (kind > 0.8) move.to_mm.z = std::clamp(at.z + 2 * unit(random) - 1.2, -6.0, -0.3);
      if (kind < 0.3) {
        const double radius = 2 + 8 * unit(random);
        const double sense = unit(random) < 0.5 ? -1 : 1;
        const double sweep = sense * (0.5 + 5.5 * unit(random));
        const Vec2 arm = radius * Vec2(std::cos(turned), std::sin(turned));
        move.arc = CutArc{at - Vec3(arm, 0), {0, 0, 1}, sweep};
        move.to_mm = EngagementOracle::place(move, 1);
      }
      if (glm::length(Vec2(move.to_mm - at)) > 1 && !by_other) {
        for (int k = 0; k < 2; ++k) {
          const double part = 0.05 + 0.85 * unit(random);
          const std::optional<HeightGrid> heights = stock->present_heights();
          EngagementScan::Look asked;
          asked.at = part, asked.owners = stock.get(), asked.ways = &ways;
          const EngagementLook found = scan.look_ahead(*heights, cutter, move, asked);
          const EngagementTruth truth = oracle.look(cutter, move, part);
          off.add(found, truth);
          asked.is_brief = true;
          brief.add(scan.look_ahead(*heights, cutter, move, asked), truth);
        }
      }
      const Cutter& by = by_other ? other : cutter;
      std::vector<CutReport> reports;
      stock->cut(by, {&move, 1}, reports);
      stock->finish(reports);
      ways.mount(by);
      ways.add(move);
      oracle.add(by, move);
      at = move.to_mm;
      if (unit(random) < 0.25) at.z = -1 - 4 * unit(random);
    }
  }
  EXPECT_GT(off.looks, 33 * rounds);
  RecordProperty("errors", off.text());
  RecordProperty("errors_in_brief", brief.text());
  // At a rim all of them. Of what is not flat material may be thinner, beside a pass, than the
  // directions and radii of a look are apart: half of those that are off are so.
  const bool flat = cutter.height_mm(cutter.radius_mm() * (1 - 1e-9)) <= 0;
  // Cells alone know walls to half of one.
  EXPECT_GE(brief.within, (flat ? 1.0 : kIsSanitized ? 0.65 : 0.85) * brief.looks) << brief.text();
  EXPECT_GE(off.within, (flat ? 1.0 : kIsSanitized ? 0.8 : 0.9) * off.looks) << off.text();
}

/// Passes side by side, as surfaces and engravings have them, a cell and a third to five cells
/// apart: what is left between two of them is thin, and next to the tip. By looks in brief.
TEST(EngagementPasses, AreNarrowFronts) {
  for (const std::string shape : {"ball:6", "bull:6:2", "vee:6:90", "vee:3:60", "drill:6:118"}) {
    const Cutter cutter = parse_shape(shape).value();
    EngagementErrors brief;
    for (const double apart_mm : {0.13, 0.333, 0.5}) {
      ZMapOptions options;
      options.blank = parse_blank("box:0,0,-5:30,12,0").value();
      options.cell_mm = kOracleCell_mm;
      const std::unique_ptr<ZMap> stock = std::move(ZMap::create(options).value());
      stock->keep_cut_ids(true);
      EngagementOracle oracle(stock->bounds_mm());
      PastWays ways;
      ways.mount(cutter);
      EngagementScan scan;
      for (std::uint64_t n = 0; n < 8; ++n) {
        CutMove move;
        move.id = n;
        const double y = 5 + static_cast<double>(n) * apart_mm;
        move.from_mm = {n % 2 == 0 ? 3.0 : 27.0, y, -0.6};
        move.to_mm = {n % 2 == 0 ? 27.0 : 3.0, y, -0.6};
        for (const double part : {0.31, 0.503}) {
          EngagementScan::Look asked;
          asked.at = part, asked.owners = stock.get(), asked.ways = &ways, asked.is_brief = true;
          brief.add(scan.look_ahead(stock->present_heights().value(), cutter, move, asked),
                    oracle.look(cutter, move, part));
        }
        std::vector<CutReport> reports;
        stock->cut(cutter, {&move, 1}, reports);
        stock->finish(reports);
        ways.add(move);
        oracle.add(cutter, move);
      }
    }
    EXPECT_EQ(brief.looks, 48) << shape;
    EXPECT_GE(brief.within, 44) << shape << ' ' << brief.text();
  }
}

/// What random moves remove in cells of 0.1 mm, against cells of a fifth of that.
TEST(EngagementVolume, IsThatOfADenseGrid) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const std::string shape : {"flat:8", "ball:8", "bull:6:2", "vee:8:90"}) {
    const Cutter cutter = parse_shape(shape).value();
    std::vector<CutMove> moves;
    Vec3 at{40 * unit(random), 30 * unit(random), -2};
    for (std::uint64_t n = 0; n < 40; ++n) {
      CutMove move;
      move.id = n, move.from_mm = at;
      move.to_mm.x = 40 * unit(random);
      move.to_mm.y = 30 * unit(random);
      move.to_mm.z = -1 - 6 * unit(random);
      moves.push_back(move);
      at = move.to_mm;
    }
    double removed_mm3[2] = {0, 0};
    for (int n = 0; n < 2; ++n) {
      ZMapOptions options;
      options.blank = parse_blank("box:0,0,-10:40,30,0").value();
      options.cell_mm = n == 0 ? 0.1 : 0.02;
      const std::unique_ptr<ZMap> stock = std::move(ZMap::create(options).value());
      std::vector<CutReport> reports;
      stock->cut(cutter, moves, reports);
      stock->finish(reports);
      removed_mm3[n] = 40 * 30 * 10 - stock->remaining_mm3();
    }
    EXPECT_NEAR(removed_mm3[0] / removed_mm3[1], 1, 1e-4) << shape;
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, EngagementOracleTest,
                         testing::Values("flat:8", "flat:3", "ball:8", "ball:4", "bull:8:1",
                                         "bull:6:2", "vee:8:90", "taper:6:10:1", "drill:6:118"));

}  // namespace
}  // namespace kerf
