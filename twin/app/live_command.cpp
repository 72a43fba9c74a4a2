#include "twin/app/live_command.h"

#include <fmt/format.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <utility>

#include "base/atomic_file.h"
#include "machine_io/recorder.h"
#include "twin/app/console.h"
#include "twin/app/exit_code.h"
#include "twin/app/good_neighbour.h"
#include "twin/app/live_console.h"
#include "twin/app/stop_signals.h"
#include "twin/app/window_host.h"
#include "twin/config/make_source.h"
#include "twin/view/drawn_machine.h"
#include "twin/view/live_view.h"
#include "twin/view/player_scene.h"

namespace kerf {
namespace {

void print(const Diagnostics& diagnostics, bool quiet) {
  for (const Diagnostic& d : diagnostics) {
    if (!quiet || d.severity == Severity::kError) print_diagnostic(stderr, d);
  }
}

/// Bits of the positions that the source can have; all of them where that is seen later.
std::uint16_t positions_of(const ConfigSource& source) {
  const auto mask = [](const auto& axes) {
    std::uint16_t bits = 0;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      if (axes[i]) bits = static_cast<std::uint16_t>(bits | 1U << i);
    }
    return bits;
  };
  if (const auto* modbus = std::get_if<ModbusSettings>(&source)) return mask(modbus->axes);
  if (const auto* can = std::get_if<CanSourceOptions>(&source)) return mask(can->map.axes);
  return (1U << kMaxPositions) - 1;
}

Result<std::unique_ptr<Recorder>> start_recorder(const LiveRequest& request,
                                                 const PositionSource& source) {
  RecordingHead head;
  head.source = source.describe();
  head.kind = coordinates_of(request.config, source);
  head.frame = request.options.cutting.frame.workpiece_frame ? CoordinateFrame::kWorkpiece
                                                             : CoordinateFrame::kMachine;
  head.axes = positions_of(request.config.source);
  if (const auto* modbus = std::get_if<ModbusSettings>(&request.config.source)) {
    head.trigger = modbus->trigger.has_value();
  } else if (const auto* can = std::get_if<CanSourceOptions>(&request.config.source)) {
    head.trigger = can->map.trigger.has_value();
  }
  head.program = std::holds_alternative<HalSettings>(request.config.source);
  if (request.options.program) head.extra.emplace_back("program", request.options.program->path);
  if (!request.config.machine.joints.empty()) {
    head.extra.emplace_back("joints", request.config.machine.joints);
  }
  return Recorder::create(request.record, head);
}

/// The console, and the kerf.* pins of the LinuxCNC that is watched.
class HalObserver final : public LiveObserver {
 public:
  HalObserver(LiveObserver& console, HalSource& hal) : console_(console), hal_(hal) {}
  void on_status(const LiveStatus& status) override {
    console_.on_status(status);
    HalStatus pins;
    pins.collision_ahead = status.collision_in_s >= 0;
    if (pins.collision_ahead) {
      pins.collision_seconds = status.collision_in_s;
      pins.finding_line = static_cast<std::int32_t>(status.collision_line);
    }
    pins.off_path = status.off_path_mm > 0;
    pins.off_path_mm = status.off_path_mm;
    pins.stale = status.state != LiveState::kLive;
    hal_.show(pins);
  }
  void on_finding(const Finding& finding, const std::vector<std::string>& files) override {
    console_.on_finding(finding, files);
  }
  void on_warning(const AheadWarning& warning, const std::vector<std::string>& files) override {
    console_.on_warning(warning, files);
  }
  void on_run(const LiveRun& run) override { console_.on_run(run); }

 private:
  LiveObserver& console_;
  HalSource& hal_;
};

/// The event stream: "-" is standard output, a file appears at once and grows.
struct EventFile {
  explicit EventFile(const std::string& path) {
    if (path.empty()) return;
    file = path == "-" ? stdout : std::fopen(path.c_str(), "we");
    if (!file) error = errno;
  }
  ~EventFile() {
    if (file && file != stdout) std::fclose(file);
  }
  EventFile(const EventFile&) = delete;
  EventFile& operator=(const EventFile&) = delete;
  std::FILE* file = nullptr;
  int error = 0;
};

Diagnostic fault(std::string message) {
  Diagnostic d;
  d.message = std::move(message);
  return d;
}

int exit_code(Outcome outcome, const Report& report, const Diagnostics& diagnostics) {
  if (outcome == Outcome::kUsageError) return kExitUsage;
  const bool finished = outcome == Outcome::kFinished || outcome == Outcome::kLossy;
  if (!finished || has_error(diagnostics)) return kExitFailure;
  if (outcome == Outcome::kLossy) return kExitLossy;
  return report.findings.count(Severity::kError) > 0 ? kExitFindings : kExitGood;
}

/// The recorder and the log say what they have met.
void close_sources(Recorder* recorder, const PositionSource* log, const std::string& path,
                   Diagnostics& diagnostics) {
  if (recorder) {
    const RecorderStatus recorded = recorder->finish();
    if (!recorded.trouble.empty()) {
      diagnostics.push_back(fault(recorded.trouble));
    } else if (recorded.lost > 0) {
      Diagnostic d = fault(fmt::format(
          "recording {}: {} samples were dropped: the disk is too slow", path, recorded.lost));
      d.severity = Severity::kWarning;
      diagnostics.push_back(std::move(d));
    }
  }
  if (const auto* source = dynamic_cast<const LogSource*>(log)) {
    diagnostics.insert(diagnostics.end(), source->notes().begin(), source->notes().end());
  }
}

/// The path, text and times of the program beside the machine. What is wrong with it, the session
/// says.
std::unique_ptr<LiveProgram> load_live_program(const LiveRequest& request, std::stop_token stop) {
  SessionOptions options;
  options.program = *request.options.program;
  options.tools = request.options.tools;
  options.blank = request.options.blank;
  options.stock = request.options.stock;
  options.timeline = request.options.cutting.timeline;
  LoadControl control;
  control.stop = std::move(stop);
  Diagnostics ignored;
  Outcome outcome = Outcome::kFailed;
  const std::unique_ptr<LoadedProgram> loaded = load_program(options, control, ignored, outcome);
  if (!loaded) return nullptr;
  const ViewedProgram shown = viewed_program(*loaded, {});
  auto program = std::make_unique<LiveProgram>();
  program->track = loaded->player.track;
  program->files = shown.files;
  program->tools = shown.tools;
  return program;
}

/// A window for what a session shows. Declared before the session, so that it ends after it.
struct LiveWindow {
  SceneMailbox mailbox{Window::wake};
  CommandQueue commands;
  /// The display is gone: the user has not closed the window.
  std::atomic<bool> lost{false};
};

LiveViewOptions view_options(const LiveRequest& request, LiveSession& session,
                             std::stop_source stop, const LiveWindow& window) {
  LiveViewOptions options;
  const std::string& program =
      request.options.program ? request.options.program->path : std::string();
  options.source_name = session.source_name();
  options.title =
      program.empty() ? options.source_name : std::filesystem::path(program).filename().string();
  options.blank_mm = session.stock()->bounds_mm();
  options.blank_outline = box_outline(options.blank_mm);
  options.stock = session.stock()->snapshot();
  options.tools = session.tool_sources();
  WorkRoom room;
  room.frame = request.options.cutting.frame.work;
  room.blank_mm = options.blank_mm;
  Diagnostics diagnostics;
  options.machine = drawn_machine(request.config.machine.drawn, request.ini, room, diagnostics);
  print(diagnostics, request.quiet);
  options.log = request.options.log();
  options.speed = options.log ? request.options.speed : 1.0;
  options.on_close = [stop, &window]() mutable {
    if (!window.lost) stop.request_stop();
  };
  if (options.log) options.on_speed = [&session](double speed) { session.set_speed(speed); };
  if (!program.empty() && program != "-") {
    options.load_program = [&request](std::stop_token token) {
      return load_live_program(request, std::move(token));
    };
  }
  return options;
}

int watch(LiveRequest& request, std::unique_ptr<PositionSource> source, std::stop_source& stop,
          LiveWindow* window) {
  Diagnostics diagnostics;
  Outcome outcome = Outcome::kFailed;
  PositionSource* const raw_source = source.get();
  std::unique_ptr<Recorder> recorder;
  EventFile events(request.events);
  if (events.error != 0) {
    diagnostics.push_back(
        fault(fmt::format("--events: {}: {}", request.events, std::strerror(events.error))));
  }
  choose_frame(request, *source, diagnostics);
  std::unique_ptr<LiveSession> session;
  if (!has_error(diagnostics)) {
    session = LiveSession::open(request.options, std::move(source), diagnostics, outcome);
  }
  if (session && !request.record.empty()) {
    auto started = start_recorder(request, *raw_source);
    if (started) {
      recorder = std::move(started.value());
      session->set_tap([&](const TappedSample& tapped) {
        if (tapped.lost > 0) recorder->note_lost(tapped.lost);
        if (tapped.clock_set_ns != 0) recorder->note_clock_set(tapped.clock_set_ns);
        recorder->record(tapped.sample);
      });
    } else {
      diagnostics.push_back(fault(started.error()));
      session.reset();
    }
  }
  print(diagnostics, request.quiet);
  if (!session) return exit_code(outcome, Report{}, diagnostics);
  diagnostics.clear();
  CpuBudget budget(request.cpu_limit_percent);
  session->set_rest([&] { return budget.rest(); });
  LiveConsole console(request.quiet, events.file);
  if (recorder) console.watch(*recorder);
  std::optional<HalObserver> pins;
  if (auto* hal = dynamic_cast<HalSource*>(raw_source)) pins.emplace(console, *hal);
  LiveObserver* observer = pins ? static_cast<LiveObserver*>(&*pins) : &console;
  std::optional<LiveView> view;
  if (window) {
    session->keep_cut_ids();
    view.emplace(view_options(request, *session, stop, *window), *observer, window->mailbox,
                 window->commands);
    observer = &*view;
  }
  session->set_observer(observer);
  outcome = session->run(stop.get_token(), diagnostics);
  close_sources(recorder.get(), raw_source, request.record, diagnostics);
  if (console.events_error() != 0) {
    diagnostics.push_back(fault(
        fmt::format("--events: {}: {}", request.events, std::strerror(console.events_error()))));
  }
  write_outputs(request.outputs, request.mesh_tolerance_mm, session->stock(), session->report(),
                diagnostics);
  if (console.unprinted() > 0) {
    kerf::print(stderr, "kerf: note: {} more findings; --json FILE lists them\n",
                console.unprinted());
  }
  if (!request.quiet) {
    const bool stdout_taken = request.outputs.uses_stdout() || request.events == "-";
    print_lengths(stdout_taken ? stderr : stdout, summary_text(session->report()));
  }
  flush_console();
  print(diagnostics, request.quiet);
  // What it came to may be looked at until the window is closed.
  if (view && !stop.stop_requested()) {
    view->end(session->stock(), session->cut_labels(), stop.get_token());
  }
  return exit_code(outcome, session->report(), diagnostics);
}

/// With a window, if one is wanted and there is a display; without one a machine is watched and a
/// log replayed, too, unless the window is all that was asked for.
int watch_in_window(LiveRequest& request, std::unique_ptr<PositionSource> source,
                    std::stop_source& stop) {
  const bool may_try = has_display() || request.needs_window;
  if (!request.window || !may_try) return watch(request, std::move(source), stop, nullptr);
  LiveWindow window;
  const auto go_on = [&](const std::string& reason) {
    Diagnostic d = fault(fmt::format("{}; going on without a window", reason));
    d.severity = Severity::kWarning;
    d.hint = "--no-view does not try one";
    print({d}, request.quiet);
  };
  WindowOptions options;
  options.road = request.draw;
  const Result<int> code = work_beside_window(
      options, window.mailbox, window.commands, stop,
      [&] { return watch(request, std::move(source), stop, &window); },
      [&](const std::string& reason) {
        window.lost = true;
        go_on(reason);
      });
  if (code) return *code;
  if (request.needs_window) {
    Diagnostic d = fault(code.error());
    d.hint = "kerf replay LOG needs no window; with --png FILE it draws what the log leaves";
    print({d}, false);
    return kExitFailure;
  }
  go_on(code.error());
  return watch(request, std::move(source), stop, nullptr);
}

}  // namespace

int live_command(const LiveArguments& arguments, LiveCommand command) {
  Diagnostics diagnostics;
  LiveRequest request = understand_live(arguments, command, diagnostics);
  show_lengths_in(request.units);
  if (has_error(diagnostics)) {
    print(diagnostics, false);
    return kExitUsage;
  }
  check_output_places(request.outputs, diagnostics);
  if (request.window && (has_display() || request.needs_window)) {
    check_shapes(request.config.machine.drawn, diagnostics);
  }
  if (command == LiveCommand::kShadow) {
    for (const std::string& refused : make_room()) {
      Diagnostic d = fault(refused);
      d.severity = Severity::kWarning;
      diagnostics.push_back(std::move(d));
    }
  }
  if (request.memory_limit_mb > 0 && !limit_memory(request.memory_limit_mb)) {
    diagnostics.push_back(fault(fmt::format("--memory-limit: {}", std::strerror(errno))));
  }
  std::stop_source stop;
  const StopSignals signals(stop, [] { remove_uncommitted_files(); });
  std::unique_ptr<PositionSource> source;
  if (!has_error(diagnostics)) source = make_source(request.config, diagnostics);
  print(diagnostics, request.quiet);
  const bool none_named = std::holds_alternative<std::monostate>(request.config.source);
  if (!source) return none_named ? kExitUsage : kExitFailure;
  return watch_in_window(request, std::move(source), stop);
}

}  // namespace kerf
