#include "twin/report/motion_table.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/base/temporary_folder.h"

namespace kerf {
namespace {

Motion feed_to(const Vec3& to, std::uint32_t line) {
  Motion m;
  m.kind = MotionKind::kFeed;
  m.to_mm = to;
  m.feed_mm_per_min = 600;
  m.source.line = line;
  m.tool = 3;
  m.spindle = SpindleState::kCounterclockwise;
  m.spindle_rpm = 8000;
  return m;
}

std::vector<std::string> lines_of(const std::string& path) {
  std::ifstream in(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::unique_ptr<MotionTable> table_at(const std::string& path) {
  auto table = MotionTable::create(path, [](std::string text) { return text; });
  EXPECT_TRUE(table) << table.error();
  return table ? std::move(table.value()) : nullptr;
}

TEST(MotionTable, ARowIsWhatItCutAndHowFast) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/m.csv";
  const auto table = table_at(path);
  table->name_files({"a, b.ngc"});
  TimedStep step;
  step.start_s = 1;
  step.duration_s = 2;
  step.length_mm = 20;
  table->on_step(4, feed_to({10, -0.0, -1.5}, 7), step);
  table->on_step(5, feed_to({20, 0, -1.5}, 8), step);
  table->on_cut(3, 99, 9);  // of a motion that is not reported on
  table->on_cut(4, 30, 1.5);
  table->on_cut(4, 12, 1.25);
  ASSERT_TRUE(table->commit());
  const std::vector<std::string> lines = lines_of(path);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[1], "7,\"a, b.ngc\",feed,10,0,-1.5,0,0,0,0,0,0,600,,20,1,2,3,-8000,42,1.5,21\r");
  EXPECT_EQ(lines[2], "8,\"a, b.ngc\",feed,20,0,-1.5,0,0,0,0,0,0,600,,20,1,2,3,-8000,0,0,0\r");
  const auto cells = [](const std::string& line) {
    return std::count(line.begin(), line.end(), ',');
  };
  EXPECT_EQ(cells(lines[0]), cells(lines[2]) - 1);  // the name has one
}

TEST(MotionTable, WhatIsNotKnownIsEmpty) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/m.csv";
  const auto table = table_at(path);
  Motion thread = feed_to({1, 2, 3}, 1);
  thread.kind = MotionKind::kThread;
  thread.feed_mm_per_min = 1.5;
  thread.unknown_to = 2;
  table->on_step(0, thread, {});
  ASSERT_TRUE(table->commit());
  EXPECT_EQ(lines_of(path)[1], "1,,thread,1,,3,0,0,0,0,0,0,,1.5,0,0,0,3,-8000,0,0,0\r");
}

TEST(MotionTable, HowToolsWereEngaged) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/m.csv";
  auto made = MotionTable::create(
      path, [](std::string text) { return text; }, true);
  ASSERT_TRUE(made);
  const auto table = std::move(made.value());
  TimedStep step;
  step.duration_s = 2;
  step.length_mm = 20;
  // 4 mm of 2, 12 mm of 5 mm width; a quarter of it in climb; 2 mm in air, 2 mm straight down.
  EngagementLook slot, side, down;
  slot.angle_rad = kPi / 2, slot.wide_mm = 2, slot.deep_mm = 3, slot.entry_rad = kPi / 2;
  slot.exit_rad = kPi, slot.climb = 1;
  side = slot;
  side.wide_mm = 5, side.entry_rad = 0, side.exit_rad = kPi / 2, side.climb = 0;
  down = side;
  down.is_plunge = true;
  table->on_step(4, feed_to({10, 0, 0}, 7), step);
  table->on_engaged(4, slot, {4, 0.4, 0});
  table->on_engaged(4, side, {12, 1.2, 0});
  table->on_engaged(4, {}, {2, 0.2, 0});
  table->on_engaged(4, down, {2, 0.2, 0});
  table->on_step(5, feed_to({20, 0, 0}, 8), step);
  table->on_engaged(5, {}, {20, 2, 0});
  table->on_step(6, feed_to({20, 0, 0}, 9), step);
  table->on_cut(4, 90, 1.5);
  ASSERT_TRUE(table->commit());
  const std::vector<std::string> lines = lines_of(path);
  ASSERT_EQ(lines.size(), 4u);
  const auto behind = [&](std::size_t n, std::string_view from) {
    return lines[n].substr(lines[n].find(from) + from.size());
  };
  EXPECT_EQ(behind(0, "removed_mm3_per_s"),
            ",ae_mm,ap_mm,entry_deg,exit_deg,climb_share,plunge_share,cut_share,cut_mm3_per_s,"
            "turned_mm_per_rev,chip_mm,air_s\r");
  // (4 * 2 + 12 * 5) / 16; 90 / 1.8 s.
  EXPECT_EQ(behind(1, ",90,1.5,45"), ",4.25,3,22.5,112.5,0.25,0.111111,0.9,50,,,0.2\r");
  EXPECT_EQ(behind(2, ",0,0,0,0,0,600,,20,0,2,3,-8000,0,0,0"), ",,,,,,,0,,,,2\r");
  EXPECT_EQ(behind(3, "-8000,0,0,0"), ",,,,,,,,,,,\r");
}

/// What a move has removed may be known behind the cuts of later ones: its row waits for that, and
/// no later one overtakes it.
TEST(MotionTable, ARowWaitsForHowItsToolWasEngaged) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/m.csv";
  auto made = MotionTable::create(
      path, [](std::string text) { return text; }, true);
  ASSERT_TRUE(made);
  const auto table = std::move(made.value());
  TimedStep step;
  step.duration_s = 2;
  step.length_mm = 20;
  for (std::uint64_t n = 0; n < 4; ++n) {
    table->on_step(n, feed_to({10, 0, 0}, static_cast<std::uint32_t>(n + 1)), step);
    table->on_engaged_until(std::min<std::uint64_t>(n, 1));
    table->on_cut(n, 1, 1);
  }
  EngagementLook look;
  look.angle_rad = 1, look.wide_mm = 2, look.deep_mm = 1;
  table->on_engaged(1, {}, {15, 1.5, 0});
  table->on_engaged(1, look, {5, 0.5, 0});
  table->on_engaged(2, {}, {20, 2, 0});
  table->on_engaged(0, {}, {20, 2, 0});  // written: it was said to be told
  table->on_engaged_until(3);
  table->on_cut(3, 1, 1);
  ASSERT_TRUE(table->commit());
  const std::vector<std::string> lines = lines_of(path);
  ASSERT_EQ(lines.size(), 5U);
  for (std::size_t n = 1; n < 5; ++n) EXPECT_EQ(lines[n].front(), static_cast<char>('0' + n));
  EXPECT_TRUE(lines[1].ends_with(",,,,,,,,,,,\r")) << lines[1];
  EXPECT_TRUE(lines[2].ends_with(",0.25,2,,,1.5\r")) << lines[2];
  EXPECT_TRUE(lines[3].ends_with(",0,,,,2\r")) << lines[3];
}

/// 15 of 20 mm in material in 1.5 of 2 s, 90 mm3: two parts, 5 mm of them twice as deep.
TEST(MotionTable, HowTurningToolsWereEngaged) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/m.csv";
  auto made = MotionTable::create(
      path, [](std::string text) { return text; }, true);
  ASSERT_TRUE(made);
  const auto table = std::move(made.value());
  TimedStep step;
  step.duration_s = 2;
  step.length_mm = 20;
  table->on_step(4, feed_to({10, 0, 0}, 7), step);
  table->on_cut(4, 90, 6);
  table->on_turned(4, {15, 1.5, 10, 3, 0.25, 0.2, 30});
  table->on_turned(4, {5, 0.5, 5, 6, 0.25, 0.2, 60});
  ASSERT_TRUE(table->commit());
  const std::string row = lines_of(path).at(1);
  EXPECT_TRUE(row.ends_with(",90,6,45,,4,,,,,0.75,60,0.25,0.2,0.5\r")) << row;
}

TEST(MotionTable, ARestartForgets) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/m.csv";
  const auto table = table_at(path);
  for (int i = 0; i < 3000; ++i) {
    table->on_step(static_cast<std::uint64_t>(i), feed_to({1, 1, 1}, 1), {});
    table->on_cut(static_cast<std::uint64_t>(i), 1, 1);
  }
  table->restart();
  table->on_step(0, feed_to({1, 1, 1}, 1), {});
  EXPECT_FALSE(std::ifstream(path).is_open());  // not before it is whole
  ASSERT_TRUE(table->commit());
  EXPECT_EQ(lines_of(path).size(), 2u);
}

TEST(MotionTable, AFolderThatIsNotThereIsAnError) {
  const TemporaryFolder folder;
  EXPECT_FALSE(MotionTable::create(folder.path() + "/no/m.csv", [](std::string t) { return t; }));
}

}  // namespace
}  // namespace kerf
