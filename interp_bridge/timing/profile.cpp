#include "interp_bridge/timing/profile.h"

#include <algorithm>
#include <cmath>

namespace kerf {

SpeedProfile speed_profile(double length, double accel, double start_speed, double target,
                           double final_speed) {
  SpeedProfile profile;
  profile.start_speed = start_speed;
  const double square0 = start_speed * start_speed;
  const double gain = 2.0 * accel * length;
  double last = std::min(final_speed, target);
  if (last * last > square0 + gain) last = std::sqrt(square0 + gain);
  if (square0 > last * last + gain) {
    // Too fast to slow down in time: brakes all the way.
    last = std::sqrt(square0 - gain);
    profile.end_speed = last;
    profile.peak_speed = profile.cruise_speed = start_speed;
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
      profile.cruise_speed = target;
      profile.duration_s = (start_speed - target) / accel + (target - last) / accel +
                           (length - braking - leaving) / target;
      return profile;
    }
    target = start_speed;
  }
  const double top = std::sqrt((gain + square0 + square1) / 2.0);
  const double peak = std::min(top, target);
  profile.peak_speed = profile.cruise_speed = peak;
  profile.duration_s = (2.0 * peak - start_speed - last) / accel;
  if (peak < top) {
    const double ramps = (2.0 * peak * peak - square0 - square1) / (2.0 * accel);
    profile.duration_s += (length - ramps) / peak;
  }
  return profile;
}

SpeedPoint point_before_stop(double length, double accel, double start_speed, double target,
                             double seconds) {
  const SpeedProfile whole = speed_profile(length, accel, start_speed, target, 0);
  // Too fast to stop at the end: it has hardly begun before it is over.
  if (seconds >= whole.duration_s || whole.end_speed > 0) return {length, whole.end_speed};
  // To its peak, on at that, and down.
  const double peak = std::min(whole.peak_speed, std::max(target, 0.0));
  const double gain = peak < start_speed ? -accel : accel;
  const double gaining_s = (peak - start_speed) / gain;
  const double cruising_s = std::max(whole.duration_s - gaining_s - peak / accel, 0.0);
  const double first_s = std::min(seconds, gaining_s);
  const double second_s = std::clamp(seconds - gaining_s, 0.0, cruising_s);
  const double third_s = seconds - first_s - second_s;
  const double way = (start_speed + gain * first_s / 2) * first_s + peak * second_s +
                     (peak - accel * third_s / 2) * third_s;
  return {std::min(way, length), std::max(start_speed + gain * first_s - accel * third_s, 0.0)};
}

SpeedProfile surprised_profile(double length, double accel_alone, double accel, double start_speed,
                               double target, double final_speed, double seconds) {
  const SpeedProfile alone = speed_profile(length, accel_alone, start_speed, target, 0);
  const SpeedPoint then = point_before_stop(length, accel_alone, start_speed, target, seconds);
  if (then.way_mm >= length) return alone;
  SpeedProfile profile =
      speed_profile(length - then.way_mm, accel, then.speed, target, final_speed);
  profile.duration_s += seconds;
  profile.start_speed = start_speed;
  profile.peak_speed = std::max(profile.peak_speed, alone.peak_speed);
  return profile;
}

}  // namespace kerf
