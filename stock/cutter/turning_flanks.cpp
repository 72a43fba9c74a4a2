#include "stock/cutter/turning_flanks.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/portable_math.h"
#include "base/units.h"
#include "stock/cutter/insert_shape.h"

namespace kerf {

std::optional<double> iso_angle_deg(char shape) {
  switch (shape) {
    case 'C':
    case 'E':
    case 'W':
      return 95;
    case 'D':
    case 'V':
    case 'K':
    case 'M':
      return 93;
    case 'T':
      return 91;
    case 'S':
      return 75;
    case 'P':
      return 60;
    default:
      return std::nullopt;
  }
}

FlankAngles usual_flanks(int orientation) {
  // LinuxCNC 2.9, configs/sim/lathe.tbl.
  constexpr std::array<FlankAngles, 8> kUsual{
      {{95, 155}, {85, 25}, {275, 335}, {265, 205}, {210, 150}, {120, 60}, {-30, 30}, {240, 300}}};
  return kUsual[static_cast<std::size_t>(std::clamp(orientation, 1, 8) - 1)];
}

std::optional<FlankAngles> nearest_flanks(FlankAngles angles) {
  const double apart = std::remainder(angles.back_deg - angles.front_deg, 360);
  if (!(std::abs(apart) < 180 - 1e-4)) return std::nullopt;
  // As they are, unless they are more than half a turn apart.
  if (std::abs(angles.back_deg - angles.front_deg) >= 180) {
    angles.back_deg = angles.front_deg + apart;
  }
  return angles;
}

bool fits_orientation(const FlankAngles& angles, int orientation) {
  if (orientation < 1 || orientation >= kOrientations) return true;
  const double middle = (angles.front_deg + angles.back_deg) / 2 * kRadPerDeg;
  const Vec2 behind = nose_direction(orientation);
  return behind.x * portable::cos(middle) + behind.y * portable::sin(middle) > 0;
}

Hand hand_of_orientation(int orientation) {
  if (orientation == 1 || orientation == 4) return Hand::kLeft;
  return orientation == 2 || orientation == 3 ? Hand::kRight : Hand::kNeutral;
}

int usual_orientation(Hand hand, bool in_bore) {
  if (hand == Hand::kNeutral) return in_bore ? 8 : 6;
  if (hand == Hand::kLeft) return in_bore ? 4 : 1;
  return in_bore ? 3 : 2;
}

FlankAngles flanks_of_hand(Hand hand, int orientation, double kappa_deg, double corner_deg) {
  // Worked out for a tool that points to -x and cuts towards -z; the others are its mirrors.
  FlankAngles angles{180 - kappa_deg, 180 - kappa_deg - corner_deg};
  if (hand == Hand::kNeutral) {
    angles = {90 + corner_deg / 2, 90 - corner_deg / 2};
    if (orientation == 5 || orientation == 7) {  // along the axis
      const double middle = orientation == 7 ? 0 : 180;
      return {middle + corner_deg / 2, middle - corner_deg / 2};
    }
  }
  if (hand == Hand::kLeft) angles = {180 - angles.front_deg, 180 - angles.back_deg};
  if (nose_direction(orientation).y < 0) angles = {360 - angles.front_deg, 360 - angles.back_deg};
  return angles;
}

}  // namespace kerf
