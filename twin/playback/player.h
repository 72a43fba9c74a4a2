// twin/playback/player.h - a program to be played like a film: to and fro, at any speed, to any
// line, always with exactly the workpiece that belongs to the place.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "interp_bridge/motion.h"
#include "stock/stock_model.h"
#include "twin/findings/finding.h"
#include "twin/job/tools.h"
#include "twin/machine/timeline.h"
#include "twin/playback/program_track.h"
#include "twin/playback/programmed_steps.h"
#include "twin/process/check_options.h"
#include "twin/process/process.h"

namespace kerf {

class LoadRecord;

/// What is played.
struct PlayerProgram {
  std::shared_ptr<const ProgramTrack> track;
  std::unique_ptr<StockModel> blank;  ///< uncut
  ToolSources tools;
  /// Where the track is of the path that the machine runs: what the program says. Not of punches.
  ProgrammedSteps programmed;
  /// Limits for the checks (over-feed, axis limits). What is cut is the track;
  /// PlannerOptions::with_path is not looked at.
  TimelineOptions timeline;
  ProcessPointer process = default_process();  ///< that fits the blank
  std::vector<TorchMaterial> materials;        ///< all that the motions name
  /// Motions before this one are cut, but not reported on (--from-line).
  std::size_t report_from = 0;
  CheckOptions checks;
  /// How tools are engaged is measured, as Session does with log_engagement(): `checks.cutting` and
  /// tools' own limits are judged, and Player::loads() is there.
  bool measures_loads = false;
  /// For nothing-cut: judged_blank().
  BlankKind blank_kind = BlankKind::kUnjudged;
  bool whole = true;  ///< false: it goes on behind the track's end, unread
  /// Findings that are known from reading the program; listed with those of cutting it.
  std::vector<Finding> remarks;
};

struct PlayerOptions {
  /// For keyframes. The workpiece at the place, the one of the checks and those that readers of
  /// states still hold come on top.
  std::size_t keyframe_bytes = std::size_t{32} << 20;
  /// While it plays, a new state at least this often (if the place moves).
  std::chrono::milliseconds publish_period{16};
  /// Cut and check the program to its end while there is nothing else to do: findings and
  /// keyframes are then there before they are asked for. Else as far as needed.
  bool check_ahead = true;
  /// Called after each new state, from the player's thread: to wake a window. May be empty.
  std::function<void()> on_state;
};

enum class PlayerMode : std::uint8_t {
  kPaused,
  kPlaying,  ///< at `speed` times the program's own time
  kRunning,  ///< as fast as it can be cut, to a place, showing what it passes
  kSeeking,  ///< jumping: the state shows the old place until the new one is reached
};

/// Why it stands.
enum class PlayerStop : std::uint8_t { kNone, kAsked, kBreakpoint, kArrived, kProgramEnd };

/// The program at one place. Immutable; holds all it refers to.
struct PlayerState {
  std::uint64_t number = 0;         ///< counts states
  std::uint64_t commands_done = 0;  ///< the tickets up to this one are carried out
  PlayerMode mode = PlayerMode::kPaused;
  PlayerStop stop = PlayerStop::kNone;
  double speed = 1;
  bool behind = false;       ///< playing slower than asked: cutting takes longer
  double seek_progress = 1;  ///< 0..1 of a seek that goes on
  std::string message;       ///< why the last command could not be carried out; mostly empty

  TrackPosition place;
  Motion motion;  ///< that runs there; at the end of the program the last one
  Vec3 tip_mm{0};
  std::array<double, 3> abc_deg{};
  Vec3 uvw_mm{0};
  double elapsed_s = 0;
  double remaining_s = 0;
  /// Cutter of `motion`; null: none that is known, or the motion cuts nothing and none did before.
  std::shared_ptr<const Cutter> cutter;

  /// The workpiece, the started part of `motion` included. Never changes.
  std::shared_ptr<const StockModel> stock;
  std::uint64_t stock_number = 0;  ///< equal numbers: the same workpiece

  /// Of the part of the program that has been checked so far, in order of time; those without one
  /// (the remarks) at the end.
  std::shared_ptr<const std::vector<Finding>> findings;
  std::size_t motions_checked = 0;
  std::size_t keyframes = 0;
  std::size_t keyframe_bytes = 0;
  double worst_seek_s = 0;  ///< estimate from measured cutting times
};

/// Plays one program. All work is done in a thread of its own, in slices of a few milliseconds; the
/// calls below return at once and are carried out in order, each as soon as the slice at hand is
/// over: a running seek is dropped for the next command (kInterrupt_ms; single moves that sweep
/// tens of millions of cells may take longer).
///
/// The workpiece at a place does not depend on the way there: it is, bit for bit, what cutting the
/// program from its start to the place leaves, and at the end what Session leaves. (Programs with
/// smooth runs of more than kLongestRun moves are cut with a seam there; heights at a seam may
/// differ from Session's in the last bit, but not from one seek to the next.)
///
/// Commands return a ticket: PlayerState::commands_done reaches it when the command has been
/// carried out (a seek has arrived, or was replaced by another; playing has begun).
class Player {
 public:
  using Ticket = std::uint64_t;
  static constexpr int kInterrupt_ms = 20;

  Player(PlayerProgram program, PlayerOptions options);
  ~Player();
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  /// The newest state; never null. Any thread, never waits for cutting.
  std::shared_ptr<const PlayerState> state() const;
  const ProgramTrack& track() const { return *track_; }
  /// Removed by each motion, as far as the program has been cut; 0 beyond. Any thread, a
  /// nanosecond a motion.
  std::vector<float> removed_mm3() const;
  /// Of the part that has been cut; null: PlayerProgram::measures_loads is not set. Any thread.
  std::shared_ptr<const LoadRecord> loads() const;

  /// `speed` > 0: program seconds a second; infinity: as fast as it can be cut, to the end.
  Ticket play(double speed = 1);
  Ticket pause();
  /// Pauses at the start of the program.
  Ticket stop();
  /// `blocks` on (or back); to the start of a block. Pauses. Back from within a block: its start.
  Ticket step_block(int blocks);

  /// Seeks: the mode is afterwards what it was before (a run becomes a pause).
  Ticket seek_time(double time_s);
  Ticket seek_motion(std::size_t motion);
  /// The first motion of the line at or after motion `from`, or of the next line that has motions.
  Ticket seek_line(SourceRef line, std::size_t from = 0);
  /// `count` tool changes or findings on (or back, < 0) from the place.
  Ticket seek_tool_change(int count);
  Ticket seek_finding(int count);
  /// Finding number `index` of PlayerState::findings: its time, else its line.
  Ticket seek_finding_number(std::size_t index);
  Ticket seek_start() { return seek_motion(0); }
  Ticket seek_end() { return seek_motion(track_->size()); }

  /// As fast as possible to there, showing what it passes. To a place behind: as a seek.
  Ticket run_to_motion(std::size_t motion);
  Ticket run_to_line(SourceRef line);

  /// Playing and running pause before the first motion of a block of these lines. Replaces those
  /// set before. Seeks and steps pass them.
  Ticket set_breakpoints(std::vector<SourceRef> lines);

  /// Waits until the ticket is carried out; false: `timeout` has passed. For tests and for
  /// commands without a window.
  bool wait(Ticket ticket, std::chrono::milliseconds timeout) const;

 private:
  struct Impl;
  std::shared_ptr<const ProgramTrack> track_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kerf
