// twin/process/milling/milling_plan.h - the process of rotating tools.
#pragma once

#include "twin/process/process.h"

namespace kerf {

/// Row of the table: takes every job.
ProcessPointer choose_milling(const ProcessWish& wish);

}  // namespace kerf
