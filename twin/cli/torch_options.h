// twin/cli/torch_options.h - the options about torches, lasers, jets and punches, which the
// commands share.
#pragma once

#include <optional>

#include "interp_bridge/program.h"
#include "stock/blank.h"
#include "twin/cli/option_reader.h"
#include "twin/cli/outputs.h"
#include "twin/machine/beam_settings.h"
#include "twin/machine/turret.h"

namespace kerf {

/// What is cut with into the result, what the program is told of its machine into `torch`. Faults
/// go to the reader.
BeamOptions understand_torch(OptionReader& reader, TorchOptions& torch);

/// What can be known before anything is cut: that there will be no sheet to write.
void check_outline_wishes(const std::optional<Blank>& blank, const OutputPaths& outputs,
                          OptionReader& reader);

/// An option that is for sheets, beside a blank that is given and is none, would do nothing: it is
/// refused. Of the command line alone; a configuration may be for many jobs.
void check_sheet_options(const std::optional<Blank>& blank, const Arguments& written,
                         Diagnostics& diagnostics);

/// Reads --turret, if it is given; what a torch is told has no place beside it. The program is to
/// tell of what the punch may wait for. Null: none, or faults, which are told.
TurretPointer understand_turret(OptionReader& reader, ProgramOptions& program);

}  // namespace kerf
