// interp_bridge/timing/way_in_time.h - how much of a motion's way is done at a share of its time,
// and the other way round.
#pragma once

namespace kerf {

/// The speed along one motion, as the planner has it, by shares of its way and time. Everybody who
/// asks when a place is passed, or where the tip is, asks this.
///
///     speed     ________
///             /          \___     middle: constant acceleration from `from` to its greatest
///       _____/               |    speed, on at that, and down to `to`
///      | in | middle    |out |    in, out: the halves of the arcs that cut its corners, evenly
///
/// Under G96 the middle is on the way at a slowness (1 / speed) that changes in proportion to the
/// way, and is even where the cap holds, before or behind `cap`.
///
/// 36 bytes. The default is an even way.
struct WayInTime {
  float in_way = 0, in_time = 0;    ///< shares of the motion
  float out_way = 0, out_time = 0;  ///< likewise
  float from = 1, to = 1;           ///< of the greatest speed
  /// Share of the middle's way in which standstill would become the greatest speed.
  float ramp = 0;
  float slowness = 1;  ///< at the end of the middle, over that at its start; G96, else 1
  float cap = 0;       ///< share of the middle's way; G96

  /// Share of the time at which this share of the way is done; 0 to 1 from 0 to 1, never falling.
  double time_of(double way) const;
  /// Share of the way that is done at this share of the time. The inverse of time_of().
  double way_of(double time) const;

  /// A part of the motion: its shares of the motion's time, and how its own way goes in that. What
  /// the motion stands at an end belongs to the part at that end.
  struct Part;
  Part between(double from_way, double to_way) const;

  bool is_even() const;
  /// About how far the way is from an even one, as a share of the time.
  double unevenness() const;
  bool operator==(const WayInTime&) const = default;

  /// A middle that begins at a speed, gets to `cruise` and ends at another.
  void set_ramps(double length, double accel, double first, double cruise, double last);
  /// A middle under G96, from the slowness at both ends and that on average.
  void set_slowness(double first, double last, double mean);
  /// The part of a middle (no in and out) from one share of its way to another.
  WayInTime part(double from_way, double to_way) const;
  /// Of a middle's way, the speed there over its greatest.
  double speed_at(double way) const;
  /// Of a middle's way, the slowness there over that at its start; without G96 1.
  double slowness_at(double way) const;
};

struct WayInTime::Part {
  double from_time = 0, to_time = 1;
  WayInTime way;
};

}  // namespace kerf
