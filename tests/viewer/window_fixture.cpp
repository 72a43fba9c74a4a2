#include "tests/viewer/window_fixture.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace kerf {
namespace {

// Much longer than anything takes: only what never comes is to be told from what comes late.
constexpr std::chrono::seconds kPatience{60};
/// On the background above the workpiece.
constexpr glm::ivec2 kNowhere{320, 60};

}  // namespace

int count_pixels(const Picture& picture, const PixelBox& box, Rgb color) {
  int count = 0;
  for (int y = box.top; y < std::min(box.bottom, picture.height_px); ++y) {
    for (int x = box.left; x < std::min(box.right, picture.width_px); ++x) {
      const std::uint8_t* at =
          &picture
               .rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width_px) +
                         static_cast<std::size_t>(x))];
      if (std::abs(at[0] - color.r) <= 3 && std::abs(at[1] - color.g) <= 3 &&
          std::abs(at[2] - color.b) <= 3) {
        ++count;
      }
    }
  }
  return count;
}

std::optional<glm::ivec2> find_pixel(const Picture& picture, const PixelBox& box, Rgb color) {
  for (int y = box.top; y < box.bottom; ++y) {
    for (int x = box.left; x < box.right; ++x) {
      if (count_pixels(picture, {x, y, x + 1, y + 1}, color) > 0) return glm::ivec2(x, y);
    }
  }
  return std::nullopt;
}

double mean_difference(const Picture& a, const Picture& b, const PixelBox& box) {
  if (a.width_px != b.width_px || a.height_px != b.height_px) return -1.0;
  double sum = 0.0;
  for (int y = box.top; y < box.bottom; ++y) {
    for (int x = 3 * box.left; x < 3 * box.right; ++x) {
      const std::size_t at =
          static_cast<std::size_t>(y) * 3 * static_cast<std::size_t>(a.width_px) +
          static_cast<std::size_t>(x);
      sum += std::abs(a.rgb[at] - b.rgb[at]);
    }
  }
  return sum / (3.0 * (box.right - box.left) * (box.bottom - box.top));
}

std::shared_ptr<const ProgramText> test_program() {
  const auto lines = [](int count, const std::string& axis) {
    std::string text;
    for (int line = 1; line <= count; ++line) {
      text += "G1 " + axis + std::to_string(line) + " F1000";
      text += line % 7 == 0 ? " (a comment)\n" : "\n";
    }
    return text;
  };
  ProgramText program;
  program.files.emplace_back("test.ngc", lines(500, "X"));
  program.files.emplace_back("subroutines/pocket.ngc", lines(50, "Y"));
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
  moment.coolant = "flood";
  moment.tool_pose = ToolPose{Vec3(80.0, 90.0, -3.0)};
  moment.past_vertices = 9;
  moment.axes = {{.name = 'X', .machine = 180.0, .work = 80.0, .to_go = 12.5},
                 {.name = 'Y', .machine = 190.0, .work = 90.0, .to_go = std::nullopt},
                 {.name = 'Z', .machine = -103.0, .work = -3.0, .to_go = 0.0}};
  moment.breakpoints = {{0, 44}};
  return moment;
}

void WindowTest::SetUp() {
  static Result<VirtualDisplay> display = VirtualDisplay::start();
  if (!display) GTEST_SKIP() << display.error();
  setenv("DISPLAY", display->name().c_str(), 1);
  unsetenv("WAYLAND_DISPLAY");
  setenv("LC_ALL", "C", 1);
}

void WindowTest::open(WindowOptions options) {
  options.settings_file = settings_file_;
  options.max_frames_per_s = most_frames_per_s_;
  if (options.width_px == 0 && settings_file_.empty()) {
    options.width_px = kWidth;
    options.height_px = kHeight;
  }
  Result<Window> window = Window::create(options, &mailbox_, &commands_);
  ASSERT_TRUE(window) << window.error();
  window_.emplace(std::move(*window));
  TestWorkpiece workpiece(200, 180);
  workpiece.dent(80, 90, 12, 6);
  SceneUpdate update;
  update.setup = workpiece.setup();
  update.patches = workpiece.take_patches();
  update.path = path_chunks(test_path(workpiece.cells_x(), workpiece.cells_y()));
  update.tool_shape = test_tool();
  update.program = test_program();
  update.timeline = std::make_shared<const ProgramTimeline>(
      ProgramTimeline{200.0, {{0.0, 1, "flat 12"}, {60.0, 3, "ball 10"}}});
  update.findings = std::make_shared<const FindingList>(
      FindingList{{{Severity::kError, "test.ngc", 30, 40.0, Vec3(120, 60, -3), "traverse touches"},
                   {Severity::kWarning, "test.ngc", 60, 90.0, std::nullopt, "deep cut"}}});
  update.moment = std::make_shared<const Moment>(test_moment());
  mailbox_.publish(std::move(update));
  ASSERT_TRUE(
      xdotool("mousemove " + std::to_string(kNowhere.x) + " " + std::to_string(kNowhere.y)));
  settle();
}

void WindowTest::publish(Moment moment) {
  SceneUpdate update;
  update.moment = std::make_shared<const Moment>(std::move(moment));
  mailbox_.publish(std::move(update));
}

void WindowTest::settle() {
  // Quiet when some turns, each of which waits for an input, draw nothing.
  constexpr int kQuietTurns = 4;
  int quiet = -1;  // the first look is before the first turn
  std::uint64_t drawn = frames();
  ASSERT_TRUE(turn_until([&] {
    quiet = frames() == drawn ? quiet + 1 : 0;
    drawn = frames();
    return quiet >= kQuietTurns;
  }));
}

bool WindowTest::turn_until(const std::function<bool()>& is_done) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!is_done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    const Result<bool> is_open = window_->frame(0.02);
    if (!is_open) {
      ADD_FAILURE() << is_open.error();
      return false;
    }
    if (!*is_open) return is_done();
  }
  return true;
}

bool WindowTest::turn_until_changed(const Picture& before, const PixelBox& box) {
  return turn_until([&] { return mean_difference(before, window_->read(), box) != 0.0; });
}

void WindowTest::move_to(int x, int y) {
  ASSERT_TRUE(xdotool("mousemove " + std::to_string(x) + " " + std::to_string(y)));
  settle();
}

void WindowTest::click(int x, int y, int button) {
  move_to(x, y);
  ASSERT_TRUE(xdotool("click " + std::to_string(button)));
}

void WindowTest::drag(glm::ivec2 from, glm::ivec2 to, int button) {
  move_to(from.x, from.y);
  ASSERT_TRUE(xdotool("mousedown " + std::to_string(button)));
  settle();
  constexpr int kSteps = 4;
  for (int i = 1; i <= kSteps; ++i) {
    const glm::ivec2 at = from + (to - from) * i / kSteps;
    move_to(at.x, at.y);
  }
  ASSERT_TRUE(xdotool("mouseup " + std::to_string(button)));
  settle();
}

void WindowTest::key(const std::string& name) { ASSERT_TRUE(xdotool("key " + name)); }

std::uint64_t WindowTest::frames() const {
  const DrawCounters& counters = window_->counters();
  return counters.full.frames + counters.local.frames + counters.still.frames;
}

}  // namespace kerf
