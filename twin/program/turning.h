// twin/program/turning.h - programs and machines for turning, which no model of kerf is for.
#pragma once

#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "interp_bridge/program.h"

namespace kerf {

/// What says for sure that this is turning, in words: that the machine is a lathe
/// (ProgramOptions::lathe), that it has X and Z alone and the program moves in G18, G7, a threading
/// or contour cycle, G96 or cutter compensation in the plane of a program that has nothing but X
/// and Z, a tool with the orientation of a lathe's. Empty: nothing does. `program` null: there is
/// none. G33, G95, G18 and G96 are no such sign alone.
std::string turning_sign(const ProgramOptions& options, const Program* program,
                         const std::vector<ToolTableRow>& table);

/// True, with an error, if there is a sign and options.as_mill does not say that it is to be milled
/// all the same.
bool refuse_turning(const ProgramOptions& options, const Program* program,
                    const std::vector<ToolTableRow>& table, Diagnostics& diagnostics);

}  // namespace kerf
