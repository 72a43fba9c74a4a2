#include "interp_bridge/machine_limits.h"

namespace kerf {

MachineLimits MachineLimits::small_mill() {
  MachineLimits limits;
  limits.axes[0] = {.present = true, .max_velocity = 100, .max_acceleration = 500};
  limits.axes[1] = {.present = true, .max_velocity = 100, .max_acceleration = 500};
  limits.axes[2] = {.present = true, .max_velocity = 60, .max_acceleration = 300};
  for (std::size_t axis = 3; axis < 6; ++axis) {
    limits.axes[axis] = {.present = true, .max_velocity = 90, .max_acceleration = 360};
  }
  limits.max_linear_velocity_mm_per_s = 100;
  return limits;
}

}  // namespace kerf
