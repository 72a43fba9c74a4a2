// twin/cli/cutting_options.h - the options about forces: --material and what it is held against.
#pragma once

#include "twin/cli/option_reader.h"
#include "twin/process/cutting_wish.h"
#include "twin/program/program_front.h"

namespace kerf {

/// Faults go to the reader: materials that are not known (with the nearest), files with faults,
/// limits of forces without a material.
CuttingWish understand_cutting(OptionReader& reader);

/// Of a machine that is watched: the material, and what its spindle is rated for.
CuttingWish understand_spindle_load(OptionReader& reader);

/// Some tool says what its maker allows, which its engagement is held against.
bool has_tool_limits(const SessionOptions& session);

}  // namespace kerf
