#include "twin/cli/view_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "base/atomic_file.h"
#include "base/exit_code.h"
#include "base/translate.h"
#include "machine_io/logs/log_source.h"
#include "twin/cli/console.h"
#include "twin/cli/job_command.h"
#include "twin/cli/live_command.h"
#include "twin/cli/option_reader.h"
#include "twin/cli/progress_bar.h"
#include "twin/cli/served_page.h"
#include "twin/cli/stop_deadline.h"
#include "twin/cli/stop_signals.h"
#include "twin/cli/torch_options.h"
#include "twin/cli/view_load.h"
#include "twin/cli/view_work.h"
#include "twin/cli/window_host.h"
#include "twin/playback/load_program.h"
#include "twin/scene/drawn_machine.h"
#include "twin/scene/frame_writer.h"
#include "twin/scene/player_view.h"
#include "twin/scene/tool_shape.h"

namespace kerf {
namespace {

constexpr std::chrono::milliseconds kPatience{50};
/// For what is drawn or written when a stop is asked for.
constexpr std::chrono::milliseconds kViewPatience{2000};

/// Those by which a log is replayed that is given as the program.
Arguments replay_arguments(Arguments arguments) {
  arguments.command = kReplay;
  arguments.options.set("LOG", arguments.options.text("PROGRAM"));
  arguments.options.clear("PROGRAM");
  arguments.in_window = true;
  return arguments;
}

int in_window(std::optional<Arguments> arguments, const ViewRequest& request,
              std::stop_source& stop, std::unique_ptr<ViewSetups> setups = nullptr) {
  SceneMailbox mailbox(Window::wake);
  CommandQueue commands;
  WindowOptions options;
  options.is_local = request.local;
  options.draw_mode = request.window_mode;
  options.section = request.frame.section;
  options.color_by = request.color_by;
  options.color_on = request.color_on;
  if (request.run.units != LengthUnit::kMm) options.units = request.run.units;
  std::optional<ServedPage> page;
  if (request.run.serve && !open_and_tell(page.emplace(), *request.run.serve)) return kExitFailure;
  ServedScene* const served = page ? &page->scene() : nullptr;
  const auto replay = [&](const Arguments& log, std::function<void()> on_start) {
    Arguments live = replay_arguments(log);
    live.options.set_flag("--quiet");
    live.words = {"kerf", "view", live.options.text("LOG")};
    return show_log(live, mailbox, commands, stop, served, std::move(on_start));
  };
  ViewWork work(std::move(arguments), request, mailbox, commands, stop, replay, std::move(setups),
                served);
  const StopDeadline deadline(stop.get_token(), kExitGood);
  const Result<int> code =
      work_beside_window(options, mailbox, commands, stop, [&work] { return work.run(); });
  if (code) return *code;
  print_diagnostics({fault_of(code.error())}, false);
  return kExitFailure;
}

/// By mesh where the workpiece has neither heights nor moves that can be subtracted.
FrameOptions frame_options(const ViewRequest& request, const ViewedProgram& shown) {
  FrameOptions options = request.frame;
  if (!shown.turns || options.draw_mode == DrawMode::kMesh) return options;
  Diagnostic note;
  note.severity = Severity::kNote;
  note.message = trf("--draw {}: a workpiece that turns is drawn by mesh alone",
                     options.draw_mode == DrawMode::kRaycast ? "raycast" : "csg");
  print_diagnostics({note}, request.run.quiet);
  options.draw_mode = DrawMode::kMesh;
  return options;
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

int into_files(const ViewRequest& request, ViewKind kind, const std::stop_source& stop) {
  Diagnostics diagnostics;
  Outcome outcome = Outcome::kFailed;
  LoadControl control;
  control.stop = stop.get_token();
  std::unique_ptr<LoadedProgram> loaded = load_viewed(request, kind, control, diagnostics, outcome);
  print_diagnostics(diagnostics, request.run.quiet);
  if (!loaded) return view_exit_code(outcome, diagnostics);
  print_faults(*loaded);
  print_guesses(request, *loaded);
  const bool whole = loaded->partial_reason.empty();
  ViewedProgram shown = viewed(request, *loaded);
  const std::shared_ptr<const ProgramTrack> track = loaded->player.track;
  PlayerOptions options = request.player;
  options.check_ahead = false;
  Player player(std::move(loaded->player), options);
  Done done = std::monostate{};
  auto renderer = FrameRenderer::create(frame_options(request, shown), *player.state(), track,
                                        std::move(shown));
  if (!renderer) {
    print_diagnostics({fault_of(renderer.error())}, false);
    return kExitFailure;
  }
  if (!go_to_place(player, request, stop.get_token())) return kExitFailure;
  if (const std::string& refused = player.state()->message; !refused.empty()) {
    print_diagnostics({fault_of(fmt::format("--at-line {}: {}", request.at_line, refused))}, false);
    return kExitUsage;
  }
  if (!request.png.empty()) {
    renderer->color(player);
    const Result<Picture> picture = renderer->draw(player.state());
    done = picture ? write_png(request.png, *picture) : Done(Error{picture.error()});
  } else {
    std::atomic<double> share{0};
    const ProgressBar bar([&] { return share.load(); }, !request.run.quiet);
    const auto frames = write_film(player, *renderer, request.film, stop.get_token(),
                                   [&](double done_share) { share = done_share; });
    if (!frames) done = Error{frames.error()};
    if (frames && !request.run.quiet) {
      print_text(stdout, trf("{} frames in {}; a film of them:\n  ffmpeg -framerate {:g} -i "
                             "{}/frame_%06d.png -pix_fmt yuv420p film.mp4\n",
                             *frames, request.film.folder, request.film.fps, request.film.folder));
    }
  }
  if (!done) print_diagnostics({fault_of(done.error())}, false);
  return done && whole && !stop.stop_requested() ? kExitGood : kExitFailure;
}

int view_log(const Arguments& arguments) {
  Diagnostics diagnostics;
  for (const char* const option :
       {"--at-line", "--until-line", "--keyframes", "--full-redraw", "--material", "--engagement",
        "--climb", "--spindle-power", "--spindle-torque", "--max-deflection", "--color",
        "--color-on"}) {
    if (arguments.options.has(option)) {
      add_fault(option, tr("is for programs, not for logs"), {}, diagnostics);
    }
  }
  if (has_error(diagnostics)) {
    print_diagnostics(diagnostics, false);
    return kExitUsage;
  }
  return live_command(replay_arguments(arguments));
}

/// What a run's window shows again when it is asked to; where the run began to report
/// (--from-line) stays with it.
Arguments again_in_window(Arguments arguments) {
  arguments.command = kView;
  WrittenOptions& options = arguments.options;
  for (const auto& [output, path] : OutputPaths{}.named()) options.clear(output);
  for (const char* const option :
       {"--mesh-tolerance", "--serve", "--view", "--verbose", "--finding-png", "--rest"}) {
    options.clear(option);
  }
  options.set_flag("--quiet");
  return arguments;
}

}  // namespace

int show_program(const Arguments& arguments, const RunRequest& run, std::stop_source& stop) {
  ViewRequest request;
  request.run = run;
  request.run.quiet = true;   // the dry run has said it
  request.run.serve.reset();  // and serves it
  request.at_end = true;
  request.window_mode = run.draw;
  if (arguments.options.text("PROGRAM") != run.session.program.path) {  // standard input: gone
    return in_window(std::nullopt, request, stop);
  }
  return in_window(again_in_window(arguments), request, stop);
}

int view_command(const Arguments& asked) {
  Diagnostics diagnostics;
  std::unique_ptr<ViewSetups> setups;
  Arguments arguments = asked;
  if (is_job_file(asked.options.text("PROGRAM"))) {
    int code = kExitGood;
    setups = view_of_job(asked, code);
    if (!setups) return code;
    arguments = setups->arguments();
  } else if (asked.options.has("--setup")) {
    add_fault("--setup", tr("is for jobs, YAML files with setups"), {}, diagnostics);
  }
  ViewRequest request = understand_view(arguments, diagnostics);
  if (setups) request.run.session.blank_words = setups->blank_words(arguments);
  check_sheet_options(request.run.session.blank, arguments, diagnostics);
  if (has_error(diagnostics)) {
    print_diagnostics(diagnostics, false);
    return kExitUsage;
  }
  show_lengths_in(request.run.units);
  const ViewKind kind = view_kind_of(request.run.session.program.path);
  if (kind == ViewKind::kLog) {
    if (request.compare.is_wanted()) {
      print_diagnostics({fault_of(tr("--compare is for programs and saved workpieces"),
                                  tr("kerf replay LOG --state FILE saves what a log leaves"))},
                        false);
      return kExitUsage;
    }
    if (request.wants_window()) return view_log(arguments);
    print_diagnostics({fault_of(tr("--png and --frames are for programs and saved workpieces"),
                                tr("kerf replay LOG --png FILE draws what a log leaves"))},
                      false);
    return kExitUsage;
  }
  OutputPaths places;
  places.png = request.png;
  check_output_places(places, diagnostics);
  if (request.compare.is_wanted()) request.design = placed_design(request.compare, diagnostics);
  check_shapes(request.run.machine, diagnostics);
  print_diagnostics(diagnostics, request.run.quiet);
  if (has_error(diagnostics)) return kExitFailure;
  std::stop_source stop;
  const StopSignals signals(stop, [] { remove_uncommitted_files(); });
  if (request.wants_window()) return in_window(arguments, request, stop, std::move(setups));
  StopDeadline deadline(stop.get_token(), kExitFailure);
  deadline.set_last_words([] { print_text(stderr, trf("kerf: interrupted\n")); }, kViewPatience);
  return into_files(request, kind, stop);
}

}  // namespace kerf
