// twin/live/live_json.h - what a live session tells, as JSON lines for other programs.
#pragma once

#include <string>
#include <vector>

#include "twin/live/live_session.h"

namespace kerf {

/// One object and a newline each. "event" says what it is:
///
///   status   state, age_ms, t_s, samples, errors, lost, dropped, tip_mm or null, tool, on_path,
///            distance_mm, file, line, program_s, remaining_s, removed_mm3, and of the nearest
///            collision ahead collision_in_s, collision_line. What is not known is null.
///   finding  as in the report: id, severity, file, line, time_s, position_mm, tool, depth_mm,
///            message
///   ahead    the same of something that has not happened yet, and in_s
std::string status_json(const LiveStatus& status);
std::string finding_event_json(const Finding& finding, const std::vector<std::string>& files);
std::string ahead_json(const AheadWarning& warning, const std::vector<std::string>& files);

}  // namespace kerf
