// twin/config/agent_machine.h - what an MTConnect agent says of its machine, where nothing else
// does.
#pragma once

#include "base/diagnostic.h"
#include "twin/config/live_config.h"
#include "twin/machine/timeline.h"

namespace kerf {

/// Asks the agent of the configuration once, 2 s at most, and fills in what no INI and no key has
/// said: travel limits of the axes (speeds stay assumed ones: no /probe has them), and LinuxCNC's
/// kinematics. Notes say what was taken. An agent that does not answer is a note as well: the watch
/// waits for it. Does nothing for other sources.
void take_agent_machine(const LiveConfig& config, TimelineOptions& timeline,
                        Diagnostics& diagnostics);

}  // namespace kerf
