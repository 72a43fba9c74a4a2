// twin/process/turning/turning_plan.h - the process of workpieces that turn.
#pragma once

#include "twin/process/process.h"

namespace kerf {

/// Row of the table: of the model turning.
ProcessPointer choose_turning(const ProcessWish& wish);

}  // namespace kerf
