// The window's scene with its workpiece in each of the three draw modes, along a program and back:
// the points that are picked in it are the same.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <thread>

#include "tests/twin/playback/tracks.h"
#include "twin/scene/player_scene.h"
#include "viewer/gl_context.h"
#include "viewer/orbit_camera.h"
#include "viewer/png_image.h"
#include "viewer/window/scene_renderer.h"

namespace kerf {
namespace {

constexpr glm::ivec2 kSize_px{320, 240};
constexpr double kCell_mm = 0.1;
/// Of the picked points: at edges, part of a cell aside is another surface. Found: 0.7 % at most.
constexpr double kMostAtEdges = 0.04;

class DrawnModes : public testing::Test {
 protected:
  void SetUp() override {
    unsetenv("DISPLAY");
    Result<GlContext> context = GlContext::create_offscreen();
    ASSERT_TRUE(context) << context.error();
    context_.emplace(std::move(*context));
    renderer_.emplace(std::move(SceneRenderer::create().value()));
    options_.upload_bytes_per_frame = std::numeric_limits<std::size_t>::max();
    MotionList program;
    program.at({-5, 10, 5}).tool(1).spindle(true);
    program.feed({5, 10, -3}).feed({35, 10, -3}).feed({35, 30, -5});
    program.arc({15, 30, -4}, {25, 30, -5}, {0, 0, 1}, kPi).feed({15, 20, -1});
    program.traverse({15, 20, 5}).tool(2).traverse({20, 25, 5}).feed({20, 25, -8});
    program.feed({30, 18, -8}).traverse({30, 18, 10});
    PlayerProgram played;
    played.track = track_ = test::track_of(program.list());
    played.blank = test::block_40(kCell_mm);
    played.tools = test::two_tools();
    ViewedProgram shown;
    shown.cuts = std::make_shared<const CutQuery>(track_, test::two_tools());
    shown.blank = played.blank->snapshot();
    shown.blank_outline = box_outline(played.blank->bounds_mm());
    PlayerOptions options;
    options.check_ahead = false;
    player_ = std::make_unique<Player>(std::move(played), options);
    scene_ = std::make_unique<PlayerScene>(track_, std::move(shown));
    renderer_->apply(scene_->start(*player_->state()));
    camera_.fit(renderer_->fit_box(), kSize_px);
    scene_->set_detail(camera_.detail(kSize_px));
  }

  void go_to(double time_s) {
    const Player::Ticket ticket = player_->seek_time(time_s);
    while (!player_->wait(ticket, std::chrono::milliseconds(100))) {
    }
  }
  /// All that there is, in this draw mode.
  void draw(DrawMode draw_mode) {
    if (draw_mode != options_.draw_mode) scene_->set_draw_mode(draw_mode);
    options_.draw_mode = draw_mode;
    do {
      renderer_->apply(scene_->update(player_->state(), PlayerScene::Clock::time_point::max()));
    } while (scene_->behind());
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    const Projection projection = camera_.projection(renderer_->depth_box(), kSize_px);
    // What is cast by a thread takes its time; whether more comes nobody tells.
    for (int quiet = 0; quiet < (draw_mode == DrawMode::kRaycast ? 60 : 1);) {
      const bool waits = renderer_->has_waiting();
      const Done done = renderer_->draw(projection, options_);
      ASSERT_TRUE(done) << done.error();
      const bool is_there =
          renderer_->drawn_mode() == draw_mode && renderer_->projection() == projection;
      quiet = waits || renderer_->has_waiting() || !is_there ? 0 : quiet + 1;
      ASSERT_LT(std::chrono::steady_clock::now(), end);
      if (draw_mode == DrawMode::kRaycast)
        std::this_thread::sleep_for(std::chrono::milliseconds(4));
    }
  }
  std::vector<Vec3> picks() const {
    std::vector<Vec3> points;
    for (int y = 3; y < kSize_px.y; y += 7) {
      for (int x = 3; x < kSize_px.x; x += 7) {
        points.push_back(renderer_->pick({x, y}).value_or(Vec3(1e6)));
      }
    }
    return points;
  }
  static double share_apart(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    constexpr double kSame_mm = 2 * kCell_mm;
    std::size_t apart = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      apart += glm::length(a[i] - b[i]) > kSame_mm ? 1 : 0;
    }
    return static_cast<double>(apart) / static_cast<double>(a.size());
  }
  /// Where KERF_PICTURES names a folder, for looking at.
  void keep_picture(const std::string& name) const {
    const char* folder = std::getenv("KERF_PICTURES");
    if (folder == nullptr) return;
    const Done done = write_png(std::string(folder) + "/" + name + ".png", renderer_->read());
    EXPECT_TRUE(done) << done.error();
  }

  std::optional<GlContext> context_;
  std::optional<SceneRenderer> renderer_;
  std::shared_ptr<const ProgramTrack> track_;
  std::unique_ptr<Player> player_;
  std::unique_ptr<PlayerScene> scene_;
  OrbitCamera camera_;
  DrawOptions options_;
};

TEST_F(DrawnModes, AllThreeHaveTheSamePointsAlongTheProgramAndBack) {
  const double end_s = track_->duration_s();
  for (const double share : {0.3, 0.62, 1.0, 0.45}) {
    SCOPED_TRACE(share);
    go_to(share * end_s);
    draw(DrawMode::kMesh);
    const std::vector<Vec3> mesh = picks();
    for (const DrawMode draw_mode : {DrawMode::kRaycast, DrawMode::kCsg}) {
      draw(draw_mode);
      const double apart = share_apart(mesh, picks());
      std::cout << "at " << share << ", draw mode " << static_cast<int>(draw_mode) << ": "
                << 100 * apart << " % apart\n";
      EXPECT_LT(apart, kMostAtEdges);
      keep_picture("drawn_" + std::to_string(static_cast<int>(draw_mode)) + "_" +
                   std::to_string(static_cast<int>(100 * share)));
    }
  }
}

TEST_F(DrawnModes, WhatAMoveChangesIsDrawnAloneByEveryMode) {
  const double end_s = track_->duration_s();
  for (const DrawMode draw_mode : {DrawMode::kRaycast, DrawMode::kCsg}) {
    SCOPED_TRACE(static_cast<int>(draw_mode));
    go_to(0.5 * end_s);
    draw(draw_mode);
    renderer_->reset_counters();
    go_to(0.505 * end_s);
    draw(draw_mode);
    const DrawCounters& counters = renderer_->counters();
    EXPECT_EQ(counters.full.frames, 0u);
    ASSERT_GE(counters.local.frames, 1u);
    EXPECT_LT(counters.local.pixels, counters.local.frames * kSize_px.x * kSize_px.y / 2);
    // Drawn anew it is the same.
    const Picture kept = renderer_->read();
    options_.is_local = false;
    draw(draw_mode);
    EXPECT_EQ(renderer_->read().rgb, kept.rgb);
    options_.is_local = true;
  }
}

/// The tool stands in its groove: what is before it hides it, as with the mesh.
TEST_F(DrawnModes, ToolAndLinesStandInTheWorkpiece) {
  go_to(0.4 * track_->duration_s());
  options_.looks[static_cast<std::size_t>(SceneObject::kCutter)].opacity = 1.0f;
  draw(DrawMode::kMesh);
  const auto yellow = [&] {
    const Picture picture = renderer_->read();
    std::size_t count = 0;
    for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3) {
      count += picture.rgb[i] > picture.rgb[i + 2] + 60 ? 1 : 0;
    }
    return static_cast<double>(count);
  };
  const double by_mesh = yellow();
  ASSERT_GT(by_mesh, 100);
  options_.looks[static_cast<std::size_t>(SceneObject::kWorkpiece)].is_visible = false;
  draw(DrawMode::kMesh);
  ASSERT_GT(yellow(), by_mesh + 40) << "so much of it is hidden by the workpiece";
  options_.looks[static_cast<std::size_t>(SceneObject::kWorkpiece)].is_visible = true;
  for (const DrawMode draw_mode : {DrawMode::kRaycast, DrawMode::kCsg}) {
    draw(draw_mode);
    EXPECT_NEAR(yellow(), by_mesh, 15) << static_cast<int>(draw_mode);
  }
}

}  // namespace
}  // namespace kerf
