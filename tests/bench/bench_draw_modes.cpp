// bench_draw_modes: how long the window's thread draws a frame in each draw mode, while a program
// is cut and while the eye moves, by the software renderer and without a window.
//
//   bench_draw_modes [--program FILE] [--stock SPEC] [--tool N=SHAPE] [--cell MM] [--speed X]
//               [--seconds N] [--draw mesh|raycast|csg]
//
// Without a program: w1, LinuxCNC's 3D_Chips.ngc, where linuxcnc-uspace has it. For each draw mode,
// or the one named, 1280x800 pixels, sixty times a second: first the program plays, then the eye
// turns as well. A line for each of them: frames a second, how long a frame took (p50, p99,
// longest). By rays and by CSG a new picture of the workpiece may come later than the frame: how
// many came a second is told, too. While the eye turns the pictures may have fewer pixels, as in
// the window. Ends with 1 if a frame in a hundred took longer than kMostStall_ms.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "stock/blank.h"
#include "twin/playback/load_program.h"
#include "twin/scene/player_view.h"
#include "viewer/gl_context.h"
#include "viewer/orbit_camera.h"
#include "viewer/window/scene_renderer.h"

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;

constexpr glm::ivec2 kSize_px{1280, 800};
constexpr double kFramesPerS = 60;
constexpr double kMostStall_ms = 50;
constexpr glm::vec2 kTurn_px{6, 1};  ///< a frame, as the mouse drags

struct Arguments {
  std::string program = "/usr/share/linuxcnc/ncfiles/3D_Chips.ngc";
  std::string stock = "box:-50,-50,-50:50,50,0";
  std::string tool = "1=ball:10";
  double cell_mm = 0.05;
  double speed = 50;
  double seconds = 10;
  std::string draw_mode;  ///< Empty: all.
};

[[noreturn]] void fail(const std::string& why) {
  fmt::print(stderr, "bench_draw_modes: {}\n", why);
  std::exit(2);
}

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::unique_ptr<LoadedProgram> load(const Arguments& arguments) {
  SessionOptions options;
  options.program.path = arguments.program;
  options.stock.cell_mm = arguments.cell_mm;
  Result<Blank> blank = parse_blank(arguments.stock);
  if (!blank) fail(blank.error());
  options.blank = std::move(blank.value());
  Result<ToolShapeArgument> tool = parse_tool_argument(arguments.tool);
  if (!tool) fail(tool.error());
  options.tools.push_back(std::move(tool.value()));
  Diagnostics diagnostics;
  Outcome outcome = Outcome::kFailed;
  auto loaded = load_program(options, {}, diagnostics, outcome);
  for (const Diagnostic& d : diagnostics) fmt::print(stderr, "{}", to_string(d));
  if (!loaded || loaded->player.track->empty()) fail("nothing to play");
  return loaded;
}

/// The program in a window without panels, from its start.
class Run {
 public:
  Run(const Arguments& arguments, DrawMode draw_mode)
      : arguments_(arguments), renderer_(std::move(SceneRenderer::create().value())) {
    std::unique_ptr<LoadedProgram> loaded = load(arguments);
    ViewedProgram shown = viewed_program(*loaded, "bench");
    view_.emplace(std::move(loaded->player), PlayerOptions{}, std::move(shown), mailbox_,
                  commands_);
    thread_ = std::jthread([this](const std::stop_token& stop) { view_->run(stop); });
    options_.draw_mode = draw_mode;
    renderer_.keep_pace();
    commands_.push(DrawModeCommand{draw_mode});
    camera_.fit(Box{Vec3(-1), Vec3(1)}, kSize_px);
    for (int quiet = 0; quiet < 100 || renderer_.drawn_mode() != draw_mode;) {
      quiet = turn() ? 0 : quiet + 1;
      std::this_thread::sleep_for(std::chrono::milliseconds(4));
      if (quiet > 5000) fail("that mode is not drawn");
    }
    commands_.push(SpeedCommand{arguments.speed});
    commands_.push(PlayCommand{});
  }
  ~Run() {
    commands_.push(CloseCommand{});
    thread_.join();
  }

  /// True if it was as good as asked for.
  bool measure(const char* name, bool eye_turns) {
    std::vector<double> frame_ms;
    std::size_t pictures = 0;
    const Clock::time_point begin = Clock::now();
    double seconds = 0;
    for (std::uint64_t tick = 0; seconds < arguments_.seconds;) {
      std::this_thread::sleep_until(
          begin + std::chrono::duration_cast<Clock::duration>(
                      std::chrono::duration<double>(static_cast<double>(tick) / kFramesPerS)));
      if (eye_turns) camera_.orbit(kTurn_px, kSize_px);
      const Clock::time_point start = Clock::now();
      const std::uint64_t drawn =
          renderer_.counters().full.frames + renderer_.counters().local.frames;
      if (turn(eye_turns)) frame_ms.push_back(ms_since(start));
      const DrawCounters& counters = renderer_.counters();
      pictures += counters.full.frames + counters.local.frames - drawn;
      seconds = ms_since(begin) / 1e3;
      tick = std::max(tick + 1, static_cast<std::uint64_t>(seconds * kFramesPerS));
    }
    if (frame_ms.empty()) fail("nothing was drawn");
    std::sort(frame_ms.begin(), frame_ms.end());
    const double p99_ms = frame_ms[frame_ms.size() * 99 / 100];
    fmt::print(
        "{}{}: {:.1f} frames/s, p50 {:.1f} ms, p99 {:.1f} ms, max {:.1f} ms; workpiece {:.1f} /s\n",
        name, eye_turns ? ", eye turns" : "", static_cast<double>(frame_ms.size()) / seconds,
        frame_ms[frame_ms.size() / 2], p99_ms, frame_ms.back(),
        static_cast<double>(pictures) / seconds);
    return p99_ms <= kMostStall_ms;
  }

 private:
  bool turn(bool always = false) {
    const std::unique_ptr<SceneUpdate> update = mailbox_.take();
    if (!update && !renderer_.has_waiting() && !always) return false;
    if (update) renderer_.apply(*update);
    if (update && update->setup) {
      camera_.fit(renderer_.fit_box(), kSize_px);
      commands_.push(DetailCommand{camera_.detail(kSize_px).times(SceneRenderer::detail_px()),
                                   SceneRenderer::easy_triangles()});
    }
    const Done done = renderer_.draw(camera_.projection(renderer_.depth_box(), kSize_px), options_);
    if (!done) fail(done.error());
    renderer_.finish();
    return true;
  }

  const Arguments& arguments_;
  SceneMailbox mailbox_;
  CommandQueue commands_;
  SceneRenderer renderer_;
  OrbitCamera camera_;
  DrawOptions options_;
  std::optional<PlayerView> view_;
  std::jthread thread_;
};

Arguments read(int count, char** words) {
  Arguments arguments;
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string_view name = words[i];
    const std::string value = words[i + 1];
    if (name == "--program") {
      arguments.program = value;
    } else if (name == "--stock") {
      arguments.stock = value;
    } else if (name == "--tool") {
      arguments.tool = value;
    } else if (name == "--cell") {
      arguments.cell_mm = std::stod(value);
    } else if (name == "--speed") {
      arguments.speed = std::stod(value);
    } else if (name == "--seconds") {
      arguments.seconds = std::stod(value);
    } else if (name == "--draw") {
      if (value != "mesh" && value != "raycast" && value != "csg") {
        fail(fmt::format("'{}' is no draw mode: mesh, raycast or csg", value));
      }
      arguments.draw_mode = value;
    } else {
      fail(fmt::format("'{}' is no option; see the source", name));
    }
  }
  return arguments;
}

int run(int count, char** words) {
  const Arguments arguments = read(count, words);
  unsetenv("DISPLAY");
  Result<GlContext> context = GlContext::create_offscreen();
  if (!context) fail(context.error());
  fmt::print("{}\n", SceneRenderer::gl_name());
  bool is_good = true;
  for (const auto& [name, draw_mode] :
       {std::pair("mesh", DrawMode::kMesh), std::pair("raycast", DrawMode::kRaycast),
        std::pair("csg", DrawMode::kCsg)}) {
    if (!arguments.draw_mode.empty() && arguments.draw_mode != name) continue;
    Run run(arguments, draw_mode);
    is_good = run.measure(name, false) && is_good;
    is_good = run.measure(name, true) && is_good;
  }
  return is_good ? 0 : 1;
}

}  // namespace
}  // namespace kerf

int main(int count, char** words) { return kerf::run(count, words); }
