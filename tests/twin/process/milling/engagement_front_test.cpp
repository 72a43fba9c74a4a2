#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "tests/twin/process/milling/engagement_oracle.h"
#include "twin/process/engagement_log.h"
#include "twin/process/milling/engagement_meter.h"
#include "twin/process/milling/engagement_scan.h"

namespace kerf {
namespace {

constexpr double kFrontCell_mm = 0.1;
constexpr double kDegree = kPi / 180;

CutMove way(Vec3 from, Vec3 to) {
  CutMove move;
  move.from_mm = from, move.to_mm = to;
  return move;
}

/// A block 60 x 40 x 10 mm with its top at Z0.
class EngagementFrontTest : public testing::Test {
 protected:
  EngagementFrontTest() {
    ZMapOptions options;
    options.blank = parse_blank("box:0,0,-10:60,40,0").value();
    options.cell_mm = kFrontCell_mm;
    stock_ = std::move(ZMap::create(options).value());
    stock_->keep_cut_ids(true);
  }
  void cut(const std::string& shape, CutMove move) {
    move.id = next_id_++;
    const Cutter cutter = parse_shape(shape).value();
    ways_.mount(cutter);
    ways_.add(move);
    std::vector<CutReport> reports;
    stock_->cut(cutter, {&move, 1}, reports);
    stock_->finish(reports);
  }
  EngagementLook look(const std::string& shape, const CutMove& move, double at = 0.5,
                      const CutMove* held = nullptr, bool anticlockwise = false) {
    const std::optional<HeightGrid> heights = stock_->present_heights();
    return scan_.look_ahead(*heights, parse_shape(shape).value(), move,
                            {at, held, anticlockwise, stock_.get(), &ways_});
  }
  EngagementLook brief(const std::string& shape, const CutMove& move, double at = 0.5) {
    const std::optional<HeightGrid> heights = stock_->present_heights();
    return scan_.look_ahead(*heights, parse_shape(shape).value(), move,
                            {at, nullptr, false, stock_.get(), &ways_, true});
  }

  std::unique_ptr<ZMap> stock_;
  PastWays ways_;
  std::uint64_t next_id_ = 0;
  EngagementScan scan_;
};

TEST_F(EngagementFrontTest, ASlotIsHalfOfTheEdgeAndAllOfTheWidth) {
  for (const Vec2 ahead : {Vec2(1, 0), Vec2(0, 1), Vec2(-0.6, 0.8)}) {
    const Vec3 from(Vec2(30, 20) - 5.0 * ahead, -2), to(Vec2(30, 20) + 5.0 * ahead, -2);
    for (const std::string shape : {"flat:8", "bull:8:1"}) {
      const EngagementLook slot = look(shape, way(from, to));
      EXPECT_NEAR(slot.angle_rad, kPi, 2 * kDegree) << shape;
      EXPECT_NEAR(slot.wide_mm, 8, 0.05) << shape;
      EXPECT_NEAR(slot.deep_mm, 2, 1e-3) << shape;
    }
    // A ball of R4 in material 2 mm deep is sqrt(16 - 4) mm wide on either side.
    const EngagementLook ball = look("ball:8", way(from, to));
    EXPECT_NEAR(ball.angle_rad, kPi, 4 * kDegree);
    EXPECT_NEAR(ball.wide_mm, 2 * std::sqrt(12.0), 0.15);
    EXPECT_NEAR(ball.deep_mm, 2, 0.02);
    EXPECT_NEAR(look("vee:8:90", way(from, to)).wide_mm, 4, 0.15);
  }
}

/// By its cells alone: a slot, a slot deeper than the ball is high, the step beside a pass, and
/// nothing where it has been.
TEST_F(EngagementFrontTest, AGapBetweenTwoSpansIsNoWidth) {
  // A slot of 3 mm is there in the middle of the way: 2.5 mm are left on either side of it.
  cut("flat:3", way({0, 20, -2}, {60, 20, -2}));
  const CutMove along = way({20, 20, -2}, {40, 20, -2});
  const EngagementLook flat = look("flat:8", along);
  EXPECT_NEAR(flat.wide_mm, 5, 0.2);
  EXPECT_NEAR(flat.gaps_mm, 3, 0.2);
  EXPECT_NEAR(flat.angle_rad, kPi - 2 * std::asin(1.5 / 4), 2 * kDegree);
  // A ball of R4 is sqrt(12) mm wide on either side, 2 mm deep.
  for (const EngagementLook& ball : {look("ball:8", along), brief("ball:8", along)}) {
    EXPECT_NEAR(ball.wide_mm, 2 * std::sqrt(12.0) - 3, 0.35);
    EXPECT_NEAR(ball.gaps_mm, 3, 0.3);
  }
  EXPECT_EQ(look("flat:8", way({20, 30, -2}, {40, 30, -2})).gaps_mm, 0);
  EXPECT_EQ(look("ball:8", way({20, 30, -2}, {40, 30, -2})).gaps_mm, 0);
  EXPECT_EQ(brief("ball:8", way({20, 30, -2}, {40, 30, -2})).gaps_mm, 0);
  // Along its side it is one span.
  EXPECT_EQ(look("flat:8", way({20, 23, -2}, {40, 23, -2})).gaps_mm, 0);
}

TEST_F(EngagementFrontTest, InBriefABallIsWhereItsCellsAre) {
  for (const Vec2 ahead : {Vec2(1, 0), Vec2(0, 1), Vec2(-0.6, 0.8)}) {
    const Vec3 from(Vec2(30, 20) - 5.0 * ahead, -2), to(Vec2(30, 20) + 5.0 * ahead, -2);
    const EngagementLook slot = brief("ball:8", way(from, to));
    EXPECT_NEAR(slot.angle_rad, kPi, 4 * kDegree);
    EXPECT_NEAR(slot.wide_mm, 2 * std::sqrt(12.0), 0.15);
    EXPECT_NEAR(slot.effective_mm, 2 * std::sqrt(12.0), 0.15);
    EXPECT_NEAR(slot.deep_mm, 2, 0.02);
    EXPECT_NEAR(slot.climb, 0.5, 0.02);
    const EngagementLook deep = brief("ball:8", way(from + Vec3(0, 0, -4), to + Vec3(0, 0, -4)));
    EXPECT_NEAR(deep.angle_rad, kPi, 2 * kDegree);
    EXPECT_NEAR(deep.wide_mm, 8, 0.01);
    EXPECT_NEAR(deep.deep_mm, 6, 0.02);
  }
  cut("ball:8", way({-10, 20, -2}, {70, 20, -2}));
  EXPECT_FALSE(brief("ball:8", way({-10, 20, -2}, {70, 20, -2})).is_engaged());
  // The two circles meet in the middle, and the new one is out of the block sqrt(12) from its own.
  const EngagementLook step = brief("ball:8", way({-10, 22, -2}, {70, 22, -2}));
  EXPECT_NEAR(step.wide_mm, 1 + std::sqrt(12.0), 0.1);
  EXPECT_NEAR(step.deep_mm, look("ball:8", way({-10, 22, -2}, {70, 22, -2})).deep_mm, 0.1);
  EXPECT_GT(step.climb, 0.99 * (look("ball:8", way({-10, 22, -2}, {70, 22, -2})).climb));
  // Beside the block, and past its end, there is air.
  EXPECT_FALSE(brief("ball:8", way({0, -4.2, -2}, {60, -4.2, -2})).is_engaged());
  EXPECT_FALSE(brief("ball:8", way({55, 30, -2}, {75, 30, -2}), 0.9).is_engaged());
}

/// The angle of a side cut of width a with a diameter D is acos(1 - 2 a / D).
TEST_F(EngagementFrontTest, SideCutsByTheirWidth) {
  for (const double wide : {0.3, 1.0, 2.5, 4.0, 6.0, 7.5}) {
    // Along the side of the block, from outside; and the other way round.
    const double y = 40 + 4 - wide;
    for (const bool back : {false, true}) {
      const EngagementLook side =
          look("flat:8", back ? way({40, y, -3}, {20, y, -3}) : way({20, y, -3}, {40, y, -3}));
      const double expected = std::acos(1 - wide / 4);
      // To a cell of the width.
      const double cell = expected - std::acos(1 - (wide - kFrontCell_mm) / 4);
      EXPECT_NEAR(side.angle_rad, expected, cell + kDegree) << wide;
      EXPECT_NEAR(side.wide_mm, wide, kFrontCell_mm) << wide;
      EXPECT_NEAR(side.deep_mm, 3, 1e-3) << wide;
    }
  }
}

TEST_F(EngagementFrontTest, BesideAPassOnlyTheStepIsLeft) {
  cut("flat:8", way({-10, 20, -2}, {70, 20, -2}));
  const EngagementLook second = look("flat:8", way({-10, 23, -2}, {70, 23, -2}));
  EXPECT_NEAR(second.wide_mm, 3, kFrontCell_mm);
  EXPECT_NEAR(second.angle_rad, std::acos(1 - 3.0 / 4), 2 * kDegree);
  // The same pass again is in nothing, deeper it is a slot of what lies below.
  EXPECT_FALSE(look("flat:8", way({-10, 20, -2}, {70, 20, -2})).is_engaged());
  const EngagementLook deeper = look("flat:8", way({-10, 20, -5}, {70, 20, -5}));
  EXPECT_NEAR(deeper.angle_rad, kPi, 2 * kDegree);
  EXPECT_NEAR(deeper.deep_mm, 3, 1e-3);
  // Along its wall it touches, and cuts nothing.
  cut("flat:8", way({-10, 23, -2}, {70, 23, -2}));
  EXPECT_FALSE(look("flat:6", way({-10, 24, -2}, {70, 24, -2})).is_engaged());
}

TEST_F(EngagementFrontTest, ABallBesideItsPassIsInTheCrest) {
  cut("ball:8", way({-10, 20, -2}, {70, 20, -2}));
  const EngagementLook second = look("ball:8", way({-10, 21, -2}, {70, 21, -2}));
  // From the crest, half a step before its middle, to where the ball leaves the top.
  EXPECT_NEAR(second.wide_mm, std::sqrt(12.0) + 0.5, 0.3);
  // Spheres side by side meet at the radius r = 1 / (1 - sin a): half of sqrt(12) at 25 degrees.
  EXPECT_NEAR(second.angle_rad, kPi / 2 - std::asin(1 - 1 / std::sqrt(3.0)), 4 * kDegree);
  EXPECT_LT(second.deep_mm, 2);
}

TEST_F(EngagementFrontTest, AnArcInsideAndAroundABlock) {
  CutMove turn = way({40, 20, -2}, {40, 20, -2});
  turn.arc = CutArc{{30, 20, -2}, {0, 0, 1}, 2 * kPi};
  EXPECT_NEAR(look("flat:8", turn, 0.3).angle_rad, kPi, 2 * kDegree);
  cut("flat:8", turn);
  EXPECT_FALSE(look("flat:8", turn, 0.3).is_engaged());
  // 2 mm farther out: that much is left beside the wall.
  CutMove wider = way({42, 20, -2}, {42, 20, -2});
  wider.arc = CutArc{{30, 20, -2}, {0, 0, 1}, 2 * kPi};
  const EngagementLook wall = look("flat:8", wider, 0.4);
  // On an arc it meets the wall of radius 14 where |R e + 12| = 14.
  const double cosine = (14.0 * 14 - 12 * 12 - 16) / (2 * 12 * 4);
  EXPECT_NEAR(wall.angle_rad, std::acos(cosine), 3 * kDegree);
  EXPECT_NEAR(wall.deep_mm, 2, 1e-3);
}

/// phi from the normal of the way, as a tooth of M3 comes round: 0 on the left.
TEST_F(EngagementFrontTest, WhereAToothMeetsAndLeavesMaterial) {
  for (const Vec2 ahead : {Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0.6, 0.8)}) {
    const CutMove slot =
        way(Vec3(Vec2(30, 20) - 5.0 * ahead, -2), Vec3(Vec2(30, 20) + 5.0 * ahead, -2));
    const EngagementLook full = look("flat:8", slot);
    EXPECT_NEAR(full.entry_rad, 0, kDegree);
    EXPECT_NEAR(full.exit_rad, kPi, kDegree);
    EXPECT_NEAR(full.climb, 0.5, 0.01);
    EXPECT_NEAR(full.effective_mm, 8, 1e-6);
    EXPECT_NEAR(full.contact_mm, 2, 1e-3);
    EXPECT_FALSE(full.cuts_centre);
  }
  // Along the upper side of the block, Y40, 2 mm of the tool in it. Toward -X the block is on the
  // left: from 0 to acos(1 - 2 / 4) = 60 degrees, conventional. Toward +X it is on the right.
  const double wide = std::acos(1 - 2.0 / 4);
  const CutMove left = way({40, 42, -3}, {20, 42, -3}), right = way({20, 42, -3}, {40, 42, -3});
  const EngagementLook up = look("flat:8", left), down = look("flat:8", right);
  EXPECT_NEAR(up.entry_rad, 0, kDegree);
  EXPECT_NEAR(up.exit_rad, wide, 2 * kDegree);
  EXPECT_EQ(up.climb, 0);
  EXPECT_NEAR(down.entry_rad, kPi - wide, 2 * kDegree);
  EXPECT_NEAR(down.exit_rad, kPi, kDegree);
  EXPECT_EQ(down.climb, 1);
  // M4 turns the other way round.
  const EngagementLook turned = look("flat:8", left, 0.5, nullptr, true);
  EXPECT_NEAR(turned.entry_rad, kPi - wide, 2 * kDegree);
  EXPECT_NEAR(turned.exit_rad, kPi, kDegree);
  EXPECT_EQ(turned.climb, 1);
  // 6 of 8 mm: past straight ahead, 90 of 120 degrees beyond it.
  const EngagementLook most = look("flat:8", way({20, 38, -3}, {40, 38, -3}));
  EXPECT_NEAR(most.entry_rad, kPi / 3, 2 * kDegree);
  EXPECT_NEAR(most.exit_rad, kPi, kDegree);
  EXPECT_NEAR(most.climb, 0.75, 0.02);
}

TEST_F(EngagementFrontTest, TheEdgeInMaterialAndItsWidestDiameter) {
  const CutMove slot = way({20, 20, -2}, {40, 20, -2});
  // A ball of R4 2 mm deep: out to sqrt(12), acos(1 - 2 / 4) of its arc.
  const EngagementLook ball = look("ball:8", slot);
  EXPECT_NEAR(ball.effective_mm, 2 * std::sqrt(12.0), 0.1);
  EXPECT_NEAR(ball.contact_mm, 4 * std::acos(0.5), 0.06);
  // Deeper than its half: a quarter of a circle, and what is above it.
  const EngagementLook deep = look("ball:8", way({20, 20, -6}, {40, 20, -6}));
  EXPECT_NEAR(deep.effective_mm, 8, 1e-6);
  EXPECT_NEAR(deep.contact_mm, 4 * kPi / 2 + 2, 0.02);
  const EngagementLook bull = look("bull:8:1", way({20, 20, -3}, {40, 20, -3}));
  EXPECT_NEAR(bull.contact_mm, kPi / 2 + 2, 0.02);
  const EngagementLook vee = look("vee:8:90", slot);
  EXPECT_NEAR(vee.contact_mm, 2 * std::sqrt(2.0), 0.06);
  EXPECT_NEAR(vee.effective_mm, 4, 0.1);
}

TEST_F(EngagementFrontTest, StraightDownAndDownASlope) {
  const EngagementLook down = look("flat:6", way({30, 20, 2}, {30, 20, -3}), 1);
  EXPECT_TRUE(down.is_plunge);
  EXPECT_NEAR(down.deep_mm, 3, 1e-3);
  EXPECT_NEAR(down.wide_mm, 6, 0.3);
  EXPECT_TRUE(down.cuts_centre);
  EXPECT_EQ(down.entry_rad, 0);
  EXPECT_NEAR(down.exit_rad, 2 * kPi, 1e-12);
  EXPECT_FALSE(look("flat:6", way({30, 20, -3}, {30, 20, 2}), 1).is_engaged());
  EXPECT_FALSE(look("flat:6", way({30, 20, 5}, {30, 20, 1}), 1).is_engaged());
  const EngagementLook slope = look("flat:6", way({20, 20, 0}, {40, 20, -2}), 0.5);
  EXPECT_NEAR(slope.angle_rad, kPi, 2 * kDegree);
  EXPECT_NEAR(slope.deep_mm, 1, 0.02);
  EXPECT_TRUE(slope.cuts_centre);
  EXPECT_FALSE(look("flat:6", way({40, 20, -2}, {20, 20, 0}), 0.5).cuts_centre);
  // Over its own slot it goes down beside nothing.
  cut("flat:6", way({15, 20, -2}, {45, 20, -2}));
  EXPECT_FALSE(look("flat:6", way({20, 20, 0}, {40, 20, -2}), 0.5).cuts_centre);
}

/// A wall that was cut before stands where those moves have left it, not where cells do: at 24.03
/// of cells of 0.1 mm the outermost of the tool is in a cell that is as high as the block.
TEST_F(EngagementFrontTest, ALayerIsAsDeepAsItIsBesideItsWall) {
  for (const std::string shape : {"flat:8", "bull:8:1"}) {
    for (const double z : {-2.0, -4.0}) cut(shape, way({-10, 20.03, z}, {70, 20.03, z}));
    const EngagementLook third = look(shape, way({-10, 20.03, -6}, {70, 20.03, -6}));
    EXPECT_NEAR(third.deep_mm, 2, 0.01) << shape;
    EXPECT_NEAR(third.angle_rad, kPi, 2 * kDegree) << shape;
    // Rounding of the program's numbers is no wall, either.
    EXPECT_NEAR(look(shape, way({-10, 20.031, -6}, {70, 20.031, -6})).deep_mm, 2, 0.01) << shape;
  }
  // Round a corner, along an arc, on the other side of the way, down a slope.
  const auto arc = [](double z) {
    CutMove turn = way({40.03, 12, z}, {40.03, 12, z});
    turn.arc = CutArc{{30, 12, z}, {0, 0, 1}, 2 * kPi};
    return turn;
  };
  for (const double z : {-7.0, -8.0}) cut("flat:8", arc(z));
  EXPECT_NEAR(look("flat:8", arc(-9), 0.3).deep_mm, 1, 0.01);
  cut("flat:8", way({-10, 20.03, -6}, {70, 20.03, -6}));
  EXPECT_NEAR(look("flat:8", way({5, 20.03, -6}, {25, 20.03, -8})).deep_mm, 1, 0.05);
}

/// What is really there at a wall is a deep cut, however thin.
TEST_F(EngagementFrontTest, AThinDeepCutAlongAWallIsDeep) {
  for (const double z : {-2.0, -4.0, -6.0}) cut("flat:8", way({-10, 20.03, z}, {70, 20.03, z}));
  for (const double thick : {0.2, 0.05, 0.02, 0.01}) {
    const EngagementLook finish =
        look("flat:8", way({-10, 20.03 + thick, -6}, {70, 20.03 + thick, -6}));
    EXPECT_NEAR(finish.deep_mm, 6, 0.01) << thick;
    EXPECT_NEAR(finish.wide_mm, thick, 0.01 + 0.1 * thick) << thick;
  }
  // The upper layer was 0.5 mm wider: there only 4 mm are left.
  cut("flat:8", way({-10, 20.53, -2}, {70, 20.53, -2}));
  EXPECT_NEAR(look("flat:8", way({-10, 20.33, -6}, {70, 20.33, -6})).deep_mm, 4, 0.01);
  EXPECT_NEAR(look("flat:8", way({-10, 20.58, -6}, {70, 20.58, -6})).deep_mm, 6, 0.01);
}

TEST_F(EngagementFrontTest, AMoveThatIsHeldBackCountsAsCut) {
  const CutMove held = way({10, 20, -2}, {40, 20, -2});
  EXPECT_FALSE(look("flat:8", way({40, 20, -2}, {10, 20, -2}), 0.5, &held).is_engaged());
  EXPECT_TRUE(look("flat:8", way({40, 20, -2}, {10, 20, -2}), 0.5).is_engaged());
}

/// Slopes at random: each point of the rim is asked for, one by one, without rays and halvings.
TEST_F(EngagementFrontTest, IsWhatManyPointsOfTheRimSay) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  constexpr int kRounds = 60;
  double sum_of_off = 0;
  const Cutter slotter = parse_shape("flat:5").value();
  EngagementOracle oracle(stock_->bounds_mm());
  for (int round = 0; round < kRounds; ++round) {
    if (round % 20 == 0) {
      for (int k = 0; k < 4; ++k) {
        const Vec3 from{60 * unit(random), 40 * unit(random), -1 - 3 * unit(random)};
        const Vec3 to{60 * unit(random), 40 * unit(random), -4};
        cut("flat:5", way(from, to));
        oracle.add(slotter, way(from, to));
      }
    }
    const double turned = 2 * kPi * unit(random), z = -1 - 4 * unit(random);
    const Vec2 ahead(std::cos(turned), std::sin(turned));
    const Vec2 at{10 + 40 * unit(random), 10 + 20 * unit(random)};
    const double radius = 1.5 + 2 * unit(random);
    const std::string shape = "flat:" + std::to_string(2 * radius);
    const CutMove move = way(Vec3(at - ahead, z), Vec3(at + ahead, z));
    const EngagementTruth truth = oracle.look(parse_shape(shape).value(), move, 0.5, 1000);
    // What lies between two rays and is less than 10 degrees may be missed, or taken for more.
    const double off = std::abs(look(shape, move).angle_rad - truth.arc);
    EXPECT_LT(off, 15 * kDegree) << round;
    sum_of_off += off;
  }
  EXPECT_LT(sum_of_off / kRounds, 1 * kDegree);
}

/// Along moves, by the meter: what is cut, in passes.
class EngagementMeterTest : public EngagementFrontTest {
 protected:
  void run(const std::string& shape, std::vector<CutMove> moves, int lift_before = -1) {
    const Cutter cutter = parse_shape(shape).value();
    meter_.mount(4, cutter);
    std::vector<CutReport> reports;
    for (std::size_t n = 0; n < moves.size(); ++n) {
      if (static_cast<int>(n) == lift_before) meter_.lift();
      const EngagementMeter::Taken taken = meter_.take(
          {cutter, moves[n], true, false, {0, static_cast<std::uint32_t>(n + 1)}, 0, 1});
      moves[n].id = next_id_++;
      meter_.note(moves[n]);
      meter_.note_cut(moves[n]);
      const double before = stock_->remaining_mm3();
      stock_->cut(cutter, {&moves[n], 1}, reports);
      stock_->finish(reports);
      log_.add_removed(taken.pass, before - stock_->remaining_mm3(), taken.sums.in_material_mm(),
                       taken.sums.cut_s);
    }
  }
  EngagementLog log_{true};
  EngagementMeter meter_{*stock_, log_, [] {}};
};

TEST_F(EngagementMeterTest, OneSlotIsOnePass) {
  run("flat:8", {way({-10, 20, -2}, {70, 20, -2})});
  const Engagement found = log_.result();
  ASSERT_EQ(found.passes.size(), 1u);
  const EngagementSums& sums = found.passes[0].sums;
  // From where its edge comes to the block until its middle leaves it; in all of its width until
  // its edge does.
  EXPECT_NEAR(sums.cut_mm, 64, 0.6);
  EXPECT_NEAR(sums.full_mm, 56, 2);
  EXPECT_NEAR(sums.wide_most_mm, 8, 0.05);
  EXPECT_NEAR(sums.mean(sums.deep_sum_mm2), 2, 0.01);
  EXPECT_NEAR(sums.removed_mm3, 60 * 8 * 2, 2);
  ASSERT_TRUE(found.map.has_value());
  const EngagementMap& map = *found.map;
  const double cell = 60.0 / map.nx;
  for (const double x : {10.0, 30.0, 50.0})
    for (const double y : {17.0, 20.0, 23.5})
      EXPECT_NEAR(
          map.angle_rad[static_cast<std::size_t>(y / cell) * static_cast<std::size_t>(map.nx) +
                        static_cast<std::size_t>(x / cell)],
          kPi, 3 * kDegree);
  EXPECT_EQ(map.angle_rad[static_cast<std::size_t>(10 / cell) * static_cast<std::size_t>(map.nx)],
            0);
}

TEST_F(EngagementMeterTest, TheWallAtAWaysEndIsNotCut) {
  cut("flat:8", way({-10, 20, -2}, {40, 20, -2}));
  run("flat:8", {way({-10, 20, -4}, {40, 20, -4})});
  // 2 mm on the floor of the first; not the 4 mm that stand at its end.
  EXPECT_NEAR(log_.result().passes.at(0).sums.deep_most_mm, 2, 1e-3);
}

TEST_F(EngagementMeterTest, WhatIsCutLastHasThePlace) {
  run("flat:8",
      {way({-10, 20, -2}, {70, 20, -2}), way({70, 20, 5}, {-10, 22, 5}),
       way({-10, 22, -2}, {70, 22, -2})},
      2);
  const Engagement found = log_.result();
  ASSERT_EQ(found.passes.size(), 2u);
  EXPECT_NEAR(found.passes[1].sums.mean(found.passes[1].sums.wide_sum_mm2), 2, 0.15);
  EXPECT_EQ(found.passes[1].sums.full_mm, 0);
  const EngagementMap& map = *found.map;
  const double cell = 60.0 / map.nx;
  const auto at = [&](double x, double y) {
    return map.angle_rad[static_cast<std::size_t>(y / cell) * static_cast<std::size_t>(map.nx) +
                         static_cast<std::size_t>(x / cell)];
  };
  EXPECT_NEAR(at(30, 20), kPi, 3 * kDegree);
  EXPECT_NEAR(at(30, 25), std::acos(1 - 2.0 / 4), 3 * kDegree);
  // All is as if it had been one tool.
  ASSERT_EQ(found.tools.size(), 1u);
  EXPECT_EQ(found.tools[0].passes, 2u);
  EXPECT_NEAR(found.tools[0].sums.removed_mm3, 60 * 10 * 2, 3);
}

TEST_F(EngagementMeterTest, ShortMovesAreAsGoodAsALongOne) {
  std::vector<CutMove> moves;
  for (int n = 0; n < 400; ++n)
    moves.push_back(way({-10 + 0.2 * n, 38, -2}, {-10 + 0.2 * (n + 1), 38, -2}));
  run("flat:8", moves);
  const Engagement found = log_.result();
  ASSERT_EQ(found.passes.size(), 1u);
  const EngagementSums& sums = found.passes[0].sums;
  EXPECT_NEAR(sums.cut_mm, 61, 5);
  EXPECT_NEAR(sums.wide_most_mm, 6, 0.1);
  EXPECT_NEAR(sums.angle_most_rad, kPi - std::acos(0.5), 2 * kDegree);
}

/// A slot 1 mm deep through 60 mm: half of the edge, but for where it comes in and goes out, half
/// of its width there each.
class ShortMovesOfRoundTools : public EngagementMeterTest,
                               public testing::WithParamInterface<std::tuple<const char*, double>> {
};
TEST_P(ShortMovesOfRoundTools, AreInASlotAsALongOneIs) {
  const auto [shape, step] = GetParam();
  const double half = shape[1] == 'a' ? std::sqrt(9.0 - 4.0) : 3.0;
  std::vector<CutMove> moves;
  for (int n = 0; n * step < 70; ++n)
    moves.push_back(way({-5 + step * n, 20, -1}, {-5 + step * (n + 1), 20, -1}));
  run(shape, moves);
  const Engagement found = log_.result();
  ASSERT_EQ(found.passes.size(), 1u);
  const EngagementSums& sums = found.passes[0].sums;
  const double mean = sums.mean(sums.angle_sum) / kDegree;
  EXPECT_NEAR(mean, 180 * (60 - half) / 60, step < 0.1 ? 18 : 9);
  EXPECT_GT(sums.angle_most_rad, (step < 0.1 ? 162 : 174) * kDegree);
  EXPECT_NEAR(sums.deep_most_mm, 1, 0.01);
  EXPECT_NEAR(sums.wide_most_mm, 2 * half, 0.1 * half);
}
INSTANTIATE_TEST_SUITE_P(Steps, ShortMovesOfRoundTools,
                         testing::Combine(testing::Values("ball:6", "bull:6:1"),
                                          testing::Values(2.0, 1.0, 0.25, 0.05)));

TEST_F(EngagementMeterTest, AirLongerThanTheToolEndsAPass) {
  // Two islands 5 and 20 mm apart from each other.
  cut("flat:5", way({20, -5, -6}, {20, 45, -6}));
  for (const double x : {35.0, 39.0, 43.0, 47.0, 50.0})
    cut("flat:5", way({x, -5, -6}, {x, 45, -6}));
  run("flat:8", {way({-10, 20, -2}, {70, 20, -2})});
  EXPECT_EQ(log_.result().passes.size(), 2u);
}

TEST_F(EngagementMeterTest, WhatIsNotMeasuredIsTold) {
  const Cutter cutter = parse_shape("tslot:10:3:4").value();
  const CutMove move = way({-10, 20, -5}, {70, 20, -5});
  meter_.mount(4, cutter);
  const EngagementMeter::Taken& taken = meter_.take({cutter, move, true, false, {0, 1}, 0, 1});
  EXPECT_EQ(taken.pass, EngagementLog::kNoPass);
  EXPECT_FALSE(taken.measured);
  const Engagement found = log_.result();
  EXPECT_TRUE(found.passes.empty());
  EXPECT_NEAR(found.unmeasured_mm, 80, 1e-9);
}

/// A ball that goes down beside a wall: only from 70 degrees to the left on there is material, from
/// 1.3 mm off its middle to its rim at 3 mm. As wide as from there, 1.3 * sin(70) = 1.22 mm, to 3.
/// Of a flat tool nothing is known but its rim: from 3 * sin(70) = 2.82 mm.
TEST(FrontRaysTest, WhatIsInMaterialFartherInIsAsWide) {
  const auto contact_at = [](double angle) {
    FrontContact contact;
    if (angle < 70 * kPi / 180) return contact;
    contact.radius_mm = 3, contact.inner_mm = 1.3, contact.high_mm = 1, contact.deep_mm = 1;
    return contact;
  };
  for (const bool is_flat : {false, true}) {
    FrontRays rays(18, 3, is_flat);
    rays.sweep(contact_at);
    const double from_mm = (is_flat ? 3 : 1.3) * std::sin(70 * kPi / 180);
    EXPECT_NEAR(rays.look(false).wide_mm, 3 - from_mm, 0.02) << is_flat;
  }
}

}  // namespace
}  // namespace kerf
