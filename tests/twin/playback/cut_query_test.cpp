#include "twin/playback/cut_query.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "stock/zmap/zmap.h"
#include "tests/stock/sweep_oracle.h"
#include "tests/twin/playback/tracks.h"

namespace kerf {
namespace {

/// As the heading of last_cut_at() says it, by brute force: every motion, many points of its way.
struct BruteForce {
  std::optional<std::size_t> last;
  bool ambiguous = false;  ///< a later one comes so close that the samples cannot tell
};

constexpr double kSampled_mm = 2e-3;  ///< how well the samples know the least height

double sampled_height(const Cutter& cutter, const CutMove& move, const Vec3& point,
                      double tolerance) {
  constexpr int kSamples = 400;
  double least = test::kInfinity;
  for (int i = 0; i <= kSamples; ++i) {
    const Vec3 tip = test::tip_at(move, static_cast<double>(i) / kSamples);
    const double beside = std::hypot(point.x - tip.x, point.y - tip.y) - tolerance;
    if (beside > cutter.radius_mm()) continue;
    least = std::min(least, tip.z + cutter.height_mm(std::max(0.0, beside)));
  }
  return least;
}

/// Is it sure that the motion touches, or that it does not? The samples are of a cutter that is a
/// little smaller or larger.
BruteForce brute_force(const CutQuery& query, const std::vector<Motion>& motions, const Vec3& point,
                       double tolerance, std::size_t until) {
  BruteForce result;
  for (std::size_t i = until; i-- > 0;) {
    const Motion& m = motions[i];
    const Cutter* const cutter = query.cutter_at(i);
    if (!cutter || !m.start_known || !(is_feed(m) || m.kind == MotionKind::kTraverse)) continue;
    const CutMove move = cut_move_from(m, i);
    const double wide = sampled_height(*cutter, move, point, tolerance + kSampled_mm);
    if (wide > point.z + tolerance + kSampled_mm) continue;
    const double narrow = sampled_height(*cutter, move, point, tolerance - kSampled_mm);
    result.ambiguous = narrow > point.z + tolerance - kSampled_mm;
    result.last = i;
    return result;
  }
  return result;
}

TEST(CutQuery, FindsWhatBruteForceFinds) {
  constexpr double kTolerance = 0.05;
  int compared = 0, touched = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const std::vector<Motion> motions = test::varied_program(seed, 700);
    const CutQuery query(test::track_of(motions), test::two_tools());
    std::mt19937 random(seed + 10);
    std::uniform_real_distribution<double> place(-2, 42), height(-6, 1);
    for (int n = 0; n < 60; ++n) {
      const Vec3 point{place(random), place(random), height(random)};
      const std::size_t until = random() % (motions.size() + 1);
      const BruteForce expected = brute_force(query, motions, point, kTolerance, until);
      if (expected.ambiguous) continue;
      ++compared;
      if (expected.last) ++touched;
      ASSERT_EQ(query.last_cut_at(point, kTolerance, {until, 0, 0}), expected.last)
          << "seed " << seed << ", " << point.x << " " << point.y << " " << point.z;
    }
  }
  EXPECT_GT(compared, 200);
  EXPECT_GT(touched, 80);
}

/// The middle of a cell lies on the envelope of the motion that gave it its height.
TEST(CutQuery, NamesTheMotionThatMadeACell) {
  constexpr double kTolerance = 1e-3;
  const std::vector<Motion> motions = test::varied_program(5, 150);
  const auto track = test::track_of(motions);
  const CutQuery query(track, test::two_tools());
  const std::unique_ptr<ZMap> stock = test::block_40();
  ToolResolver resolver(test::two_tools(), ZMap::can_cut);
  FindingLog log;
  CutStage stage(*stock, resolver, log, TimelineOptions{});
  stage.take(motions);
  stage.finish();
  std::mt19937 random(6);
  int cut = 0, whole = 0;
  for (int n = 0; n < 400; ++n) {
    const int i = static_cast<int>(random() % static_cast<unsigned>(stock->nx()));
    const int j = static_cast<int>(random() % static_cast<unsigned>(stock->ny()));
    const double cell = stock->cell_mm();
    const Vec3 point{(i + 0.5) * cell, (j + 0.5) * cell, stock->height_mm(i, j)};
    const auto found = query.last_cut_at(point, kTolerance, track->place_before(motions.size()));
    if (point.z == 0 || !found) {
      EXPECT_EQ(point.z, 0) << "was cut, but by nothing";
      ++whole;
      continue;
    }
    ++cut;
    ASSERT_TRUE(query.cutter_at(*found));
    const test::OracleHeight left = test::sweep_height(
        *query.cutter_at(*found), cut_move_from(motions[*found], 0), point.x, point.y, 400);
    if (left.edge_distance < 2 * kTolerance) continue;  // a wall: any height is of it
    EXPECT_NEAR(left.z, point.z, 2 * kTolerance) << "motion " << *found;
  }
  EXPECT_GT(cut, 100);
  EXPECT_GT(whole, 20);
}

TEST(CutQuery, LooksNoFartherThanThePlace) {
  MotionList program;
  program.at({-5, 20, 5}).tool(1).spindle(true);
  program.feed({-5, 20, -2}).feed({45, 20, -2});  // motions 1, 2
  program.traverse({45, 20, 5}).traverse({-5, 20, 5});
  program.feed({-5, 20, -3}).feed({45, 20, -3});  // motions 5, 6
  const auto track = test::track_of(program.list());
  const CutQuery query(track, test::two_tools());
  const Vec3 first{20, 20, -2}, second{20, 20, -3};
  EXPECT_EQ(query.last_cut_at(first, 1e-6, track->place_before(2)), std::nullopt);
  EXPECT_EQ(query.last_cut_at(first, 1e-6, track->place_before(3)), 2U);
  EXPECT_EQ(query.last_cut_at(second, 1e-6, track->place_before(6)), std::nullopt);
  EXPECT_EQ(query.last_cut_at(second, 1e-6, track->place_before(7)), 6U);
  // Halfway along the second slot the cutter has come as far as X20 and its radius.
  EXPECT_EQ(query.last_cut_at({19.9, 20, -3}, 1e-6, {6, 0.5, 0}), 6U);
  EXPECT_EQ(query.last_cut_at({20.1, 20, -3}, 1e-6, {6, 0.5, 0}), std::nullopt);
  EXPECT_EQ(query.last_cut_at({20.1, 20, -2}, 1e-6, {6, 0.5, 0}), 6U) << "the ball's flank";
  EXPECT_EQ(query.last_cut_at({23.1, 20, -2}, 1e-6, {6, 0.5, 0}), 2U);
  EXPECT_EQ(query.last_cut_at({20, 20, -3.001}, 1e-6, track->place_before(7)), std::nullopt);
  EXPECT_EQ(query.last_cut_at({20, 20, -3.001}, 0.002, track->place_before(7)), 6U);
}

TEST(CutQuery, WallsAndRimsOfAFlatCutter) {
  ToolSources tools;
  tools.arguments.push_back(std::move(parse_tool_argument("1=flat:6").value()));
  MotionList program;
  program.at({0, 0, 0}).tool(1).spindle(true).feed({20, 0, -4});  // motion 1, sloping down
  const auto track = test::track_of(program.list());
  const CutQuery query(track, tools);
  const TrackPosition end = track->place_before(2);
  EXPECT_EQ(query.last_cut_at({10, 2.999, -2}, 1e-6, end), 1U);
  EXPECT_EQ(query.last_cut_at({10, 3.001, -2}, 1e-6, end), std::nullopt);
  EXPECT_EQ(query.last_cut_at({10, 3.001, -2}, 0.002, end), 1U);
  // The rear of the rim leaves the floor: at X10 the tip is at X13 then, 2.6 deep.
  EXPECT_EQ(query.last_cut_at({10, 0, -2.6}, 1e-6, end), 1U);
  EXPECT_EQ(query.last_cut_at({10, 0, -2.60001}, 1e-6, end), std::nullopt);
}

TEST(CutQuery, ToolsThatDoNotCutTouchNothing) {
  MotionList program;
  program.at({-5, 20, 5}).tool(1).spindle(true).feed({-5, 20, -2}).feed({45, 20, -2});
  program.tool(3).feed({-5, 20, -3});  // motion 4; nothing is known of tool 3
  program.tool(1).probe({45, 20, -3});
  const auto track = test::track_of(program.list());
  const CutQuery query(track, test::two_tools());
  EXPECT_EQ(query.last_cut_at({20, 20, -2}, 1e-6, track->place_before(track->size())), 2U);
  EXPECT_EQ(query.cutter_at(4), nullptr);
  EXPECT_EQ(query.cutter_at(2)->spec(), "ball:6");
}

TEST(CutQuery, AnEmptyProgramTouchesNothing) {
  const CutQuery query(test::track_of({}), {});
  EXPECT_EQ(query.last_cut_at({0, 0, 0}, 1, {}), std::nullopt);
}

}  // namespace
}  // namespace kerf
