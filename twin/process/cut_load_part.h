// twin/process/cut_load_part.h - what a part of a feed move asks of the spindle.
#pragma once

#include <functional>

#include "cutting/material.h"
#include "interp_bridge/motion.h"

namespace kerf {

struct CutLoadPart {
  double start_s = 0, seconds = 0;
  int tool = 0;
  SourceRef source;
  double rpm = 0;           ///< 0: the spindle stands, or nobody knows
  bool is_engaged = false;  ///< false: it is in the air, and asks for nothing
  /// What it asks for could be worked out. Not of tools without teeth=N, of what is not measured.
  bool is_known = true;
  ValueRange power_w;    ///< at the edges, in the mean of a revolution
  ValueRange torque_nm;  ///< the same
};

/// Is told of parts in their order, some time after they were cut.
using CutLoadHearer = std::function<void(const CutLoadPart&)>;

}  // namespace kerf
