// twin/live/live_session.h - a machine watched (shadow), or a log of one run again (replay).
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "base/diagnostic.h"
#include "interp_bridge/program.h"
#include "machine_io/position_source.h"
#include "stock/blank.h"
#include "twin/findings/outcome.h"
#include "twin/job/tools.h"
#include "twin/live/clock_watch.h"
#include "twin/live/feed_meter.h"
#include "twin/live/live_cutter.h"
#include "twin/live/live_programs.h"
#include "twin/live/live_shift.h"
#include "twin/live/log_pace.h"
#include "twin/live/sample_queue.h"
#include "twin/live/source_faults.h"
#include "twin/program/session_parts.h"
#include "twin/report/live_report.h"
#include "twin/report/report.h"

namespace kerf {

/// How old what is shown is.
enum class LiveState : std::uint8_t {
  kWaiting,  ///< no position yet
  kLive,
  kStale,  ///< no sample for LiveOptions::stale_after_s
  kLost,   ///< no sample for LiveOptions::lost_after_s
  kEnded,  ///< the log is at its end, or the time asked for is over
};
const char* to_string(LiveState state);

struct LiveOptions {
  std::optional<ProgramOptions> program;
  /// Other programs that the machine may run, with the same settings: which one it is at each
  /// start, its path tells.
  std::vector<std::string> more_programs;
  OnProgramEnd on_end = OnProgramEnd::kKeep;
  /// Without a program: where the tool table is, and its unit.
  std::string tool_table_path;
  bool inch_table = false;
  std::string lathe;     ///< ProgramOptions::lathe, with a program or without
  bool as_mill = false;  ///< ProgramOptions::as_mill
  std::vector<ToolShapeArgument> tools;
  std::vector<ToolLibrary> libraries;
  std::optional<Blank> blank;
  StockSettings stock;
  double margin_mm = 5;  ///< around a blank guessed from the program
  /// For a sheet. Without a program there is nothing to look for the trigger in, and a warning says
  /// so (LiveCutOptions::process).
  BeamOptions beam;
  TurretPointer turret;  ///< for a sheet that is punched, instead
  LiveCutOptions cutting;
  double stale_after_s = 0.5;
  double lost_after_s = 2.0;
  /// Of a log: program seconds a second; infinity: as fast as it goes. Of a machine: 0.
  double speed = 0;
  /// Ends after so many seconds; 0: with the source, or when it is stopped.
  double for_s = 0;
  /// This computer's clock, for tests; empty: real_time_ns().
  std::function<std::int64_t()> clock_ns;
  bool log() const { return speed > 0; }
};

/// What a window or a console shows.
struct LiveStatus {
  LiveState state = LiveState::kWaiting;
  double age_s = 0;  ///< of the newest sample
  double t_s = 0;    ///< since the first sample, by its clock
  ToolState place;
  std::uint32_t run = 1;  ///< LiveRun's number
  std::uint32_t part = 1;
  std::string file;            ///< of the program's line the machine is on
  double remaining_s = -1;     ///< of the program, by the plan; < 0: not known
  double collision_in_s = -1;  ///< the nearest of the warnings that are still ahead; < 0: none
  std::uint32_t collision_line = 0;
  SourceStatus source;
  std::uint64_t dropped = 0;  ///< samples that came faster than they could be cut
  std::uint64_t samples = 0;
  WorkpieceFrame work;     ///< where the workpiece lies in the machine
  double off_path_mm = 0;  ///< while the tip is off the path
  double removed_mm3 = 0;
  /// Of the tip on the part, from the positions (FeedMeter); none: the source is not live, or it is
  /// not known yet.
  std::optional<double> feed_mm_per_min;
  std::optional<LoadNow> load;  ///< of the spindle
};

/// Told from the thread in LiveSession::run().
class LiveObserver {
 public:
  virtual ~LiveObserver() = default;
  /// The state changed, or a while has passed (LiveSession::kStatusPeriod).
  virtual void on_status(const LiveStatus& status) = 0;
  virtual void on_finding(const Finding& finding, const std::vector<std::string>& files) = 0;
  virtual void on_warning(const AheadWarning& warning, const std::vector<std::string>& files) = 0;
  /// A run of a program is over, and another one has begun or the watch ends.
  virtual void on_run(const LiveRun& run) { static_cast<void>(run); }
  /// Asked once, before the first sample: on_frame() is wanted.
  virtual bool wants_frames() const { return false; }
  /// How often; asked once as well.
  virtual std::chrono::milliseconds frame_period() const { return kFramePeriod; }
  static constexpr std::chrono::milliseconds kFramePeriod{8};
  /// After samples were taken, as soon as frame_period() has passed since the last call: for views.
  /// `stock` during the call only; its snapshot() has all samples. `cutter`: in the spindle, null
  /// as long as none that is known was needed.
  /// `trail`: where the tip has been since the last call, points farther apart than kTrail_mm.
  /// `labels`: of all cuts so far, by cut id; empty unless LiveSession::keep_cut_ids() was called.
  virtual void on_frame(StockModel& stock, const Cutter* cutter, const LiveStatus& status,
                        std::span<const Vec3> trail, std::span<const CutLabel> labels) {
    static_cast<void>(stock), static_cast<void>(cutter), static_cast<void>(status);
    static_cast<void>(trail), static_cast<void>(labels);
  }
  static constexpr double kTrail_mm = 0.05;
};

/// A sample with what lies between it and the one before.
struct TappedSample {
  const AxisSample& sample;
  std::uint64_t lost = 0;         ///< that the source has lost
  std::int64_t clock_set_ns = 0;  ///< by which this computer's clock was set; of logs 0
};

/// Takes every sample, in the thread that reads the source. For recorders.
using SampleTap = std::function<void(const TappedSample&)>;

/// Two threads: one asks the source, the caller's cuts. A machine is never waited for nor made to
/// wait: what comes faster than it can be cut is dropped and counted. A log waits.
class LiveSession {
 public:
  static constexpr std::chrono::milliseconds kStatusPeriod{100};

  /// Checks all that can be checked beforehand. Null on error, with diagnostics; `outcome` says of
  /// which kind.
  static std::unique_ptr<LiveSession> open(LiveOptions options,
                                           std::unique_ptr<PositionSource> source,
                                           Diagnostics& diagnostics, Outcome& outcome);
  ~LiveSession();

  void set_observer(LiveObserver* observer) { observer_ = observer; }
  void set_tap(SampleTap tap) { tap_ = std::move(tap); }
  /// Asked between batches how long to sleep, to leave the computer to others.
  void set_rest(std::function<std::chrono::microseconds()> rest) { rest_ = std::move(rest); }

  /// The workpiece remembers which tool and line cut it where, for windows; its cut ids are the
  /// numbers of labels. Costs as much memory as its heights do, and some cutting time; what it
  /// becomes is the same. Before run().
  void keep_cut_ids();
  /// By cut id; after run().
  std::span<const CutLabel> cut_labels() const { return labels_.all(); }

  /// Of a log, while it runs: program seconds a second, 0 stands still, infinity goes as fast as it
  /// can. Any thread. A machine has its own speed.
  void set_speed(double speed) { pace_.set_speed(speed); }

  /// Call once.
  Outcome run(std::stop_token stop, Diagnostics& diagnostics);

  /// After run().
  Report& report() { return report_; }
  const StockModel* stock() const { return shift_ ? &shift_->stock() : stock_.get(); }
  const ToolSources& tool_sources() const { return tool_sources_; }
  /// As findings are judged by, with what holds the blank there is.
  const CollisionWishes& collisions() const { return options_.cutting.checks.collisions; }
  std::string source_name() const { return source_->describe(); }

 private:
  using Clock = std::chrono::steady_clock;
  LiveSession(LiveOptions options, std::unique_ptr<PositionSource> source);
  bool set_up(Diagnostics& diagnostics, Outcome& outcome);
  /// What the program is found to need before it is followed.
  struct Survey;
  bool survey_program(const ToolSources& tools, Survey& survey, Diagnostics& diagnostics);
  void prepare_process(Diagnostics& diagnostics);
  bool guess_blank(const Survey& survey, Diagnostics& diagnostics, Outcome& outcome);
  std::string need_of_tilt(const Survey& survey) const;
  void read_source(std::stop_token stop);
  void cut_samples(const std::stop_token& stop);
  TappedSample tapped(const ArrivedSample& arrived);
  void take(const ArrivedSample& arrived);
  double time_of(const ArrivedSample& arrived);
  void note_clocks(const ArrivedSample& arrived, double t_s);
  void tell(bool ended);
  void measure_feed();
  void extend_trail();
  void show_frame();
  LiveStatus status_now(LiveState state, double age_s);
  LiveState state_now(double age_s) const;
  void conclude();
  Outcome outcome() const;

  LiveOptions options_;
  std::unique_ptr<PositionSource> source_;
  LivePrograms programs_;
  StockChoice choice_;
  std::unique_ptr<StockModel> stock_;  ///< until there is a shift
  StockReport stock_facts_;
  ToolSources tool_sources_;
  CutLabels labels_;
  std::unique_ptr<LiveShift> shift_;
  LiveObserver* observer_ = nullptr;
  SampleTap tap_;
  LogPace pace_;
  std::function<std::chrono::microseconds()> rest_;
  Report report_;

  SampleQueue queue_;
  mutable std::mutex status_mutex_;  // of source_status_
  SourceStatus source_status_;
  SourceFaults source_faults_;

  // of the cutting thread
  std::optional<ArrivedSample> first_;
  ArrivedSample newest_;
  double t_s_ = 0;
  double look_at_s_ = 0;  ///< when the program ahead is looked at next
  bool stopped_ = false;  ///< by who called run()
  std::int64_t stamp_before_ns_ = 0;
  std::uint64_t lost_before_ = 0;
  std::uint64_t dropped_before_ = 0;
  LiveState told_state_ = LiveState::kWaiting;
  LiveState last_state_ = LiveState::kWaiting;  ///< when it was stopped
  Clock::time_point told_at_;
  bool shows_frames_ = false;
  std::chrono::milliseconds frame_period_{0};
  Clock::time_point frame_at_;
  std::uint64_t frame_samples_ = 0;  ///< those that the last frame had
  std::vector<Vec3> trail_;          ///< since the last frame
  std::optional<Vec3> trail_end_;
  std::size_t told_runs_ = 0;
  std::vector<LiveShift::Told> fresh_;  ///< not told yet
  std::uint64_t samples_ = 0;
  std::vector<AheadWarning> ahead_;  ///< warnings whose time has not come
  LiveReport live_;
  FeedMeter feed_meter_;
  std::vector<float> ages_ms_;  ///< ring of the ages at which samples were cut
  std::size_t next_age_ = 0;
  // of the source's thread
  std::uint64_t tapped_lost_ = 0;
  ClockWatch clock_watch_;
  Clock::time_point start_;
};

}  // namespace kerf
