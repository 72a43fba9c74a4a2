// interp_bridge/timing/profile.h - time over one segment at limited speed and acceleration.
#pragma once

namespace kerf {

struct SpeedProfile {
  double duration_s = 0;
  double rest_s = 0;  ///< of that, standing at the end
  double start_speed = 0;
  double end_speed = 0;  ///< reached at the end; above `final_speed` if it could not slow down
  double peak_speed = 0;
  double cruise_speed = 0;  ///< between the ramps; below peak_speed where it begins by braking
};

/// Trapezoid (or triangle, or part of one): starts at start_speed, runs at `target` where it can,
/// and is at final_speed at the end if the acceleration allows it. All speeds in mm/s, >= 0;
/// length > 0, accel > 0; target > 0. A start above `target` is slowed down first.
SpeedProfile speed_profile(double length, double accel, double start_speed, double target,
                           double final_speed);

/// Where a segment is after `seconds` on the way to a stop at its end.
struct SpeedPoint {
  double way_mm = 0;
  double speed = 0;
};
SpeedPoint point_before_stop(double length, double accel, double start_speed, double target,
                             double seconds);

/// speed_profile() of a segment that is run towards a stop at accel_alone for the first seconds,
/// and only then with `accel` towards final_speed.
SpeedProfile surprised_profile(double length, double accel_alone, double accel, double start_speed,
                               double target, double final_speed, double seconds);

}  // namespace kerf
