#include "twin/scene/sheet_query.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/twin/playback/tracks.h"
#include "tests/twin/process/torch_shop.h"
#include "twin/process/torch/torch_plan.h"

namespace kerf {
namespace {

/// A square of 40 with its lower left corner at (50, 30), lead-in from the left; kerf 2.
class SheetQueryTest : public testing::Test {
 protected:
  void open(const MotionList& program, double pierce_mm = 0) {
    PlayerProgram played;
    played.track = track_ = test::track_of(program.list());
    played.blank = test::sheet_200();
    played.tools = test::torch_of("kerf:2");
    BeamSettings beam;
    beam.pierce_mm = pierce_mm;
    played.process = torch_process(std::move(beam));
    query_ = SheetQuery::of(played);
    ASSERT_TRUE(query_);
  }
  /// The end of the motion that made the wall there.
  std::optional<Vec2> end_at(const Vec2& point, std::optional<TrackPosition> until = {}) {
    const auto wall = query_->wall_at(Vec3(point, -1.5), until ? *until : end());
    if (!wall) return std::nullopt;
    return Vec2(track_->motion(wall->motion).to_mm);
  }
  TrackPosition end() const { return track_->place_before(track_->size()); }

  std::shared_ptr<const ProgramTrack> track_;
  std::shared_ptr<const SheetQuery> query_;
};

TEST_F(SheetQueryTest, AWallBelongsToTheMotionHalfAKerfBeside) {
  MotionList program = test::torch_program();
  test::square(program, {50, 30}, 40);
  open(program);
  EXPECT_EQ(end_at({70, 29}), Vec2(90, 30)) << "outside, below";
  EXPECT_EQ(end_at({70, 31}), Vec2(90, 30)) << "inside, below";
  EXPECT_EQ(end_at({91, 50}), Vec2(90, 70));
  EXPECT_EQ(end_at({60, 69}), Vec2(50, 70));
  EXPECT_EQ(end_at({51, 50}), Vec2(50, 30));
  EXPECT_EQ(end_at({48, 31}), Vec2(50, 30)) << "the lead-in";
  EXPECT_EQ(end_at({70, 28.6}), Vec2(90, 30)) << "the edge of the upper face, missed by a little";
  EXPECT_EQ(end_at({70, 50}), std::nullopt) << "in the middle of the part";
  EXPECT_EQ(end_at({20, 28.9}), std::nullopt) << "a traverse cuts nothing";
  EXPECT_EQ(end_at({0, 50}), std::nullopt) << "the edge of the sheet";
  const auto wall = query_->wall_at({70, 29, 0}, end());
  ASSERT_TRUE(wall);
  EXPECT_EQ(wall->cutter.substr(0, 6), "kerf 2") << wall->cutter;
}

TEST_F(SheetQueryTest, WhatIsNotCutYetMadeNoWall) {
  MotionList program = test::torch_program();
  test::square(program, {50, 30}, 40);
  open(program);
  const auto wall = query_->wall_at({70, 29, 0}, end());
  ASSERT_TRUE(wall);
  EXPECT_EQ(end_at({70, 29}, track_->place_before(wall->motion)), std::nullopt);
  EXPECT_EQ(end_at({70, 29}, TrackPosition{wall->motion, 0.4, 0}), std::nullopt) << "to X66";
  EXPECT_TRUE(end_at({70, 29}, TrackPosition{wall->motion, 0.6, 0})) << "to X74";
}

TEST_F(SheetQueryTest, OfTheSameContourTwiceTheFirstMadeIt) {
  MotionList program = test::torch_program();
  test::square(program, {50, 30}, 40);
  const std::size_t once = program.list().size();
  test::square(program, {50, 30}, 40);
  open(program);
  const auto wall = query_->wall_at({70, 29, 0}, end());
  ASSERT_TRUE(wall);
  EXPECT_LT(wall->motion, once);
}

TEST_F(SheetQueryTest, ArcsAndPierceHoles) {
  MotionList program = test::torch_program();
  program.traverse({60, 50, 1}).spindle(true);
  program.arc({60, 50, 1}, {80, 50, 1}, {0, 0, 1}, 2 * kPi).spindle(false);
  open(program, 6);
  for (int i = 1; i < 12; ++i) {
    const double angle = kPi + 2 * kPi * i / 12;
    const Vec2 way(std::cos(angle), std::sin(angle));
    EXPECT_TRUE(end_at(Vec2(80, 50) + 21.0 * way)) << i;
    EXPECT_TRUE(end_at(Vec2(80, 50) + 19.0 * way)) << i;
    EXPECT_FALSE(end_at(Vec2(80, 50) + 23.0 * way)) << i;
  }
  EXPECT_TRUE(end_at({57, 50})) << "the hole of the pierce";
  EXPECT_FALSE(end_at({55, 50}));
}

/// Every wall that a sheet has after a program is one that a motion made.
TEST_F(SheetQueryTest, AllWallsOfACutSheetAreKnown) {
  MotionList program = test::torch_program();
  test::square(program, {50, 30}, 40);
  program.traverse({120, 40, 1}).spindle(true);
  program.arc({120, 40, 1}, {135, 40, 1}, {0, 0, 1}, 2 * kPi).spindle(false);
  open(program);
  test::TorchShop shop(program.list());
  int walls = 0;
  for (const auto& ring : shop.sheet().outline().rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec2 at = 0.5 * (ring[i] + ring[(i + 1) % ring.size()]);
      const bool on_edge = at.x < 1e-6 || at.y < 1e-6 || at.x > 200 - 1e-6 || at.y > 100 - 1e-6;
      EXPECT_EQ(end_at(at).has_value(), !on_edge) << at.x << " " << at.y;
      walls += on_edge ? 0 : 1;
    }
  }
  EXPECT_GT(walls, 20);
}

}  // namespace
}  // namespace kerf
