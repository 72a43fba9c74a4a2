// twin/playback/player_engine.h - what a Player does, without its thread.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "twin/playback/frontier.h"
#include "twin/playback/keyframe_store.h"
#include "twin/playback/player.h"
#include "twin/playback/program_track.h"
#include "twin/playback/stock_cursor.h"

namespace kerf {

/// One call of Player; what the fields mean is said there.
struct PlayerCommand {
  enum class Kind : std::uint8_t {
    kPlay,  ///< number: speed
    kPause,
    kStepBlock,          ///< count
    kSeekTime,           ///< number: seconds
    kSeekMotion,         ///< motion
    kSeekLine,           ///< line, motion
    kSeekToolChange,     ///< count
    kSeekFinding,        ///< count
    kSeekFindingNumber,  ///< motion: the index
    kStop,
    kRunToMotion,     ///< motion
    kRunToLine,       ///< line
    kSetBreakpoints,  ///< lines
  };
  Kind kind = Kind::kPause;
  Player::Ticket ticket = 0;
  double number = 0;
  std::size_t motion = 0;
  int count = 0;
  SourceRef line{};
  std::vector<SourceRef> lines{};
};

/// Works in slices: work() returns after some milliseconds, done or not, so commands never wait
/// longer than that. One thread.
class PlayerEngine {
 public:
  using Clock = std::chrono::steady_clock;
  /// Length of a slice. With the picture that may follow it stays below Player::kInterrupt_ms.
  static constexpr std::chrono::milliseconds kSlice{4};

  PlayerEngine(PlayerProgram program, const PlayerOptions& options);

  void command(const PlayerCommand& command);
  /// A slice. Returns when the next one is wanted: at once (a time that is over), later, or (max())
  /// not before a command.
  Clock::time_point work();
  /// When the next state should be shown; max(): there is nothing new to show.
  /// Any thread.
  std::vector<float> removed_mm3() const { return frontier_.record().removed_mm3(); }
  std::shared_ptr<const LoadRecord> loads() const { return frontier_.loads(); }
  Clock::time_point state_due_at() const;
  std::shared_ptr<const PlayerState> take_state();

 private:
  void set_playing(double speed);
  void go_to(const TrackPosition& goal);
  void run_to(std::size_t motion);
  void stand(PlayerStop why);
  void refuse(std::string message);
  void step_blocks(int blocks);
  void seek_line(const PlayerCommand& command);
  void seek_tool_change(int count);
  void find_finding(int count);
  void seek_finding_number(std::size_t index);
  std::optional<SourceRef> line_of(const Finding& finding) const;
  void find_breakpoint();
  const TrackPosition& destination() const {
    return mode_ == PlayerMode::kSeeking ? goal_ : place_;
  }

  bool search_finding();
  bool reach(const TrackPosition& goal, Clock::time_point until);
  void work_seek(Clock::time_point until);
  void work_run(Clock::time_point until);
  void work_play(Clock::time_point now, Clock::time_point until);
  void move_to(const TrackPosition& place);
  void refresh_findings();
  void describe_place(PlayerState& state) const;
  double seek_progress() const;

  std::shared_ptr<const ProgramTrack> track_;
  PlayerOptions options_;
  std::vector<Finding> remarks_;
  KeyframeStore store_;
  Frontier frontier_;
  StockCursor cursor_;

  PlayerMode mode_ = PlayerMode::kPaused;
  PlayerStop stop_ = PlayerStop::kNone;
  TrackPosition place_;   ///< the cursor stands at its motion, unless a seek or run goes on
  TrackPosition goal_;    ///< of a seek or run
  bool play_on_ = false;  ///< after the seek
  std::optional<int> finding_count_;  ///< of findings to the goal, which is still unknown
  double finding_from_s_ = 0;
  std::size_t seek_from_ = 0;  ///< motion, for the progress
  double speed_ = 1;
  bool behind_ = false;
  Clock::time_point anchor_;  ///< when the place was that of anchor_s_
  double anchor_s_ = 0;
  std::vector<SourceRef> breakpoints_;
  std::size_t next_breakpoint_ = 0;  ///< motion; size(): none ahead

  Player::Ticket ticket_ = 0;  ///< of the last command
  std::string message_;
  bool changed_ = true;  ///< since the last state
  bool urgent_ = true;   ///< and it should be shown at once
  Clock::time_point shown_;
  std::uint64_t states_ = 0;

  std::shared_ptr<const std::vector<Finding>> findings_;
  std::size_t findings_seen_ = 0;
  bool findings_whole_ = false;
  std::shared_ptr<const StockModel> picture_;  ///< of picture_place_
  TrackPosition picture_place_;  ///< without the time; fraction 0 where nothing is cut
  TrackPosition shown_place_;    ///< of the last state
  std::uint64_t pictures_ = 0;
};

}  // namespace kerf
