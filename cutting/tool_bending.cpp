#include "cutting/tool_bending.h"

#include <algorithm>
#include <cmath>

#include "base/geometry.h"

namespace kerf {
namespace {

/// Of a rod from `from` to `to` (from the tip), where a force at `at` bends it: the moment is
/// x - at for each N, and each mm of it turns the tip by as much over x.
double part_of(double diameter_mm, double modulus, double from, double to, double at) {
  from = std::max(from, at);
  if (to <= from) return 0;
  const auto whole = [at](double x) { return x * x * x / 3 - at * x * x / 2; };
  const double inertia = kPi / 64 * std::pow(diameter_mm, 4);
  return (whole(to) - whole(from)) / (modulus * inertia);
}

}  // namespace

double tip_bends_mm_per_n(const ToolRods& rods, double at_mm) {
  const double flute_mm = std::min(rods.flute_mm, rods.stickout_mm);
  return part_of(kFluteShare * rods.diameter_mm, rods.modulus_n_per_mm2, 0, flute_mm, at_mm) +
         part_of(rods.shank_diameter_mm, rods.modulus_n_per_mm2, flute_mm, rods.stickout_mm, at_mm);
}

}  // namespace kerf
