// interp_bridge/timing/spindle_speed.h - how fast the spindle turns along a motion, and a feed per
// revolution with it.
#pragma once

#include "interp_bridge/motion.h"
#include "interp_bridge/timing/way_in_time.h"

namespace kerf {

/// What is commanded of the spindle when `share` (0 to 1) of the motion's way is done: S, or under
/// G96 what the tip's distance from the axis makes of it, capped by D. Never negative; whether it
/// turns is in motion.spindle. O(1).
double spindle_rpm_at(const Motion& motion, double share);

/// The fastest that is commanded along a motion, and the share of the way where it first is.
struct SpindlePeak {
  double rpm = 0;
  double share = 0;
};
/// A straight line: exact. An arc under G96: to a ten-thousandth of its way. O(1).
SpindlePeak peak_spindle_rpm(const Motion& motion);

/// How fast a spindle gets from one speed to another, and when LinuxCNC calls it at speed.
struct SpindleDrive {
  /// Speed gained or lost in a second; 0: not known, it is at speed at once.
  double accel_rpm_per_s = 0;
  double max_rpm = 0;  ///< it turns no faster, whatever is commanded; 0: not known

  /// As LinuxCNC's sample configurations have it (hallib: near, lowpass): at speed within a tenth
  /// or 10 rpm, by a speed that is measured with this lag.
  static constexpr double kNearShare = 1.1;
  static constexpr double kNear_rpm = 10;
  static constexpr double kMeasured_s = 0.0138;

  bool known() const { return accel_rpm_per_s > 0; }
};

/// The motion as a spindle runs it that has a greatest speed.
void cap_speed(Motion& motion, double max_rpm);

/// The speed of a spindle in time. Speeds are signed: negative turns counterclockwise.
class SpindleSpeed {
 public:
  explicit SpindleSpeed(const SpindleDrive& drive) : drive_(drive) {}

  double rpm() const { return rpm_; }
  /// What is commanded stays so long.
  void stand(double commanded_rpm, double seconds);
  /// A motion is run: its way as `way` has it, or if end_rpm >= 0 so that the spindle has that at
  /// its end.
  void follow(const Motion& motion, double seconds, const WayInTime& way, double end_rpm);
  /// Seconds until LinuxCNC calls it at speed; it is that much further then. 0: it is.
  double wait_until_near(double commanded_rpm);

 private:
  void step(double commanded_rpm, double seconds);
  bool is_near(double commanded_rpm) const;

  SpindleDrive drive_;
  double rpm_ = 0;
  double measured_rpm_ = 0;
};

/// The speed that the spindle has when a motion's program has it, signed.
double commanded_rpm(const Motion& motion, double share);

/// A feed per revolution along a motion.
struct SpindleFeed {
  double mean = 0;  ///< mm/s: the way over the time it takes
  double most = 0;  ///< mm/s, of what is commanded
  double end_rpm = 0;
  double slow_from = 0, slow_to = 0;  ///< s/mm at both ends; 0: it does not change
};
/// `feed_mm` per revolution, from a spindle that turns at start_rpm (negative: at what is
/// commanded), on a way on which the axes do most_mm_per_s. Where the spindle cannot follow what
/// G96 commands, it is late. O(1): some hundred steps where the distance from the axis changes.
SpindleFeed spindle_feed(const Motion& motion, double feed_mm, double length_mm,
                         const SpindleDrive& drive, double start_rpm, double most_mm_per_s);

}  // namespace kerf
