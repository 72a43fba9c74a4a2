#include "twin/playback/program_track.h"

#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "tests/twin/playback/tracks.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

std::vector<std::uint64_t> bits_of(const Motion& m) {
  std::vector<std::uint64_t> bits;
  const auto add = [&](double value) { bits.push_back(std::bit_cast<std::uint64_t>(value)); };
  for (const auto integer : {static_cast<std::int64_t>(m.kind),
                             static_cast<std::int64_t>(m.spindle),
                             static_cast<std::int64_t>(m.flood),
                             static_cast<std::int64_t>(m.mist),
                             static_cast<std::int64_t>(m.path_mode),
                             static_cast<std::int64_t>(m.feed_per_rev),
                             static_cast<std::int64_t>(m.start_known),
                             static_cast<std::int64_t>(m.tool),
                             static_cast<std::int64_t>(m.source.file),
                             static_cast<std::int64_t>(m.source.line),
                             static_cast<std::int64_t>(m.length.verdict),
                             static_cast<std::int64_t>(m.length.offset_tool),
                             static_cast<std::int64_t>(m.length.set_at.file),
                             static_cast<std::int64_t>(m.length.set_at.line),
                             static_cast<std::int64_t>(m.unknown_from),
                             static_cast<std::int64_t>(m.unknown_to),
                             static_cast<std::int64_t>(m.to_machine_place),
                             static_cast<std::int64_t>(m.speed_said),
                             static_cast<std::int64_t>(m.user_m),
                             static_cast<std::int64_t>(m.rapid),
                             static_cast<std::int64_t>(m.halts),
                             static_cast<std::int64_t>(m.io_halts),
                             static_cast<std::int64_t>(m.chain_end),
                             static_cast<std::int64_t>(m.tool_prepare),
                             static_cast<std::int64_t>(m.by_number),
                             static_cast<std::int64_t>(m.table_reloaded),
                             static_cast<std::int64_t>(m.length.displaces),
                             static_cast<std::int64_t>(m.selected_tool),
                             static_cast<std::int64_t>(m.selected_at.file),
                             static_cast<std::int64_t>(m.selected_at.line)}) {
    bits.push_back(static_cast<std::uint64_t>(integer));
  }
  for (const Vec3& v :
       {m.from_mm, m.to_mm, m.arc.center_mm, m.arc.axis, m.tool_offset_mm, m.from_uvw_mm,
        m.to_uvw_mm, m.tool_offset_uvw_mm, m.length.applied_mm, m.length.real_mm,
        m.length.tip_shift_mm, m.length.uvw_off_mm, m.length.abc_off_deg}) {
    for (int axis = 0; axis < 3; ++axis) add(v[axis]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    add(m.from_abc_deg[i]);
    add(m.to_abc_deg[i]);
  }
  for (const double value :
       {m.arc.sweep_rad, m.feed_mm_per_min, m.spindle_rpm, m.duration_s, m.surface.mm_per_min,
        m.surface.max_rpm, m.surface.axis_x_mm, static_cast<double>(m.blend_tolerance_mm),
        static_cast<double>(m.merge_tolerance_mm)}) {
    add(value);
  }
  return bits;
}

/// Everything that a motion can have, and much that none will.
std::vector<Motion> wild_motions(std::size_t count) {
  std::mt19937_64 random(7);
  const auto number = [&]() -> double {
    switch (random() % 6) {
      case 0:
        return 0;
      case 1:
        return -0.0;
      case 2:
        return static_cast<double>(random() % 2'000'000) / 1e4 - 100;
      case 3:
        return 1.5;
      default:
        return std::ldexp(static_cast<double>(random()), -50) - 100;
    }
  };
  const auto vector = [&] { return Vec3{number(), number(), number()}; };
  std::vector<Motion> motions;
  Motion m;
  for (std::size_t i = 0; i < count; ++i) {
    const bool jumps = random() % 9 == 0;
    m.from_mm = jumps ? vector() : m.to_mm;
    m.from_abc_deg = random() % 50 == 0 ? std::array{number(), 0.0, number()} : m.to_abc_deg;
    m.to_mm = vector();
    if (random() % 20 == 0) m.to_abc_deg = {number(), number(), number()};
    m.from_uvw_mm = random() % 50 == 0 ? vector() : m.to_uvw_mm;
    if (random() % 20 == 0) m.to_uvw_mm = vector();
    m.tool_offset_uvw_mm = random() % 9 == 0 ? Vec3{0, 0, 2.5} : Vec3{0};
    if (random() % 9 == 0) {
      m.length.verdict = static_cast<ToolLengthState::Verdict>(random() % 3);
      m.length.displaces = random() % 2 == 0;
      m.length.uvw_off_mm = vector();
      m.length.abc_off_deg = vector();
      m.length.offset_tool = static_cast<int>(random() % 3) - 1;
      m.length.set_at = {0, static_cast<std::uint32_t>(random() % 3)};
      m.length.tip_shift_mm = {0, 0, random() % 2 == 0 ? -15.0 : 0.0};
      m.length.applied_mm = {0, 0, random() % 2 == 0 ? 60.0 : 75.0};
      m.length.real_mm = {random() % 2 == 0 ? -1.0 : 0.0, 0, 75};
    }
    m.kind = static_cast<MotionKind>(random() % 9);
    m.spindle = static_cast<SpindleState>(random() % 3);
    m.path_mode = static_cast<PathMode>(random() % 3);
    m.flood = random() % 2 == 0;
    m.mist = random() % 2 == 0;
    m.feed_per_rev = random() % 2 == 0;
    m.start_known = random() % 2 == 0;
    m.unknown_from = static_cast<std::uint8_t>(random() % 8);
    m.unknown_to = static_cast<std::uint8_t>(random() % 8);
    m.to_machine_place = random() % 2 == 0;
    m.speed_said = random() % 2 == 0;
    m.rapid = random() % 2 == 0;
    m.user_m = random() % 9 == 0 ? static_cast<std::uint8_t>(random()) : 0;
    m.halts = random() % 9 == 0 ? static_cast<std::uint8_t>(random()) : 0;
    m.io_halts = random() % 9 == 0 ? static_cast<std::uint8_t>(random()) : 0;
    m.chain_end = static_cast<ChainEnd>(random() % 3);
    m.tool_prepare = static_cast<ToolPrepare>(random() % 4);
    m.by_number = random() % 9 == 0;
    m.table_reloaded = random() % 9 == 0;
    if (random() % 20 == 0) m.selected_tool = static_cast<int>(random() % 1000) - 1;
    if (random() % 20 == 0) {
      m.selected_at = {static_cast<std::uint32_t>(random() % 3),
                       static_cast<std::uint32_t>(random() % 2'000'000)};
    }
    if (random() % 30 == 0) m.tool = static_cast<int>(random() % 5) - 1;
    m.source = {static_cast<std::uint32_t>(random() % 3),
                static_cast<std::uint32_t>(random() % 99)};
    m.arc = {vector(), random() % 2 == 0 ? Vec3{0, 0, 1} : Vec3{0, -1, 0}, number()};
    m.tool_offset_mm = random() % 2 == 0 ? Vec3{0, 0, 12.5} : Vec3{-0.0, 0, 0};
    m.feed_mm_per_min = number();
    m.spindle_rpm = number();
    m.surface = {random() % 2 == 0 ? 0 : 1.8e5, random() % 2 == 0 ? 1e30 : 2500,
                 random() % 2 == 0 ? -0.0 : 12.5};
    m.duration_s = random() % 2 == 0 ? 0 : 0.25;
    m.blend_tolerance_mm = random() % 2 == 0 ? 0.F : 0.01F;
    m.merge_tolerance_mm = random() % 2 == 0 ? -0.F : 0.002F;
    motions.push_back(m);
  }
  return motions;
}

TEST(ProgramTrack, MotionsAndTimesComeOutBitForBit) {
  ASSERT_EQ(sizeof(Motion), 520U) << "it has another field, which bits_of() must look at";
  const std::vector<Motion> motions = wild_motions(5000);
  ProgramTrackBuilder builder;
  std::mt19937_64 random(8);
  std::vector<TimedStep> steps;
  double clock = 0;
  for (const Motion& m : motions) {
    TimedStep step;
    step.start_s = clock;
    step.duration_s = std::ldexp(static_cast<double>(random()), -60);
    step.programmed_mm_per_min = static_cast<double>(random() % 3) * 1000.1;
    step.allowed_mm_per_min = std::ldexp(static_cast<double>(random()), -50);
    switch (random() % 8) {
      case 0:  // it waits before the next one
        clock += step.duration_s + 0.5;
        break;
      case 1:  // as a planner's clock has it
        clock += step.duration_s;
        step.duration_s = clock - step.start_s;
        break;
      case 2:
        step.duration_s = random() % 2 == 0 ? 0.0 : -0.0;
        break;
      default:
        clock += step.duration_s;
    }
    steps.push_back(step);
    builder.step(m, step, {});
  }
  const auto track = builder.build({"a.ngc", "b.ngc", "c.ngc"}, {});
  ASSERT_EQ(track->size(), motions.size());
  std::vector<std::size_t> order(motions.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), random);
  for (const std::size_t i : order) {
    ASSERT_EQ(bits_of(track->motion(i)), bits_of(motions[i])) << i;
    const TimedStep step = track->step(i);
    const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
    ASSERT_EQ(bits(step.start_s), bits(steps[i].start_s));
    ASSERT_EQ(bits(step.duration_s), bits(steps[i].duration_s));
    ASSERT_EQ(step.programmed_mm_per_min, steps[i].programmed_mm_per_min);
    ASSERT_EQ(step.allowed_mm_per_min, steps[i].allowed_mm_per_min);
    const CutMove expected = cut_move_from(motions[i], i);
    const CutMove move = track->cut_move(i);
    ASSERT_EQ(move.from_mm, expected.from_mm);
    ASSERT_EQ(move.to_mm, expected.to_mm);
    ASSERT_EQ(move.arc.has_value(), expected.arc.has_value());
    if (move.arc) {
      ASSERT_EQ(move.arc->center_mm, expected.arc->center_mm);
      ASSERT_EQ(move.arc->axis, expected.arc->axis);
      ASSERT_EQ(move.arc->sweep_rad, expected.arc->sweep_rad);
    }
  }
}

TEST(ProgramTrack, OfTheLastMotionTheTimeStays) {
  for (const std::size_t count : {1U, 2U, 256U, 257U}) {
    ProgramTrackBuilder builder;
    TimedStep step;
    for (std::size_t i = 0; i < count; ++i) {
      step.start_s = static_cast<double>(i) / 3;
      step.duration_s = 0.1 + static_cast<double>(i) / 7;
      builder.step(Motion{}, step, {});
    }
    const auto track = builder.build({"a.ngc"}, {});
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(track->step(i).duration_s, 0.1 + static_cast<double>(i) / 7);
    }
    EXPECT_EQ(track->duration_s(), step.start_s + step.duration_s);
  }
}

TEST(ProgramTrack, AMillionMotionsTakeFarLessThan100MB) {
  ProgramTrackBuilder builder;
  Motion m;
  m.kind = MotionKind::kFeed;
  m.tool = 1;
  m.feed_mm_per_min = 3000;
  TimedStep step;
  for (std::uint32_t i = 0; i < 1'000'000; ++i) {
    m.from_mm = m.to_mm;
    m.to_mm = {static_cast<double>(i % 1000) / 5, static_cast<double>(i / 1000) / 5,
               std::round(1e4 * std::sin(i / 70.0)) / 1e4};
    m.source.line = i + 6;
    m.selected_tool = 1;
    m.selected_at.line = i + 6;  // some write a T word in every block
    step.start_s += step.duration_s;
    step.duration_s = 0.004 + 1e-4 * std::sin(i);
    step.allowed_mm_per_min = 5000 + std::cos(i);
    step.programmed_mm_per_min = 3000;
    builder.step(m, step, {});
  }
  const auto track = builder.build({"part.ngc"}, {});
  EXPECT_EQ(track->size(), 1'000'000U);
  EXPECT_LT(track->bytes(), 32'000'000U);
  EXPECT_EQ(track->first_of_line({0, 777'777 + 6}), 777'777U);
}

/// Lines 1..4, of which 2 and 3 run three times, with a called file in between.
std::shared_ptr<const ProgramTrack> looping_track() {
  std::vector<Motion> motions;
  Motion m;
  m.kind = MotionKind::kFeed;
  m.feed_mm_per_min = 60;
  const auto move = [&](std::uint32_t file, std::uint32_t line) {
    m.source = {file, line};
    m.from_mm = m.to_mm;
    m.to_mm.x += 1;
    motions.push_back(m);
  };
  move(0, 1);
  for (int turn = 0; turn < 3; ++turn) {
    move(0, 2);
    move(0, 2);  // one block, two motions
    move(1, 7);
    move(0, 3);
  }
  move(0, 5);
  ProgramTrackBuilder builder;
  TimedStep step;
  step.duration_s = 1;
  for (const Motion& motion : motions) {
    builder.step(motion, step, {});
    step.start_s += 1.5;  // half a second of waiting behind each
  }
  return builder.build({"main.ngc", "sub.ngc"}, {});
}

TEST(ProgramTrack, LinesAreFoundInLoopsAndFiles) {
  const auto track = looping_track();
  EXPECT_EQ(track->first_of_line({0, 2}), 1U);
  EXPECT_EQ(track->first_of_line({0, 2}, 1), 1U);
  EXPECT_EQ(track->first_of_line({0, 2}, 2), 2U) << "within the block";
  EXPECT_EQ(track->first_of_line({0, 2}, 3), 5U);
  EXPECT_EQ(track->first_of_line({0, 2}, 10), 10U);
  EXPECT_EQ(track->first_of_line({0, 2}, 11), std::nullopt);
  EXPECT_EQ(track->first_of_line({1, 7}, 4), 7U);
  EXPECT_EQ(track->first_of_line({0, 4}), std::nullopt);
  EXPECT_EQ(track->line_with_motions({0, 4}), (SourceRef{0, 5}));
  EXPECT_EQ(track->line_with_motions({0, 3}), (SourceRef{0, 3}));
  EXPECT_EQ(track->line_with_motions({0, 6}), std::nullopt) << "not the next file's";
  EXPECT_EQ(track->line_with_motions({1, 0}), (SourceRef{1, 7}));
}

TEST(ProgramTrack, BlocksToAndFro) {
  const auto track = looping_track();
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < track->size(); i = track->next_block(i)) starts.push_back(i);
  EXPECT_EQ(starts, (std::vector<std::size_t>{0, 1, 3, 4, 5, 7, 8, 9, 11, 12, 13}));
  std::vector<std::size_t> back;
  for (std::size_t i = track->size(); i > 0;) back.push_back(i = track->previous_block(i));
  std::reverse(back.begin(), back.end());
  EXPECT_EQ(back, starts);
  EXPECT_EQ(track->previous_block(0), 0U);
  EXPECT_EQ(track->previous_block(2), 1U);
}

TEST(ProgramTrack, LongBlocksSpanManyWords) {
  ProgramTrackBuilder builder;
  Motion m;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    m.source.line = i < 300 ? 1 : i < 301 ? 2 : 3;
    builder.step(m, {}, {});
  }
  const auto track = builder.build({"a"}, {});
  EXPECT_EQ(track->next_block(0), 300U);
  EXPECT_EQ(track->next_block(300), 301U);
  EXPECT_EQ(track->next_block(301), 1000U);
  EXPECT_EQ(track->previous_block(1000), 301U);
  EXPECT_EQ(track->previous_block(301), 300U);
  EXPECT_EQ(track->previous_block(300), 0U);
}

TEST(ProgramTrack, PlacesInTime) {
  const auto track = looping_track();
  EXPECT_EQ(track->place_at(-1), (TrackPosition{0, 0, 0}));
  EXPECT_EQ(track->place_at(0.25), (TrackPosition{0, 0.25, 0.25}));
  EXPECT_EQ(track->place_at(1.25), (TrackPosition{1, 0, 1.25})) << "the wait behind the first";
  EXPECT_EQ(track->place_at(1.5), (TrackPosition{1, 0, 1.5}));
  EXPECT_EQ(track->place_at(2), (TrackPosition{1, 0.5, 2}));
  EXPECT_EQ(track->duration_s(), 13 * 1.5 + 1);
  EXPECT_EQ(track->place_at(1e9), (TrackPosition{14, 0, 20.5}));
  EXPECT_EQ(track->place_before(3), (TrackPosition{3, 0, 4.5}));
  EXPECT_EQ(track->place_before(14), (TrackPosition{14, 0, 20.5}));
}

/// Whoever asks when a place is passed, and where the tip is then, hears the same.
TEST(ProgramTrack, PlacesAreWhereTheSpeedsAlongTheWayHaveThem) {
  MotionList program;
  program.feed({1, 0, 0})
      .feed({60, 0, 0})
      .feed({60, 5, 0})
      .feed({58, 40, 0})
      .tool(1)
      .feed({4, 0, 0});
  const auto track = test::track_of(program.list());
  std::size_t uneven = 0;
  for (std::size_t i = 0; i < track->size(); ++i) {
    const TimedStep step = track->step(i);
    if (step.duration_s <= 0 || step.length_mm <= 0) continue;
    uneven += step.way.is_even() ? 0 : 1;
    for (int k = 1; k < 20; ++k) {
      const double share = k / 20.0;
      const TrackPosition place = track->place_at(step.time_at(share));
      EXPECT_EQ(place.motion, i);
      EXPECT_NEAR(place.fraction, share, 1e-5) << i;
      EXPECT_NEAR(step.way_at(place.time_s), share, 1e-5) << i;
    }
  }
  EXPECT_GE(uneven, 4U);
}

TEST(PackedWay, ComesOutBitForBit) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(0, 1);
  for (int i = 0; i < 2000; ++i) {
    WayInTime way;
    if (i % 3 == 0) {
      const double first = 0.1 + any(random), last = 0.1 + any(random);
      way.set_slowness(first, last, first + (last - first) * any(random));
    } else {
      const double cruise = 1 + 50 * any(random), first = 1.9 * cruise * any(random);
      way.set_ramps(5 + 300 * any(random), 500, first, cruise, cruise * any(random));
    }
    way.in_way = static_cast<float>(0.2 * any(random));
    way.in_time = static_cast<float>(0.2 * any(random));
    way.out_way = static_cast<float>(0.2 * any(random));
    way.out_time = static_cast<float>(0.2 * any(random));
    EXPECT_EQ(PackedWay(way).unpacked(), way) << i;
    const WayInTime part = way.between(0.3, 0.8).way;
    EXPECT_EQ(PackedWay(part).unpacked(), part) << i;
  }
  EXPECT_LE(sizeof(PackedWay), 28U);
}

TEST(ProgramTrack, ToolChanges) {
  MotionList program;
  program.feed({1, 0, 0}).tool(1).feed({2, 0, 0}).feed({3, 0, 0}).tool(2).feed({4, 0, 0});
  const auto track = test::track_of(program.list());
  EXPECT_EQ(std::vector<std::uint32_t>(track->tool_changes().begin(), track->tool_changes().end()),
            (std::vector<std::uint32_t>{1, 4}));
  EXPECT_EQ(track->next_tool_change(0), 1U);
  EXPECT_EQ(track->next_tool_change(1), 4U);
  EXPECT_EQ(track->next_tool_change(4), std::nullopt);
  EXPECT_EQ(track->previous_tool_change(4), 1U);
  EXPECT_EQ(track->previous_tool_change(1), std::nullopt);
}

TEST(ProgramTrack, EmptyProgram) {
  const auto track = ProgramTrackBuilder().build({}, {});
  EXPECT_TRUE(track->empty());
  EXPECT_EQ(track->duration_s(), 0);
  EXPECT_EQ(track->place_at(3), (TrackPosition{0, 0, 0}));
  EXPECT_EQ(track->first_of_line({0, 1}), std::nullopt);
  EXPECT_EQ(track->line_with_motions({0, 1}), std::nullopt);
  EXPECT_EQ(track->next_block(0), 0U);
  EXPECT_EQ(track->previous_block(0), 0U);
}

}  // namespace
}  // namespace kerf
