// twin/report/run_json.h - a run of a program as JSON, of reports and events.
#pragma once

#include <nlohmann/json.hpp>

#include "twin/report/live_run.h"

namespace kerf {

/// number, part, program, end, from_line, to_line, begin_s, end_s, samples, path_mm, chord_mm,
/// on_path, off_path, gaps, removed_mm3, part_removed_mm3, digest, errors, warnings, notes.
nlohmann::ordered_json run_json(const LiveRun& run);

}  // namespace kerf
