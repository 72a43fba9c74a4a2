// twin/live/program_duration.h - how long a whole program takes, by the plan.
#pragma once

#include <stop_token>

#include "interp_bridge/program.h"
#include "twin/machine/timeline.h"

namespace kerf {

/// Runs the program. Seconds; < 0: it was stopped. About 1 us a motion.
double program_duration_s(Program& program, TimelineOptions timing, const std::stop_token& stop);

}  // namespace kerf
