// cutting/drilling_force.h - what drilling, and going straight down with another tool, takes.
#pragma once

#include <optional>

#include "cutting/material.h"

namespace kerf {

/// A tool that goes straight down into solid material. Its edges reach to the axis.
struct DrillingCut {
  double diameter_mm = 0;
  int edges = 2;
  double point_deg = 180;  ///< of the whole point; 180: flat
  double feed_per_rev_mm = 0;
  double rpm = 0;
};

/// h = feed / edges * sin(point / 2); each edge cuts with kc * D / 2 * feed / edges, in the mean at
/// a quarter of the diameter: torque = kc * feed * D^2 / 8. Thrust = 0.5 * kc * D / 2 * feed *
/// sin(point / 2) (Sandvik Coromant, drilling formulas and definitions). Both without the chisel
/// edge, which takes most of its share in thrust: a fair guide for drills with a thinned web, too
/// little for others.
struct DrillingLoad {
  double chip_mm = 0;
  ValueRange torque_nm, thrust_n, power_w;
};
DrillingLoad drilling_load(const Material& material, const DrillingCut& cut,
                           std::optional<double> rake_deg);

}  // namespace kerf
