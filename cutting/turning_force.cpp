#include "cutting/turning_force.h"

#include <cmath>

#include "base/geometry.h"

namespace kerf {

TurningLoad turning_load(const Material& material, const TurningCut& cut) {
  TurningLoad load;
  load.chip_mm = cut.feed_mm_per_rev * cut.sine;
  const double per_s = cut.rpm / 60;
  load.speed_m_per_min = 2 * kPi * cut.radius_mm * cut.rpm / 1000;
  if (load.chip_mm <= 0 || cut.deep_mm <= 0) return load;
  const double section_mm2 = cut.deep_mm * cut.feed_mm_per_rev;
  load.force_n = material.kc11_n_per_mm2.times(std::pow(load.chip_mm, -material.mc) * section_mm2);
  load.torque_nm = load.force_n.times(cut.radius_mm / 1000);
  load.power_w = load.torque_nm.times(2 * kPi * per_s);
  return load;
}

}  // namespace kerf
