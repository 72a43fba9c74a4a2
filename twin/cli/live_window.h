// twin/cli/live_window.h - the window beside a session: what it shows, and what comes next in it.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "twin/cli/entry_ask.h"
#include "twin/cli/live_options.h"
#include "twin/cli/program_setup.h"
#include "twin/scene/live_view.h"
#include "viewer/scene_mailbox.h"
#include "viewer/viewer_command.h"

namespace kerf {

/// The machine that is watched, around the blank; see drawn_machine().
std::shared_ptr<const MachineModel> machine_beside(const LiveRequest& request,
                                                   const LiveSession& session,
                                                   Diagnostics& diagnostics);

/// A session is one round. Another one follows when files of a log were changed, or when another
/// log is opened. Declared before the sessions, so that it ends after them.
class LiveWindow {
 public:
  /// `is_shown`: there is a window; else there are rounds, and nobody sees them.
  LiveWindow(SceneMailbox& mailbox, CommandQueue& commands, Arguments arguments,
             bool is_shown = true);
  bool is_shown() const { return is_shown_; }

  /// `on_start` is called before anything of a session is shown; what the user opens then ends the
  /// round and is opened().
  void serve(std::function<void()> on_start);
  bool serves() const { return static_cast<bool>(on_start_); }

  /// Of this round; `stop` ends it.
  LiveViewOptions view_options(const LiveRequest& request, LiveSession& session,
                               std::stop_source stop);
  /// Looks at the files of this round until the thread is ended: those of a log begin the next
  /// round, those of a machine are told.
  std::jthread watch_inputs(const LiveRequest& request, LiveView& view, std::stop_source stop);

  /// The next round is along this program (empty: along none), from now on; false: not now.
  bool follow(const std::string& program);
  /// Blank, tools and fixtures of programs are set in their fields, and remembered from now on.
  /// `on_set` is called when that was done for the program that is followed.
  void edit_setups(std::function<void()> on_set);
  /// What was written, and over it what was set for this program.
  WrittenOptions options_of(const std::string& program) const;
  /// What came of what was asked for in the fields, to be told: it is remembered, or wrong, and the
  /// job's faults say why.
  std::string set_up(const JobCommand& asked);
  /// Of the program that is followed, with its fields.
  void publish_job();

  /// By which the round that begins can be ended for the sake of the next one.
  void begin_round(std::stop_source stop);

  /// This round is over for the sake of the next one.
  bool is_over() const { return is_over_; }
  /// The next round, if there is one.
  std::optional<LiveRequest> take_next();
  const std::optional<std::string>& opened() const { return opened_; }

  SceneMailbox& mailbox() { return mailbox_; }
  CommandQueue& commands() { return commands_; }
  /// The display is gone: the user has not closed the window.
  std::atomic<bool> lost{false};

 private:
  ViewedJob job() const;
  void note_tools(std::vector<JobTool> used);
  void show_job(ViewedJob job);
  void open(const std::string& path, std::stop_source stop);
  /// Of this round.
  bool can_enter() const;
  void ask_entry(int line, const LiveScene& now);
  /// False, and why in the job's faults: what was asked for cannot be shown.
  bool begin_next(Arguments arguments, std::stop_source stop);
  std::vector<std::string> inputs(const LiveRequest& request) const;

  SceneMailbox& mailbox_;
  CommandQueue& commands_;
  const Command command_;
  const bool is_shown_;
  const WrittenOptions written_;  ///< for the first round
  const SetupMemory memory_{setup_memory_path()};
  std::function<void()> on_start_;
  EntryAsk entries_{mailbox_};
  std::mutex mutex_;  // of what follows
  Arguments arguments_;
  std::optional<LiveRequest> next_;
  std::optional<std::string> opened_;
  std::optional<std::stop_source> round_;
  std::function<void()> on_set_;     ///< empty: set-ups are not edited
  std::vector<JobTool> used_tools_;  ///< by the program that is followed, once it was read
  Box blank_mm_;                     ///< that is in use; empty: none yet
  std::atomic<bool> is_over_{false};
};

}  // namespace kerf
