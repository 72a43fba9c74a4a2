// twin/program/turning.h - whether a program is for a lathe.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "interp_bridge/program.h"
#include "twin/job/stock_choice.h"
#include "twin/job/tools.h"

namespace kerf {

/// What says for sure that this is turning, in words: that the machine is a lathe
/// (ProgramOptions::lathe), that it has X and Z alone and the program moves in G18, G7, a threading
/// or contour cycle, G96 or cutter compensation in the plane of a program that has nothing but X
/// and Z, a tool with the orientation of a lathe's. Empty: nothing does. `program` null: there is
/// none. G33, G95, G18 and G96 are no such sign alone.
std::string turning_sign(const ProgramOptions& options, const Program* program,
                         const std::vector<ToolTableRow>& table);

/// Notes in `tools` that the workpiece turns, if there is a sign and options.as_mill does not say
/// that it is to be milled all the same, or if the model turning is asked for, or the blank is one
/// that only turns (a hexagonal bar, a turned part that was saved), or a tool is a turning tool
/// (--tool). False, with an error: another
/// model is asked for, and there is a sign.
bool note_turning(const ProgramOptions& options, const Program* program,
                  std::optional<StockKind> kind, const std::optional<Blank>& blank,
                  ToolSources& tools, Diagnostics& diagnostics);

}  // namespace kerf
