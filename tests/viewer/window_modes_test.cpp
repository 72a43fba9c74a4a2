// The draw modes in which the window draws the workpiece: chosen by key, remembered, told of in
// words.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/viewer/raycast/sample_grids.h"
#include "tests/viewer/window_fixture.h"
#include "viewer/csg/cut_moves.h"
#include "viewer/png_image.h"

namespace kerf {
namespace {

constexpr Rgb kWarningText{242, 184, 82};
constexpr PixelBox kStatus{0, 780, 1280, 800};
const Box kBlank{Vec3(0, 0, -10), Vec3(200, 180, 0)};

class WindowModesTest : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    settings_file_ = folder_.path() + "/view.conf";
  }
  void open_wide(WindowOptions options = {}) {
    options.width_px = kWidth;
    options.height_px = kHeight;
    open(options);
  }
  void answer(DrawAnswer answer) {
    SceneUpdate update;
    update.draw_mode = std::make_shared<const DrawAnswer>(std::move(answer));
    mailbox_.publish(std::move(update));
    settle();
  }
  void choose(DrawMode draw_mode) {
    key("r");
    const auto command = next<DrawModeCommand>();
    ASSERT_TRUE(command);
    ASSERT_EQ(command->draw_mode, draw_mode);
  }
  /// Turns until the workpiece is drawn in this draw mode, in all of its pixels: a coarse picture
  /// may come first, and then nothing for longer than settle() waits.
  void come_to_rest(DrawMode draw_mode) {
    ASSERT_TRUE(
        turn_until([&] { return window_->drawn_mode() == draw_mode && window_->is_full(); }));
    settle();
  }
  std::string settings_text() const {
    std::ifstream file(settings_file_);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static std::shared_ptr<const DrawAnswer> drawn(DrawMode draw_mode) {
    auto answer = std::make_shared<DrawAnswer>();
    answer->draw_mode = draw_mode;
    return answer;
  }
  /// A block with a groove, as heights.
  static std::shared_ptr<const HeightGrid> grooved() {
    return test::make_grid(kBlank, 400, 360, [](double x, double y) {
      return std::abs(y - 90) < 15 && x > 40 && x < 160 ? -6.0 : 0.0;
    });
  }
  static std::shared_ptr<const CutMoves> groove() {
    auto moves = std::make_shared<CutMoves>();
    moves->blank_mm = kBlank;
    CsgTool tool;
    tool.shape.cutter = {{0, 0}, {15, 0}, {15, 30}};
    moves->tools = std::make_shared<const std::vector<CsgTool>>(1, tool);
    moves->moves = {{Vec3(55, 90, -6), Vec3(145, 90, -6), 0}};
    return moves;
  }
  /// Where KERF_PICTURES names a folder, for looking at.
  void keep_picture(const std::string& name) const {
    const char* folder = std::getenv("KERF_PICTURES");
    if (folder == nullptr) return;
    const Done done = write_png(std::string(folder) + "/" + name + ".png", window_->read());
    EXPECT_TRUE(done) << done.error();
  }

  TemporaryFolder folder_;
};

TEST_F(WindowModesTest, TheKeyGoesThroughTheModesAndTheChoiceIsRemembered) {
  open_wide();
  choose(DrawMode::kRaycast);
  choose(DrawMode::kCsg);
  choose(DrawMode::kMesh);
  choose(DrawMode::kRaycast);
  window_.reset();
  EXPECT_NE(settings_text().find("draw = raycast\n"), std::string::npos) << settings_text();
  commands_.take();
  open_wide();
  const auto command = next<DrawModeCommand>();
  ASSERT_TRUE(command) << "said again when it opens";
  EXPECT_EQ(command->draw_mode, DrawMode::kRaycast);
}

TEST_F(WindowModesTest, WhatTheCommandLineSaysIsForThisTimeAlone) {
  open_wide();
  choose(DrawMode::kRaycast);
  window_.reset();
  WindowOptions options;
  options.draw_mode = DrawMode::kCsg;
  commands_.take();
  open_wide(options);
  const auto command = next<DrawModeCommand>();
  ASSERT_TRUE(command);
  EXPECT_EQ(command->draw_mode, DrawMode::kCsg);
  window_.reset();
  EXPECT_NE(settings_text().find("draw = raycast\n"), std::string::npos) << settings_text();
  open_wide(options);
  ASSERT_TRUE(next<DrawModeCommand>()) << "that of the command line";
  choose(DrawMode::kMesh);  // after csg: a choice of the user
  window_.reset();
  EXPECT_NE(settings_text().find("draw = mesh\n"), std::string::npos) << settings_text();
}

TEST_F(WindowModesTest, WhatAModeCannotDoStandsInTheStatusLineAndTheMeshIsDrawn) {
  open_wide();
  const Picture mesh = window_->read_scene();
  choose(DrawMode::kRaycast);
  settle();
  EXPECT_EQ(count_pixels(window_->read(), kStatus, kWarningText), 0);
  answer({DrawMode::kRaycast, DrawLimit::kNoHeights, "octree", 0});
  EXPECT_GT(count_pixels(window_->read(), kStatus, kWarningText), 50);
  EXPECT_EQ(window_->read_scene().rgb, mesh.rgb);
  keep_picture("mode_refused");
  choose(DrawMode::kCsg);
  settle();
  EXPECT_EQ(count_pixels(window_->read(), kStatus, kWarningText), 0)
      << "that was of another draw mode";
}

/// Groove by heights, groove by moves: the scene around it stays where it is.
TEST_F(WindowModesTest, ValuesOfTheModeTakeTheMeshsPlace) {
  open_wide();
  const Picture mesh = window_->read_scene();
  const auto differs_by = [&](const Picture& other) {
    const Picture now = window_->read_scene();
    std::size_t count = 0;
    for (std::size_t i = 0; i + 2 < now.rgb.size(); i += 3) {
      int most = 0;
      for (std::size_t k = i; k < i + 3; ++k) {
        most = std::max(most, std::abs(static_cast<int>(now.rgb[k]) - other.rgb[k]));
      }
      if (most > 40) ++count;
    }
    return static_cast<double>(count) / (static_cast<double>(now.rgb.size()) / 3);
  };
  choose(DrawMode::kRaycast);
  SceneUpdate update;
  update.draw_mode = drawn(DrawMode::kRaycast);
  update.heights = grooved();
  mailbox_.publish(std::move(update));
  come_to_rest(DrawMode::kRaycast);
  EXPECT_GT(differs_by(mesh), 0.02);
  keep_picture("mode_rays");
  const Picture rays = window_->read_scene();
  // A pick reads the depth that was uploaded.
  click(640, 430);
  const auto picked = next<PickCommand>();
  ASSERT_TRUE(picked);
  EXPECT_TRUE(std::abs(picked->point_mm.z) < 0.2 || std::abs(picked->point_mm.z + 6) < 0.2)
      << picked->point_mm.z;

  choose(DrawMode::kCsg);
  update = {};
  update.draw_mode = drawn(DrawMode::kCsg);
  update.cut_moves = groove();
  mailbox_.publish(std::move(update));
  come_to_rest(DrawMode::kCsg);
  EXPECT_GT(differs_by(rays), 0.01) << "the groove has another colour";
  keep_picture("mode_csg");
  click(640, 430);
  const auto again = next<PickCommand>();
  ASSERT_TRUE(again);
  EXPECT_LT(glm::distance(again->point_mm, picked->point_mm), 0.5);

  choose(DrawMode::kMesh);
  move_to(320, 60);
  come_to_rest(DrawMode::kMesh);
  EXPECT_EQ(differs_by(mesh), 0.0);
}

/// The picture lags behind the eye, and comes to rest where the eye does.
TEST_F(WindowModesTest, RaysFollowTheEye) {
  open_wide();
  choose(DrawMode::kRaycast);
  SceneUpdate update;
  update.draw_mode = drawn(DrawMode::kRaycast);
  update.heights = grooved();
  mailbox_.publish(std::move(update));
  come_to_rest(DrawMode::kRaycast);
  key("7");
  settle();
  drag({600, 200}, {700, 260});
  key("7");
  move_to(320, 60);
  const auto rest = [&] {
    come_to_rest(DrawMode::kRaycast);
    return window_->read_scene();
  };
  const Picture before = rest();
  drag({600, 200}, {500, 260});
  EXPECT_GT(mean_difference(before, rest(), {0, 0, 600, 600}), 1.0);
  key("7");
  move_to(320, 60);
  EXPECT_EQ(rest().rgb, before.rgb);
}

}  // namespace
}  // namespace kerf
