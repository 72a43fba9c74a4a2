// twin/cli/live_place.h - where the machine stands now, by the source of a configuration: for a
// start in the middle of a program (`kerf run --enter --at live`).
#pragma once

#include "base/diagnostic.h"
#include "twin/config/live_config.h"
#include "twin/config/written_options.h"
#include "twin/session/entry_check.h"

namespace kerf {

/// Of a command line of `kerf run` with a configuration that has a source. Faults of either are
/// diagnostics. The finder connects when it is asked, waits for up to 10 s until X, Y and Z (or the
/// joints that they are made of) have come, none of them older than source.stale_after_ms, from a
/// machine that has stood still for 0.4 s, and says what was wrong otherwise. Of a log it takes the
/// last line: as old as it is by the recording's clock, or else by the time at which the file was
/// written last. It only reads.
EntryPlaceFinder live_place_finder(const Arguments& arguments, Diagnostics& diagnostics);

}  // namespace kerf
