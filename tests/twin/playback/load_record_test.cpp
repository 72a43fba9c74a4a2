// What the cuts of a program that is played are like, motion by motion.
#include "twin/playback/load_record.h"

#include <gtest/gtest.h>

#include "tests/twin/playback/tracks.h"

namespace kerf {
namespace {

/// Motions that last some seconds each.
std::shared_ptr<const ProgramTrack> strokes() {
  MotionList program;
  program.at({0, 0, 5}).tool(1).spindle(true);
  program.feed({0, 0, -1}).feed({40, 0, -1}).feed({40, 20, -1}).feed({0, 20, -1});
  return test::track_of(program.list());
}

CutLoad force(double from_s, double to_s, double newton) {
  CutLoad load;
  load.is_engaged = true;
  load.start_s = from_s;
  load.seconds = to_s - from_s;
  load.set(LoadKind::kForce, {newton, newton, 1.5 * newton});
  return load;
}

TEST(LoadRecord, EachMotionHasTheGreatestOfItsTime) {
  const auto track = strokes();
  const std::size_t last = track->size() - 1, before = last - 1;
  LoadRecord record(track);
  EXPECT_TRUE(record.by_motion(LoadKind::kForce).empty());
  const double from_s = track->start_s(before), end_s = track->end_s(before);
  const double middle_s = 0.5 * (from_s + end_s);
  // Two halves; the second of them ends where the next motion begins, but for rounding.
  record.on_load(force(from_s, middle_s, 100));
  record.on_load(force(middle_s, end_s * (1 + 1e-14), 250));
  record.on_load(force(track->start_s(last), track->end_s(last), 70));
  const std::vector<float> values = record.by_motion(LoadKind::kForce);
  ASSERT_EQ(values.size(), track->size());
  EXPECT_EQ(values[before], 250);
  EXPECT_EQ(values[last], 70);
  for (std::size_t i = 0; i < before; ++i) EXPECT_EQ(values[i], 0) << i;
  EXPECT_FALSE(record.curve().nominal(LoadKind::kForce).empty());
  // What is told of an earlier one finds its place, too.
  record.on_load(force(from_s, middle_s, 300));
  EXPECT_EQ(record.by_motion(LoadKind::kForce)[before], 300);
}

/// Of short moves several are looked at together.
TEST(LoadRecord, ALoadOfSeveralMotionsCountsForEach) {
  const auto track = strokes();
  const std::size_t last = track->size() - 1;
  LoadRecord record(track);
  record.on_load(force(track->start_s(last - 1), track->end_s(last), 90));
  const std::vector<float> values = record.by_motion(LoadKind::kForce);
  EXPECT_EQ(values[last - 1], 90);
  EXPECT_EQ(values[last], 90);
  EXPECT_EQ(values[last - 2], 0);
  record.restart();
  EXPECT_TRUE(record.by_motion(LoadKind::kForce).empty());
}

}  // namespace
}  // namespace kerf
