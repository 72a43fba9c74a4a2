#include "twin/cli/live_command.h"

#include <fmt/format.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <utility>

#include "base/atomic_file.h"
#include "base/exit_code.h"
#include "base/translate.h"
#include "machine_io/recorder.h"
#include "twin/cli/borrowed_source.h"
#include "twin/cli/console.h"
#include "twin/cli/finding_shots.h"
#include "twin/cli/live_console.h"
#include "twin/cli/live_window.h"
#include "twin/cli/page_output.h"
#include "twin/cli/scheduling.h"
#include "twin/cli/screen_program.h"
#include "twin/cli/served_page.h"
#include "twin/cli/stop_signals.h"
#include "twin/cli/window_host.h"
#include "twin/config/agent_machine.h"
#include "twin/config/make_source.h"
#include "twin/serve/live_broadcast.h"

namespace kerf {
namespace {

using LiveClock = std::chrono::steady_clock;

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
  head.load = load_unit_of(request.config, source);
  head.program = std::holds_alternative<HalSettings>(request.config.source) ||
                 std::holds_alternative<MtconnectSettings>(request.config.source);
  if (request.options.program) head.extra.emplace_back("program", request.options.program->path);
  if (!request.config.machine.joints.empty()) {
    head.extra.emplace_back("joints", request.config.machine.joints);
  }
  return Recorder::create(request.record, head);
}

/// The console, and the kerf.* pins of the LinuxCNC that is watched.
class HalObserver final : public LiveObserver {
 public:
  /// `loaded`: null where the program that LinuxCNC has loaded is not followed. `program`: that of
  /// this session; empty: none.
  HalObserver(LiveObserver& console, HalSource& hal, const ScreenProgram* loaded,
              std::string program, bool is_quiet)
      : console_(console),
        hal_(hal),
        loaded_(loaded),
        program_(std::move(program)),
        is_quiet_(is_quiet) {}
  /// Who gets the findings of the dry run, and a line about it.
  void tell_to(LiveObserver* all, LiveView* view) {
    all_ = all;
    view_ = view;
  }
  void on_status(const LiveStatus& status) override {
    console_.on_status(status);
    HalStatus pins;
    show_loaded(status, pins);
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
  void show_loaded(const LiveStatus& status, HalStatus& pins) {
    if (status.remaining_s >= 0) pins.time_left_s = status.remaining_s;
    if (loaded_ == nullptr) return;
    const ScreenProgramState state = loaded_->state();
    if (!state.result || state.program.empty()) return;
    const DryRunResult& result = *state.result;
    const bool is_followed = state.program == program_;
    if (state.number != told_ && (is_followed || program_.empty())) {
      told_ = state.number;
      tell(result);
    }
    if (!is_followed || !result.is_done) return;
    pins.program_ok = result.is_good() && status.state == LiveState::kLive;
    pins.findings = result.errors + result.warnings;
    if (pins.time_left_s < 0) pins.time_left_s = result.duration_s;
  }
  void tell(const DryRunResult& result) {
    const std::string line = line_of(result);
    if (!is_quiet_) {
      print_text(stderr, trf("kerf: {}\n", line));
      flush_console();
    }
    if (view_ != nullptr) view_->tell(line);
    for (const Finding& finding : result.findings) all_->on_finding(finding, {});
  }

  LiveObserver& console_;
  HalSource& hal_;
  const ScreenProgram* loaded_;
  const std::string program_;
  const bool is_quiet_;
  LiveObserver* all_ = this;
  LiveView* view_ = nullptr;
  std::uint32_t told_ = 0;  ///< ScreenProgramState::number
};

/// What goes on from one session to the next.
struct Surroundings {
  LiveWindow* window = nullptr;           ///< null: one session, without a window
  HalSource* hal = nullptr;               ///< of a LinuxCNC: where the pins are
  const ScreenProgram* loaded = nullptr;  ///< null: not followed
  ServedScene* served = nullptr;          ///< null: no page is served
  bool is_first = true;                   ///< of the sessions
  bool has_begun = false;                 ///< out: it could be watched
};

/// The event stream: "-" is standard output, a file appears at once and grows.
struct EventFile {
  EventFile(const std::string& path, bool is_new) {
    if (path.empty()) return;
    file = path == "-" ? stdout : std::fopen(path.c_str(), is_new ? "we" : "ae");
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
      Diagnostic d = fault(
          trf("recording {}: {} samples were dropped: the disk is too slow", path, recorded.lost));
      d.severity = Severity::kWarning;
      diagnostics.push_back(std::move(d));
    }
  }
  if (const auto* source = dynamic_cast<const LogSource*>(log)) {
    diagnostics.insert(diagnostics.end(), source->notes().begin(), source->notes().end());
  }
}

int watch(LiveRequest& request, std::unique_ptr<PositionSource> source, std::stop_source& stop,
          Surroundings& around) {
  around.has_begun = false;
  LiveWindow* const window = around.window;
  const bool is_shown = window != nullptr && window->is_shown();
  Diagnostics diagnostics;
  Outcome outcome = Outcome::kFailed;
  PositionSource* const raw_source = source.get();
  std::unique_ptr<Recorder> recorder;
  EventFile events(request.events, std::exchange(around.is_first, false));
  if (events.error != 0) {
    diagnostics.push_back(
        fault(fmt::format("--events: {}: {}", request.events, std::strerror(events.error))));
  }
  choose_frame(request, *source, diagnostics);
  if (!check_load(request, *source, diagnostics)) outcome = Outcome::kUsageError;
  const std::shared_ptr<const DesignFile> design = open_design(request.compare, diagnostics);
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
  print_diagnostics(diagnostics, request.quiet);
  if (!session) return exit_code(outcome, Report{}, diagnostics);
  around.has_begun = true;
  diagnostics.clear();
  CpuBudget budget(request.cpu_limit_percent);
  session->set_rest([&] { return budget.rest(); });
  LiveConsole console(request.quiet, events.file);
  if (recorder) console.watch(*recorder);
  std::optional<HalObserver> pins;
  if (around.hal != nullptr) {
    pins.emplace(console, *around.hal, around.loaded,
                 request.options.program ? request.options.program->path : std::string(),
                 request.quiet);
  }
  LiveObserver* observer = pins ? static_cast<LiveObserver*>(&*pins) : &console;
  std::optional<FindingShots> shots;
  if (!request.finding_png.empty()) {
    observer = &shots.emplace(*session, machine_beside(request, *session, diagnostics), *observer);
    print_diagnostics(diagnostics, request.quiet);
    diagnostics.clear();
  }
  std::optional<LiveView> view;
  std::optional<std::jthread> inputs;
  if (is_shown || design || request.outputs.wants_page()) session->keep_cut_ids();
  if (is_shown) {
    view.emplace(window->view_options(request, *session, stop), *observer, window->mailbox(),
                 window->commands());
    observer = &*view;
    inputs.emplace(window->watch_inputs(request, *view, stop));
  }
  std::optional<LiveBroadcast> broadcast;
  if (around.served != nullptr) {
    observer = &broadcast.emplace(broadcast_options(request, *session), shown_unit(),
                                  session->tool_sources(), *observer, *around.served);
  }
  if (pins) pins->tell_to(observer, view ? &*view : nullptr);
  session->set_observer(observer);
  outcome = session->run(stop.get_token(), diagnostics);
  if (broadcast) broadcast->end(session->stock());
  // What was cut of a log whose round is over is nothing to be reported.
  if (window && window->is_over()) return kExitGood;
  close_sources(recorder.get(), raw_source, request.record, diagnostics);
  if (console.events_error() != 0) {
    diagnostics.push_back(fault(
        fmt::format("--events: {}: {}", request.events, std::strerror(console.events_error()))));
  }
  Compared compared;
  if (design) {
    compared = compare_finished(request.compare, *design, session->stock(),
                                {session->cut_labels(), nullptr}, session->report(), diagnostics);
  }
  write_pages(request.outputs, session->report(), session->stock(),
              {session->cut_labels(), nullptr, {}, request.units, compared.of_workpiece().get()},
              diagnostics);
  write_outputs(request.outputs, request.mesh_tolerance_mm, session->stock(), session->collisions(),
                session->report(), diagnostics, nullptr, compared);
  const ListedProgram listed = listed_program(session->report());
  write_finding_lists(request.outputs, {&listed, 1}, diagnostics);
  if (shots) {
    shots->write(request.finding_png, session->collisions(), diagnostics);
  }
  if (console.unprinted() > 0) {
    print_text(stderr,
               trf("kerf: note: {} more findings; --json FILE lists them\n", console.unprinted()));
  }
  if (!request.quiet) {
    const bool tells_id = request.tab && !request.tab->parent;
    const bool stdout_taken = request.outputs.uses_stdout() || request.events == "-" || tells_id;
    print_lengths(stdout_taken ? stderr : stdout, summary_text(session->report()));
  }
  flush_console();
  print_diagnostics(diagnostics, request.quiet);
  // What it came to may be looked at until the window is closed.
  if (view && !stop.stop_requested()) {
    view->end(session->stock(), session->cut_labels(), stop.get_token());
  }
  return exit_code(outcome, session->report(), diagnostics);
}

/// Until the next round begins, or somebody stops: the pins say that nothing is vouched for.
int wait_for_program(SharedSource& shared, const Surroundings& around, double for_s, bool is_quiet,
                     std::stop_source& stop) {
  const LiveClock::time_point begun = LiveClock::now();
  std::uint32_t told = 0;
  const std::string waiting = tr("waiting for a program: LinuxCNC has loaded none");
  const auto tell = [&](const std::string& line) {
    if (!is_quiet) print_text(stderr, trf("kerf: {}\n", line));
    flush_console();
    SceneUpdate update;
    auto moment = std::make_shared<Moment>();
    moment->notice = line;
    update.moment = std::move(moment);
    around.window->mailbox().publish(std::move(update));
    if (around.served != nullptr) {
      around.served->set_state(state_members(waiting_moment(line)));
      around.served->publish();
    }
  };
  if (around.loaded->state().program.empty()) tell(waiting);
  around.window->publish_job();
  while (!stop.stop_requested()) {
    const double passed_s = std::chrono::duration<double>(LiveClock::now() - begun).count();
    if (for_s > 0 && passed_s > for_s) break;
    AxisSample sample;
    BorrowedSource(shared).next(sample, std::chrono::milliseconds(100));
    HalStatus pins;
    pins.stale = true;
    around.hal->show(pins);
    const ScreenProgramState state = around.loaded->state();
    if (state.result && std::exchange(told, state.number) != state.number) {
      tell(line_of(*state.result));
    }
    for (const ViewerCommand& command : around.window->commands().take()) {
      if (std::holds_alternative<CloseCommand>(command) && !around.window->lost) {
        stop.request_stop();
      }
      if (const auto* const job = std::get_if<JobCommand>(&command)) {
        if (const std::string said = around.window->set_up(*job); !said.empty()) tell(said);
      }
    }
  }
  return kExitGood;
}

/// Round after round, as the window asks for them, or LinuxCNC loads programs.
int watch_rounds(LiveRequest& request, std::unique_ptr<PositionSource> source,
                 std::stop_source& stop, LiveWindow& window, ServedScene* served) {
  const LiveClock::time_point begun = LiveClock::now();
  const double for_s = request.options.for_s;
  // Its pins stay, whatever is linked to them.
  std::optional<SharedSource> shared;
  std::optional<ScreenProgram> loaded;
  Surroundings around;
  around.window = &window;
  around.served = served;
  around.hal = dynamic_cast<HalSource*>(source.get());
  if (around.hal != nullptr) {
    shared.emplace(std::move(source));
    source = std::make_unique<BorrowedSource>(*shared);
  }
  if (shared && !request.kerf_status.empty()) {
    loaded.emplace(
        request.kerf_status, request.nml_file,
        [&window](const std::string& program) { return window.options_of(program); },
        [&shared] { return shared->is_running.load(); },
        [&window](const std::string& program) { return window.follow(program); });
    around.loaded = &*loaded;
    window.edit_setups([&loaded] { loaded->look_again(); });
  }
  while (true) {
    int code = kExitGood;
    {
      std::stop_source round;
      const std::stop_callback ends(stop.get_token(), [&round] { round.request_stop(); });
      window.begin_round(round);
      // Without a program and a blank there is nothing to be watched yet.
      const bool has_work = !loaded || request.options.program || request.options.blank;
      if (has_work) code = watch(request, std::move(source), round, around);
      // Nor is there along a program that cannot be followed, until another one comes.
      if (loaded && !(has_work && around.has_begun)) {
        code = wait_for_program(*shared, around, for_s, request.quiet, round);
      }
    }
    std::optional<LiveRequest> next = window.take_next();
    if (!next || stop.stop_requested()) return code;
    Diagnostics diagnostics;
    request = std::move(*next);
    if (for_s > 0) {
      const double left_s = for_s - std::chrono::duration<double>(LiveClock::now() - begun).count();
      if (left_s <= 0) return code;
      request.options.for_s = left_s;
    }
    source = shared ? std::make_unique<BorrowedSource>(*shared)
                    : make_source(request.config, diagnostics);
    print_diagnostics(diagnostics, request.quiet);
    if (!source) return kExitFailure;
  }
}

/// Without a window: in rounds where LinuxCNC's programs are followed.
int watch_unseen(const Arguments& arguments, LiveRequest& request,
                 std::unique_ptr<PositionSource> source, std::stop_source& stop,
                 ServedScene* served) {
  if (request.kerf_status.empty()) {
    HalSource* const hal = dynamic_cast<HalSource*>(source.get());
    Surroundings around;
    around.hal = hal;
    around.served = served;
    return watch(request, std::move(source), stop, around);
  }
  SceneMailbox mailbox;
  CommandQueue commands;
  LiveWindow rounds(mailbox, commands, arguments, false);
  return watch_rounds(request, std::move(source), stop, rounds, served);
}

/// With a window, if one is wanted and there is a display; without one a machine is watched and a
/// log replayed, too, unless the window is all that was asked for.
int watch_in_window(const Arguments& arguments, LiveRequest& request,
                    std::unique_ptr<PositionSource> source, std::stop_source& stop,
                    ServedScene* served) {
  const bool may_try = has_display() || request.needs_window;
  if (!request.window || !may_try) {
    return watch_unseen(arguments, request, std::move(source), stop, served);
  }
  SceneMailbox mailbox(Window::wake);
  CommandQueue commands;
  LiveWindow window(mailbox, commands, arguments);
  const bool quiet = request.quiet;
  const auto go_on = [quiet](const std::string& reason) {
    Diagnostic d = fault(trf("{}; going on without a window", reason));
    d.severity = Severity::kWarning;
    d.hint = tr("--no-view does not try one");
    print_diagnostics({d}, quiet);
  };
  WindowOptions options;
  options.draw_mode = request.draw;
  if (request.units != LengthUnit::kMm) options.units = request.units;
  options.embed_in = request.embed_in;
  const Result<int> code = work_beside_window(
      options, mailbox, commands, stop,
      [&] { return watch_rounds(request, std::move(source), stop, window, served); },
      [&](const std::string& reason) {
        window.lost = true;
        go_on(reason);
      });
  if (code) return *code;
  if (request.needs_window) {
    Diagnostic d = fault(code.error());
    d.hint = tr("kerf replay LOG needs no window; with --png FILE it draws what the log leaves");
    print_diagnostics({d}, false);
    return kExitFailure;
  }
  go_on(code.error());
  return watch_unseen(arguments, request, std::move(source), stop, served);
}

int watch_as_asked(const Arguments& arguments, LiveRequest& request, Diagnostics diagnostics) {
  show_lengths_in(request.units);
  check_output_places(request.outputs, diagnostics);
  make_finding_folder(request.finding_png, diagnostics);
  if (request.window && (has_display() || request.needs_window)) {
    check_shapes(request.config.machine.drawn, diagnostics);
  }
  if (arguments.command == kShadow) {
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
  if (!has_error(diagnostics) && request.ini.empty()) {
    take_agent_machine(request.config, request.options.cutting.timeline, diagnostics);
  }
  if (!has_error(diagnostics)) source = make_source(request.config, diagnostics);
  print_diagnostics(diagnostics, request.quiet);
  const bool none_named = std::holds_alternative<std::monostate>(request.config.source);
  if (!source) return none_named ? kExitUsage : kExitFailure;
  std::optional<ServedPage> page;
  if (request.serve) {
    page.emplace();
    if (!open_and_tell(*page, *request.serve)) return kExitFailure;
  }
  return watch_in_window(arguments, request, std::move(source), stop,
                         page ? &page->scene() : nullptr);
}

/// In a tab of LinuxCNC's screen.
int watch_in_tab(const Arguments& arguments, LiveRequest& request, Diagnostics diagnostics) {
  Result<ScreenTab> tab = ScreenTab::open(request.tab->parent);
  if (!tab) {
    Diagnostic d =
        fault(fmt::format("{}: {}", request.tab->parent ? "--embed" : "--xid", tab.error()));
    d.hint = tr("--no-view watches without a window");
    print_diagnostics({d}, false);
    return kExitFailure;
  }
  request.embed_in = tab->id();
  if (!request.tab->parent) {
    kerf::print(stdout, "{}\n", tab->id());
    flush_console();
  }
  return guard_tab(std::move(*tab),
                   [&] { return watch_as_asked(arguments, request, std::move(diagnostics)); });
}

}  // namespace

int live_command(const Arguments& arguments) {
  Diagnostics diagnostics;
  LiveRequest request = understand_live(arguments, diagnostics);
  if (has_error(diagnostics)) {
    print_diagnostics(diagnostics, false);
    return kExitUsage;
  }
  if (request.tab) return watch_in_tab(arguments, request, std::move(diagnostics));
  return watch_as_asked(arguments, request, std::move(diagnostics));
}

ShownLog show_log(const Arguments& arguments, SceneMailbox& mailbox, CommandQueue& commands,
                  std::stop_source& stop, ServedScene* served, std::function<void()> on_start) {
  ShownLog shown;
  LiveRequest request = understand_live(arguments, shown.diagnostics);
  check_shapes(request.config.machine.drawn, shown.diagnostics);
  if (has_error(shown.diagnostics)) return shown;
  std::unique_ptr<PositionSource> source = make_source(request.config, shown.diagnostics);
  if (!source || has_error(shown.diagnostics)) return shown;
  LiveWindow window(mailbox, commands, arguments);
  bool has_started = false;
  window.serve([&] {
    if (!std::exchange(has_started, true)) on_start();
  });
  watch_rounds(request, std::move(source), stop, window, served);
  shown.opened = window.opened();
  if (!has_started) {
    shown.diagnostics.push_back(fault(trf("{} cannot be replayed", arguments.options.text("LOG"))));
  }
  return shown;
}

}  // namespace kerf
