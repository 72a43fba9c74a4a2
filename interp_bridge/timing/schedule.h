// interp_bridge/timing/schedule.h - the clock: hands the time of segments to the motions they were
// made of.
#pragma once

#include <vector>

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
  void open_motion(double programmed_mm_per_min, double allowed_mm_per_min, std::uint32_t pieces);
  std::uint64_t add_piece(double length_mm);
  /// A motion done by itself while nothing is queued. speed: its peak.
  void alone(const Motion& motion, MotionTiming timing, double seconds, double speed);
  /// The oldest pieces take no time after all.
  void drop_pieces(std::uint32_t count);

  /// The segment after one begins while that still brakes.
  struct Overlap {
    double seconds = 0;
    double braking = 0;   ///< mm/s2, to a stop at its end
    double speeding = 0;  ///< mm/s2, of the next, from a stop ..
    double speed = 0;     ///< .. up to this, mm/s
    const Segment* next = nullptr;
  };
  /// The next segment has been run.
  void run(const Segment& segment, const SpeedProfile& profile, const Overlap& overlap);
  /// The machine stands: the last segment's motion is complete.
  void settle();

 private:
  struct Pending {
    MotionTiming timing;
    std::uint32_t pieces_left = 0;
    bool started = false;
    int middles = 0;             ///< segments that were run for it; of one the way is known
    double in_s = 0, out_s = 0;  ///< corners at its ends, and its rest at the end
  };
  struct Piece {
    std::uint64_t motion = 0;
    double length_mm = 0;
  };

  Pending& add_time(std::uint64_t motion, double seconds, double speed);
  void close_piece();
  void report_ready();
  void run_pieces(const Segment& segment, double seconds, const SpeedProfile& profile,
                  double corner_s);
  void run_blend(const Segment& segment, double seconds, const SpeedProfile& profile);
  void send_line(const Segment& segment, double from_mm, double to_mm);
  void send_arc(const Segment& segment, double from_mm, double to_mm);
  void send_chords(std::size_t from, std::size_t to);
  void round_corner(const Segment& segment, const Overlap& overlap);
  void send_blend_half(const Segment& segment, bool first);

  MotionPlanSink& sink_;
  bool with_path_;
  double clock_s_ = 0;
  std::uint64_t next_index_ = 0;
  /// Half of the time in which the segment before and the next are run at once: it belongs to the
  /// motion before.
  double corner_s_ = 0;
  bool held_ = false;  ///< the oldest piece has been run, up to the blend that may follow
  /// The corner that two segments pass while both are run, as points; the second half of it, and so
  /// much of the second segment, belongs to that.
  std::vector<Vec3> corner_mm_;
  double corner_ahead_mm_ = 0;
  double corner_behind_mm_ = 0;
  double corner_before_mm_ = 0;  ///< of the segment that is run: where its own corner begins
  Ring<Pending> pending_;
  Ring<Piece> pieces_;
};

}  // namespace kerf
