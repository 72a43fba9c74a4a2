// twin/live/live_json.h - what a live session tells, as JSON lines for other programs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "twin/live/live_session.h"

namespace kerf {

/// What every event has. A reader that has missed some sees it by the sequence; one that was begun
/// anew by the instance.
struct EventHead {
  std::uint64_t instance_id = 0;  ///< of this watch: microseconds since 1970 at its beginning
  std::uint64_t sequence = 1;     ///< 1, 2, .. of the watch's events
  std::int64_t time_ns = 0;       ///< when it was told: since 1970, UTC
};

/// One object and a newline each: instance_id, sequence, time (ISO 8601, UTC), and "event", which
/// says what it is:
///
///   status   state, age_ms, t_s, run, part, samples, errors, lost, dropped, tip_mm or null, tool,
///            on_path, distance_mm, file, line, program_s, remaining_s, removed_mm3, and of the
///            nearest collision ahead collision_in_s, collision_line. What is not known is null.
///   finding  as in the report: id, severity, file, line, time_s, position_mm, tool, depth_mm,
///            message
///   ahead    the same of something that has not happened yet: time_s is that of the program. And
///            t_s, when it was found, and in_s, how long after that it will be
///   run      a run of a program is over: as in the report's live.runs. None where it is all of
///            the watch
/// t_s and a finding's time_s are seconds since the first sample.
std::string status_json(const LiveStatus& status, const EventHead& head);
std::string finding_event_json(const Finding& finding, const std::vector<std::string>& files,
                               const EventHead& head);
std::string ahead_json(const AheadWarning& warning, const std::vector<std::string>& files,
                       const EventHead& head);
std::string run_event_json(const LiveRun& run, const EventHead& head);

}  // namespace kerf
