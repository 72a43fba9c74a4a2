// twin/report/live_report.h - what a report says of a watched machine, besides what it says of a
// dry run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "machine_io/position_source.h"
#include "twin/report/live_facts.h"
#include "twin/report/live_load.h"
#include "twin/report/live_run.h"

namespace kerf {

struct LiveReport {
  std::string source;  ///< "modbus tcp 127.0.0.1:1502 unit 1"
  SourceStatus status;
  LiveFacts facts;
  std::uint64_t dropped = 0;  ///< samples that came faster than they could be cut
  double duration_s = 0;      ///< from the first sample to the last
  double rate_hz = 0;
  /// Age of samples when they were cut: what a machine's position is late by. ms.
  double age_median_ms = 0;
  double age_p99_ms = 0;
  double age_max_ms = 0;
  /// Of sources with a clock of their own: how far the two drift apart beyond their first offset,
  /// and back.
  double clock_offset_s = 0;      ///< host less device at the first sample
  double jitter_ms = 0;           ///< greatest deviation from that offset
  std::uint64_t clock_steps = 0;  ///< this computer's clock was set meanwhile
  std::uint64_t warnings_ahead = 0;
  std::optional<LoadReport> load;  ///< of the spindle; none: the source tells none
  std::vector<LiveRun> runs;       ///< one where the machine has run one program, or none
};

}  // namespace kerf
