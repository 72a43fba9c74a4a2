#include "interp_bridge/timing/profile.h"

#include <algorithm>
#include <cmath>

namespace kerf {

SpeedProfile speed_profile(double length, double accel, double start_speed, double target,
                           double final_speed) {
  SpeedProfile profile;
  const double square0 = start_speed * start_speed;
  const double gain = 2.0 * accel * length;
  double last = std::min(final_speed, target);
  if (last * last > square0 + gain) last = std::sqrt(square0 + gain);
  if (square0 > last * last + gain) {
    // Too fast to slow down in time: brakes all the way.
    last = std::sqrt(square0 - gain);
    profile.end_speed = last;
    profile.peak_speed = start_speed;
    profile.duration_s = 2.0 * length / (start_speed + last);
    return profile;
  }
  profile.end_speed = last;
  const double square1 = last * last;
  if (start_speed > target) {
    const double braking = (square0 - target * target) / (2.0 * accel);
    const double leaving = (target * target - square1) / (2.0 * accel);
    if (braking + leaving <= length) {
      profile.peak_speed = start_speed;
      profile.duration_s = (start_speed - target) / accel + (target - last) / accel +
                           (length - braking - leaving) / target;
      return profile;
    }
    target = start_speed;
  }
  const double top = std::sqrt((gain + square0 + square1) / 2.0);
  const double peak = std::min(top, target);
  profile.peak_speed = peak;
  profile.duration_s = (2.0 * peak - start_speed - last) / accel;
  if (peak < top) {
    const double ramps = (2.0 * peak * peak - square0 - square1) / (2.0 * accel);
    profile.duration_s += (length - ramps) / peak;
  }
  return profile;
}

}  // namespace kerf
