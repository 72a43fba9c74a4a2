// interp_bridge/timing/schedule.h - the clock: hands the time of segments to the motions they were
// made of.
#pragma once

#include "interp_bridge/timing/planner.h"
#include "interp_bridge/timing/profile.h"
#include "interp_bridge/timing/ring.h"
#include "interp_bridge/timing/segment.h"

namespace kerf {

/// A motion is opened with the number of pieces that it is queued as; pieces are numbered in order
/// and each segment covers a run of them. A motion is reported when the last of its pieces is done,
/// and all motions before it.
class Schedule {
 public:
  Schedule(MotionPlanSink& sink, bool with_path);

  double clock_s() const { return clock_s_; }
  /// Time in which no motion runs.
  void pause(double seconds) { clock_s_ += seconds; }

  /// A motion of `pieces` pieces, to be added right after. 0: it takes no time.
  void open_motion(const MotionTiming& timing, std::uint32_t pieces);
  std::uint64_t add_piece(double length_mm);
  /// A motion done by itself while nothing is queued. speed: its peak.
  void alone(const Motion& motion, MotionTiming timing, double seconds, double speed);
  /// The oldest pieces take no time after all.
  void drop_pieces(std::uint32_t count);

  /// The next segment has been run. overlap_s: how much earlier the one after it begins.
  void run(const Segment& segment, const SpeedProfile& profile, double overlap_s);
  /// The machine stands: the last segment's motion is complete.
  void settle();

 private:
  struct Pending {
    MotionTiming timing;
    std::uint32_t pieces_left = 0;
    bool started = false;
  };
  struct Piece {
    std::uint64_t motion = 0;
    double length_mm = 0;
  };

  void add_time(std::uint64_t motion, double seconds, double speed);
  void close_piece();
  void report_ready();
  void run_pieces(const Segment& segment, double seconds, double speed);
  void run_blend(const Segment& segment, double seconds, double speed);
  void send_line(const Segment& segment, double from_part, double to_part);
  void send_arc(const Segment& segment);
  void send_blend_half(const Segment& segment, bool first);

  MotionPlanSink& sink_;
  bool with_path_;
  double clock_s_ = 0;
  std::uint64_t next_index_ = 0;
  bool held_ = false;  ///< the oldest piece has been run, up to the blend that may follow
  Ring<Pending> pending_;
  Ring<Piece> pieces_;
};

}  // namespace kerf
