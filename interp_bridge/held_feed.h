// interp_bridge/held_feed.h - feeds that LinuxCNC does not send to the machine at once.
#pragma once

#include "interp_bridge/motion.h"

namespace kerf {

/// LinuxCNC (2.8 to 2.10) holds the feed back until it knows whether the next one can be merged
/// with it (G64 Q): a straight one, or an arc so flat that two lines are made of it. M61 and G10
/// L0, behind which the program is read on from where the machine stands, forget it.
bool is_held_back(const Motion& motion);

}  // namespace kerf
