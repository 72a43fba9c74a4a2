#include "twin/playback/player.h"

#include <gtest/gtest.h>

#include <atomic>

#include "tests/twin/playback/tracks.h"

namespace kerf {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr seconds kLong{60};

std::unique_ptr<Player> open(std::span<const Motion> motions, PlayerOptions options = {}) {
  PlayerProgram program;
  program.track = test::track_of(motions);
  program.blank = test::block_40();
  program.tools = test::two_tools();
  return std::make_unique<Player>(std::move(program), std::move(options));
}

std::shared_ptr<const PlayerState> after(const Player& player, Player::Ticket ticket) {
  EXPECT_TRUE(player.wait(ticket, kLong));
  return player.state();
}

/// Waits for a state of which `wanted` is true.
template <class Wanted>
std::shared_ptr<const PlayerState> until(const Player& player, Wanted wanted) {
  const auto end = std::chrono::steady_clock::now() + kLong;
  std::shared_ptr<const PlayerState> state = player.state();
  while (!wanted(*state) && std::chrono::steady_clock::now() < end) {
    std::this_thread::yield();
    state = player.state();
  }
  EXPECT_TRUE(wanted(*state));
  return state;
}

/// Three slots, on lines 2.. of their own; the rapid of line 5 runs through the block.
MotionList slots() {
  MotionList program;
  program.at({-5, 10, 5}).tool(1).spindle(true);  // line 1
  program.feed({-5, 10, -2}).feed({45, 10, -2});  // 2, 3
  program.traverse({45, 20, -2});                 // 4
  program.traverse({-5, 20, -3});                 // 5: through the block
  program.tool(2);                                // 6
  program.feed({-5, 30, -2}).feed({45, 30, -2});  // 7, 8
  program.traverse({45, 35, -2}).traverse({45, 35, 5}).traverse({20, 35, 5});  // 9, 10, 11
  program.traverse({20, 35, -1});                                              // 12: and again
  return program;
}

TEST(Player, StartsAtTheBeginning) {
  const auto player = open(slots().list());
  const auto state = player->state();
  ASSERT_TRUE(state);
  EXPECT_EQ(state->mode, PlayerMode::kPaused);
  EXPECT_EQ(state->place, (TrackPosition{0, 0, 0}));
  EXPECT_EQ(state->stock->digest(), test::block_40()->digest());
  EXPECT_DOUBLE_EQ(state->remaining_s, player->track().duration_s());
}

TEST(Player, SeeksToAndFroShowADryRun) {
  const std::vector<Motion> motions = test::varied_program(51, 1500);
  PlayerOptions options;
  options.keyframe_bytes = 10'000'000;
  const auto player = open(motions, options);
  std::mt19937 random(52);
  const std::vector<std::size_t> places = test::random_places(random, motions.size(), 120);
  const auto expected = test::digests_after(motions, places);
  for (const std::size_t motion : places) {
    const auto state = after(*player, player->seek_motion(motion));
    ASSERT_EQ(state->place.motion, motion);
    ASSERT_EQ(state->stock->digest(), expected.at(motion)) << motion;
  }
  ASSERT_EQ(test::digest_after(motions, places[0]), expected.at(places[0]));
}

TEST(Player, SaysWhatRunsThere) {
  const MotionList program = slots();
  const auto player = open(program.list());
  const auto state = after(*player, player->seek_line({0, 8}));
  EXPECT_EQ(state->motion.source.line, 8U);
  EXPECT_EQ(state->tip_mm, (Vec3{-5, 30, -2}));
  EXPECT_EQ(state->motion.tool, 2);
  ASSERT_TRUE(state->cutter);
  EXPECT_EQ(state->cutter->spec(), "bull:4:1");
  EXPECT_EQ(state->stop, PlayerStop::kArrived);
  EXPECT_NEAR(state->elapsed_s + state->remaining_s, player->track().duration_s(), 1e-9);
  const auto first = after(*player, player->seek_line({0, 2}));
  EXPECT_EQ(first->cutter->spec(), "ball:6");
  const auto end = after(*player, player->seek_end());
  EXPECT_EQ(end->stop, PlayerStop::kProgramEnd);
  EXPECT_EQ(end->tip_mm, (Vec3{20, 35, -1}));
  EXPECT_EQ(end->remaining_s, 0);
}

TEST(Player, WithinAMoveTheStartedPartIsCut) {
  const MotionList program = slots();
  const auto player = open(program.list());
  const ProgramTrack& track = player->track();
  const double half_s = track.step(2).time_at(0.5);
  const auto state = after(*player, player->seek_time(half_s));
  EXPECT_EQ(state->place.motion, 2U);
  EXPECT_NEAR(state->place.fraction, 0.5, 1e-7);
  EXPECT_NEAR(state->tip_mm.x, 20, 1e-5);
  const auto before = after(*player, player->seek_motion(2));
  const auto behind = after(*player, player->seek_motion(3));
  EXPECT_GT(before->stock->remaining_mm3(), state->stock->remaining_mm3());
  EXPECT_GT(state->stock->remaining_mm3(), behind->stock->remaining_mm3());
  EXPECT_NE(before->stock_number, behind->stock_number);
}

TEST(Player, StepsBlocks) {
  const auto player = open(slots().list());
  EXPECT_EQ(after(*player, player->step_block(1))->place.motion, 1U);
  EXPECT_EQ(after(*player, player->step_block(3))->place.motion, 4U);
  EXPECT_EQ(after(*player, player->step_block(-1))->place.motion, 3U);
  // Sent at once they add up, whether or not the first has arrived.
  player->step_block(1);
  player->step_block(1);
  EXPECT_EQ(after(*player, player->step_block(-1))->place.motion, 4U);
  EXPECT_EQ(after(*player, player->step_block(-100))->place.motion, 0U);
  const auto end = after(*player, player->step_block(100));
  EXPECT_EQ(end->place.motion, player->track().size());
  const double within_s = player->track().start_s(2) + 0.1;
  after(*player, player->seek_time(within_s));
  EXPECT_EQ(after(*player, player->step_block(-1))->place, player->track().place_before(2));
}

TEST(Player, GoesToToolsAndFindings) {
  const auto player = open(slots().list());
  EXPECT_EQ(after(*player, player->seek_tool_change(1))->place.motion, 5U);
  const auto none = after(*player, player->seek_tool_change(1));
  EXPECT_EQ(none->place.motion, 5U);
  EXPECT_EQ(none->message, "there is no tool change behind this place");
  EXPECT_EQ(after(*player, player->seek_tool_change(-1))->place.motion, 0U);

  const auto first = after(*player, player->seek_finding(1));
  EXPECT_EQ(first->motion.source.line, 5U);
  EXPECT_GT(first->place.fraction, 0);
  const auto second = after(*player, player->seek_finding(1));
  EXPECT_EQ(second->motion.source.line, 12U);
  EXPECT_EQ(after(*player, player->seek_finding(1))->message,
            "there is no finding behind this place");
  EXPECT_EQ(after(*player, player->seek_finding(-1))->motion.source.line, 5U);
  EXPECT_EQ(after(*player, player->seek_finding(-1))->message,
            "there is no finding before this place");
  const auto listed = player->state()->findings;
  ASSERT_EQ(listed->size(), 2U);
  EXPECT_EQ((*listed)[0].id, FindingId::kRapidContact);
  EXPECT_EQ(after(*player, player->seek_finding_number(1))->motion.source.line, 12U);
  EXPECT_EQ(after(*player, player->seek_finding_number(2))->message,
            "finding 3 has no place in the program");
}

TEST(Player, FindsTheNextFindingBeforeItIsKnown) {
  PlayerOptions options;
  options.check_ahead = false;
  const auto player = open(slots().list(), options);
  EXPECT_EQ(player->state()->motions_checked, 0U);
  EXPECT_EQ(after(*player, player->seek_finding(2))->motion.source.line, 12U);
}

TEST(Player, LinesWithoutMovesAndLoopsAreFound) {
  MotionList program;
  program.at({-5, 10, 5}).tool(1).spindle(true);
  std::vector<Motion> motions = program.list();
  Motion m = motions.back();
  m.kind = MotionKind::kTraverse;
  for (int turn = 0; turn < 3; ++turn) {
    for (const std::uint32_t line : {10U, 14U}) {
      m.source.line = line;
      m.from_mm = m.to_mm;
      m.to_mm.x += 1;
      motions.push_back(m);
    }
  }
  const auto player = open(motions);
  EXPECT_EQ(after(*player, player->seek_line({0, 10}))->place.motion, 1U);
  EXPECT_EQ(after(*player, player->seek_line({0, 10}, 2))->place.motion, 3U);
  EXPECT_EQ(after(*player, player->seek_line({0, 10}, 6))->place.motion, 1U) << "from the start";
  EXPECT_EQ(after(*player, player->seek_line({0, 12}))->place.motion, 2U);
  EXPECT_EQ(after(*player, player->seek_line({0, 12}, 5))->place.motion, 6U);
  const auto none = after(*player, player->seek_line({0, 15}));
  EXPECT_EQ(none->place.motion, 6U);
  EXPECT_EQ(none->message, "the program makes no move in line 15 or behind it");
}

TEST(Player, PlaysToTheEnd) {
  const MotionList program = slots();
  const auto player = open(program.list());
  player->play(200);
  const auto end = until(*player, [](const PlayerState& s) {
    return s.stop == PlayerStop::kProgramEnd && s.motions_checked == 12;
  });
  EXPECT_EQ(end->mode, PlayerMode::kPaused);
  EXPECT_EQ(end->place.motion, program.list().size());
  EXPECT_EQ(end->stock->digest(), test::digest_after(program.list(), program.list().size()));
}

TEST(Player, PlaysInTime) {
  const auto player = open(slots().list());
  const auto begin = std::chrono::steady_clock::now();
  player->play(2);
  const auto state = until(*player, [](const PlayerState& s) { return s.elapsed_s > 0.4; });
  const double wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_EQ(state->mode, PlayerMode::kPlaying);
  EXPECT_LE(state->elapsed_s, 2 * wall_s) << "never ahead of the clock";
  const auto paused = after(*player, player->pause());
  EXPECT_EQ(paused->mode, PlayerMode::kPaused);
  EXPECT_EQ(paused->stop, PlayerStop::kAsked);
  const auto stopped = after(*player, player->stop());
  EXPECT_EQ(stopped->place.motion, 0U);
  EXPECT_EQ(stopped->mode, PlayerMode::kPaused);
}

TEST(Player, ASeekWhilePlayingGoesOnPlaying) {
  const auto player = open(slots().list());
  player->play(0.001);
  const auto state = after(*player, player->seek_motion(7));
  EXPECT_EQ(state->mode, PlayerMode::kPlaying);
  EXPECT_EQ(state->place.motion, 7U);
  EXPECT_EQ(state->speed, 0.001);
}

TEST(Player, BreakpointsStopPlayingAndRunning) {
  const MotionList program = slots();
  const auto player = open(program.list());
  player->set_breakpoints({{0, 3}, {0, 8}});
  player->play(1000);
  const auto first =
      until(*player, [](const PlayerState& s) { return s.stop == PlayerStop::kBreakpoint; });
  EXPECT_EQ(first->place, player->track().place_before(2));
  const auto second = after(*player, player->run_to_motion(program.list().size()));
  EXPECT_EQ(second->stop, PlayerStop::kBreakpoint);
  EXPECT_EQ(second->place.motion, 7U);
  EXPECT_EQ(second->stock->digest(), test::digest_after(program.list(), 7));
  const auto end = after(*player, player->play(std::numeric_limits<double>::infinity()));
  EXPECT_EQ(end->stop, PlayerStop::kProgramEnd);
  EXPECT_EQ(after(*player, player->seek_motion(3))->stop, PlayerStop::kArrived);
  EXPECT_EQ(after(*player, player->run_to_line({0, 2}))->place.motion, 1U) << "behind: a seek";
}

TEST(Player, RefusesASpeedOfNothing) {
  const auto player = open(slots().list());
  const auto state = after(*player, player->play(0));
  EXPECT_EQ(state->mode, PlayerMode::kPaused);
  EXPECT_EQ(state->message, "speed 0 is not allowed; must be above 0");
}

TEST(Player, ChecksAheadWhileItStands) {
  const std::vector<Motion> motions = test::varied_program(61, 600);
  std::atomic<int> told = 0;
  PlayerOptions options;
  options.on_state = [&] { ++told; };
  const auto player = open(motions, options);
  const auto state = until(*player, [&](const PlayerState& s) {
    return s.motions_checked == motions.size() && s.mode == PlayerMode::kPaused;
  });
  std::vector<Finding> expected;
  test::digest_after(motions, motions.size(), &expected);
  EXPECT_EQ(state->findings->size(), expected.size());
  EXPECT_EQ(state->place.motion, 0U);
  EXPECT_GT(told, 0);
}

/// A program so short that it is checked before the first state is old: nobody sends a command
/// then, and yet the findings must come.
TEST(Player, TheLastNewsComesByItself) {
  const MotionList program = slots();
  const auto player = open(program.list());
  const auto state = until(
      *player, [&](const PlayerState& s) { return s.motions_checked == program.list().size(); });
  EXPECT_EQ(state->findings->size(), 2U);
}

/// A long program with big cutting: a seek to its end takes far longer than kInterrupt_ms, yet the
/// next command is carried out at once.
TEST(Player, ACommandInterruptsASeek) {
  MotionList program;
  program.at({0, 0, 5}).tool(1).spindle(true);
  std::mt19937 random(71);
  std::uniform_real_distribution<double> place(0, 40);
  for (int i = 0; i < 40'000; ++i) program.feed({place(random), place(random), -i * 1e-4});
  PlayerOptions options;
  options.check_ahead = false;
  const auto player = open(program.list(), options);
  const Player::Ticket far = player->seek_end();
  until(*player, [](const PlayerState& s) { return s.motions_checked > 0; });
  EXPECT_LT(player->state()->commands_done, far);
  const auto start = std::chrono::steady_clock::now();
  const auto state = after(*player, player->pause());
  const auto took = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(state->mode, PlayerMode::kPaused);
  EXPECT_EQ(state->place.motion, 0U);
  EXPECT_LT(state->motions_checked, program.list().size()) << "the seek is dropped";
  RecordProperty("interrupt_us",
                 static_cast<int>(std::chrono::duration<double, std::micro>(took).count()));
  // The seek that comes next replaces the one before it.
  player->seek_end();
  EXPECT_EQ(after(*player, player->seek_motion(10))->place.motion, 10U);
}

TEST(Player, HoldsStatesThatOutliveIt) {
  std::shared_ptr<const PlayerState> state;
  {
    const auto player = open(slots().list());
    state = after(*player, player->seek_motion(3));
  }
  EXPECT_EQ(state->stock->digest(), test::digest_after(slots().list(), 3));
}

TEST(Player, AnEmptyProgramHasOnePlace) {
  const auto player = open({});
  EXPECT_EQ(after(*player, player->seek_time(5))->place.motion, 0U);
  EXPECT_EQ(after(*player, player->step_block(1))->place.motion, 0U);
  const auto state = after(*player, player->play(std::numeric_limits<double>::infinity()));
  EXPECT_EQ(state->stop, PlayerStop::kProgramEnd);
}

}  // namespace
}  // namespace kerf
