// A lathe's program in the player: to and fro, the workpiece is that of a dry run.
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <utility>
#include <vector>

#include "stock/cutter/insert_shape.h"
#include "stock/cutter/shape_spec.h"
#include "stock/turning/turning_stock.h"
#include "tests/twin/playback/tracks.h"
#include "twin/process/process_table.h"

namespace kerf {
namespace {

constexpr std::chrono::seconds kLong{60};

std::unique_ptr<StockModel> bar_40() {
  return std::make_unique<TurningStock>(*TurnedPart::create(bar_profile(-60, 0, 40)));
}

/// A nose of 0.4 mm, whose cutting edge comes from +z and leaves towards +x.
Cutter nose() {
  NoseInsert insert;
  insert.radius_mm = 0.4;
  insert.orientation = 2;
  insert.front_rad = 85 * kPi / 180;
  insert.back_rad = 5 * kPi / 180;
  return Cutter::from_insert("turn:0.4:2:85:5", *nose_insert(insert));
}

/// Passes along the bar, grooves, arcs in the plane of the lathe.
std::vector<Motion> roughing(unsigned seed, int passes) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> length(-50, -5), radius(4, 20);
  MotionList program;
  program.at({25, 0, 5}).tool(1).spindle(true);
  for (int i = 0; i < passes; ++i) {
    const double x = radius(random), z = length(random);
    program.traverse({x, 0, 2}).feed({x, 0, z});
    if (i % 3 == 0) {
      program.arc({x + 2, 0, z - 2}, {x + 2, 0, z}, {0, 1, 0}, -kPi / 2);
    } else {
      program.feed({x + 3, 0, z - 1});
    }
    program.feed({22, 0, z - 1}).traverse({25, 0, 2});
  }
  return program.list();
}

PlayerProgram program_of(const std::vector<Motion>& motions, const Cutter& cutter = nose()) {
  PlayerProgram program;
  program.track = test::track_of(motions);
  program.blank = bar_40();
  program.tools.arguments.push_back({1, cutter});
  program.tools.turning = true;
  ProcessWish wish;
  wish.is_turned = true;
  program.process = choose_process(wish);
  return program;
}

std::string digest_after(const std::vector<Motion>& motions, std::size_t count) {
  TurningStock stock(*TurnedPart::create(bar_profile(-60, 0, 40)));
  const auto track = test::track_of(motions);
  const Cutter cutter = nose();
  std::vector<CutReport> reports;
  std::vector<CutMove> moves;
  for (std::size_t i = 0; i < count; ++i) {
    const MotionKind kind = track->motion(i).kind;
    if (kind != MotionKind::kTraverse && kind != MotionKind::kFeed && kind != MotionKind::kArc)
      continue;
    track->append_moves(i, MotionMoves(), cutter, moves);
  }
  stock.cut(cutter, moves, reports);
  return stock.digest();
}

/// Any order of seeks, with little memory for keyframes and with much.
TEST(TurnedPlayer, AnyOrderOfSeeksGivesTheSameWorkpiece) {
  const std::vector<Motion> motions = roughing(3, 400);
  const std::size_t count = test::track_of(motions)->size();
  const std::array<std::size_t, 7> places{0,         7,    count / 5, count / 2, 2 * count / 3,
                                          count - 9, count};
  std::vector<std::string> wanted;
  for (const std::size_t place : places) wanted.push_back(digest_after(motions, place));
  EXPECT_NE(wanted[3], wanted[6]);
  for (const std::size_t keyframe_bytes : {std::size_t{0}, std::size_t{1} << 24}) {
    PlayerOptions options;
    options.keyframe_bytes = keyframe_bytes;
    Player player(program_of(motions), options);
    std::mt19937 random(11);
    for (int i = 0; i < 40; ++i) {
      const std::size_t n = random() % places.size();
      ASSERT_TRUE(player.wait(player.seek_motion(places[n]), kLong));
      EXPECT_EQ(player.state()->stock->digest(), wanted[n]) << "place " << places[n];
    }
  }
}

/// G84: to its R, in with overrides off, out with the spindle reversed, all in one block.
TEST(TurnedPlayer, ATapInAFloatingChuckLeavesItsThreadWhereverItIsSought) {
  MotionList program;
  program.at({0, 0, 5}).tool(1).spindle(true);
  program.traverse({0, 0, 2}).feed({0, 0, -10}).feed({0, 0, 2}).traverse({0, 0, 5});
  std::vector<Motion> motions = program.list();
  Motion& out = motions[motions.size() - 2];
  Motion& in = motions[motions.size() - 3];
  for (std::size_t i = motions.size() - 4; i + 1 < motions.size(); ++i) {
    motions[i].source.line = 7;
    motions[i].spindle_rpm = 400;
  }
  in.feed_mm_per_min = out.feed_mm_per_min = 500;
  in.chain_end = ChainEnd::kEnds;
  in.spindle = SpindleState::kClockwise;
  out.spindle = SpindleState::kCounterclockwise;
  PlayerOptions options;
  options.keyframe_bytes = 0;
  Player player(program_of(motions, parse_shape("flat:8").value()), options);
  const auto at = [&](std::size_t motion) {
    EXPECT_TRUE(player.wait(player.seek_motion(motion), kLong));
    const auto stock = player.state()->stock;
    return std::pair(stock->digest(), stock->turned()->part().threads().passes().size());
  };
  const std::size_t count = motions.size();
  const auto tapped = at(count);
  EXPECT_EQ(tapped.second, 1U);
  EXPECT_EQ(at(count - 3).second, 0U);
  EXPECT_EQ(at(count - 2), tapped);
  EXPECT_EQ(at(count), tapped);
}

TEST(TurnedPlayer, ASnapshotStaysAsItWas) {
  const std::vector<Motion> motions = roughing(4, 60);
  Player player(program_of(motions), {});
  ASSERT_TRUE(player.wait(player.seek_motion(100), kLong));
  const std::shared_ptr<const PlayerState> held = player.state();
  const std::string digest = held->stock->digest();
  ASSERT_TRUE(player.wait(player.seek_end(), kLong));
  EXPECT_NE(player.state()->stock->digest(), digest);
  EXPECT_EQ(held->stock->digest(), digest);
}

}  // namespace
}  // namespace kerf
