// twin/process/cutting_wish.h - what is wanted of forces: the material, and what they are held
// against.
#pragma once

#include <optional>

#include "cutting/material.h"

namespace kerf {

struct CuttingWish {
  std::optional<Material> material;  ///< none: no forces
  double spindle_power_kw = 0;       ///< 0: not known
  double spindle_torque_nm = 0;      ///< 0: not known
  double spindle_current_a = 0;      ///< of its motor at that torque; 0: not known
  double most_bend_mm = 0;           ///< of a tool's tip; 0: not judged
  bool wants_climb = false;          ///< conventional milling is told

  /// How tools are engaged has to be measured for it.
  bool is_wanted() const { return material || wants_climb; }
};

}  // namespace kerf
