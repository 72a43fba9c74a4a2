#include "cutting/drilling_force.h"

#include <cmath>

#include "base/geometry.h"

namespace kerf {

DrillingLoad drilling_load(const Material& material, const DrillingCut& cut,
                           std::optional<double> rake_deg) {
  DrillingLoad load;
  if (cut.feed_per_rev_mm <= 0 || cut.diameter_mm <= 0 || cut.edges <= 0) return load;
  const double steep = std::sin(cut.point_deg / 2 * kPi / 180);
  load.chip_mm = cut.feed_per_rev_mm / cut.edges * steep;
  const ValueRange kc =
      kc11_at_rake(material, rake_deg).times(std::pow(load.chip_mm, -material.mc));
  const double torque_nm = cut.feed_per_rev_mm * cut.diameter_mm * cut.diameter_mm / 8 / 1000;
  load.torque_nm = kc.times(torque_nm);
  load.thrust_n = kc.times(0.5 * cut.diameter_mm / 2 * cut.feed_per_rev_mm * steep);
  load.power_w = kc.times(torque_nm * 2 * kPi * cut.rpm / 60);
  return load;
}

}  // namespace kerf
