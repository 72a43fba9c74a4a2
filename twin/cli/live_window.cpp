#include "twin/cli/live_window.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "base/translate.h"
#include "stock/cutter/shape_spec.h"
#include "twin/cli/command_line.h"
#include "twin/cli/console.h"
#include "twin/cli/file_watch.h"
#include "twin/cli/view_load.h"
#include "twin/config/make_source.h"
#include "twin/job/stock_choice.h"
#include "twin/playback/load_program.h"
#include "twin/report/shown_lengths.h"
#include "twin/scene/drawn_machine.h"
#include "twin/scene/player_scene.h"
#include "twin/scene/turned_look.h"

namespace kerf {
namespace {

/// A place that is older may be left by now.
constexpr double kOldPlace_s = 2;
/// Of what is wrong with a log the window tells the first.
constexpr std::size_t kFaultsShown = 8;

/// The path, text and times of the program beside the machine. What is wrong with it, the session
/// says.
std::unique_ptr<LiveProgram> load_live_program(const LiveRequest& request, std::stop_token stop,
                                               std::vector<JobTool>& used) {
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
  for (const ProgramTool& tool : loaded->tools) {
    used.push_back({tool.number, "", shape_in(tool.shape, shown_unit()), tool.origin});
  }
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

/// As --stock takes it.
std::string text_of(const Box& box, LengthUnit unit) {
  const auto corner = [unit](const Vec3& mm) {
    return fmt::format("{:.4g},{:.4g},{:.4g}", from_mm(mm.x, unit), from_mm(mm.y, unit),
                       from_mm(mm.z, unit));
  };
  return fmt::format("box:{}:{}", corner(box.min), corner(box.max));
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
      written_(arguments.options),
      arguments_(std::move(arguments)) {}

void LiveWindow::serve(std::function<void()> on_start) { on_start_ = std::move(on_start); }

ViewedJob LiveWindow::job() const {
  ViewedJob job;
  job.program = arguments_.options.text("LOG");
  job.command = command_line(arguments_.words);
  const bool is_edited = on_set_ && arguments_.options.has("--program");
  job.is_fixed = !is_edited;
  job.can_open = command_ == kReplay;
  job.can_enter = can_enter();
  if (!is_edited) return job;
  const ProgramSetup setup = setup_of(arguments_.options);
  job.program = arguments_.options.text("--program");
  job.stock = setup.stock;
  if (!blank_mm_.empty()) job.stock_in_use = text_of(blank_mm_, shown_unit());
  job.cell = setup.cell;
  job.model = setup.model;
  job.unit = shown_unit();
  job.models = {"auto"};
  for (const StockModelRow& row : stock_models()) job.models.emplace_back(row.name);
  job.tools = job_tools(used_tools_, setup);
  job.fixtures = setup.fixtures;
  return job;
}

void LiveWindow::show_job(ViewedJob job) {
  SceneUpdate update;
  update.job = std::make_shared<const ViewedJob>(std::move(job));
  mailbox_.publish(std::move(update));
}

void LiveWindow::publish_job() {
  const std::lock_guard lock(mutex_);
  show_job(job());
}

/// They have fields of their own, for what is not known of them.
void LiveWindow::note_tools(std::vector<JobTool> used) {
  const std::lock_guard lock(mutex_);
  used_tools_ = std::move(used);
  if (on_set_) show_job(job());
}

void LiveWindow::edit_setups(std::function<void()> on_set) {
  const std::lock_guard lock(mutex_);
  on_set_ = std::move(on_set);
}

WrittenOptions LiveWindow::options_of(const std::string& program) const {
  WrittenOptions options = written_;
  const Result<std::optional<ProgramSetup>> setup = memory_.find(program);
  if (!setup) {
    print_text(stderr, trf("kerf: warning: {}\n", setup.error()));
  } else if (*setup) {
    lay_over(**setup, options);
  }
  return options;
}

std::string LiveWindow::set_up(const JobCommand& asked) {
  // What is as it was written is not remembered: that may be written otherwise the next time.
  const ProgramSetup plain = setup_of(written_);
  ProgramSetup setup{asked.stock, asked.cell, asked.model, asked.tools, asked.fixtures};
  if (setup.stock == plain.stock) setup.stock.clear();
  if (setup.cell == plain.cell) setup.cell.clear();
  if (setup.model == plain.model) setup.model.clear();
  if (setup.tools == plain.tools) setup.tools.clear();
  if (setup.fixtures == plain.fixtures) setup.fixtures.clear();
  std::function<void()> on_set;
  std::string program;
  {
    const std::lock_guard lock(mutex_);
    program = arguments_.options.text("--program");
    if (!on_set_ || program.empty()) return {};
    Arguments arguments = arguments_;
    arguments.options = written_;
    lay_over(setup, arguments.options);
    arguments.options.set("--program", program);
    Diagnostics diagnostics;
    understand_live(arguments, diagnostics);
    std::vector<std::string> faults = faults_of(diagnostics);
    if (faults.empty()) {
      const Done kept = memory_.keep(program, setup);
      if (!kept) faults.push_back(kept.error());
    }
    if (!faults.empty()) {
      const std::string first = faults.front();
      arguments_.options = std::move(arguments.options);  // they stay in their fields
      ViewedJob refused = job();
      refused.faults = std::move(faults);
      show_job(std::move(refused));
      return first;
    }
    on_set = on_set_;
  }
  on_set();
  return trf("set for {}, and remembered", std::filesystem::path(program).filename().string());
}

LiveViewOptions LiveWindow::view_options(const LiveRequest& request, LiveSession& session,
                                         std::stop_source stop) {
  if (on_start_) on_start_();
  entries_.forget();
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
    options.load_program = [this, &request](std::stop_token token) {
      std::vector<JobTool> used;
      auto loaded = load_live_program(request, std::move(token), used);
      if (loaded) note_tools(std::move(used));
      return loaded;
    };
  }
  const std::lock_guard lock(mutex_);
  used_tools_.clear();
  blank_mm_ = options.blank_mm;
  options.job = std::make_shared<const ViewedJob>(job());
  options.on_job = [this](const JobCommand& asked) { return set_up(asked); };
  options.on_entry = [this](int line, const LiveScene& now) { ask_entry(line, now); };
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

bool LiveWindow::can_enter() const {
  const std::string& program = arguments_.options.text("--program");
  return command_ == kShadow && !program.empty() && program != "-" &&
         !program.ends_with(".canon") && arguments_.options.text("--interp") != "text";
}

/// From the place where the machine stands, through the workpiece as it is.
void LiveWindow::ask_entry(int line, const LiveScene& now) {
  WrittenOptions options;
  {
    const std::lock_guard lock(mutex_);
    if (!can_enter()) return;
    options = arguments_.options;
  }
  if (!now.stock || !now.status || !now.status->place.known)
    return entries_.refuse(line, tr("where the machine stands is not known yet"));
  if (now.status->place.turns)
    return entries_.refuse(line, tr("of a workpiece that turns on its table it cannot be told"));
  if (now.status->age_s > kOldPlace_s) {
    return entries_.refuse(line,
                           trf("the machine's last position is {:.1f} s old", now.status->age_s));
  }
  const LengthUnit unit = shown_unit();
  const Vec3& tip = now.status->place.tip_mm;
  const std::string program = options.text("--program");
  // What a workpiece is made of is in it; where the work lies, the program and its INI say.
  for (const char* const option : {"--stock", "--cell", "--model", "--at"}) options.clear(option);
  options.set("--at", fmt::format("{},{},{}", from_mm(tip.x, unit), from_mm(tip.y, unit),
                                  from_mm(tip.z, unit)));
  entries_.ask(line, program, options, unit, now.stock);
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
    ViewedJob refused = job();
    refused.faults = {trf("{} is no log; kerf view opens programs and logs", path)};
    show_job(std::move(refused));
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
  arguments.options = options_of(program);
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
    if (on_set_) arguments_ = std::move(arguments);  // to be mended in its fields
    ViewedJob refused = job();
    refused.faults = faults_of(diagnostics);
    show_job(std::move(refused));
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
