#include "twin/scene/player_view.h"

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

namespace kerf {
namespace {

using std::chrono::milliseconds;

/// How often the player's state is looked at while things move, and while they do not.
constexpr milliseconds kQuick{2};
constexpr milliseconds kSlow{100};
/// Time for patches between two looks at the commands.
constexpr milliseconds kPlayerSlice{8};
/// Twice as often as a window draws: there is a new state whenever it is free for the next one.
constexpr milliseconds kStatePeriod{8};
constexpr std::chrono::seconds kQuickAfterCommand{1};

PlayerOptions with_frequent_states(PlayerOptions options) {
  options.publish_period = std::min(options.publish_period, kStatePeriod);
  return options;
}

}  // namespace

PlayerView::PlayerView(PlayerProgram program, PlayerOptions options, ViewedProgram shown,
                       SceneMailbox& mailbox, CommandQueue& commands)
    : track_(program.track),
      mailbox_(mailbox),
      commands_(commands),
      player_(std::move(program), with_frequent_states(std::move(options))),
      scene_(track_, std::move(shown)) {
  if (auto loads = player_.loads()) scene_.show_loads(std::move(loads));
}

void PlayerView::run(std::stop_token stop, std::optional<double> speed,
                     const std::function<bool()>& is_over) {
  asked_.reset();
  if (!std::exchange(is_started_, true)) mailbox_.publish(scene_.start(*player_.state()));
  if (speed) {
    speed_ = *speed;
    play();
    scene_.set_controls(speed_, breakpoints_);
  }
  quick_until_ = Clock::now() + kQuickAfterCommand;
  while (!stop.stop_requested()) {
    for (const ViewerCommand& command : commands_.wait_for(restless() ? kQuick : kSlow)) {
      quick_until_ = Clock::now() + kQuickAfterCommand;
      remember(command);
      if (!obey(command)) return;
    }
    show();
    if (is_over && is_over()) return;
  }
}

bool PlayerView::restless() const {
  if (!state_ || state_->mode != PlayerMode::kPaused) return true;
  return scene_.behind() || Clock::now() < quick_until_;
}

void PlayerView::remember(const ViewerCommand& command) {
  const bool lasts = std::holds_alternative<DetailCommand>(command) ||
                     std::holds_alternative<ColorCommand>(command) ||
                     std::holds_alternative<DrawModeCommand>(command);
  if (!lasts) return;
  std::erase_if(lasting_, [&](const ViewerCommand& c) { return c.index() == command.index(); });
  lasting_.push_back(command);
}

void PlayerView::play() { plays_ = player_.play(speed_); }

bool PlayerView::has_played_out() const {
  return plays_ && state_ && state_->commands_done >= *plays_ &&
         state_->mode == PlayerMode::kPaused && state_->stop == PlayerStop::kProgramEnd;
}

std::vector<ViewerCommand> PlayerView::lasting() const {
  std::vector<ViewerCommand> all = lasting_;
  for (const SourceRef& line : breakpoints_) {
    all.push_back(BreakpointCommand{scene_.file(line), static_cast<int>(line.line), true});
  }
  return all;
}

bool PlayerView::obey(const ViewerCommand& command) {
  bool goes_on = true;
  std::visit(
      [&](const auto& c) {
        using Command = std::decay_t<decltype(c)>;
        if constexpr (std::is_same_v<Command, PauseCommand> ||
                      std::is_same_v<Command, StopCommand> ||
                      std::is_same_v<Command, StepBlockCommand> ||
                      std::is_same_v<Command, SeekEndCommand> ||
                      std::is_same_v<Command, RunToLineCommand>)
          plays_.reset();
        if constexpr (std::is_same_v<Command, SeekTimeCommand>) {
          if (c.time_s >= track_->duration_s()) plays_.reset();
        }
        if constexpr (std::is_same_v<Command, PlayCommand>) play();
        if constexpr (std::is_same_v<Command, PauseCommand>) player_.pause();
        if constexpr (std::is_same_v<Command, StopCommand>) player_.stop();
        if constexpr (std::is_same_v<Command, SpeedCommand>) {
          // Beyond the greatest: as fast as it can be cut.
          speed_ = c.factor > kMaxSpeed ? std::numeric_limits<double>::infinity()
                                        : std::max(c.factor, kMinSpeed);
          scene_.set_controls(speed_, breakpoints_);
          if (player_.state()->mode == PlayerMode::kPlaying) play();
        }
        if constexpr (std::is_same_v<Command, StepBlockCommand>) player_.step_block(c.blocks);
        if constexpr (std::is_same_v<Command, SeekLineCommand>) seek_line(c.file, c.line);
        if constexpr (std::is_same_v<Command, RunToLineCommand>) run_to_line(c.file, c.line);
        if constexpr (std::is_same_v<Command, SeekTimeCommand>) player_.seek_time(c.time_s);
        if constexpr (std::is_same_v<Command, SeekEndCommand>) player_.seek_end();
        if constexpr (std::is_same_v<Command, NextToolCommand>) player_.seek_tool_change(c.step);
        if constexpr (std::is_same_v<Command, NextFindingCommand>) player_.seek_finding(c.step);
        if constexpr (std::is_same_v<Command, SeekFindingCommand>) {
          if (c.index >= 0) player_.seek_finding_number(static_cast<std::size_t>(c.index));
        }
        if constexpr (std::is_same_v<Command, BreakpointCommand>) set_breakpoint(c);
        if constexpr (std::is_same_v<Command, DetailCommand>)
          scene_.set_detail(c.detail, c.easy_triangles);
        if constexpr (std::is_same_v<Command, DrawModeCommand>) scene_.set_draw_mode(c.draw_mode);
        if constexpr (std::is_same_v<Command, ColorCommand>)
          scene_.set_colors(c, player_.removed_mm3());
        if constexpr (std::is_same_v<Command, PickCommand>)
          scene_.pick(c.point_mm, *player_.state());
        if constexpr (std::is_same_v<Command, EntryCommand>) {
          if (on_entry_) on_entry_(c.line);
        }
        if constexpr (std::is_same_v<Command, OpenCommand> || std::is_same_v<Command, JobCommand> ||
                      std::is_same_v<Command, SetupCommand> ||
                      std::is_same_v<Command, ReadAgainCommand>) {
          asked_ = c;
          goes_on = false;
        }
        if constexpr (std::is_same_v<Command, CloseCommand>) goes_on = false;
      },
      command);
  return goes_on;
}

void PlayerView::seek_line(const std::string& file, int line) {
  if (const auto source = scene_.source_of(file, line)) player_.seek_line(*source);
}

void PlayerView::run_to_line(const std::string& file, int line) {
  if (const auto source = scene_.source_of(file, line)) player_.run_to_line(*source);
}

void PlayerView::set_breakpoint(const BreakpointCommand& command) {
  const auto source = scene_.source_of(command.file, command.line);
  if (!source) return;
  std::erase(breakpoints_, *source);
  if (command.set) breakpoints_.push_back(*source);
  player_.set_breakpoints(breakpoints_);
  scene_.set_controls(speed_, breakpoints_);
}

/// While the window is busy with one picture, one more is made for it, not several: of what moves,
/// the states between would not be seen.
void PlayerView::show() {
  if (mailbox_.is_full()) return;
  state_ = player_.state();
  const bool is_halted = plays_ && state_->commands_done >= *plays_ &&
                         state_->mode == PlayerMode::kPaused &&
                         state_->stop != PlayerStop::kProgramEnd;
  if (is_halted) plays_.reset();
  if (scene_.wants_curves(*state_)) scene_.add_curves(*state_, player_.removed_mm3());
  SceneUpdate update = scene_.update(state_, Clock::now() + kPlayerSlice);
  if (update.moment) moment_ = update.moment;
  if (!PlayerScene::is_empty(update)) mailbox_.publish(std::move(update));
}

}  // namespace kerf
