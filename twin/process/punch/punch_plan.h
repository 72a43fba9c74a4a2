// twin/process/punch/punch_plan.h - the process of sheets under a punch.
#pragma once

#include "twin/process/process.h"

namespace kerf {

/// Row of the table: of sheets, with a turret.
ProcessPointer choose_punch(const ProcessWish& wish);
ProcessPointer punch_process(TurretPointer turret);

}  // namespace kerf
