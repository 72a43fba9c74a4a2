#include "twin/cli/live_window.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "base/translate.h"
#include "twin/cli/command_line.h"
#include "twin/cli/console.h"
#include "twin/cli/file_watch.h"
#include "twin/cli/view_load.h"
#include "twin/config/make_source.h"
#include "twin/playback/load_program.h"
#include "twin/scene/drawn_machine.h"
#include "twin/scene/player_scene.h"
#include "twin/scene/turned_look.h"

namespace kerf {
namespace {

/// Of what is wrong with a log the window tells the first.
constexpr std::size_t kFaultsShown = 8;

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

std::vector<std::string> faults_of(const Diagnostics& diagnostics) {
  std::vector<std::string> faults;
  for (const Diagnostic& d : diagnostics) {
    if (d.severity != Severity::kError || faults.size() >= kFaultsShown) continue;
    const std::string text = to_string(d);
    faults.push_back(text.substr(0, text.find('\n')));
  }
  return faults;
}

}  // namespace

std::shared_ptr<const MachineModel> machine_beside(const LiveRequest& request,
                                                   const LiveSession& session,
                                                   Diagnostics& diagnostics) {
  WorkRoom room;
  room.frame = request.options.cutting.frame.work;
  room.blank_mm = session.stock()->bounds_mm();
  room.chuck = chuck_room(session.collisions().held_by);
  return drawn_machine(request.config.machine.drawn, request.ini, room, diagnostics);
}

LiveWindow::LiveWindow(SceneMailbox& mailbox, CommandQueue& commands, Arguments arguments,
                       bool is_shown)
    : mailbox_(mailbox),
      commands_(commands),
      command_(arguments.command),
      is_shown_(is_shown),
      arguments_(std::move(arguments)) {}

void LiveWindow::serve(std::function<void()> on_start) { on_start_ = std::move(on_start); }

ViewedJob LiveWindow::job() const {
  ViewedJob job;
  job.program = arguments_.options.text("LOG");
  job.command = command_line(arguments_.words);
  job.is_fixed = true;
  job.can_open = command_ == kReplay;
  return job;
}

LiveViewOptions LiveWindow::view_options(const LiveRequest& request, LiveSession& session,
                                         std::stop_source stop) {
  if (on_start_) on_start_();
  LiveViewOptions options;
  const std::string& program =
      request.options.program ? request.options.program->path : std::string();
  options.source_name = session.source_name();
  options.title =
      program.empty() ? options.source_name : std::filesystem::path(program).filename().string();
  options.blank_mm = session.stock()->bounds_mm();
  options.blank_outline = blank_outline_of(*session.stock());
  options.stock = session.stock()->snapshot();
  options.tools = session.tool_sources();
  Diagnostics diagnostics;
  options.machine = machine_beside(request, session, diagnostics);
  print_diagnostics(diagnostics, request.quiet);
  options.collisions = session.collisions();
  options.log = request.options.log();
  options.speed = options.log ? request.options.speed : 1.0;
  options.on_close = [stop, this]() mutable {
    if (!lost) stop.request_stop();
  };
  if (options.log) options.on_speed = [&session](double speed) { session.set_speed(speed); };
  if (!program.empty() && program != "-") {
    options.load_program = [&request](std::stop_token token) {
      return load_live_program(request, std::move(token));
    };
  }
  const std::lock_guard lock(mutex_);
  options.job = std::make_shared<const ViewedJob>(job());
  if (command_ == kReplay) {
    options.on_open = [this, stop](const std::string& path) { open(path, stop); };
  }
  if (!options.machine) {
    SceneUpdate update;  // that of the round before
    update.machine = std::make_shared<const SceneMachine>();
    mailbox_.publish(std::move(update));
  }
  return options;
}

void LiveWindow::open(const std::string& path, std::stop_source stop) {
  Arguments arguments;
  {
    const std::lock_guard lock(mutex_);
    if (serves()) {
      opened_ = path;
      is_over_ = true;
      stop.request_stop();
      return;
    }
    arguments = arguments_;
  }
  if (view_kind_of(path) != ViewKind::kLog) {
    const std::lock_guard lock(mutex_);
    SceneUpdate update;
    ViewedJob refused = job();
    refused.faults = {trf("{} is no log; kerf view opens programs and logs", path)};
    update.job = std::make_shared<const ViewedJob>(std::move(refused));
    mailbox_.publish(std::move(update));
    return;
  }
  std::replace(arguments.words.begin(), arguments.words.end(), arguments.options.text("LOG"), path);
  arguments.options.set("LOG", path);
  begin_next(std::move(arguments), std::move(stop));
}

void LiveWindow::begin_round(std::stop_source stop) {
  const std::lock_guard lock(mutex_);
  round_ = std::move(stop);
}

bool LiveWindow::follow(const std::string& program) {
  Arguments arguments;
  std::optional<std::stop_source> round;
  {
    const std::lock_guard lock(mutex_);
    if (!round_ || is_over_) return false;
    arguments = arguments_;
    round = round_;
  }
  arguments.options.set("--program", program);
  // One that cannot be followed is told once, and the watch goes on as it is.
  begin_next(std::move(arguments), std::move(*round));
  return true;
}

bool LiveWindow::begin_next(Arguments arguments, std::stop_source stop) {
  Diagnostics diagnostics;
  LiveRequest request = understand_live(arguments, diagnostics);
  // That of a LinuxCNC goes on.
  const bool keeps_source = std::holds_alternative<HalSettings>(request.config.source);
  if (!has_error(diagnostics) && !keeps_source) make_source(request.config, diagnostics);
  const std::lock_guard lock(mutex_);
  if (has_error(diagnostics)) {
    print_diagnostics(diagnostics, request.quiet);
    SceneUpdate update;
    ViewedJob refused = job();
    refused.faults = faults_of(diagnostics);
    update.job = std::make_shared<const ViewedJob>(std::move(refused));
    mailbox_.publish(std::move(update));
    return false;
  }
  arguments_ = std::move(arguments);
  next_ = std::move(request);
  is_over_ = true;
  stop.request_stop();
  return true;
}

std::optional<LiveRequest> LiveWindow::take_next() {
  const std::lock_guard lock(mutex_);
  is_over_ = false;
  return std::exchange(next_, std::nullopt);
}

std::vector<std::string> LiveWindow::inputs(const LiveRequest& request) const {
  const WrittenOptions& said = arguments_.options;
  if (said.text("LOG") == "-") return {};  // is not there a second time
  std::vector<std::string> paths{request.ini};
  for (const char* const option :
       {"LOG", "--config", "--ini", "--tool-table", "--turret", "--materials", "--pins"}) {
    paths.push_back(said.text(option));
  }
  for (const ToolLibrary& library : request.options.libraries) paths.push_back(library.path);
  if (request.options.program) {
    paths.push_back(request.options.program->path);
    paths.push_back(request.options.program->tool_table_path);
  }
  return paths;
}

std::jthread LiveWindow::watch_inputs(const LiveRequest& request, LiveView& view,
                                      std::stop_source stop) {
  std::vector<std::string> paths = inputs(request);
  return std::jthread(
      [this, paths = std::move(paths), &view, stop](const std::stop_token& ends) mutable {
        std::vector<FileWatch> watches;
        for (const std::string& path : paths) watches.emplace_back().add(path);
        while (!ends.stop_requested()) {
          std::this_thread::sleep_for(FileWatch::kPeriod / 2);
          for (std::size_t i = 0; i < paths.size(); ++i) {
            if (!watches[i].has_changed()) continue;
            if (command_ == kShadow) {
              view.tell(trf("{} has changed: a new start of kerf shadow takes it", paths[i]));
              watches[i].clear();
              continue;
            }
            Arguments arguments;
            {
              const std::lock_guard lock(mutex_);
              arguments = arguments_;
            }
            if (begin_next(std::move(arguments), stop)) return;
            watches[i].clear();  // told; whoever mends it changes it once more
            watches[i].add(paths[i]);
          }
        }
      });
}

}  // namespace kerf
