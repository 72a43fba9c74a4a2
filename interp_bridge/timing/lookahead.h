// interp_bridge/timing/lookahead.h - how fast each corner may be passed, given the stops that may
// follow within the planner's look-ahead.
#pragma once

#include <cstdint>

#include "interp_bridge/timing/ring.h"
#include "interp_bridge/timing/schedule.h"
#include "interp_bridge/timing/segment.h"

namespace kerf {

/// Queue of segments between the corners and the clock. With w(i) the square of the speed at the
/// end of segment i, c(i) the square of what its corner allows and g(i) = 2 a L the square of the
/// speed that segment i can brake from,
///
///     w(i) = min( c(i), w(i+1) + g(i+1) ) = min over j >= i of ( c(j) + S(j) ) - S(i)
///
/// with S the running sum of g: the least of a sliding window, found in constant time per segment.
/// The window ends arc_blend_depth segments on, where LinuxCNC reckons with a stop.
class Lookahead {
 public:
  Lookahead(const AxisRates& rates, Schedule& schedule);

  /// Appends a segment, with what its corner to the one before becomes. What is left of `segment`
  /// is of no use.
  void add(Segment& segment);
  bool empty() const { return queue_.empty(); }
  /// When the machine stands, on the schedule's clock, if nothing more is added.
  double end_s() const;
  /// What is added from here on reaches LinuxCNC at that moment of the schedule's clock: the last
  /// segment, if it has begun by then, has begun as if nothing followed.
  void next_comes_at(double clock_s);
  /// The last of what is queued ends in a full stop: what follows waits for the spindle.
  void stop_last() {
    if (!queue_.empty()) queue_.back().segment.end = SegmentEnd::kStop;
  }
  /// The machine stops after what is queued; all of it is run.
  void drain();

 private:
  struct Queued {
    Segment segment;
    double sum = 0;  ///< S, once finalized
  };
  struct Limit {
    std::uint64_t number = 0;
    double height = 0;  ///< c + S
  };

  struct Run {
    SpeedProfile profile;
    Schedule::Overlap overlap;
  };

  /// What happens if nothing more is added.
  struct Rest {
    double end_s = 0;
    double last_begins_s = 0;  ///< the last segment
    double last_speed = 0;     ///< at which it begins
  };

  Rest rest() const;
  void finalize_back(bool followed);
  void finish_back();
  Run run_of_front(double horizon, double clock_s);
  void drop_front(const Run& run);
  void limit_corner(std::uint64_t number, double square);
  double speed_into(const Segment& segment, const Segment& next, double target) const;
  void retire(double horizon);

  const AxisRates& rates_;
  Schedule& schedule_;
  Ring<Queued> queue_;
  Segment blend_;  ///< of join_corner()
  Ring<Limit> limits_;
  double retired_sum_ = 0;
  double speed_ = 0;  ///< at the end of the last retired segment
};

}  // namespace kerf
