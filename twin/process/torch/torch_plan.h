// twin/process/torch/torch_plan.h - the process of sheets under a torch, laser or jet.
#pragma once

#include "twin/process/process.h"

namespace kerf {

/// Row of the table: of sheets that nothing punches.
ProcessPointer choose_torch(const ProcessWish& wish);
ProcessPointer torch_process(BeamSettings settings);

}  // namespace kerf
