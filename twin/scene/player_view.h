// twin/scene/player_view.h - a program in the window: commands of the user in, scene values out.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "twin/playback/player.h"
#include "twin/scene/player_scene.h"
#include "viewer/scene_mailbox.h"
#include "viewer/viewer_command.h"

namespace kerf {

/// Stands between Player, which cuts in its own thread, and the window, which draws in the main
/// one: in a third thread it makes what the window needs of what the player has. None waits for
/// another: the newest state counts, and what was not drawn of older ones is skipped. The next
/// picture is made while the window draws the one before, and not before it has taken that.
class PlayerView {
 public:
  /// `mailbox` and `commands` must outlive it.
  PlayerView(PlayerProgram program, PlayerOptions options, ViewedProgram shown,
             SceneMailbox& mailbox, CommandQueue& commands);

  /// Until the window is closed (CloseCommand), something else is to be shown (asked()), `stop` is
  /// asked for, or `is_over`, which is called about ten times a second or more often, says so.
  /// Starts playing at once if `speed` is given. May be called again.
  void run(std::stop_token stop, std::optional<double> speed = std::nullopt,
           const std::function<bool()>& is_over = {});

  /// Who answers an EntryCommand, from within run(); without it none is.
  void answer_entries_by(std::function<void(int line)> on_entry) {
    on_entry_ = std::move(on_entry);
  }

  Player& player() { return player_; }
  /// The OpenCommand, JobCommand, SetupCommand or ReadAgainCommand that ended run(); none: another
  /// reason did.
  const std::optional<ViewerCommand>& asked() const { return asked_; }
  /// What was played has come to the end of the program by itself: nobody has stopped it, or jumped
  /// there.
  bool has_played_out() const;
  bool is_playing() const { return plays_ && !has_played_out(); }
  /// That it has_played_out() was taken note of: not so again before it is played anew.
  void stay() { plays_.reset(); }
  /// What the window was told to be shown how, and the breakpoints: for whatever is shown next.
  std::vector<ViewerCommand> lasting() const;
  /// That was shown last; never null.
  const std::shared_ptr<const Moment>& moment() const { return moment_; }
  double speed() const { return speed_; }

 private:
  using Clock = std::chrono::steady_clock;
  bool obey(const ViewerCommand& command);
  void play();
  void seek_line(const std::string& file, int line);
  void run_to_line(const std::string& file, int line);
  void set_breakpoint(const BreakpointCommand& command);
  void show();
  bool restless() const;
  void remember(const ViewerCommand& command);

  std::shared_ptr<const ProgramTrack> track_;
  SceneMailbox& mailbox_;
  CommandQueue& commands_;
  Player player_;
  PlayerScene scene_;
  double speed_ = 1;
  std::optional<Player::Ticket> plays_;  ///< since this command; none: it stands, or was stopped
  std::vector<SourceRef> breakpoints_;
  std::shared_ptr<const PlayerState> state_;
  std::optional<ViewerCommand> asked_;
  std::function<void(int)> on_entry_;
  std::vector<ViewerCommand> lasting_;
  std::shared_ptr<const Moment> moment_ = std::make_shared<Moment>();
  bool is_started_ = false;
  Clock::time_point quick_until_;  ///< after a command its answer is looked for often
};

}  // namespace kerf
