// What a turn of the window costs on a virtual display, panels included, and what it costs while
// nothing happens. Each kind of frame is timed until it is on the screen.
//
//     bench_window [FRAMES]
//
// Prints one line a kind: best, median, 99th percentile and longest frame, in milliseconds.

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <thread>
#include <vector>

#include "tests/viewer/test_scene.h"
#include "tests/viewer/virtual_display.h"
#include "viewer/window/window.h"

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kProgramLines = 1'000'000;
constexpr int kCells = 2000;
constexpr double kDuration_s = 3600.0;
/// After this long panels are drawn again with the next news.
constexpr std::chrono::milliseconds kPanelsDue{60};

std::shared_ptr<const ProgramText> long_program() {
  std::string text;
  for (int line = 1; line <= kProgramLines; ++line) {
    text += fmt::format("G1 X{}.25 Y{}.5 F1500\n", line % 200, line % 150);
  }
  ProgramText program;
  program.files.emplace_back("long.ngc", std::move(text));
  return std::make_shared<const ProgramText>(std::move(program));
}

Moment moment_of(int frame) {
  Moment moment;
  moment.state = PlayState::kPlaying;
  moment.speed = 50.0;
  moment.time_s = 2.0 * frame;
  moment.line = 1000 + frame * 40;
  moment.tool = 3;
  moment.tool_name = "ball 10";
  moment.spindle_rpm = 12000;
  moment.feed_mm_per_min = 1500;
  moment.work_offset = "G54";
  const double x = 400.0 + 3.0 * frame;
  moment.tool_pose = ToolPose{Vec3(x, 900.0, -20.0)};
  moment.axes = {{.name = 'X', .machine = x + 100, .work = x, .to_go = 12.5},
                 {.name = 'Y', .machine = 1000, .work = 900, .to_go = 1.0},
                 {.name = 'Z', .machine = -120, .work = -20, .to_go = 0.0}};
  return moment;
}

double cpu_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

class Bench {
 public:
  bool open() {
    WindowOptions options;
    options.settings_file.clear();
    options.width_px = 1280;
    options.height_px = 800;
    options.max_frames_per_s = 100'000;
    Result<Window> window = Window::create(options, &mailbox_, &commands_);
    if (!window) {
      fmt::print(stderr, "bench_window: {}\n", window.error());
      return false;
    }
    window_.emplace(std::move(*window));
    SceneUpdate update;
    update.setup = workpiece_.setup();
    update.patches = workpiece_.take_patches();
    update.tool_shape = test_tool(40.0f);
    update.program = long_program();
    update.timeline = std::make_shared<const ProgramTimeline>(
        ProgramTimeline{kDuration_s, {{0.0, 1, "flat 12"}, {1200.0, 3, "ball 10"}}});
    update.moment = std::make_shared<const Moment>(moment_of(0));
    mailbox_.publish(std::move(update));
    for (int i = 0; i < 40; ++i) turn();
    return true;
  }

  /// `prepare` publishes what the frame shows.
  void time(const char* name, int frames, const std::function<void(int)>& prepare) {
    std::vector<double> ms;
    const double before_s = cpu_s();
    for (int frame = 0; frame < frames; ++frame) {
      prepare(frame);
      const auto start = Clock::now();
      turn();
      ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }
    std::sort(ms.begin(), ms.end());
    fmt::print(
        "{}: best {:.2f} ms, median {:.2f} ms, p99 {:.2f} ms, longest {:.2f} ms, {} frames, {:.2f} "
        "ms of processor time each\n",
        name, ms.front(), ms[ms.size() / 2], ms[ms.size() * 99 / 100], ms.back(), ms.size(),
        1000.0 * (cpu_s() - before_s) / frames);
  }

  void move_tool(int frame) {
    SceneUpdate update;
    update.moment = std::make_shared<const Moment>(moment_of(frame));
    mailbox_.publish(std::move(update));
  }

  void cut(int frame) {
    workpiece_.dent(400.0 + 3.0 * frame, 900.0, 40.0, 20.0);
    SceneUpdate update;
    update.patches = workpiece_.take_patches();
    update.moment = std::make_shared<const Moment>(moment_of(frame));
    mailbox_.publish(std::move(update));
  }

  void time_idle(double seconds) {
    for (int i = 0; i < 20; ++i) turn();
    const double before = cpu_s();
    const auto start = Clock::now();
    while (Clock::now() - start < std::chrono::duration<double>(seconds)) turn(1.0);
    const double wall = std::chrono::duration<double>(Clock::now() - start).count();
    fmt::print("idle: {:.2f} % of a core\n", 100.0 * (cpu_s() - before) / wall);
  }

 private:
  void turn(double longest_wait_s = 0.0) {
    const Result<bool> is_open = window_->frame(longest_wait_s);
    if (is_open) return;
    fmt::print(stderr, "bench_window: {}\n", is_open.error());
    std::exit(4);
  }

  SceneMailbox mailbox_{Window::wake};
  CommandQueue commands_;
  TestWorkpiece workpiece_{kCells, kCells};
  std::optional<Window> window_;
};

int run(int frames) {
  Result<VirtualDisplay> display = VirtualDisplay::start();
  if (!display) {
    fmt::print(stderr, "bench_window: {}\n", display.error());
    return 4;
  }
  Bench bench;
  if (!bench.open()) return 4;
  fmt::print("{}\n", SceneRenderer::gl_name());
  bench.time("only the tool moves", frames, [&](int frame) { bench.move_tool(frame); });
  bench.time("cutting", frames, [&](int frame) { bench.cut(frame); });
  bench.time("only the tool moves", frames, [&](int frame) { bench.move_tool(frame); });
  bench.time("tool and panels, other lines of the program", std::min(frames, 60), [&](int frame) {
    std::this_thread::sleep_for(kPanelsDue);
    bench.move_tool(frame);
  });
  bench.time_idle(5.0);
  return 0;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  return kerf::run(argc > 1 ? std::max(10, std::atoi(argv[1])) : 200);
}
