// Shank and holder against columns: closed forms, and an oracle that steps along the way and keeps
// each column as the cutter leaves it.
#include "stock/zmap/part_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"

namespace kerf {
namespace {

constexpr double kTolerance_mm = 0.01;
constexpr int kSteps = 20000;

std::unique_ptr<ZMap> block(double cell_mm) {
  ZMapOptions options;
  options.blank = *parse_blank("box:0,0,-20:30,30,0");
  options.cell_mm = cell_mm;
  return std::move(*ZMap::create(options));
}

CutMove line(const Vec3& from, const Vec3& to) {
  CutMove move;
  move.from_mm = from;
  move.to_mm = to;
  return move;
}

Vec3 tip_at(const CutMove& move, double t) {
  Vec3 tip = move.from_mm + t * (move.to_mm - move.from_mm);
  if (!move.arc) return tip;
  const double dx = move.from_mm.x - move.arc->center_mm.x;
  const double dy = move.from_mm.y - move.arc->center_mm.y;
  const double angle = t * move.arc->sweep_rad * move.arc->axis.z;
  tip.x = move.arc->center_mm.x + dx * std::cos(angle) - dy * std::sin(angle);
  tip.y = move.arc->center_mm.y + dx * std::sin(angle) + dy * std::cos(angle);
  return tip;
}

struct Stepped {
  double t = 2;
  double depth_mm = 0;
};

Stepped step_along(const ZMap& stock, const Cutter& cutter, const CarriedPart& part,
                   const CutMove& move) {
  const int n = stock.nx();
  const double cell = 30.0 / n;
  std::vector<double> high;
  for (const float z : stock.heights_mm()) high.push_back(static_cast<double>(z));
  const double flutes = cutter.flute_length_mm().value_or(1e9);
  std::vector<bool> stays(high.size(), false);
  Stepped found;
  for (int step = 0; step <= kSteps; ++step) {
    const double t = static_cast<double>(step) / kSteps;
    const Vec3 tip = tip_at(move, t);
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(j * n + i);
        const double d = std::hypot((i + 0.5) * cell - tip.x, (j + 0.5) * cell - tip.y);
        if (high[k] <= tip.z || high[k] <= -20) continue;
        if (d <= cutter.radius_mm() && !stays[k]) {
          if (high[k] > tip.z + flutes + kTolerance_mm)
            stays[k] = true;
          else
            high[k] = std::min(high[k], tip.z + cutter.height_mm(d));
        }
        const double depth = high[k] - tip.z - part.from_z_mm;
        if (d > part.radius_mm - kTolerance_mm || depth <= kTolerance_mm) continue;
        found.t = std::min(found.t, t);
        found.depth_mm = std::max(found.depth_mm, depth);
      }
    }
  }
  return found;
}

TEST(PartContact, TellsADeepPlungeToTheHundredth) {
  const auto stock = block(0.1);
  const Cutter cutter = *parse_shape("flat:6:flute=12");
  const auto met =
      stock->part_contact(cutter, {16, 12}, line({15, 15, 2}, {15, 15, -13}), kTolerance_mm);
  ASSERT_TRUE(met);
  EXPECT_NEAR(met->tip_mm.z, -12, 1e-4);
  EXPECT_NEAR(met->t, 14.0 / 15, 1e-5);
  EXPECT_NEAR(met->depth_mm, 1, 1e-4);
  EXPECT_FALSE(
      stock->part_contact(cutter, {16, 12}, line({15, 15, 2}, {15, 15, -11.99}), kTolerance_mm));
  // A shank no wider than the cutter is in the hole that is cut.
  EXPECT_FALSE(
      stock->part_contact(cutter, {3, 12}, line({15, 15, 2}, {15, 15, -18}), kTolerance_mm));
}

TEST(PartContact, WhereNothingIsNothingIsTouchedBelowTheFloor) {
  // A quarter of an inch: as a float it is higher than as a double.
  ZMapOptions options;
  options.blank = *parse_blank("cylinder:15,15,-6.35:0:30");
  options.cell_mm = 0.1;
  const auto stock = std::move(*ZMap::create(options));
  ASSERT_GT(static_cast<double>(-6.35f), -6.35);
  const Cutter cutter = *parse_shape("flat:2:flute=5");
  // In the corner beside the round, its middle 21.2 mm from that of the blank.
  const CutMove beside = line({-1, 0, -20}, {0, -1, -20});
  EXPECT_FALSE(stock->part_contact(cutter, {4, 5}, beside, kTolerance_mm));
  EXPECT_FALSE(stock->first_contact(cutter, beside, kTolerance_mm));
  EXPECT_TRUE(stock->part_contact(cutter, {7.5, 5}, beside, kTolerance_mm));
}

TEST(PartContact, TellsWhatStandsAboveTheFlutes) {
  const auto stock = block(0.1);
  const Cutter cutter = *parse_shape("flat:6:flute=8:shank=6");
  const auto met =
      stock->part_contact(cutter, {3, 8}, line({-10, 15, -10}, {40, 15, -10}), kTolerance_mm);
  ASSERT_TRUE(met);
  EXPECT_NEAR(met->tip_mm.x, 0.05 - 3, 0.08);
  EXPECT_NEAR(met->depth_mm, 2, 1e-4);
  EXPECT_FALSE(
      stock->part_contact(cutter, {3, 8}, line({-10, 15, -8}, {40, 15, -8}), kTolerance_mm));
}

TEST(PartContact, SpareIsABoundThatFollowsTheCut) {
  const auto stock = block(0.1);
  const CarriedPart part{10, 12};
  const auto spare = [&](double tip_z_mm) {
    const Vec3 tip{15, 15, tip_z_mm};
    return stock->part_spare_mm(part, line(tip, tip), 1, 5);
  };
  EXPECT_EQ(spare(2), 5);
  EXPECT_NEAR(spare(-8), 4, 1e-9);
  EXPECT_NEAR(spare(-11.5), 0.5, 1e-9);
  EXPECT_EQ(spare(-13), 0);
  std::vector<CutReport> reports;
  stock->cut(*parse_shape("flat:80"), std::vector{line({15, 15, 5}, {15, 15, -4})}, reports);
  stock->finish(reports);
  EXPECT_NEAR(spare(-13), 3, 1e-6);
  EXPECT_EQ(stock->part_spare_mm(part, line({60, 15, -15}, {50, 15, -15}), 1, 5), 5);
}

TEST(PartContact, TheGapIsTheDistanceToWhatIsLeft) {
  const auto stock = block(0.1);
  const Cutter cutter = *parse_shape("flat:6:flute=12");
  const CarriedPart part{10, 12};
  // Above the top, beside the block, and over its edge.
  const auto above = stock->part_gap(cutter, part, line({15, 15, 2}, {15, 15, -11.7}), 1);
  ASSERT_TRUE(above);
  EXPECT_NEAR(above->mm, 0.3, 1e-4);
  EXPECT_NEAR(above->t, 1, 1e-4);
  EXPECT_FALSE(stock->part_gap(cutter, part, line({15, 15, 2}, {15, 15, -10.9}), 1));
  const auto beside = stock->part_gap(cutter, part, line({-10.5, 0, -20}, {-10.5, 30, -20}), 1);
  ASSERT_TRUE(beside);
  EXPECT_NEAR(beside->mm, 0.5, 0.06);
  const auto over = stock->part_gap(cutter, part, line({-10.3, 15, -11.6}, {-40, 15, 0}), 1);
  ASSERT_TRUE(over);
  EXPECT_NEAR(over->mm, 0.5, 0.06);
  EXPECT_NEAR(over->t, 0, 1e-3);
  // The cutter, wide enough, takes away what the part would come near to.
  const Cutter wide = *parse_shape("flat:24:flute=12");
  EXPECT_FALSE(stock->part_gap(wide, part, line({15, 15, 2}, {15, 15, -11.7}), 1));
  EXPECT_TRUE(stock->part_gap(wide, {12.5, 12}, line({15, 15, 2}, {15, 15, -11.7}), 1));
}

TEST(PartContact, AgreesWithSteppingAlongTheWay) {
  std::mt19937 random(20);
  const auto between = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  int touching = 0, clear = 0, unlike = 0;
  for (int round = 0; round < 120; ++round) {
    const auto stock = block(1.5);
    std::vector<CutReport> reports;
    std::vector<CutMove> before;
    for (int i = 0; i < 3; ++i) {
      const double z = between(-15, -1);
      const Vec3 from{between(0, 30), between(0, 30), z}, to{between(0, 30), between(0, 30), z};
      before.push_back(line(from, to));
    }
    stock->cut(*parse_shape("flat:7"), before, reports);
    stock->finish(reports);

    const double radius = between(1.5, 5), flutes = between(3, 14);
    const Cutter cutter =
        *parse_shape("flat:" + std::to_string(2 * radius) + ":flute=" + std::to_string(flutes));
    const CarriedPart part{between(1, 12), *cutter.flute_length_mm() + between(0, 10)};
    const Vec3 begin{between(-5, 35), between(-5, 35), between(-13, 3)};
    const Vec3 end{between(-5, 35), between(-5, 35), between(-13, 3)};
    CutMove move = line(begin, end);
    if (round % 3 == 0) move.to_mm.z = move.from_mm.z;
    if (round % 5 == 0) move.to_mm = {move.from_mm.x, move.from_mm.y, between(-19, 0)};
    if (round % 4 == 3) {
      CutArc arc;
      arc.center_mm = {between(8, 22), between(8, 22), 0};
      arc.axis = {0, 0, round % 8 == 3 ? 1.0 : -1.0};
      arc.sweep_rad = between(0.3, 20);
      move.arc = arc;
      const double z = move.to_mm.z;
      move.to_mm = tip_at(move, 1);
      move.to_mm.z = z;
    }
    const Stepped want = step_along(*stock, cutter, part, move);
    const auto met = stock->part_contact(cutter, part, move, kTolerance_mm);
    // What only touches is told or not, as rounding has it.
    const bool grazes = want.depth_mm > 0 || met;
    if (grazes && std::max(want.depth_mm, met ? met->depth_mm : 0) < kTolerance_mm + 0.02) continue;
    ASSERT_EQ(met.has_value(), want.t <= 1) << "round " << round;
    (met ? touching : clear) += 1;
    if (!met) continue;
    EXPECT_NEAR(met->t, want.t, 0.012) << "round " << round;
    // Beside the cutter's rim it may be one cell that is cut by the steps and not by the way.
    unlike += std::abs(met->depth_mm - want.depth_mm) > 0.03;
    EXPECT_NEAR(met->depth_mm, want.depth_mm, 0.3) << "round " << round;
  }
  EXPECT_LE(unlike, 1);
  EXPECT_GT(touching, 15);
  EXPECT_GT(clear, 8);
}

}  // namespace
}  // namespace kerf
