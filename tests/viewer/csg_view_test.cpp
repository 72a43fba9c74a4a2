// Blank minus moves in the scene: an eye that turns sees whole pictures, one that stands the full
// one.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "viewer/csg/cut_moves.h"
#include "viewer/gl_context.h"
#include "viewer/orbit_camera.h"
#include "viewer/window/csg_picture.h"
#include "viewer/window/scene_renderer.h"

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;

constexpr glm::ivec2 kSize_px{400, 300};
const Box kBlank{Vec3(0, 0, -20), Vec3(100, 100, 0)};
/// Pixels along edges: a coarse picture has them elsewhere. The moves are a quarter of the picture.
constexpr double kMostAtEdges = 0.08;
constexpr int kRows = 160;

ToolShape flat_6() {
  ToolShape shape;
  shape.cutter = {{0, 0}, {3, 0}, {3, 20}};
  return shape;
}

/// Row by row to and fro, 8 mm deep, all of the blank.
std::shared_ptr<CutMoves> rows(int count) {
  static const auto kTools = std::make_shared<const std::vector<CsgTool>>(1, CsgTool{flat_6()});
  auto moves = std::make_shared<CutMoves>();
  moves->blank_mm = kBlank;
  moves->tools = kTools;
  for (int row = 0; row < count; ++row) {
    const double y = 100.0 * row / kRows;
    moves->moves.push_back({Vec3(-5, y, -8), Vec3(105, y, -8), 0});
  }
  return moves;
}

class CsgViewTest : public testing::Test {
 protected:
  void SetUp() override {
    unsetenv("DISPLAY");
    Result<GlContext> context = GlContext::create_offscreen();
    ASSERT_TRUE(context) << context.error();
    context_.emplace(std::move(*context));
    scene_.emplace(std::move(SceneRenderer::create().value()));
    reference_.emplace(std::move(SceneRenderer::create().value()));
    options_.draw_mode = DrawMode::kCsg;
    SceneUpdate update;
    auto answer = std::make_shared<DrawAnswer>();
    answer->draw_mode = DrawMode::kCsg;
    update.draw_mode = std::move(answer);
    auto setup = std::make_shared<SceneSetup>();
    setup->bounds_mm = kBlank;
    update.setup = std::move(setup);
    for (SceneRenderer* renderer : {&*scene_, &*reference_}) renderer->apply(update);
    camera_.fit(kBlank, kSize_px);
  }

  static void cut(SceneRenderer* renderer, std::shared_ptr<const CutMoves> moves) {
    SceneUpdate update;
    update.cut_moves = std::move(moves);
    renderer->apply(update);
  }
  Projection projection() const { return camera_.projection(scene_->depth_box(), kSize_px); }
  void draw(SceneRenderer* renderer, const Projection& projection) {
    const Done done = renderer->draw(projection, options_);
    ASSERT_TRUE(done) << done.error();
  }
  /// The full picture.
  Picture settled(SceneRenderer* renderer, const Projection& projection) {
    const auto end = Clock::now() + std::chrono::seconds(60);
    do {
      draw(renderer, projection);
    } while ((renderer->has_waiting() || renderer->drawn_mode() != DrawMode::kCsg) &&
             Clock::now() < end);
    EXPECT_TRUE(renderer->is_full());
    EXPECT_EQ(renderer->projection(), projection);
    return renderer->read();
  }
  static double share_apart(const Picture& a, const Picture& b) {
    EXPECT_EQ(a.rgb.size(), b.rgb.size());
    std::size_t apart = 0;
    for (std::size_t i = 0; i + 2 < std::min(a.rgb.size(), b.rgb.size()); i += 3) {
      int most = 0;
      for (std::size_t k = i; k < i + 3; ++k) most = std::max(most, std::abs(a.rgb[k] - b.rgb[k]));
      apart += most > 24 ? 1 : 0;
    }
    return 3.0 * static_cast<double>(apart) / static_cast<double>(a.rgb.size());
  }

  std::optional<GlContext> context_;
  std::optional<SceneRenderer> scene_;
  std::optional<SceneRenderer> reference_;
  OrbitCamera camera_;
  DrawOptions options_;
};

TEST_F(CsgViewTest, AnEyeThatTurnsSeesWholePictures) {
  cut(&*scene_, rows(kRows));
  cut(&*reference_, rows(kRows));
  settled(&*scene_, projection());
  const Projection begin = scene_->projection();
  Projection seen = begin;
  int pictures = 0;
  for (int turn = 0; turn < 1000 && pictures < 3; ++turn) {
    camera_.orbit({6, 1}, kSize_px);
    draw(&*scene_, projection());
    ASSERT_EQ(scene_->drawn_mode(), DrawMode::kCsg);
    if (scene_->projection() == seen) continue;
    seen = scene_->projection();
    ++pictures;
    EXPECT_LT(share_apart(scene_->read(), settled(&*reference_, seen)), kMostAtEdges) << turn;
  }
  EXPECT_EQ(pictures, 3);
  // With the newest moves missing it is another picture, and that would have been noticed.
  cut(&*reference_, rows(kRows / 8));
  EXPECT_GT(share_apart(scene_->read(), settled(&*reference_, seen)), 2 * kMostAtEdges);
  // At rest nothing is left of it. Where walls of two moves coincide, which of them is seen depends
  // on how the time limits divided the work.
  cut(&*reference_, rows(kRows));
  const Projection rest = projection();
  EXPECT_LT(share_apart(settled(&*scene_, rest), settled(&*reference_, rest)), kMostAtEdges);
}

TEST_F(CsgViewTest, MovesThatComeWhileTheEyeTurnsAreInTheNextPicture) {
  cut(&*scene_, rows(60));
  settled(&*scene_, projection());
  int count = 60;
  std::optional<Projection> seen;
  // Each picture shows at least what was there when it was begun: when the one before was shown.
  int begun_with = count;
  for (int turn = 0, pictures = 0; turn < 1000 && pictures < 3; ++turn) {
    camera_.orbit({6, 1}, kSize_px);
    cut(&*scene_, rows(++count));
    draw(&*scene_, projection());
    if (scene_->projection() == seen) continue;
    if (seen) {
      cut(&*reference_, rows(begun_with));
      const Picture least = settled(&*reference_, scene_->projection());
      cut(&*reference_, rows(count));
      const Picture most = settled(&*reference_, scene_->projection());
      const Picture now = scene_->read();
      EXPECT_LT(std::min(share_apart(now, least), share_apart(now, most)), kMostAtEdges) << turn;
      ++pictures;
    }
    seen = scene_->projection();
    begun_with = count;
  }
  cut(&*reference_, rows(count));
  const Projection rest = projection();
  EXPECT_EQ(settled(&*scene_, rest).rgb, settled(&*reference_, rest).rgb);
}

/// Of a long program the oldest moves go, time and again. They were cut all the same: while the eye
/// stands still nothing grows back, and nothing is made anew.
TEST_F(CsgViewTest, MovesThatGoAtTheFrontStayCutWhileTheEyeStands) {
  constexpr int kFirst = 60;
  const auto without_oldest = [](int count, int left_out) {
    auto moves = rows(count);
    moves->moves.erase(moves->moves.begin(), moves->moves.begin() + left_out);
    moves->left_out = static_cast<std::size_t>(left_out);
    return moves;
  };
  cut(&*scene_, rows(kFirst));
  settled(&*scene_, projection());
  cut(&*scene_, without_oldest(kFirst + 1, kFirst / 2));
  draw(&*scene_, projection());
  EXPECT_GT(scene_->counters().local.frames, 0u);
  const std::uint64_t full = scene_->counters().full.frames;
  const Picture kept = settled(&*scene_, projection());
  EXPECT_EQ(scene_->counters().full.frames, full);
  cut(&*reference_, rows(kFirst + 1));
  EXPECT_EQ(kept.rgb, settled(&*reference_, projection()).rgb);

  // Another eye sees what is asked for.
  camera_.orbit({40, 0}, kSize_px);
  cut(&*reference_, without_oldest(kFirst + 1, kFirst / 2));
  const Picture turned = settled(&*scene_, projection());
  EXPECT_LT(share_apart(turned, settled(&*reference_, projection())), kMostAtEdges / 8);
  // Back to a place before: the same row is another move there.
  cut(&*scene_, rows(1));
  cut(&*reference_, rows(1));
  EXPECT_EQ(settled(&*scene_, projection()).rgb, settled(&*reference_, projection()).rgb);
}

/// A spiral of short moves over most of the blank, straightened where the eye turns.
TEST_F(CsgViewTest, OfShortMovesTheTurningEyeSeesTheSame) {
  constexpr int kMoves = 800;
  const auto at = [](int i) {
    const double angle = 12 * kPi * i / kMoves, radius_mm = 4 + 41.0 * i / kMoves;
    return Vec3(50 + radius_mm * std::cos(angle), 50 + radius_mm * std::sin(angle),
                -6 - 6.0 * i / kMoves);
  };
  const std::shared_ptr<CutMoves> spiral = rows(0);
  for (int i = 0; i < kMoves; ++i) spiral->moves.push_back({at(i), at(i + 1), 0});
  cut(&*scene_, spiral);
  cut(&*reference_, spiral);
  draw(&*scene_, projection());
  const Projection begin = scene_->projection();
  const auto end = Clock::now() + std::chrono::seconds(60);
  while ((scene_->drawn_mode() != DrawMode::kCsg || scene_->projection() == begin) &&
         Clock::now() < end) {
    camera_.orbit({6, 1}, kSize_px);
    draw(&*scene_, projection());
  }
  ASSERT_EQ(scene_->drawn_mode(), DrawMode::kCsg);
  EXPECT_FALSE(scene_->is_full());
  const Projection seen = scene_->projection();
  const double apart = share_apart(scene_->read(), settled(&*reference_, seen));
  cut(&*reference_, rows(0));
  const double of_none = share_apart(scene_->read(), settled(&*reference_, seen));
  EXPECT_LT(apart, kMostAtEdges);
  EXPECT_GT(of_none, 1.5 * kMostAtEdges) << "that would have been noticed";
}

/// Many at once are no reason to begin anew.
TEST_F(CsgViewTest, ManyNewMovesLeaveWhatIsThere) {
  cut(&*scene_, rows(40));
  const Picture before = settled(&*scene_, projection());
  const std::uint64_t full = scene_->counters().full.frames;
  cut(&*scene_, rows(kRows));
  draw(&*scene_, projection());
  EXPECT_NE(scene_->read().rgb, before.rgb) << "some are there at once";
  cut(&*reference_, rows(kRows));
  EXPECT_EQ(settled(&*scene_, projection()).rgb, settled(&*reference_, projection()).rgb);
  EXPECT_EQ(scene_->counters().full.frames, full);
}

TEST_F(CsgViewTest, AtRestANewMoveIsThereAtOnce) {
  cut(&*scene_, rows(60));
  const Picture before = settled(&*scene_, projection());
  cut(&*scene_, rows(61));
  draw(&*scene_, projection());
  EXPECT_NE(scene_->read().rgb, before.rgb);
  settled(&*scene_, projection());
  cut(&*reference_, rows(61));
  EXPECT_EQ(scene_->read().rgb, settled(&*reference_, projection()).rgb);
}

/// A circle of 3600 moves: chords whose sagitta is the tolerance or less, ends and tools as they
/// were, every tip near.
TEST(Straightened, LeavesNoPointByMoreThanTheTolerance) {
  constexpr int kMoves = 3600;
  constexpr double kRadius_mm = 20, kTolerance_mm = 0.2;
  const auto at = [](int i) {
    const double angle = 2 * kPi * i / kMoves;
    return Vec3(kRadius_mm * std::cos(angle), kRadius_mm * std::sin(angle), -0.001 * i);
  };
  std::vector<SweptMove> moves;
  for (int i = 0; i < kMoves; ++i) moves.push_back({at(i), at(i + 1), i < kMoves / 2 ? 0u : 1u});
  moves.push_back({Vec3(0, 0, 5), Vec3(1, 0, 5), 1});  // begins elsewhere
  const std::vector<SweptMove> fewer = straightened(moves, kTolerance_mm);
  EXPECT_LT(fewer.size(), moves.size() / 20);
  EXPECT_GT(fewer.size(), 10u);
  EXPECT_EQ(fewer.front().from_mm, moves.front().from_mm);
  EXPECT_EQ(fewer.back().from_mm, Vec3(0, 0, 5));
  EXPECT_EQ(fewer[fewer.size() - 2].to_mm, at(kMoves));
  for (std::size_t i = 0; i + 2 < fewer.size(); ++i) {
    EXPECT_EQ(fewer[i].to_mm, fewer[i + 1].from_mm);
    const Vec3 middle = 0.5 * (fewer[i].from_mm + fewer[i].to_mm);
    EXPECT_GE(glm::length(Vec2(middle)), kRadius_mm - kTolerance_mm);
    EXPECT_EQ(fewer[i].tool, fewer[i].to_mm.z >= -0.001 * kMoves / 2 - 1e-9 ? 0u : 1u);
  }
  // To and fro is not nothing: the far end stays.
  const SweptMove there{Vec3(0, 0, 0), Vec3(5, 0, 0), 0}, back{Vec3(5, 0, 0), Vec3(0, 0, 0), 0};
  EXPECT_EQ(straightened(std::vector{there, back}, kTolerance_mm).size(), 2u);
}

}  // namespace
}  // namespace kerf
