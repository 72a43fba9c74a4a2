#include "twin/scene/draw_feeder.h"

#include <gtest/gtest.h>

#include "stock/sheet/sheet.h"
#include "tests/twin/playback/tracks.h"

namespace kerf {
namespace {

class DrawFeederTest : public testing::Test {
 protected:
  void open(const MotionList& program, std::shared_ptr<const StockModel> blank = nullptr) {
    if (!blank) blank = test::block_40(0.5);
    program_.track = test::track_of(program.list());
    program_.cuts = std::make_shared<const CutQuery>(program_.track, test::two_tools());
    program_.blank = std::move(blank);
    feeder_ = DrawFeeder(program_);
  }
  SceneUpdate at(const TrackPosition& place) {
    SceneUpdate update;
    feeder_.update(program_.blank, place, &update);
    return update;
  }
  DrawLimit limit_of(DrawMode draw_mode) {
    feeder_.choose(draw_mode);
    const SceneUpdate update = at({});
    EXPECT_TRUE(update.draw_mode) << "an answer at once";
    if (!update.draw_mode) return DrawLimit::kNone;
    EXPECT_EQ(update.draw_mode->draw_mode, draw_mode);
    EXPECT_EQ(feeder_.drawn(), update.draw_mode->is_drawn() ? draw_mode : DrawMode::kMesh);
    return update.draw_mode->limit;
  }
  /// To and fro over the block, a step a motion.
  static MotionList rows(int count) {
    MotionList program;
    program.at({1, 1, -1}).tool(1).spindle(true);
    for (int i = 0; i < count; ++i) {
      program.feed({i % 2 == 0 ? 39.0 : 1.0, 1.0 + 0.001 * i, -1});
    }
    return program;
  }

  DrawFeeder::Program program_;
  DrawFeeder feeder_;
};

TEST_F(DrawFeederTest, NothingUntilAModeIsChosen) {
  open(rows(3));
  const SceneUpdate update = at({});
  EXPECT_FALSE(update.draw_mode);
  EXPECT_FALSE(update.heights);
  EXPECT_FALSE(update.cut_moves);
  EXPECT_EQ(feeder_.drawn(), DrawMode::kMesh);
}

TEST_F(DrawFeederTest, HeightsComeWithEachNewWorkpieceOnce) {
  open(rows(3));
  feeder_.choose(DrawMode::kRaycast);
  SceneUpdate first;
  feeder_.update(program_.blank, {}, &first);
  ASSERT_TRUE(first.heights);
  ASSERT_TRUE(first.draw_mode);
  SceneUpdate same;
  feeder_.update(program_.blank, {}, &same);
  EXPECT_FALSE(same.heights);
  EXPECT_FALSE(same.draw_mode);
  SceneUpdate other;
  feeder_.update(program_.blank->snapshot(), {}, &other);
  EXPECT_TRUE(other.heights);
  feeder_.choose(DrawMode::kMesh);
  SceneUpdate mesh;
  feeder_.update(program_.blank->snapshot(), {}, &mesh);
  EXPECT_FALSE(mesh.heights);
  ASSERT_TRUE(mesh.draw_mode);
  EXPECT_EQ(mesh.draw_mode->draw_mode, DrawMode::kMesh);
}

TEST_F(DrawFeederTest, WhatCannotBeIsSaid) {
  SheetOptions options;
  options.outline = rectangle_outline({0, 0}, {40, 40});
  open(rows(3), std::move(Sheet::create(options).value()));
  EXPECT_EQ(limit_of(DrawMode::kRaycast), DrawLimit::kNoHeights);
  EXPECT_EQ(limit_of(DrawMode::kCsg), DrawLimit::kNoBox);
  EXPECT_EQ(limit_of(DrawMode::kMesh), DrawLimit::kNone);

  auto dented = test::block_40(0.5);
  std::vector<CutReport> reports;
  CutMove move;
  move.from_mm = move.to_mm = Vec3(10, 10, -2);
  dented->cut(parse_shape("flat:4").value(), {&move, 1}, reports);
  dented->finish(reports);
  open(rows(3), std::move(dented));
  EXPECT_EQ(limit_of(DrawMode::kCsg), DrawLimit::kNoBox);
  EXPECT_EQ(limit_of(DrawMode::kRaycast), DrawLimit::kNone);

  open(rows(3));
  program_.is_tilted = true;
  feeder_ = DrawFeeder(program_);
  EXPECT_EQ(limit_of(DrawMode::kCsg), DrawLimit::kTilted);
  program_.is_tilted = false;
  program_.is_compared = true;
  feeder_ = DrawFeeder(program_);
  EXPECT_EQ(limit_of(DrawMode::kCsg), DrawLimit::kCompared);
  EXPECT_EQ(limit_of(DrawMode::kRaycast), DrawLimit::kCompared);

  feeder_ = DrawFeeder();
  EXPECT_EQ(limit_of(DrawMode::kCsg), DrawLimit::kWatched);
  EXPECT_EQ(limit_of(DrawMode::kRaycast), DrawLimit::kNone);
}

/// So that the window can go on with what it has: moves are added, and the last one grows.
TEST_F(DrawFeederTest, ForwardMovesAreAddedAndTheLastOneGrows) {
  MotionList program;
  program.at({1, 1, 5}).tool(1).spindle(true);
  program.feed({1, 1, -1}).feed({30, 1, -1});
  program.arc({30, 21, -2}, {30, 11, -1}, {0, 0, 1}, kPi);
  program.feed({1, 21, -2}).traverse({1, 21, 5}).tool(2).feed({5, 30, -1});
  open(program);
  feeder_.choose(DrawMode::kCsg);
  std::vector<SweptMove> before;
  const double end_s = program_.track->duration_s();
  for (int step = 0; step <= 300; ++step) {
    const TrackPosition place = program_.track->place_at(end_s * step / 300);
    const SceneUpdate update = at(place);
    if (!update.cut_moves) continue;
    const std::vector<SweptMove>& moves = update.cut_moves->moves;
    ASSERT_GE(moves.size() + 1, before.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
      const bool is_last = i + 1 == before.size();
      if (is_last && i >= moves.size()) continue;
      EXPECT_EQ(moves[i].from_mm, before[i].from_mm) << step;
      EXPECT_EQ(moves[i].tool, before[i].tool) << step;
      if (!is_last) {
        EXPECT_EQ(moves[i].to_mm, before[i].to_mm) << step;
      } else {
        const Vec3 was = before[i].to_mm - before[i].from_mm,
                   is = moves[i].to_mm - moves[i].from_mm;
        EXPECT_LT(glm::length(glm::cross(was, is)),
                  1e-9 * glm::length(is) * glm::length(is) + 1e-12);
        EXPECT_GE(glm::length(is), glm::length(was) * (1 - 1e-12));
      }
    }
    before = moves;
  }
  const FrameMoves all(program_.track, program_.cuts, program_.blank->bounds_mm());
  const std::vector<SweptMove> whole =
      all.between({}, program_.track->place_before(program_.track->size()));
  ASSERT_EQ(before.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_EQ(before[i].to_mm, whole[i].to_mm) << i;
}

TEST_F(DrawFeederTest, OfALongProgramTheNewestMovesAreShownAndTheAnswerSaysSince) {
  constexpr std::size_t kCount = 3 * DrawFeeder::kMostMoves;
  open(rows(static_cast<int>(kCount)));
  feeder_.choose(DrawMode::kCsg);
  const ProgramTrack& track = *program_.track;
  const SceneUpdate end = at(track.place_before(track.size()));
  ASSERT_TRUE(end.cut_moves);
  EXPECT_EQ(end.cut_moves->moves.size(), DrawFeeder::kMostMoves);
  EXPECT_EQ(end.cut_moves->moves.back().to_mm, track.motion(track.size() - 1).to_mm);
  ASSERT_TRUE(end.draw_mode);
  EXPECT_EQ(end.draw_mode->limit, DrawLimit::kNewest);
  const std::size_t first = track.size() - DrawFeeder::kMostMoves;
  EXPECT_EQ(end.draw_mode->line, static_cast<int>(track.source(first).line));
  EXPECT_EQ(end.cut_moves->moves.front().to_mm, track.motion(first).to_mm);
  EXPECT_EQ(end.cut_moves->left_out, first);

  // Back to where all of them are few enough.
  const SceneUpdate back = at(track.place_before(DrawFeeder::kMostMoves / 2));
  ASSERT_TRUE(back.draw_mode);
  EXPECT_EQ(back.draw_mode->limit, DrawLimit::kNone);
  ASSERT_TRUE(back.cut_moves);
  EXPECT_EQ(back.cut_moves->left_out, 0u);
  // And forward again: as they become too many, the older half goes.
  std::size_t most = 0;
  int answers = 0;
  for (std::size_t i = DrawFeeder::kMostMoves / 2; i < track.size(); i += 7) {
    const SceneUpdate update = at(track.place_before(i));
    if (update.cut_moves) most = std::max(most, update.cut_moves->moves.size());
    if (update.draw_mode) ++answers;
  }
  EXPECT_LE(most, DrawFeeder::kMostMoves);
  EXPECT_GT(most, DrawFeeder::kMostMoves * 9 / 10);
  EXPECT_GE(answers, 3);
  EXPECT_LE(answers, 6) << "only when the line changes";
}

}  // namespace
}  // namespace kerf
