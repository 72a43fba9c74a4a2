#include "viewer/window/window.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include "tests/viewer/test_scene.h"
#include "tests/viewer/virtual_display.h"

namespace kerf {
namespace {

std::shared_ptr<const ProgramText> test_program() {
  std::string text;
  for (int line = 1; line <= 500; ++line) text += "G1 X" + std::to_string(line) + " F1000\n";
  ProgramText program;
  program.files.emplace_back("test.ngc", std::move(text));
  return std::make_shared<const ProgramText>(std::move(program));
}

Moment test_moment() {
  Moment moment;
  moment.time_s = 63.4;
  moment.line = 42;
  moment.tool = 3;
  moment.tool_name = "ball 10";
  moment.spindle_rpm = 12000;
  moment.feed_mm_per_min = 1500;
  moment.work_offset = "G54";
  moment.tool_pose = ToolPose{Vec3(80.0, 90.0, -3.0)};
  moment.past_vertices = 9;
  moment.axes = {{.name = 'X', .machine = 180.0, .work = 80.0, .to_go = 12.5},
                 {.name = 'Y', .machine = 190.0, .work = 90.0, .to_go = std::nullopt},
                 {.name = 'Z', .machine = -103.0, .work = -3.0, .to_go = 0.0}};
  moment.breakpoints = {44};
  return moment;
}

SceneUpdate test_update(TestWorkpiece* workpiece) {
  SceneUpdate update;
  update.setup = workpiece->setup();
  update.patches = workpiece->take_patches();
  update.path = path_chunks(test_path(workpiece->cells_x(), workpiece->cells_y()));
  update.tool_shape = test_tool();
  update.program = test_program();
  update.timeline = std::make_shared<const ProgramTimeline>(
      ProgramTimeline{200.0, {{0.0, 1, "flat 12"}, {60.0, 3, "ball 10"}}});
  update.findings = std::make_shared<const FindingList>(
      FindingList{{{Severity::kError, "test.ngc", 30, 40.0, Vec3(120, 60, -3), "traverse touches"},
                   {Severity::kWarning, "test.ngc", 60, 90.0, std::nullopt, "deep cut"}}});
  update.moment = std::make_shared<const Moment>(test_moment());
  return update;
}

/// One display for all tests, started by the first.
class WindowTest : public testing::Test {
 protected:
  void SetUp() override {
    static Result<VirtualDisplay> display = VirtualDisplay::start();
    if (!display) GTEST_SKIP() << display.error();
    setenv("DISPLAY", display->name().c_str(), 1);
    unsetenv("WAYLAND_DISPLAY");
    setenv("LC_ALL", "C", 1);
  }

  void open(WindowOptions options = {}) {
    options.settings_file = settings_file_;
    options.max_frames_per_s = 1000;
    if (options.width_px == 0 && settings_file_.empty()) {
      options.width_px = 1280;
      options.height_px = 800;
    }
    Result<Window> window = Window::create(options, &mailbox_, &commands_);
    ASSERT_TRUE(window) << window.error();
    window_.emplace(std::move(*window));
    TestWorkpiece workpiece(200, 180);
    workpiece.dent(80, 90, 12, 6);
    mailbox_.publish(test_update(&workpiece));
    turn(8);
    commands_.take();
  }

  void turn(int frames) {
    for (int i = 0; i < frames; ++i) {
      const Result<bool> is_open = window_->frame(0.001);
      ASSERT_TRUE(is_open) << is_open.error();
    }
  }

  /// Turns until a command of this kind comes; none after ten seconds.
  template <class Command>
  std::optional<Command> next() {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (std::chrono::steady_clock::now() < end) {
      if (const Result<bool> is_open = window_->frame(0.01); !is_open) return std::nullopt;
      for (const ViewerCommand& command : commands_.take()) {
        if (const auto* found = std::get_if<Command>(&command)) return *found;
      }
    }
    return std::nullopt;
  }

  /// Turns until `is_done`; false after ten seconds.
  bool turn_until(const std::function<bool()>& is_done) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (!is_done()) {
      if (std::chrono::steady_clock::now() > end || !window_->frame(0.01)) return false;
    }
    return true;
  }

  SceneMailbox mailbox_{Window::wake};
  CommandQueue commands_;
  std::string settings_file_;
  std::optional<Window> window_;
};

TEST_F(WindowTest, ShowsTheScene) {
  open();
  const Picture picture = window_->read();
  ASSERT_EQ(picture.width_px, 1280);
  ASSERT_EQ(picture.height_px, 800);
  if (const char* path = std::getenv("KERF_WINDOW_PICTURE")) {
    const Done done = write_png(path, picture);
    EXPECT_TRUE(done) << done.error();
  }
}

}  // namespace
}  // namespace kerf
