#include "twin/app/view_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "base/atomic_file.h"
#include "machine_io/logs/log_source.h"
#include "twin/app/console.h"
#include "twin/app/exit_code.h"
#include "twin/app/live_command.h"
#include "twin/app/option_reader.h"
#include "twin/app/progress_bar.h"
#include "twin/app/stop_signals.h"
#include "twin/app/window_host.h"
#include "twin/playback/load_program.h"
#include "twin/view/drawn_machine.h"
#include "twin/view/frame_writer.h"
#include "twin/view/player_view.h"
#include "twin/view/tool_shape.h"

namespace kerf {
namespace {

constexpr std::chrono::milliseconds kPatience{200};

void print(const Diagnostics& diagnostics, bool quiet) {
  for (const Diagnostic& d : diagnostics) {
    if (!quiet || d.severity == Severity::kError) kerf::print(stderr, "{}", to_string(d));
  }
}

Diagnostic fault(std::string message, std::string hint = {}) {
  Diagnostic d;
  d.message = std::move(message);
  d.hint = std::move(hint);
  return d;
}

enum class Kind { kProgram, kState, kLog };

/// What the file is, by its first bytes; by its name where they do not tell.
Kind kind_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string head(64, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  const std::string_view begin = head;
  if (begin.starts_with("kerf-state/")) return Kind::kState;
  if (begin.find("kerf-recording/") != std::string_view::npos) return Kind::kLog;
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".csv" || extension == ".log" || extension == ".sam" ? Kind::kLog
                                                                           : Kind::kProgram;
}

/// Program, blank, tools; null on error.
std::unique_ptr<LoadedProgram> load(const ViewRequest& request, Kind kind,
                                    const LoadControl& control, Diagnostics& diagnostics,
                                    Outcome& outcome) {
  if (kind == Kind::kProgram) {
    auto loaded = load_program(request.run.session, control, diagnostics, outcome);
    // Who cut where is what colours and the difference between cut and uncut are made of.
    if (loaded && loaded->player.blank) loaded->player.blank->keep_cut_ids(true);
    return loaded;
  }
  const std::string& path = request.run.session.program.path;
  Result<Blank> blank = parse_blank("state:" + path);
  if (!blank) {
    diagnostics.push_back(fault(blank.error()));
    outcome = Outcome::kFailed;
    return nullptr;
  }
  StockSetup setup =
      make_stock(*blank, StockChoice{}, request.run.session.stock, path, diagnostics, outcome);
  if (!setup.stock) return nullptr;
  auto loaded = std::make_unique<LoadedProgram>();
  loaded->player.track = ProgramTrackBuilder().build({}, {});
  loaded->player.blank = std::move(setup.stock);
  loaded->blank = setup.facts;
  return loaded;
}

/// What was taken for want of better, and the command that says so.
void print_guesses(const ViewRequest& request, const LoadedProgram& loaded) {
  if (request.run.quiet || loaded.guesses.empty()) return;
  kerf::print(stderr, "{}", guess_text(loaded.guesses, request.run.summary.command));
}

/// The block that the interpreter refused, if there is one, and why the program is not whole.
void print_faults(const LoadedProgram& loaded) {
  for (const Finding& remark : loaded.player.remarks) {
    if (remark.severity != Severity::kError) continue;
    kerf::print(stderr, "{}", to_string(diagnostic_of(remark, loaded.player.track->files())));
  }
  if (!loaded.partial_reason.empty()) kerf::print(stderr, "kerf: {}\n", loaded.partial_reason);
}

int exit_code(Outcome outcome, const Diagnostics& diagnostics) {
  if (outcome == Outcome::kUsageError) return kExitUsage;
  return has_error(diagnostics) || outcome == Outcome::kFailed ? kExitFailure : kExitGood;
}

/// Where the comparison will not say what its user expects.
Diagnostics comparison_doubts(const ViewRequest& request, const StockModel& stock) {
  Diagnostics doubts;
  const auto doubt = [&](std::string message, std::string hint) {
    Diagnostic d = fault(std::move(message), std::move(hint));
    d.severity = Severity::kWarning;
    d.file = request.compare;
    doubts.push_back(std::move(d));
  };
  const Box part = request.design->box_mm(), blank = stock.bounds_mm();
  bool apart = false;
  for (int axis = 0; axis < 3; ++axis) {
    apart = apart || part.min[axis] > blank.max[axis] || part.max[axis] < blank.min[axis];
  }
  if (apart) {
    doubt(fmt::format("lies beside the blank: X {:g} to {:g}, Y {:g} to {:g}, Z {:g} to {:g} mm; "
                      "the blank is X {:g} to {:g}, Y {:g} to {:g}, Z {:g} to {:g}",
                      part.min.x, part.max.x, part.min.y, part.max.y, part.min.z, part.max.z,
                      blank.min.x, blank.max.x, blank.min.y, blank.max.y, blank.min.z, blank.max.z),
          "the design part is taken as mm, in the coordinates that the program writes");
  }
  if (stock.cell_mm() > request.tolerance_mm) {
    doubt(fmt::format("cells of {:g} mm are coarser than the tolerance of {:g} mm: walls may seem "
                      "off by up to a cell",
                      stock.cell_mm(), request.tolerance_mm),
          fmt::format("--cell {:g} or --tolerance {:g}", request.tolerance_mm, stock.cell_mm()));
  }
  return doubts;
}

/// With the machine around it. What is wrong with that one is said; the program is shown without.
ViewedProgram viewed(const ViewRequest& request, const LoadedProgram& loaded) {
  ViewedProgram shown = viewed_program(
      loaded, std::filesystem::path(request.run.session.program.path).filename().string());
  if (request.design && loaded.player.blank) {
    shown.design = request.design;
    shown.tolerance_mm = request.tolerance_mm;
    print(comparison_doubts(request, *loaded.player.blank), request.run.quiet);
  }
  const RunRequest& run = request.run;
  const bool wanted = !run.ini.empty() || run.machine.is_chosen();
  if (!wanted || !loaded.player.blank) return shown;
  double longest_mm = 0;
  for (const ProgramTool& tool : loaded.tools) {
    const auto cutter = parse_tool_argument("0=" + tool.shape);
    if (cutter) {
      longest_mm = std::max(longest_mm, drawn_height_mm(*tool_shape_of(cutter->cutter)));
    }
  }
  if (const TurretPointer& turret = loaded.player.turret) {
    for (const auto& [number, station] : turret->stations) {
      longest_mm = std::max(longest_mm, drawn_height_mm(*tool_shape_of(station.punch)));
    }
  }
  Diagnostics diagnostics;
  WorkRoom room = work_room(*loaded.player.track, loaded.player.blank->bounds_mm(), longest_mm);
  room.turret = loaded.player.turret;
  shown.machine = drawn_machine(run.machine, run.ini, room, diagnostics);
  print(diagnostics, request.run.quiet);
  return shown;
}

/// Reads, then plays, in the thread beside the window.
class Work {
 public:
  Work(const ViewRequest& request, Kind kind, SceneMailbox& mailbox, CommandQueue& commands,
       std::stop_source& stop)
      : request_(request), kind_(kind), mailbox_(mailbox), commands_(commands), stop_(stop) {}

  int operator()() {
    announce({});
    LoadControl control;
    control.stop = stop_.get_token();
    control.on_progress = [this](const LoadProgress& progress) { announce(progress); };
    Diagnostics diagnostics;
    Outcome outcome = Outcome::kFailed;
    std::unique_ptr<LoadedProgram> loaded = load(request_, kind_, control, diagnostics, outcome);
    print(diagnostics, request_.run.quiet);
    if (!loaded || stop_.stop_requested()) return exit_code(outcome, diagnostics);
    print_faults(*loaded);
    print_guesses(request_, *loaded);
    ViewedProgram shown = viewed(request_, *loaded);
    PlayerOptions options = request_.player;
    PlayerView view(std::move(loaded->player), options, std::move(shown), mailbox_, commands_);
    for (ViewerCommand& command : waiting_) commands_.push(std::move(command));
    if (request_.at_line > 0) view.player().seek_line({0, request_.at_line});
    if (request_.at_end) view.player().seek_end();
    view.run(stop_.get_token(), request_.speed);
    return kExitGood;
  }

 private:
  using Clock = std::chrono::steady_clock;
  /// What the window says while there is nothing to be seen yet; and whether it is closed already.
  void announce(const LoadProgress& progress) {
    const auto now = Clock::now();
    if (progress.motions > 0 && now - announced_ < std::chrono::milliseconds(100)) return;
    announced_ = now;
    for (ViewerCommand& command : commands_.take()) {
      if (std::holds_alternative<CloseCommand>(command)) stop_.request_stop();
      // Said once, when the window opens or is looked at in another way; the rest is about a
      // program that is not there yet.
      const bool lasts = std::holds_alternative<ColorCommand>(command) ||
                         std::holds_alternative<DetailCommand>(command) ||
                         std::holds_alternative<RoadCommand>(command) ||
                         std::holds_alternative<SpeedCommand>(command);
      if (lasts) waiting_.push_back(std::move(command));
    }
    auto moment = std::make_shared<Moment>();
    moment->notice = progress.fraction >= 0 ? fmt::format("{:.0f} %", 100 * progress.fraction)
                                            : fmt::format("{} motions", progress.motions);
    moment->notice = "reading: " + moment->notice;
    SceneUpdate update;
    update.moment = std::move(moment);
    mailbox_.publish(std::move(update));
  }

  const ViewRequest& request_;
  Kind kind_;
  SceneMailbox& mailbox_;
  CommandQueue& commands_;
  std::stop_source& stop_;
  Clock::time_point announced_{};
  std::vector<ViewerCommand> waiting_;
};

int in_window(const ViewRequest& request, Kind kind, std::stop_source& stop) {
  SceneMailbox mailbox(Window::wake);
  CommandQueue commands;
  WindowOptions options;
  options.is_local = request.local;
  options.road = request.window_road;
  const Result<int> code = work_beside_window(options, mailbox, commands, stop,
                                              Work(request, kind, mailbox, commands, stop));
  if (code) return *code;
  print({fault(code.error())}, false);
  return kExitFailure;
}

/// To the line asked for, or (for a picture) to the end.
bool go_to_place(Player& player, const ViewRequest& request, const std::stop_token& stop) {
  Player::Ticket ticket = 0;
  if (request.at_line > 0) {
    ticket = player.seek_line({0, request.at_line});
  } else if (!request.png.empty()) {
    ticket = player.seek_end();
  } else {
    return true;
  }
  while (!player.wait(ticket, kPatience)) {
    if (stop.stop_requested()) return false;
  }
  return true;
}

int into_files(const ViewRequest& request, Kind kind, const std::stop_source& stop) {
  Diagnostics diagnostics;
  Outcome outcome = Outcome::kFailed;
  LoadControl control;
  control.stop = stop.get_token();
  std::unique_ptr<LoadedProgram> loaded = load(request, kind, control, diagnostics, outcome);
  print(diagnostics, request.run.quiet);
  if (!loaded) return exit_code(outcome, diagnostics);
  print_faults(*loaded);
  print_guesses(request, *loaded);
  const bool whole = loaded->partial_reason.empty();
  ViewedProgram shown = viewed(request, *loaded);
  const std::shared_ptr<const ProgramTrack> track = loaded->player.track;
  PlayerOptions options = request.player;
  options.check_ahead = false;
  Player player(std::move(loaded->player), options);
  Done done = std::monostate{};
  auto renderer = FrameRenderer::create(request.frame, *player.state(), track, std::move(shown));
  if (!renderer) {
    print({fault(renderer.error())}, false);
    return kExitFailure;
  }
  if (!go_to_place(player, request, stop.get_token())) return kExitFailure;
  if (const std::string& refused = player.state()->message; !refused.empty()) {
    print({fault(fmt::format("--at-line {}: {}", request.at_line, refused))}, false);
    return kExitUsage;
  }
  if (!request.png.empty()) {
    const Result<Picture> picture = renderer->draw(player.state());
    done = picture ? write_png(request.png, *picture) : Done(Error{picture.error()});
  } else {
    std::atomic<double> share{0};
    const ProgressBar bar([&] { return share.load(); }, !request.run.quiet);
    const auto frames = write_film(player, *renderer, request.film, stop.get_token(),
                                   [&](double done_share) { share = done_share; });
    if (!frames) done = Error{frames.error()};
    if (frames && !request.run.quiet) {
      fmt::print(
          "{} frames in {}; a film of them:\n  ffmpeg -framerate {:g} -i "
          "{}/frame_%06d.png -pix_fmt yuv420p film.mp4\n",
          *frames, request.film.folder, request.film.fps, request.film.folder);
    }
  }
  if (!done) print({fault(done.error())}, false);
  return done && whole && !stop.stop_requested() ? kExitGood : kExitFailure;
}

int view_log(const ViewArguments& arguments) {
  Diagnostics diagnostics;
  OptionReader reader(diagnostics);
  const auto refuse = [&](const char* option, bool given) {
    if (given) reader.fault(option, "is for programs, not for logs");
  };
  refuse("--at-line", !arguments.at_line.empty());
  refuse("--until-line", !arguments.run.until_line.empty());
  refuse("--keyframes", !arguments.keyframes.empty());
  refuse("--full-redraw", arguments.no_local);
  if (has_error(diagnostics)) {
    print(diagnostics, false);
    return kExitUsage;
  }
  LiveArguments live;
  live.config = arguments.config;
  live.sets = arguments.sets;
  live.log = arguments.run.source.program;
  live.source = arguments.run.source;
  live.source.program.clear();
  live.work = arguments.run.work;
  live.torch = arguments.run.torch;
  live.speed = arguments.speed;
  live.draw = arguments.draw;
  live.quiet = arguments.run.quiet;
  live.in_window = true;
  return live_command(live, LiveCommand::kReplay);
}

}  // namespace

int show_program(const RunRequest& run, std::stop_source& stop) {
  ViewRequest request;
  request.run = run;
  request.run.quiet = true;  // the dry run has said it
  request.at_end = true;
  request.window_road = run.draw;
  return in_window(request, Kind::kProgram, stop);
}

int view_command(const ViewArguments& arguments) {
  Diagnostics diagnostics;
  ViewRequest request = understand_view(arguments, diagnostics);
  if (has_error(diagnostics)) {
    print(diagnostics, false);
    return kExitUsage;
  }
  const Kind kind = kind_of(request.run.session.program.path);
  if (kind == Kind::kLog) {
    if (!request.compare.empty()) {
      print({fault("--compare is for programs and saved workpieces",
                   "kerf replay LOG --state FILE saves what a log leaves")},
            false);
      return kExitUsage;
    }
    if (request.wants_window()) return view_log(arguments);
    print({fault("--png and --frames are for programs and saved workpieces",
                 "kerf replay LOG --png FILE draws what a log leaves")},
          false);
    return kExitUsage;
  }
  OutputPaths places;
  places.png = request.png;
  check_output_places(places, diagnostics);
  if (!request.compare.empty()) request.design = DesignPart::read(request.compare, diagnostics);
  check_shapes(request.run.machine, diagnostics);
  print(diagnostics, request.run.quiet);
  if (has_error(diagnostics)) return kExitFailure;
  std::stop_source stop;
  const StopSignals signals(stop, [] { remove_uncommitted_files(); });
  return request.wants_window() ? in_window(request, kind, stop) : into_files(request, kind, stop);
}

}  // namespace kerf
