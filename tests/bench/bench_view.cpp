// bench_view: the picture of a program while it is cut, and of a machine while it is watched, with
// all threads that the window has, by the software renderer and without a window.
//
//   bench_view [--program FILE] [--stock SPEC] [--tool N=SHAPE] [--cells N] [--speed X]
//              [--seconds N] [--full-redraw on|off]
//
// Without a program: w1, LinuxCNC's 3D_Chips.ngc, where linuxcnc-uspace has it. First plays it at
// `speed` times its own time, drawing 1280x800 pixels at most 60 times a second: frames a second,
// how long drawing took (p50, p99, longest), patches, memory. Afterwards the picture is compared
// with one that is drawn anew: a wrong one ends the run. Then follows a machine that goes round and
// round at 100 and 500 positions a second: time from a position's arrival to the end of the first
// draw that shows it or a later one. Ends with 1 if playing missed kFramesPerS or kMostStall_ms.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "stock/blank.h"
#include "stock/cutter/shape_spec.h"
#include "twin/live/live_session.h"
#include "twin/playback/load_program.h"
#include "twin/view/live_view.h"
#include "twin/view/player_view.h"
#include "viewer/gl_context.h"
#include "viewer/window/orbit_camera.h"
#include "viewer/window/scene_renderer.h"

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;

constexpr glm::ivec2 kSize{1280, 800};
constexpr double kFramesPerS = 60;
/// What is asked of the window's thread, p99.
constexpr double kMostStall_ms = 50;
/// One frame in a hundred seconds of film may be missed for the clock's sake.
constexpr double kFrameSlack = 0.99;
constexpr const char* kChips = "/usr/share/linuxcnc/ncfiles/3D_Chips.ngc";

struct Arguments {
  std::string program = kChips;
  std::string stock = "box:-50,-50,-50:50,50,0";
  std::string tool = "1=ball:10";
  int cells = 2000;
  double speed = 50;
  double seconds = 20;
  bool local = true;
};

[[noreturn]] void fail(const std::string& why) {
  fmt::print(stderr, "bench_view: {}\n", why);
  std::exit(2);
}

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::string load_average() {
  std::ifstream file("/proc/loadavg");
  std::string one;
  file >> one;
  return one;
}

std::string spread(std::vector<double> ms) {
  if (ms.empty()) return "none";
  std::sort(ms.begin(), ms.end());
  return fmt::format("p50 {:.1f} ms, p99 {:.1f} ms, max {:.1f} ms", ms[ms.size() / 2],
                     ms[ms.size() * 99 / 100], ms.back());
}

double p99(std::vector<double> ms) {
  std::sort(ms.begin(), ms.end());
  return ms[ms.size() * 99 / 100];
}

/// What the window's thread does, panels aside: takes news, draws, waits for the next frame.
class Screen {
 public:
  Screen(SceneMailbox& mailbox, bool local)
      : mailbox_(mailbox), renderer_(std::move(SceneRenderer::create().value())) {
    options_.is_local = local;
  }

  /// Draws until the workpiece and the path have come, as nothing moves yet.
  void settle(const std::function<bool()>& ready) {
    for (int quiet = 0; quiet < 50;) {
      quiet = turn() || !ready() ? 0 : quiet + 1;
      std::this_thread::sleep_for(std::chrono::milliseconds(4));
    }
  }

  /// One frame, if there is something new.
  bool turn() {
    const std::unique_ptr<SceneUpdate> update = mailbox_.take();
    if (!update && !renderer_.has_waiting()) return false;
    if (update) {
      patches_ += update->patches.size();
      if (update->moment) moment_ = update->moment;
      renderer_.apply(*update);
      if (update->setup) camera_.fit(renderer_.fit_box(), kSize);
    }
    draw(options_);
    return true;
  }

  /// As the window asks for it.
  double detail_mm() const { return camera_.pixel_mm(kSize) * SceneRenderer::detail_px(); }

  /// The picture as it has become, and as it is drawn anew.
  void check() {
    while (turn()) {
    }
    const Picture kept = renderer_.read();
    DrawOptions whole = options_;
    whole.is_local = false;
    draw(whole);
    if (renderer_.read().rgb != kept.rgb) fail("the kept picture is not that of a full redraw");
  }

  void finish() const { renderer_.finish(); }
  const DrawCounters& counters() const { return renderer_.counters(); }
  void reset() {
    renderer_.reset_counters();
    patches_ = 0;
  }
  std::size_t patches() const { return patches_; }
  const Moment* moment() const { return moment_.get(); }

 private:
  void draw(const DrawOptions& options) {
    const Done done = renderer_.draw(camera_.projection(renderer_.depth_box(), kSize), options);
    if (!done) fail(done.error());
    renderer_.finish();
  }

  SceneMailbox& mailbox_;
  SceneRenderer renderer_;
  OrbitCamera camera_;
  DrawOptions options_;
  std::size_t patches_ = 0;
  std::shared_ptr<const Moment> moment_;
};

SessionOptions session_of(const Arguments& arguments) {
  SessionOptions options;
  options.program.path = arguments.program;
  Result<Blank> blank = parse_blank(arguments.stock);
  if (!blank) fail(blank.error());
  options.blank = std::move(blank.value());
  Result<ToolShapeArgument> tool = parse_tool_argument(arguments.tool);
  if (!tool) fail(tool.error());
  options.tools.push_back(std::move(tool.value()));
  return options;
}

/// The edge of a cell that makes the longer side of the blank so many cells.
double cell_mm_of(const Arguments& arguments) {
  SessionOptions options = session_of(arguments);
  Diagnostics diagnostics;
  Outcome outcome = Outcome::kFailed;
  const StockSetup setup =
      make_stock(*options.blank, options.stock, "--stock", diagnostics, outcome);
  if (!setup.stock) fail("no blank");
  const Vec3 size = setup.stock->bounds_mm().size();
  return std::max(size.x, size.y) / arguments.cells;
}

/// True if it was as good as asked for.
bool play(const Arguments& arguments) {
  SessionOptions options = session_of(arguments);
  options.stock.cell_mm = cell_mm_of(arguments);
  Diagnostics diagnostics;
  Outcome outcome = Outcome::kFailed;
  std::unique_ptr<LoadedProgram> loaded = load_program(options, {}, diagnostics, outcome);
  for (const Diagnostic& d : diagnostics) fmt::print(stderr, "{}", to_string(d));
  if (!loaded || loaded->player.track->empty()) fail("nothing to play");
  loaded->player.blank->keep_cut_ids(true);
  const double duration_s = loaded->player.track->duration_s();
  SceneMailbox mailbox;
  CommandQueue commands;
  ViewedProgram shown = viewed_program(*loaded, "bench");
  PlayerView view(std::move(loaded->player), {}, std::move(shown), mailbox, commands);
  Screen screen(mailbox, arguments.local);
  std::jthread thread([&](const std::stop_token& stop) { view.run(stop); });
  screen.settle([&] { return screen.moment() != nullptr; });
  commands.push(DetailCommand{screen.detail_mm()});
  screen.settle([&] { return screen.moment() != nullptr; });
  screen.reset();
  commands.push(SpeedCommand{arguments.speed});
  commands.push(PlayCommand{});
  std::vector<double> frame_ms;
  const Clock::time_point begin = Clock::now();
  double seconds = 0;
  std::size_t behind = 0;
  for (std::uint64_t tick = 0; seconds < arguments.seconds; ++tick) {
    std::this_thread::sleep_until(
        begin + std::chrono::duration_cast<Clock::duration>(
                    std::chrono::duration<double>(static_cast<double>(tick) / kFramesPerS)));
    const Clock::time_point start = Clock::now();
    if (screen.turn()) frame_ms.push_back(ms_since(start));
    // A frame that took longer than its time delays those after it; they are not made up for.
    seconds = ms_since(begin) / 1e3;
    tick = std::max(tick, static_cast<std::uint64_t>(seconds * kFramesPerS));
    if (screen.moment()->state == PlayState::kEnded) break;
    if (view.player().state()->behind) ++behind;
  }
  const double played_s = screen.moment()->time_s;
  const DrawCounters counters = screen.counters();
  commands.push(PauseCommand{});
  screen.settle([&] { return screen.moment()->state != PlayState::kPlaying; });
  screen.check();
  commands.push(CloseCommand{});
  thread.join();
  const double frames_per_s = static_cast<double>(frame_ms.size()) / seconds;
  fmt::print("play {}x, {} cells a side, {}: {:.1f} frames/s, frame {}\n", arguments.speed,
             arguments.cells, arguments.local ? "local" : "full redraw", frames_per_s,
             spread(frame_ms));
  fmt::print(
      "  {:.0f} s of {:.0f} s of the program in {:.1f} s ({:.1f}x); {:.0f} patches/s; frames: {} "
      "full, {} local, {} still; behind in {} frames; peak {:.0f} MB; load average {}\n",
      played_s, duration_s, seconds, played_s / seconds,
      static_cast<double>(screen.patches()) / seconds, counters.full.frames, counters.local.frames,
      counters.still.frames, behind, peak_rss_mb(), load_average());
  const double locals = static_cast<double>(std::max<std::uint64_t>(1, counters.local.frames));
  fmt::print("  a local frame: {:.0f} pixels of {}, {:.0f} triangles\n",
             static_cast<double>(counters.local.pixels) / locals, kSize.x * kSize.y,
             static_cast<double>(counters.local.triangles) / locals);
  return frames_per_s >= kFramesPerS * kFrameSlack && p99(frame_ms) <= kMostStall_ms;
}

/// A machine that goes round in the blank, a position every period.
class CirclingSource final : public PositionSource {
 public:
  explicit CirclingSource(double rate_hz) : rate_hz_(rate_hz) {}
  Next next(AxisSample& sample, std::chrono::milliseconds) override {
    if (!start_) start_ = Clock::now();
    const double t_s = static_cast<double>(status_.samples) / rate_hz_;
    std::this_thread::sleep_until(
        *start_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(t_s)));
    const double angle = 2 * t_s;
    sample = AxisSample{};
    sample.set(0, 30 * std::cos(angle));
    sample.set(1, 30 * std::sin(angle));
    sample.set(2, -5 - 0.2 * t_s);
    sample.tool = 1;
    sample.device_ns = static_cast<std::int64_t>(t_s * 1e9);
    sample.host_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(
                         std::chrono::system_clock::now().time_since_epoch())
                         .count();
    ++status_.samples;
    status_.state = SourceState::kReading;
    return Next::kSample;
  }
  const SourceStatus& status() const override { return status_; }
  std::string describe() const override { return "a circle"; }

 private:
  double rate_hz_;
  std::optional<Clock::time_point> start_;
  SourceStatus status_;
};

struct Nobody : LiveObserver {
  void on_status(const LiveStatus&) override {}
  void on_finding(const Finding&, const std::vector<std::string>&) override {}
  void on_warning(const AheadWarning&, const std::vector<std::string>&) override {}
};

/// When the samples came, by their own time.
class Arrivals {
 public:
  void note(const AxisSample& sample) {
    const std::lock_guard lock(mutex_);
    at_.push_back(Clock::now());
    stamp_s_.push_back(static_cast<double>(sample.device_ns) * 1e-9);
  }
  /// Of all that are shown by `t_s` and have not been asked for yet, in ms until now.
  void take_shown(double t_s, std::vector<double>& ms) {
    const std::lock_guard lock(mutex_);
    for (; next_ < at_.size() && stamp_s_[next_] <= t_s + 1e-9; ++next_) {
      ms.push_back(ms_since(at_[next_]));
    }
  }

 private:
  std::mutex mutex_;
  std::vector<Clock::time_point> at_;
  std::vector<double> stamp_s_;
  std::size_t next_ = 0;
};

void follow(const Arguments& arguments, double rate_hz) {
  SessionOptions session_options = session_of(arguments);
  LiveOptions options;
  options.blank = std::move(session_options.blank);
  options.tools = std::move(session_options.tools);
  options.stock.cell_mm = cell_mm_of(arguments);
  options.cutting.frame.tool_length = ToolLengthFrom::kNone;
  Diagnostics diagnostics;
  Outcome outcome = Outcome::kFailed;
  auto session = LiveSession::open(std::move(options), std::make_unique<CirclingSource>(rate_hz),
                                   diagnostics, outcome);
  for (const Diagnostic& d : diagnostics) fmt::print(stderr, "{}", to_string(d));
  if (!session) fail("nothing to follow");
  Arrivals arrivals;
  session->set_tap([&](const AxisSample& sample) { arrivals.note(sample); });
  SceneMailbox mailbox;
  CommandQueue commands;
  LiveViewOptions view_options;
  view_options.blank_mm = session->stock()->bounds_mm();
  view_options.tools = session->tool_sources();
  Nobody nobody;
  LiveView view(std::move(view_options), nobody, mailbox, commands);
  session->set_observer(&view);
  Screen screen(mailbox, arguments.local);
  std::jthread thread([&](const std::stop_token& stop) { session->run(stop, diagnostics); });
  std::vector<double> age_ms, frame_ms;
  const Clock::time_point begin = Clock::now();
  bool warm = false;
  while (ms_since(begin) < 1e3 * (arguments.seconds + 2)) {
    const Clock::time_point start = Clock::now();
    if (screen.turn()) {
      if (warm) frame_ms.push_back(ms_since(start));
      if (screen.moment()) arrivals.take_shown(screen.moment()->time_s, age_ms);
    }
    // The first picture of a whole blank is not what is measured.
    if (!warm && ms_since(begin) > 2e3) {
      warm = true;
      commands.push(DetailCommand{screen.detail_mm()});
      age_ms.clear();
    }
    std::this_thread::sleep_until(start + std::chrono::duration_cast<Clock::duration>(
                                              std::chrono::duration<double>(1 / kFramesPerS)));
  }
  thread.request_stop();
  thread.join();
  screen.settle([] { return true; });
  screen.check();
  fmt::print(
      "follow {:g} positions/s: position to drawn frame {} ({} positions); {:.1f} frames/s, frame "
      "{}; dropped {}; load average {}\n",
      rate_hz, spread(age_ms), age_ms.size(),
      static_cast<double>(frame_ms.size()) / arguments.seconds, spread(frame_ms),
      session->report().live ? session->report().live->dropped : 0, load_average());
}

int run(const Arguments& arguments) {
  if (!std::filesystem::exists(arguments.program)) {
    fail(arguments.program + " is not there (Debian package linuxcnc-uspace has it)");
  }
  const Result<GlContext> context = GlContext::create_offscreen();
  if (!context) fail(context.error());
  fmt::print("{}\n", SceneRenderer::gl_name());
  const bool good = play(arguments);
  for (const double rate_hz : {100.0, 500.0}) follow(arguments, rate_hz);
  fmt::print("60 frames/s, p99 within {:g} ms while playing: {}\n", kMostStall_ms,
             good ? "good" : "BAD");
  return good ? 0 : 1;
}

Arguments understand(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; i += 2) {
    const std::string_view name = argv[i];
    if (i + 1 == argc) fail(fmt::format("{} lacks its value", name));
    const char* const value = argv[i + 1];
    if (name == "--program") {
      arguments.program = value;
    } else if (name == "--stock") {
      arguments.stock = value;
    } else if (name == "--tool") {
      arguments.tool = value;
    } else if (name == "--cells") {
      arguments.cells = std::max(10, std::atoi(value));
    } else if (name == "--speed") {
      arguments.speed = std::max(0.1, std::atof(value));
    } else if (name == "--seconds") {
      arguments.seconds = std::max(1.0, std::atof(value));
    } else if (name == "--full-redraw") {
      arguments.local = std::string_view(value) != "on";
    } else {
      fail(fmt::format("{} is not known", name));
    }
  }
  return arguments;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) { return kerf::run(kerf::understand(argc, argv)); }
