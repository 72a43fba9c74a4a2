// What a program does over its time, added up as it is cut.
#include "twin/scene/program_curves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/twin/playback/tracks.h"

namespace kerf {
namespace {

constexpr CurveMaker::Clock::time_point kNever = CurveMaker::Clock::time_point::max();

/// 30 mm with either tool, 1 s or more each; what the second one removes has not been told when it
/// is checked.
MotionList two_cuts() {
  MotionList program;
  program.at({0, 0, 5}).tool(1).spindle(true);                      // 0, 1, 2
  program.feed({0, 0, -1}).feed({30, 0, -1}).traverse({30, 0, 5});  // 3 .. 5
  program.tool(2).feed({30, 0, -1}).feed({0, 0, -1});               // 6 .. 8
  return program;
}

ToolSources tools_of_teeth() {
  ToolSources sources;
  sources.arguments.push_back(std::move(parse_tool_argument("1=ball:6:teeth=2").value()));
  sources.arguments.push_back(std::move(parse_tool_argument("2=bull:4:1").value()));
  return sources;
}

double sum(const std::vector<float>& values, double step_s) {
  return step_s * std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(ProgramCurves, OfRateFeedAndTeethInTheColoursOfTools) {
  const auto track = test::track_of(two_cuts().list());
  std::vector<float> removed(track->size(), 0.0f);
  const auto cut_along = [&](int tool, float mm3) {
    for (std::size_t i = 0; i < track->size(); ++i) {
      const Vec3 way = track->to_mm(i) - track->from_mm(i);
      if (track->tool(i) == tool && std::abs(way.x) > 29 && !track->is_traverse(i))
        removed[i] = mm3;
    }
  };
  cut_along(1, 120);
  CurveMaker maker(track, {{1, "ball 6"}, {2, "bull 4 1"}},
                   std::make_shared<const CutQuery>(track, tools_of_teeth()));
  const std::size_t half = track->tool_changes().back();
  ASSERT_TRUE(maker.wants(half, CurveMaker::Clock::now()));
  const auto first = maker.make(half, removed, kNever);
  ASSERT_TRUE(first);
  EXPECT_NEAR(sum(first->mm3_per_s, first->step_s), 120, 1e-3);
  EXPECT_FALSE(maker.is_complete());
  EXPECT_FALSE(maker.wants(half, CurveMaker::Clock::now())) << "nothing new";
  EXPECT_FALSE(maker.wants(half + 1, CurveMaker::Clock::now())) << "too soon";
  const auto later = CurveMaker::Clock::now() + CurveMaker::kPeriod;
  ASSERT_TRUE(maker.wants(half + 1, later));
  ASSERT_TRUE(maker.wants(track->size(), CurveMaker::Clock::now())) << "the last";

  cut_along(2, 60);
  const auto whole = maker.make(track->size(), removed, kNever);
  ASSERT_TRUE(whole);
  EXPECT_TRUE(maker.is_complete());
  EXPECT_FALSE(maker.wants(track->size(), later));
  EXPECT_NEAR(sum(whole->mm3_per_s, whole->step_s), 180, 1e-3);
  EXPECT_NEAR(whole->known_until_s, track->duration_s(), 1e-9);
  ASSERT_EQ(whole->mm3_per_s.size(), whole->color.size());
  ASSERT_EQ(whole->feed_mm_per_min.size(), whole->color.size());
  ASSERT_EQ(whole->feed_per_tooth_mm.size(), whole->color.size());
  EXPECT_EQ(whole->color.front(), color_of_number(0));
  EXPECT_EQ(whole->color.back(), color_of_number(1));

  // Within the first tool's cut: its feed, and of that what each of two teeth gets.
  for (std::size_t i = 0; i < track->size(); ++i) {
    if (removed[i] != 120) continue;
    const double seconds = track->end_s(i) - track->start_s(i),
                 middle_s = track->start_s(i) + seconds / 2;
    ASSERT_GT(seconds, 4 * whole->step_s);
    const auto column = static_cast<std::size_t>(middle_s / whole->step_s);
    EXPECT_NEAR(whole->mm3_per_s[column], 120 / seconds, 1e-3);
    EXPECT_NEAR(whole->feed_mm_per_min[column], 60 * 30 / seconds, 0.1);
    const double turns = track->motion(i).spindle_rpm / 60 * seconds;
    EXPECT_NEAR(whole->feed_per_tooth_mm[column], 30 / turns / 2, 1e-6);
  }
  // Nothing is known of the second one's teeth.
  EXPECT_EQ(whole->feed_per_tooth_mm.back(), 0.0f);
}

TEST(ProgramCurves, LoadsAreInTheColumnsOfTheOthersWithTheirLimits) {
  const auto track = test::track_of(two_cuts().list());
  const auto record = std::make_shared<LoadRecord>(track);
  std::size_t cut = 0;
  for (std::size_t i = 0; i < track->size(); ++i) {
    const Vec3 way = track->to_mm(i) - track->from_mm(i);
    if (way.x > 29 && !track->is_traverse(i)) cut = i;
  }
  CutLoad load;
  load.is_engaged = true;
  load.start_s = track->start_s(cut);
  load.seconds = track->end_s(cut) - load.start_s;
  load.set(LoadKind::kPower, {1, 1.5, 2.5});
  record->on_load(load);
  CuttingWish wish;
  wish.spindle_power_kw = 2;
  CurveMaker maker(track, {{1, "ball 6"}}, nullptr);
  maker.show_loads(record, wish);
  const std::vector<float> removed(track->size(), 1.0f);
  const auto whole = maker.make(track->size(), removed, kNever);
  ASSERT_TRUE(whole);
  const SceneLoadCurve& power = whole->loads[static_cast<std::size_t>(CutLoadKind::kPower)];
  EXPECT_EQ(power.limit, 2);
  ASSERT_EQ(power.nominal.size(), whole->color.size());
  ASSERT_EQ(power.high.size(), whole->color.size());
  const auto column = static_cast<std::size_t>((load.start_s + load.seconds / 2) / whole->step_s);
  EXPECT_EQ(power.nominal[column], 1.5f);
  EXPECT_EQ(power.high[column], 2.5f);
  EXPECT_EQ(power.nominal.front(), 0);
  EXPECT_EQ(power.nominal.back(), 0);
  const SceneLoadCurve& force = whole->loads[static_cast<std::size_t>(CutLoadKind::kForce)];
  EXPECT_TRUE(force.nominal.empty());
  EXPECT_EQ(force.limit, 0);
}

TEST(ProgramCurves, AnEmptyProgramHasNone) {
  CurveMaker maker(test::track_of({}), {}, nullptr);
  EXPECT_FALSE(maker.wants(0, CurveMaker::Clock::now()));
}

TEST(ProgramCurves, ALongProgramComesInSlicesAndIsAddedUpOnceMore) {
  const std::vector<Motion> motions = test::varied_program(3, 3000);
  const auto track = test::track_of(motions);
  std::vector<float> removed(track->size(), 0.5f);
  CurveMaker maker(track, {}, nullptr);
  int slices = 0;
  std::shared_ptr<const ProgramCurves> whole;
  while (!whole && ++slices < 1000)
    whole = maker.make(track->size(), removed, CurveMaker::Clock::time_point::min());
  ASSERT_TRUE(whole);
  EXPECT_GE(slices, static_cast<int>(track->size() / 256));
  EXPECT_TRUE(maker.is_complete());
  EXPECT_TRUE(whole->feed_per_tooth_mm.empty());
  EXPECT_NEAR(sum(whole->mm3_per_s, whole->step_s) / (0.5 * static_cast<double>(track->size())), 1,
              1e-4);
}

}  // namespace
}  // namespace kerf
