// Threads that are found on a part, against what they were made by.
#include "stock/turning/thread_gauge.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/stock/turning/turning_samples.h"

namespace kerf {
namespace {

using namespace turning_test;

constexpr double kBound_mm = 1e-3;  // what is promised

InsertOutline vee_insert(double flat_mm, double angle_deg, int orientation = 6) {
  return *thread_insert({radians(angle_deg), flat_mm, 4, orientation});
}

TurnMove lead_move(const Vec2& from, const Vec2& to, double lead) {
  return {from, to, std::nullopt, 0, lead};
}

/// M10 x 1.5: as G76 P1.5 Z-20 I-2 K0.92 E1.5 L2 leaves it, its last pass.
TurnedPart m10() {
  TurnedPart part = *TurnedPart::create(bar_profile(-40, 0, 10));
  part.cut(TurningTool(right_hand(0)), line({0.5, 4.0}, {-1.5, 6.0}));  // a chamfer
  const TurningTool tool(vee_insert(0.1875, 60));
  part.cut(tool, lead_move({3, 4.08}, {-18.5, 4.08}, 1.5));
  part.cut(tool, lead_move({-18.5, 4.08}, {-20, 5}, 1.5 * std::hypot(1.5, 0.92) / 1.5));
  part.cut(tool, line({-20, 5}, {-20, 8}));
  return part;
}

TEST(ThreadGauge, an_outer_thread) {
  const std::vector<MeasuredThread> threads = measure_threads(m10());
  ASSERT_EQ(threads.size(), 1u);
  const MeasuredThread& t = threads[0];
  EXPECT_FALSE(t.is_internal);
  EXPECT_TRUE(t.is_right_hand);
  EXPECT_EQ(t.starts, 1);
  EXPECT_NEAR(t.pitch_mm(), 1.5, 1e-9);
  EXPECT_NEAR(t.major_mm, 10, kBound_mm);
  EXPECT_NEAR(t.minor_mm, 8.16, kBound_mm);
  EXPECT_NEAR(t.depth_mm(), 0.92, kBound_mm);
  const double tan = std::tan(radians(30));
  // Groove and ridge are 0.75 wide.
  EXPECT_NEAR(t.pitch_diameter_mm, 2 * (4.08 + (0.75 - 0.1875) / 2 / tan), kBound_mm);
  EXPECT_NEAR(t.angle_rad, radians(60), 1e-4);
  EXPECT_NEAR(t.taper, 0, 1e-9);
  // From where it rises to where its flank is through the chamfer, of which 1 / 1000 may be
  // missing.
  EXPECT_NEAR(t.low_z_mm, -18.5, 0.02);
  const double half = 0.1875 / 2 + 0.92 * tan;
  EXPECT_NEAR(t.high_z_mm, -0.5 - half, 0.05);
  // At z = -20 it is at the crest; it comes in by its flank at the face, below the chamfer.
  EXPECT_NEAR(t.low_run_out_mm, 1.5, 0.02);
  EXPECT_GT(t.high_z_mm + t.high_run_out_mm, 0);
  EXPECT_LT(t.high_z_mm + t.high_run_out_mm, half);
}

/// X, Z and the lead of each move of G76 P1.5 Z-20 I-2 J0.3 K0.92 H1 R1.5 Q29.5 E1.5 L3 from X7 Z5,
/// in G8, as rs274 of LinuxCNC 2.9 lists them: to 0.1 um.
constexpr double kListing[][3] = {
    {7.0000, 5.0000, 0},       {7.6200, 4.8303, 0},     {5.6200, 4.8303, 1.75966},
    {4.7000, 3.3303, 1.75966}, {4.7000, -18.1492, 1.5}, {5.6200, -19.6492, 1.75966},
    {7.6200, -19.6492, 0},     {7.4438, 4.7306, 0},     {5.4438, 4.7306, 1.75966},
    {4.5238, 3.2306, 1.75966}, {4.5238, -18.2489, 1.5}, {5.4438, -19.7489, 1.75966},
    {7.4438, -19.7489, 0},     {7.2960, 4.6469, 0},     {5.2960, 4.6469, 1.75966},
    {4.3760, 3.1469, 1.75966}, {4.3760, -18.3325, 1.5}, {5.2960, -19.8325, 1.75966},
    {7.2960, -19.8325, 0},     {7.1640, 4.5723, 0},     {5.1640, 4.5723, 1.75966},
    {4.2440, 3.0723, 1.75966}, {4.2440, -18.4072, 1.5}, {5.1640, -19.9072, 1.75966},
    {7.1640, -19.9072, 0},     {7.0428, 4.5037, 0},     {5.0428, 4.5037, 1.75966},
    {4.1228, 3.0037, 1.75966}, {4.1228, -18.4758, 1.5}, {5.0428, -19.9758, 1.75966},
    {7.0428, -19.9758, 0},     {7.0000, 4.4795, 0},     {5.0000, 4.4795, 1.75966},
    {4.0800, 2.9795, 1.75966}, {4.0800, -18.5000, 1.5}, {5.0000, -20.0000, 1.75966},
    {7.0000, -20.0000, 0},     {7.0000, 4.4795, 0},     {5.0000, 4.4795, 1.75966},
    {4.0800, 2.9795, 1.75966}, {4.0800, -18.5000, 1.5}, {5.0000, -20.0000, 1.75966},
    {7.0000, -20.0000, 0},
};

TEST(ThreadGauge, a_listing_of_the_interpreter) {
  TurnedPart part = *TurnedPart::create(bar_profile(-40, 0, 10));
  const TurningTool tool(vee_insert(0.1875, 60)), inner = tool.inset(0.01);
  Vec2 at(5, 20);
  double removed = 0;
  for (const auto& [x, z, lead] : kListing) {
    const TurnMove move{at, {z, x}, std::nullopt, 0, lead};
    if (lead == 0) {
      EXPECT_FALSE(part.first_contact(inner, move)) << x << " " << z;
    }
    removed += part.cut(tool, move).removed_mm3;
    at = move.to_mm;
  }
  // The main way, and the way out: passes before, and the entry in the air, are in these.
  EXPECT_EQ(part.threads().passes().size(), 2u);
  EXPECT_NEAR(removed, part.blank_mm3() - part.remaining_mm3(), 1e-6);
  const std::vector<MeasuredThread> threads = measure_threads(part);
  ASSERT_EQ(threads.size(), 1u);
  const MeasuredThread& t = threads[0];
  EXPECT_TRUE(t.is_right_hand);
  EXPECT_EQ(t.starts, 1);
  EXPECT_NEAR(t.lead_mm, 1.5, 1e-6);
  EXPECT_NEAR(t.major_mm, 10, kBound_mm);
  EXPECT_NEAR(t.minor_mm, 8.16, kBound_mm);
  EXPECT_NEAR(t.angle_rad, radians(60), 1e-3);
  EXPECT_NEAR(t.low_z_mm, -18.5, 0.02);
  EXPECT_NEAR(t.low_run_out_mm, 1.5, 0.02);
}

TEST(ThreadGauge, a_left_hand_thread_and_one_the_other_way) {
  for (const double lead : {-2.0, 2.0}) {
    for (const bool outward : {false, true}) {
      TurnedPart part = *TurnedPart::create(bar_profile(-40, 0, 20));
      const Vec2 out(5, 9), in(-30, 9);
      part.cut(TurningTool(vee_insert(0.2, 55)),
               outward ? lead_move(in, out, lead) : lead_move(out, in, lead));
      const std::vector<MeasuredThread> threads = measure_threads(part);
      ASSERT_EQ(threads.size(), 1u);
      EXPECT_EQ(threads[0].is_right_hand, (lead > 0) != outward);
      EXPECT_NEAR(threads[0].angle_rad, radians(55), 1e-4);
      EXPECT_NEAR(threads[0].low_run_out_mm, 0, 1e-3);  // it stops in the material
      EXPECT_NEAR(threads[0].low_z_mm, -30, 1e-3);
    }
  }
}

TEST(ThreadGauge, an_inner_thread) {
  TurnedPart part = *TurnedPart::create(tube_profile(-25, 0, 30, 14));
  part.cut(TurningTool(vee_insert(0.25, 60, 8)), lead_move({4, 8.08}, {-30, 8.08}, 2));
  const std::vector<MeasuredThread> threads = measure_threads(part);
  ASSERT_EQ(threads.size(), 1u);
  const MeasuredThread& t = threads[0];
  EXPECT_TRUE(t.is_internal);
  EXPECT_TRUE(t.is_right_hand);
  EXPECT_NEAR(t.major_mm, 16.16, kBound_mm);
  EXPECT_NEAR(t.minor_mm, 14, kBound_mm);
  EXPECT_NEAR(t.pitch_diameter_mm, 2 * (8.08 - (1 - 0.25) / 2 / std::tan(radians(30))), kBound_mm);
}

TEST(ThreadGauge, three_starts) {
  TurnedPart part = *TurnedPart::create(bar_profile(-40, 0, 20));
  const TurningTool tool(vee_insert(0.2, 60));
  for (const double start : {5.0, 6.5, 8.0}) {
    part.cut(tool, lead_move({start, 9.2}, {-30, 9.2}, 4.5));
    part.cut(tool, line({-30, 9.2}, {-30, 15}));
  }
  const std::vector<MeasuredThread> threads = measure_threads(part);
  ASSERT_EQ(threads.size(), 1u);
  EXPECT_EQ(threads[0].starts, 3);
  EXPECT_NEAR(threads[0].lead_mm, 4.5, 1e-9);
  EXPECT_NEAR(threads[0].pitch_mm(), 1.5, 1e-9);
  EXPECT_NEAR(threads[0].minor_mm, 18.4, kBound_mm);
  EXPECT_NEAR(threads[0].major_mm, 20, kBound_mm);
}

/// NPT 1/2: 14 threads an inch, 1 in 16, as G33 cuts it: K is along the way.
TEST(ThreadGauge, a_taper_thread) {
  const double slope = 1.0 / 32, pitch = 25.4 / 14;
  TurnedPart part = *TurnedPart::create({{{-40, 0}, {0, 0}, {0, 10.5}, {-40, 10.5 + 40 * slope}}});
  const Vec2 from(6, 10.5 - 6 * slope - 1.2), to(-20, 10.5 + 20 * slope - 1.2);
  const double along = glm::distance(from, to) / 26;
  part.cut(TurningTool(vee_insert(0.1, 60)), lead_move(from, to, pitch * along));
  const std::vector<MeasuredThread> threads = measure_threads(part);
  ASSERT_EQ(threads.size(), 1u);
  const MeasuredThread& t = threads[0];
  EXPECT_NEAR(t.taper, -1.0 / 16, 1e-6);
  EXPECT_NEAR(t.lead_mm, pitch, 1e-6);
  EXPECT_NEAR(t.minor_mm, 2 * (10.5 - t.at_z_mm * slope - 1.2), 0.004);
  EXPECT_NEAR(t.major_mm, 2 * (10.5 - t.at_z_mm * slope), 0.004);
  EXPECT_NEAR(t.angle_rad, radians(60), 1e-4);
}

TEST(ThreadGauge, crests_that_were_turned_off_and_sharp_ones) {
  TurnedPart part = m10();
  part.cut(TurningTool(right_hand(0)), line({2, 4.9}, {-30, 4.9}));
  std::vector<MeasuredThread> threads = measure_threads(part);
  ASSERT_EQ(threads.size(), 1u);
  EXPECT_NEAR(threads[0].major_mm, 9.8, kBound_mm);
  // So deep that crests are sharp and below the bar.
  TurnedPart deep = *TurnedPart::create(bar_profile(-40, 0, 10));
  deep.cut(TurningTool(vee_insert(0, 60)), lead_move({5, 3.5}, {-30, 3.5}, 1.0));
  threads = measure_threads(deep);
  ASSERT_EQ(threads.size(), 1u);
  EXPECT_NEAR(threads[0].major_mm, 2 * (3.5 + 0.5 / std::tan(radians(30))), kBound_mm);
  EXPECT_NEAR(threads[0].minor_mm, 7, kBound_mm);
}

TEST(ThreadGauge, no_thread_no_finding) {
  TurnedPart part = *TurnedPart::create(bar_profile(-40, 0, 10));
  EXPECT_TRUE(measure_threads(part).empty());
  part.cut(TurningTool(vee_insert(0.1, 60)), line({5, 4}, {-10, 4}));
  EXPECT_TRUE(measure_threads(part).empty());
  // A scroll on the face.
  part.cut(TurningTool(*groove_insert({0.5, 0, 5, 5, true})), lead_move({-0.3, 6}, {-0.3, 1}, 1));
  EXPECT_FALSE(part.threads().empty());
  EXPECT_TRUE(measure_threads(part).empty());
}

}  // namespace
}  // namespace kerf
