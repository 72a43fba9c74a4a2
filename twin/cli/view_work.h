// twin/cli/view_work.h - what `kerf view` does beside its window: reads, plays, reads again.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "twin/cli/entry_ask.h"
#include "twin/cli/file_watch.h"
#include "twin/cli/live_command.h"
#include "twin/cli/view_load.h"
#include "twin/cli/view_setups.h"
#include "twin/scene/player_view.h"
#include "twin/serve/player_broadcast.h"
#include "viewer/scene_mailbox.h"
#include "viewer/viewer_command.h"

namespace kerf {

/// In a thread of its own. A program whose files are changed, that is opened from the window or is
/// to be cut otherwise is read while the one before is still shown; where that fails, the one
/// before stays, and the window says why.
class ViewWork {
 public:
  /// `arguments`: from which the request can be understood again; none: what was asked for is shown
  /// and nothing else. The others must outlive it.
  /// `replay` shows the log that is the arguments' program, where logs can be shown. `setups`: of
  /// the part whose setup is shown; when that has been played to its end, the next one plays on.
  /// `served`: pages show what the window does; null: none do.
  using Replay = std::function<ShownLog(const Arguments&, std::function<void()> on_start)>;
  ViewWork(std::optional<Arguments> arguments, ViewRequest request, SceneMailbox& mailbox,
           CommandQueue& commands, std::stop_source& stop, Replay replay = {},
           std::unique_ptr<ViewSetups> setups = nullptr, ServedScene* served = nullptr);

  /// Until the window is closed; what the program is to end with.
  int run();

 private:
  using Clock = std::chrono::steady_clock;
  /// Where a program was when it was read again.
  struct Place {
    std::size_t motions = 0;
    double duration_s = 0;
    std::size_t motion = 0;
    double time_s = 0;
    SourceRef line;
    std::optional<double> speed;  ///< it was playing
  };

  bool has_program() const { return !request_.run.session.program.path.empty(); }
  bool load();
  bool understand_again();
  bool take(const ViewerCommand& asked);
  bool open_setups();
  std::optional<ViewerCommand> wait_without_program();
  bool is_log(const ViewerCommand& asked) const;
  std::optional<ViewerCommand> replay_logs(ViewerCommand asked);
  void tell_faults();
  bool goes_on_to_next() const;
  bool go_to_setup(std::size_t setup, bool plays_on);
  bool show_setup(std::size_t setup);
  bool cut_to_end();
  void tell_changed_setup();
  void replace_view(std::unique_ptr<LoadedProgram> loaded);
  Place place() const;
  void go_to(const Place& place);
  void watch_inputs();
  void describe(const LoadedProgram& loaded);
  void publish_job();
  bool can_enter() const;
  void tell(const std::string& notice);
  void tell_waiting_pages(const std::string& notice);
  void drop_view();
  void announce(const LoadProgress& progress);
  void watch_commands();
  void keep(ViewerCommand command);

  std::optional<Arguments> arguments_;
  ViewRequest request_;
  SceneMailbox& mailbox_;
  CommandQueue& commands_;
  std::stop_source& stop_;
  Replay replay_;
  std::unique_ptr<ViewSetups> setups_;  ///< null: it is one program
  std::string partial_reason_;          ///< of what is shown; empty: it was read to its end
  bool is_setup_shown_ = false;         ///< by view_, and not what was there before the job
  std::optional<std::size_t> told_changed_;
  ServedScene* served_ = nullptr;             ///< null: no page is served
  std::unique_ptr<PlayerView> view_;          ///< null: there is no program
  std::optional<PlayerBroadcast> broadcast_;  ///< of view_'s player
  bool has_machine_ = false;                  ///< in the window
  bool is_same_program_ = false;              ///< as the one that is shown
  std::optional<double> speed_;               ///< to play at, at once
  ViewedJob job_;
  std::string shown_blank_;  ///< its box, as --stock has it; empty: there is none
  FileWatch watch_;
  Diagnostics diagnostics_;  ///< of the last reading
  Outcome outcome_ = Outcome::kFailed;
  Clock::time_point announced_{};
  EntryAsk entries_;
  std::vector<ViewerCommand> waiting_;  ///< for what is shown next
};

}  // namespace kerf
