// twin/live/live_text.h - what of a machine that is watched people read in a line.
#pragma once

#include <string>

#include "twin/live/live_session.h"

namespace kerf {

/// "5 s", "2 min 05 s", "1 h 02 min"
std::string time_left_text(double seconds);
/// "40 ms", "2.5 s"
std::string short_age_text(double seconds);

/// What is to be known before all else: that no position comes, a collision ahead, off the path.
/// Empty: nothing. Lengths are mm (in_unit()).
std::string notice_of(const LiveStatus& status);

}  // namespace kerf
