// cutting/turning_force.h - what turning takes: the force on an insert, torque and power of the
// spindle.
#pragma once

#include "cutting/material.h"

namespace kerf {

/// An insert in a workpiece that turns.
struct TurningCut {
  double deep_mm = 0;          ///< ap, across the way
  double feed_mm_per_rev = 0;  ///< f
  /// Of the lead angle kappa, between edge and way; of an edge that is none straight line its width
  /// across the way to its length. Above 0, 1 at most.
  double sine = 1;
  double radius_mm = 0;  ///< of the workpiece, where it is cut
  double rpm = 0;
};

/// Kienzle on the chip's section (Tabellenbuch Zerspantechnik, 5th ed. 2022; Sandvik Coromant's
/// turning formulas are the same): h = f sin(kappa), Fc = kc11 h^-mc ap f; torque = Fc r, power =
/// torque times the spindle's speed. What goes along the feed and into the part is not worked out:
/// it depends on the insert's rake and its wear.
struct TurningLoad {
  double chip_mm = 0;
  double speed_m_per_min = 0;
  ValueRange force_n;  ///< in the cutting direction
  ValueRange torque_nm, power_w;
};
TurningLoad turning_load(const Material& material, const TurningCut& cut);

}  // namespace kerf
