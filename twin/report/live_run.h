// twin/report/live_run.h - one run of a program, of those that a watched machine makes in a shift.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "twin/report/live_facts.h"
#include "twin/report/sheet_report.h"

namespace kerf {

/// How a run has ended.
enum class RunEnd : std::uint8_t {
  kRuns,      ///< not yet, when the watch ended
  kFinished,  ///< at the end of its program
  kAborted,   ///< before that
  kUnseen,    ///< it has never been on the path of the program
};
const char* to_string(RunEnd end);

/// What becomes of the workpiece when a program has come to its end.
enum class OnProgramEnd : std::uint8_t {
  kKeep,      ///< the next program works on in it
  kNewBlank,  ///< the next program begins in a new one; after an abort it is still the old one
};

/// From a program's start to the next one's: what the machine does by hand in between belongs to
/// the run before.
struct LiveRun {
  std::uint32_t number = 1;
  std::uint32_t part = 1;  ///< number of the blank that is worked
  std::string program;     ///< path; empty: none is followed
  RunEnd end = RunEnd::kRuns;
  std::uint32_t from_line = 0;  ///< where the machine was found first; 0: it was not
  std::uint32_t to_line = 0;    ///< and last
  double begin_s = 0;           ///< since the first sample
  double end_s = 0;             ///< of the program: what is done by hand afterwards comes later
  LiveFacts facts;
  double removed_mm3 = 0;
  double part_removed_mm3 = 0;                        ///< of the part, by this run and those before
  std::string digest;                                 ///< of the workpiece after it
  std::optional<SheetReport> sheet;                   ///< that is the workpiece, after it
  std::vector<std::string> files;                     ///< of its program; of sheet's lines
  std::uint64_t errors = 0, warnings = 0, notes = 0;  ///< findings
};

}  // namespace kerf
