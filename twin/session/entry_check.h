// twin/session/entry_check.h - is it safe to begin a program in its middle, as LinuxCNC's "run from
// here" does it?
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "twin/report/entry_report.h"
#include "twin/session/session.h"

namespace kerf {

/// What the program has at the line, by which a machine's positions become its coordinates.
struct EntryFrame {
  WorkpieceFrame work;
  double tool_length_mm = 0;  ///< in force, along Z
};

/// Waits for the machine. Nothing, with diagnostics: it does not say, or not well; nothing without
/// them: it was stopped.
using EntryPlaceFinder =
    std::function<std::optional<EntryLive>(const EntryFrame&, std::stop_token, Diagnostics&)>;

struct EntryWish {
  std::uint32_t line = 0;  ///< 0: none is wanted
  /// Where the machine stands: X Y Z of the workpiece, mm. Nothing: where the program has it.
  std::optional<Vec3> at_mm;
  EntryPlaceFinder find_place;  ///< not null: asks the machine itself instead
};

/// How the program is run from there, and what is known before it is.
struct EntryPlan {
  SessionOptions session;  ///< a run as LinuxCNC would make it, over the workpiece as it is then
  EntryReport report;
  std::vector<Finding> findings;  ///< entry-contact
};

/// Runs the program up to the line (that makes the workpiece, unless `options` has a saved one:
/// that is as it is already), looks what is in force there, where it could be begun instead, and
/// tries the ways. `folder`: for the workpiece in between; it lasts as long as the plan. Nothing,
/// with diagnostics: the line has no motion, it is no milled workpiece, rs274 alone is there, or
/// the program fails before. LinuxCNC: emctaskmain.cc, programStartLine.
std::optional<EntryPlan> plan_entry(const SessionOptions& options, const EntryWish& wish,
                                    const std::string& folder, std::stop_token stop,
                                    Diagnostics& diagnostics);

}  // namespace kerf
