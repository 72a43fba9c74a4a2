// bench_view: the picture of a program while it is cut, and of a machine while it is watched, with
// all threads that the window has, by the software renderer and without a window.
//
//   bench_view [--program FILE] [--stock SPEC] [--tool N=SHAPE] [--cells N] [--speed X]
//              [--seconds N] [--from S] [--full-redraw on|off] [--follow on|off]
//
// Without a program: w1, LinuxCNC's 3D_Chips.ngc, where linuxcnc-uspace has it. First goes through
// it in steps of a sixtieth of a second at `speed` times its own time, from `S` seconds of it on
// and for at most N seconds of such film, and draws each: processor time a frame of the threads
// that share the work, which depends little on what else the machine does. Then plays it at that
// speed, drawing 1280x800 pixels at most 60 times a second: frames a second, how long drawing took
// (p50, p99, longest), patches, memory, processor time. Afterwards the picture is compared with one
// that is drawn anew: a wrong one ends the run. Then follows a machine that goes round and round at
// 100 and 500 positions a second: time from a position's arrival to the end of the first draw that
// shows it or a later one. Ends with 1 if playing missed kFramesPerS or kMostStall_ms.
#include <fmt/format.h>
#include <sys/prctl.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
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
#include "twin/scene/live_view.h"
#include "twin/scene/player_view.h"
#include "viewer/gl_context.h"
#include "viewer/orbit_camera.h"
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
  double from_s = 0;  ///< of the program
  bool local = true;
  bool follow = true;
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

/// New threads take over the name of the one that starts them.
void name_thread(const char* name) { prctl(PR_SET_NAME, name); }

/// Processor time that the threads of this program have had, by their names, in ms. The software
/// renderer's are called llvmpipe-0, -1, ... and count together.
std::map<std::string, double> processor_ms() {
  std::map<std::string, double> by_name;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream name_file(thread.path() / "comm"), time_file(thread.path() / "schedstat");
    std::string name;
    double ns = 0;
    if (!(name_file >> name) || !(time_file >> ns)) continue;
    by_name[name.substr(0, name.find('-'))] += ns / 1e6;
  }
  return by_name;
}

/// What was used since `before`, for each of `frames`.
std::string processor_use(const std::map<std::string, double>& before, double frames) {
  std::string text;
  double sum_ms = 0;
  for (const auto& [name, ms] : processor_ms()) {
    const auto known = before.find(name);
    const double used_ms = (ms - (known == before.end() ? 0 : known->second)) / frames;
    sum_ms += used_ms;
    if (used_ms >= 0.01) text += fmt::format(", {} {:.2f} ms", name, used_ms);
  }
  return fmt::format("{:.2f} ms{}", sum_ms, text);
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
    if (update) apply(*update);
    draw(options_);
    return true;
  }

  /// One frame of all that comes until `complete` and a while after.
  void collect(const std::function<bool()>& complete) {
    for (int quiet = 0; quiet < 4;) {
      const std::unique_ptr<SceneUpdate> update = mailbox_.take();
      if (update) apply(*update);
      quiet = update || !complete() ? 0 : quiet + 1;
      std::this_thread::sleep_for(std::chrono::milliseconds(4));
    }
    draw(options_);
  }

  /// As the window asks for it.
  DetailCommand detail() const {
    return {camera_.detail(kSize).times(SceneRenderer::detail_px()),
            SceneRenderer::easy_triangles()};
  }

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
  void apply(const SceneUpdate& update) {
    patches_ += update.patches.size();
    if (update.moment) moment_ = update.moment;
    renderer_.apply(update);
    if (update.setup) camera_.fit(renderer_.fit_box(), kSize);
  }

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
      make_stock(*options.blank, StockChoice{}, options.stock, "--stock", diagnostics, outcome);
  if (!setup.stock) fail("no blank");
  const Vec3 size = setup.stock->bounds_mm().size();
  return std::max(size.x, size.y) / arguments.cells;
}

/// The program before its start, in the window, with all the threads that it has there.
class Stage {
 public:
  explicit Stage(const Arguments& arguments) {
    SessionOptions options = session_of(arguments);
    options.stock.cell_mm = cell_mm_of(arguments);
    Diagnostics diagnostics;
    Outcome outcome = Outcome::kFailed;
    std::unique_ptr<LoadedProgram> loaded = load_program(options, {}, diagnostics, outcome);
    for (const Diagnostic& d : diagnostics) fmt::print(stderr, "{}", to_string(d));
    if (!loaded || loaded->player.track->empty()) fail("nothing to play");
    loaded->player.blank->keep_cut_ids(true);
    begin_s_ = loaded->player.track->start_s(0);
    duration_s_ = loaded->player.track->duration_s();
    ViewedProgram shown = viewed_program(*loaded, "bench");
    name_thread("player");
    view_.emplace(std::move(loaded->player), PlayerOptions{}, std::move(shown), mailbox_,
                  commands_);
    name_thread("window");
    screen_.emplace(mailbox_, arguments.local);
    thread_ = std::jthread([this](const std::stop_token& stop) {
      name_thread("patches");
      view_->run(stop);
    });
    screen_->settle([this] { return moment() != nullptr; });
    send(screen_->detail());
    screen_->settle([this] { return moment() != nullptr; });
    screen_->reset();
  }
  ~Stage() {
    if (thread_.joinable()) close();
  }

  void send(ViewerCommand command) { commands_.push(std::move(command)); }
  void close() {
    send(CloseCommand{});
    thread_.join();
  }
  Screen& screen() { return *screen_; }
  /// As the window's thread sleeps.
  void wait_for_news(std::chrono::duration<double> longest) {
    std::unique_lock lock(news_mutex_);
    news_come_.wait_for(lock, longest, [this] { return mailbox_.is_full(); });
  }
  const Moment* moment() const { return screen_->moment(); }
  /// A tool change may come before the first motion: earlier than that nothing is shown.
  bool is_at(double time_s) const {
    return std::abs(moment()->time_s - std::max(time_s, begin_s_)) < 1e-6;
  }
  void seek(double time_s) {
    send(SeekTimeCommand{time_s});
    screen_->settle([this, time_s] { return is_at(time_s); });
  }
  bool is_behind() { return view_->player().state()->behind; }
  double duration_s() const { return duration_s_; }

 private:
  std::mutex news_mutex_;
  std::condition_variable news_come_;
  SceneMailbox mailbox_{[this] {
    { const std::lock_guard lock(news_mutex_); }
    news_come_.notify_one();
  }};
  CommandQueue commands_;
  double begin_s_ = 0, duration_s_ = 0;
  std::optional<PlayerView> view_;
  std::optional<Screen> screen_;
  std::jthread thread_;
};

void print_work(const DrawCounters& counters, const std::string& used) {
  const double locals = static_cast<double>(std::max<std::uint64_t>(1, counters.local.frames));
  fmt::print(
      "  a local frame: {:.0f} pixels of {}, {:.0f} triangles, {:.0f} KB uploaded\n"
      "  processor time a frame: {}\n",
      static_cast<double>(counters.local.pixels) / locals, kSize.x * kSize.y,
      static_cast<double>(counters.local.triangles) / locals,
      static_cast<double>(counters.uploaded_bytes) / 1e3 / locals, used);
}

/// True if it was as good as asked for.
bool play(const Arguments& arguments) {
  Stage stage(arguments);
  Screen& screen = stage.screen();
  if (arguments.from_s > 0) stage.seek(arguments.from_s);
  const double from_s = stage.moment()->time_s;
  screen.reset();
  const std::map<std::string, double> processor_before = processor_ms();
  stage.send(SpeedCommand{arguments.speed});
  stage.send(PlayCommand{});
  std::vector<double> frame_ms;
  const Clock::time_point begin = Clock::now();
  double seconds = 0;
  std::size_t behind = 0;
  for (std::uint64_t tick = 0; seconds < arguments.seconds;) {
    std::this_thread::sleep_until(
        begin + std::chrono::duration_cast<Clock::duration>(
                    std::chrono::duration<double>(static_cast<double>(tick) / kFramesPerS)));
    stage.wait_for_news(std::chrono::duration<double>(1 / kFramesPerS));
    const Clock::time_point start = Clock::now();
    if (screen.turn()) frame_ms.push_back(ms_since(start));
    // A frame that took longer than its time delays those after it; they are not made up for.
    seconds = ms_since(begin) / 1e3;
    tick = std::max(tick + 1, static_cast<std::uint64_t>(seconds * kFramesPerS));
    if (stage.moment()->state == PlayState::kEnded) break;
    if (stage.is_behind()) ++behind;
  }
  const double played_s = stage.moment()->time_s;
  const DrawCounters counters = screen.counters();
  const std::string used =
      processor_use(processor_before, std::max(1.0, static_cast<double>(frame_ms.size())));
  const double patches_per_s = static_cast<double>(screen.patches()) / seconds;
  stage.send(PauseCommand{});
  screen.settle([&] { return stage.moment()->state != PlayState::kPlaying; });
  screen.check();
  stage.close();
  const double frames_per_s = static_cast<double>(frame_ms.size()) / seconds;
  fmt::print("play {}x, {} cells a side, {}: {:.1f} frames/s, frame {}\n", arguments.speed,
             arguments.cells, arguments.local ? "local" : "full redraw", frames_per_s,
             spread(frame_ms));
  fmt::print(
      "  {:.0f} s of {:.0f} s of the program in {:.1f} s ({:.1f}x); {:.0f} patches/s; frames: {} "
      "full, {} local, {} still; behind in {} frames; peak {:.0f} MB; load average {}\n",
      played_s - from_s, stage.duration_s(), seconds, (played_s - from_s) / seconds, patches_per_s,
      counters.full.frames, counters.local.frames, counters.still.frames, behind, peak_rss_mb(),
      load_average());
  print_work(counters, used);
  return frames_per_s >= kFramesPerS * kFrameSlack && p99(frame_ms) <= kMostStall_ms;
}

/// The same frames, however much else the machine has to do: each is waited for until all that has
/// changed by then is there to be drawn. What they cost says whether kFramesPerS can be reached.
void play_in_steps(const Arguments& arguments) {
  Stage stage(arguments);
  Screen& screen = stage.screen();
  // Checks that run ahead are done first, as they have nothing to do with drawing.
  stage.send(SeekEndCommand{});
  screen.settle([&] { return stage.moment()->state == PlayState::kEnded; });
  stage.seek(arguments.from_s);
  screen.reset();
  const std::map<std::string, double> processor_before = processor_ms();
  const double step_s = arguments.speed / kFramesPerS;
  const double until_s =
      std::min(stage.duration_s(), arguments.from_s + step_s * kFramesPerS * arguments.seconds);
  std::size_t frames = 0;
  for (double at_s = arguments.from_s + step_s; at_s < until_s; at_s += step_s, ++frames) {
    stage.send(SeekTimeCommand{at_s});
    screen.collect([&] { return stage.is_at(at_s); });
  }
  if (frames == 0) fail("the program is over by then");
  const std::string used = processor_use(processor_before, static_cast<double>(frames));
  const DrawCounters counters = screen.counters();
  const std::size_t patches = screen.patches();
  screen.check();
  stage.close();
  fmt::print("play in {} steps of 1/{:g} s at {}x: {:.1f} patches a frame\n", frames, kFramesPerS,
             arguments.speed, static_cast<double>(patches) / static_cast<double>(frames));
  print_work(counters, used);
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
  session->set_tap([&](const TappedSample& tapped) { arrivals.note(tapped.sample); });
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
      commands.push(screen.detail());
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
  play_in_steps(arguments);
  const bool good = play(arguments);
  for (const double rate_hz : {100.0, 500.0}) {
    if (arguments.follow) follow(arguments, rate_hz);
  }
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
    } else if (name == "--from") {
      arguments.from_s = std::max(0.0, std::atof(value));
    } else if (name == "--full-redraw") {
      arguments.local = std::string_view(value) != "on";
    } else if (name == "--follow") {
      arguments.follow = std::string_view(value) != "off";
    } else {
      fail(fmt::format("{} is not known", name));
    }
  }
  return arguments;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) { return kerf::run(kerf::understand(argc, argv)); }
