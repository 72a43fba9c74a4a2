#include "twin/cli/view_work.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/exit_code.h"
#include "base/translate.h"
#include "stock/cutter/shape_spec.h"
#include "twin/cli/command_line.h"
#include "twin/cli/console.h"
#include "twin/cli/program_setup.h"
#include "twin/job/stock_choice.h"
#include "twin/report/shown_lengths.h"

namespace kerf {
namespace {

constexpr std::chrono::milliseconds kWorkPatience{100};
constexpr std::chrono::milliseconds kAnnouncePeriod{100};
/// Of what is wrong with a program the window tells the first.
constexpr std::size_t kFaultsShown = 8;

std::string first_line(const Diagnostic& diagnostic) {
  const std::string text = to_string(in_unit(diagnostic, shown_unit()));
  return text.substr(0, text.find('\n'));
}

}  // namespace

ViewWork::ViewWork(std::optional<Arguments> arguments, ViewRequest request, SceneMailbox& mailbox,
                   CommandQueue& commands, std::stop_source& stop, Replay replay,
                   std::unique_ptr<ViewSetups> setups, ServedScene* served)
    : arguments_(std::move(arguments)),
      request_(std::move(request)),
      mailbox_(mailbox),
      commands_(commands),
      stop_(stop),
      replay_(std::move(replay)),
      setups_(std::move(setups)),
      served_(served),
      speed_(request_.speed),
      entries_(mailbox) {}

int ViewWork::run() {
  if (has_program()) {
    announce({});
    if (!load()) {
      return stop_.stop_requested() ? kExitGood : view_exit_code(outcome_, diagnostics_);
    }
    if (stop_.stop_requested()) return kExitGood;
    if (request_.at_line > 0) view_->player().seek_line({0, request_.at_line});
    if (request_.at_end) view_->player().seek_end();
  }
  publish_job();
  while (!stop_.stop_requested()) {
    std::optional<ViewerCommand> asked;
    bool has_changed = false, plays_on = false;
    if (view_) {
      const auto is_over = [&] {
        tell_changed_setup();
        has_changed = arguments_ && watch_.has_changed();
        return has_changed || goes_on_to_next();
      };
      view_->run(stop_.get_token(), std::exchange(speed_, std::nullopt), is_over);
      asked = view_->asked();
      plays_on = is_setup_shown_ && view_->is_playing();
      if (!asked && !has_changed && goes_on_to_next()) {
        asked = SetupCommand{setups_->shown() + 1};
        plays_on = true;
      }
    } else {
      asked = wait_without_program();
      has_changed = !asked;
    }
    if (stop_.stop_requested() || !(asked || has_changed)) break;
    if (!arguments_) continue;
    if (asked && is_log(*asked)) {
      asked = replay_logs(std::move(*asked));
      if (!asked) continue;
    }
    if (const auto* const other = asked ? std::get_if<SetupCommand>(&*asked) : nullptr) {
      if (view_) view_->stay();
      if (!go_to_setup(other->setup, plays_on)) {
        speed_.reset();
        if (!stop_.stop_requested()) tell_faults();
      }
      publish_job();
      continue;
    }
    is_same_program_ = true;
    if (setups_) setups_->forget_next();
    if (asked && !take(*asked)) {
      tell_faults();
      publish_job();
      continue;
    }
    if (!arguments_->options.has("PROGRAM")) {
      publish_job();
      continue;
    }
    if (!(understand_again() && load()) && !stop_.stop_requested()) tell_faults();
    publish_job();
  }
  return kExitGood;
}

void ViewWork::tell_faults() {
  for (const Diagnostic& d : diagnostics_) {
    if (d.severity != Severity::kError || job_.faults.size() >= kFaultsShown) continue;
    job_.faults.push_back(first_line(d));
  }
  if (job_.faults.empty()) job_.faults.emplace_back(tr("it cannot be shown"));
  tell(job_.faults.front());
}

bool ViewWork::is_log(const ViewerCommand& asked) const {
  const auto* const open = std::get_if<OpenCommand>(&asked);
  return open != nullptr && replay_ && view_kind_of(open->path) == ViewKind::kLog;
}

/// One log after the other; what is asked for when it is no log any more. Nothing: it cannot be
/// replayed, or the window is closed.
std::optional<ViewerCommand> ViewWork::replay_logs(ViewerCommand asked) {
  while (is_log(asked)) {
    Arguments log = *arguments_;
    log.options.set("PROGRAM", std::get<OpenCommand>(asked).path);
    log.options.clear("--speed");
    // A log says nothing of the work: it is that of the program before it.
    if (!log.options.has("--stock")) log.options.set("--stock", shown_blank_);
    for (const JobTool& tool : job_.tools) {
      const bool is_free = tool.number > 0 && tool.given.empty() && !tool.in_use.empty();
      if (is_free) log.options.add("--tool", fmt::format("{}={}", tool.number, tool.in_use));
    }
    const ShownLog shown = replay_(log, [this] {
      drop_view();
      has_machine_ = true;  // maybe; what comes next takes it away
      job_ = ViewedJob{};
      arguments_->options.clear("PROGRAM");
      request_.run.session.program.path.clear();
      watch_.clear();
    });
    if (has_error(shown.diagnostics)) {
      diagnostics_ = shown.diagnostics;
      print_diagnostics(diagnostics_, false);
      job_.faults.clear();
      tell_faults();
      publish_job();
      return std::nullopt;
    }
    if (!shown.opened) {
      stop_.request_stop();
      return std::nullopt;
    }
    asked = OpenCommand{*shown.opened};
  }
  return asked;
}

/// False: what is wrong is in the diagnostics.
bool ViewWork::take(const ViewerCommand& asked) {
  if (const auto* open = std::get_if<OpenCommand>(&asked)) {
    setups_.reset();
    // Blank and tools were those of the other program; the machine stays.
    for (const char* const option : {"--stock", "--tool", "--cell", "--model", "--until-line",
                                     "--at-line", "--compare", "--tolerance"}) {
      arguments_->options.clear(option);
    }
    arguments_->options.set("PROGRAM", open->path);
    is_same_program_ = false;
    // A fault is to be read beside what was asked for.
    job_ = ViewedJob{};
    if (is_job_file(open->path)) return open_setups();
  } else if (const auto* job = std::get_if<JobCommand>(&asked)) {
    WrittenOptions& options = arguments_->options;
    options.set("--stock", job->stock.empty() && setups_ ? setups_->carried_blank() : job->stock);
    options.set("--cell", job->cell);
    options.set("--model", job->model);
    options.clear("--tool");
    for (const auto& [number, shape] : job->tools) {
      options.add("--tool", fmt::format("{}={}", number, shape));
    }
    options.set_all("--fixture", job->fixtures);
  }
  return true;
}

/// False: what is wrong is in the diagnostics.
bool ViewWork::understand_again() {
  diagnostics_.clear();
  job_.faults.clear();
  outcome_ = Outcome::kUsageError;
  ViewRequest request = understand_view(*arguments_, diagnostics_);
  const std::string& path = arguments_->options.text("PROGRAM");
  if (!has_error(diagnostics_) && view_kind_of(path) == ViewKind::kLog) {
    diagnostics_.push_back(
        fault_of(trf("{} is a log", path), tr("kerf view LOG shows it in its own window")));
  }
  if (!has_error(diagnostics_) && request.compare.is_wanted()) {
    request.design = placed_design(request.compare, diagnostics_);
  }
  check_shapes(request.run.machine, diagnostics_);
  if (has_error(diagnostics_)) {
    print_diagnostics(diagnostics_, request_.run.quiet);
    // Whoever mends it is not to have to do more than that.
    watch_inputs();
    return false;
  }
  request_ = std::move(request);
  if (setups_) request_.run.session.blank_words = setups_->blank_words(*arguments_);
  return true;
}

/// False: nothing was read, what is shown stays.
bool ViewWork::load() {
  diagnostics_.clear();
  job_.faults.clear();
  watch_inputs();
  LoadControl control;
  control.stop = stop_.get_token();
  control.on_progress = [this](const LoadProgress& progress) { announce(progress); };
  std::unique_ptr<LoadedProgram> loaded = load_viewed(
      request_, view_kind_of(request_.run.session.program.path), control, diagnostics_, outcome_);
  print_diagnostics(diagnostics_, request_.run.quiet);
  if (!loaded || stop_.stop_requested()) return false;
  print_faults(*loaded);
  if (!setups_) print_guesses(request_, *loaded);
  partial_reason_ = loaded->partial_reason;
  is_setup_shown_ = setups_ != nullptr;
  for (const std::string& file : loaded->files) watch_.add(file);
  describe(*loaded);
  replace_view(std::move(loaded));
  return true;
}

void ViewWork::replace_view(std::unique_ptr<LoadedProgram> loaded) {
  const std::optional<Place> before =
      view_ && is_same_program_ ? std::optional(place()) : std::nullopt;
  if (view_) {
    for (ViewerCommand& command : view_->lasting()) commands_.push(std::move(command));
    commands_.push(SpeedCommand{view_->speed()});
  }
  ViewedProgram shown = viewed(request_, *loaded);
  if (setups_) shown.title = setups_->title();
  shown.keeps_eye = before.has_value();
  if (has_machine_ && !shown.machine) {
    SceneUpdate update;
    update.machine = std::make_shared<const SceneMachine>();
    mailbox_.publish(std::move(update));
  }
  has_machine_ = shown.machine != nullptr;
  entries_.forget();
  drop_view();  // its keyframes first
  PlayedForPage played = for_page(shown);
  view_ = std::make_unique<PlayerView>(std::move(loaded->player), request_.player, std::move(shown),
                                       mailbox_, commands_);
  if (served_ != nullptr)
    broadcast_.emplace(view_->player(), std::move(played), request_.run.units, *served_);
  view_->answer_entries_by([this](int line) {
    if (!can_enter()) return;
    entries_.ask(line, arguments_->options.text("PROGRAM"), arguments_->options,
                 request_.run.units);
  });
  for (ViewerCommand& command : waiting_) commands_.push(std::move(command));
  waiting_.clear();
  if (before) go_to(*before);
}

ViewWork::Place ViewWork::place() const {
  const std::shared_ptr<const PlayerState> state = view_->player().state();
  const ProgramTrack& track = view_->player().track();
  Place place{track.size(),     track.duration_s(),   state->place.motion,
              state->elapsed_s, state->motion.source, std::nullopt};
  if (state->mode == PlayerMode::kPlaying) place.speed = view_->speed();
  return place;
}

/// To the same place, as far as there is one: by time in the same motions, by number where they
/// take another time, else by line.
void ViewWork::go_to(const Place& place) {
  Player& player = view_->player();
  const ProgramTrack& track = player.track();
  speed_ = place.speed;
  if (place.motion == 0 && place.time_s <= 0) return;
  if (place.motion >= place.motions) {
    player.seek_end();
  } else if (place.motions != track.size()) {
    player.seek_line(place.line);
  } else if (place.duration_s == track.duration_s()) {
    player.seek_time(place.time_s);
  } else {
    player.seek_motion(place.motion);
  }
}

/// What is watched is what is asked for, whether or not it could be shown.
void ViewWork::watch_inputs() {
  if (!arguments_) return;
  watch_.clear();
  const RunRequest& run = request_.run;
  for (const char* const option :
       {"PROGRAM", "--config", "--ini", "--tool-table", "--turret", "--materials", "--compare"}) {
    watch_.add(arguments_->options.text(option));
  }
  watch_.add(run.ini);
  watch_.add(run.session.program.tool_table_path);
}

void ViewWork::describe(const LoadedProgram& loaded) {
  const LengthUnit unit = request_.run.units;
  job_.stock_in_use = in_unit(loaded.blank.description, unit);
  if (!loaded.blank.origin.empty()) job_.stock_in_use += fmt::format(" ({})", loaded.blank.origin);
  shown_blank_.clear();
  if (loaded.player.blank) {
    const Box box = loaded.player.blank->bounds_mm();
    const auto shown = [unit](double mm) { return fmt::format("{:.4f}", from_mm(mm, unit)); };
    shown_blank_ =
        fmt::format("box:{},{},{}:{},{},{}", shown(box.min.x), shown(box.min.y), shown(box.min.z),
                    shown(box.max.x), shown(box.max.y), shown(box.max.z));
  }
  const double cell = from_mm(loaded.blank.cell_mm, unit);
  job_.cell_in_use = cell > 0 ? fmt::format("{:.4g}", cell) : "";
  job_.model_in_use = loaded.blank.model;
  job_.tools.clear();
  for (const ProgramTool& tool : loaded.tools) {
    job_.tools.push_back({tool.number, "", shape_in(tool.shape, unit), tool.origin});
  }
}

/// kerf-interp runs it alone, and of a part in several setups nobody has the workpiece between.
bool ViewWork::can_enter() const {
  if (!arguments_ || setups_ || !has_program()) return false;
  const ProgramOptions& program = request_.run.session.program;
  return program.interpreter != InterpreterChoice::kText &&
         view_kind_of(program.path) == ViewKind::kProgram && !program.path.ends_with(".canon");
}

void ViewWork::publish_job() {
  if (!arguments_) return;
  const WrittenOptions& options = arguments_->options;
  job_.program = setups_ ? setups_->path() : options.text("PROGRAM");
  job_.setups = setups_ ? setups_->names() : std::vector<std::string>();
  job_.setup = setups_ ? setups_->shown() : 0;
  job_.unit = request_.run.units;
  job_.stock = options.text("--stock");
  if (setups_ && job_.stock == setups_->carried_blank()) job_.stock.clear();
  job_.cell = options.text("--cell");
  job_.model = options.text("--model");
  job_.can_enter = can_enter();
  job_.command = command_line(setups_ ? setups_->job_arguments(*arguments_) : *arguments_);
  job_.models = {"auto"};
  for (const StockModelRow& row : stock_models()) job_.models.emplace_back(row.name);
  const ProgramSetup setup = setup_of(options);
  job_.fixtures = setup.fixtures;
  job_.tools = job_tools(std::move(job_.tools), setup);
  SceneUpdate update;
  update.job = std::make_shared<const ViewedJob>(job_);
  mailbox_.publish(std::move(update));
}

void ViewWork::drop_view() {
  broadcast_.reset();
  view_.reset();
}

/// While there is a program they show that.
void ViewWork::tell_waiting_pages(const std::string& notice) {
  if (served_ == nullptr || view_) return;
  served_->set_state(state_members(waiting_moment(notice)));
  served_->publish();
}

/// In the status line, until something moves.
void ViewWork::tell(const std::string& notice) {
  auto moment = std::make_shared<Moment>(view_ ? *view_->moment() : Moment{});
  moment->notice = notice;
  SceneUpdate update;
  update.moment = std::move(moment);
  mailbox_.publish(std::move(update));
  tell_waiting_pages(notice);
}

/// Nothing if files have changed, or if it is over.
std::optional<ViewerCommand> ViewWork::wait_without_program() {
  if (job_.faults.empty()) tell_waiting_pages(tr("no program is open"));
  while (!stop_.stop_requested()) {
    for (ViewerCommand& command : commands_.wait_for(kWorkPatience)) {
      if (std::holds_alternative<OpenCommand>(command) ||
          std::holds_alternative<JobCommand>(command) ||
          std::holds_alternative<SetupCommand>(command) ||
          std::holds_alternative<ReadAgainCommand>(command)) {
        return std::move(command);
      }
      if (std::holds_alternative<CloseCommand>(command)) stop_.request_stop();
      keep(std::move(command));
    }
    if (watch_.has_changed()) return std::nullopt;
  }
  return std::nullopt;
}

/// What is said once, when the window opens or is looked at in another way, or what is to come
/// next; the rest is about a program that is not there yet.
void ViewWork::keep(ViewerCommand command) {
  const bool lasts = std::holds_alternative<ColorCommand>(command) ||
                     std::holds_alternative<DetailCommand>(command) ||
                     std::holds_alternative<DrawModeCommand>(command) ||
                     std::holds_alternative<SpeedCommand>(command) ||
                     std::holds_alternative<OpenCommand>(command) ||
                     std::holds_alternative<JobCommand>(command) ||
                     std::holds_alternative<SetupCommand>(command) ||
                     std::holds_alternative<ReadAgainCommand>(command);
  if (lasts) waiting_.push_back(std::move(command));
}

/// Whether the window is closed already; the rest is for what is shown next.
void ViewWork::watch_commands() {
  for (ViewerCommand& command : commands_.take()) {
    if (std::holds_alternative<CloseCommand>(command)) stop_.request_stop();
    keep(std::move(command));
  }
}

/// What the window says while something is read.
void ViewWork::announce(const LoadProgress& progress) {
  const auto now = Clock::now();
  if (progress.motions > 0 && now - announced_ < kAnnouncePeriod) return;
  announced_ = now;
  watch_commands();
  tell(tr("reading: ") + (progress.fraction >= 0 ? fmt::format("{:.0f} %", 100 * progress.fraction)
                                                 : trf("{} motions", progress.motions)));
}

}  // namespace kerf
