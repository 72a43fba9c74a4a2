// twin/app/torch_options.h - the options about torches, lasers, jets and punches, which the
// commands share.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "interp_bridge/program.h"
#include "twin/app/option_reader.h"
#include "twin/app/outputs.h"
#include "twin/beam_settings.h"
#include "twin/config/live_config.h"
#include "twin/turret.h"

namespace kerf {

/// The arguments as written. Empty = not given.
struct TorchArguments {
  std::string beam;
  bool beam_is_mm = false;  ///< it is a configuration's: a level in it is mm, whatever --units says
  std::string kerf;
  std::string pierce;
  std::string slats;
  std::string density;
  std::string qtplasmac;
  std::string materials;
  std::vector<std::string> hal;
  std::string turret;
};

/// What is not given, as the configuration has it. Whoever asks for a punch wants no beam, and the
/// reverse: of those the command line's alone counts. `unit`: of the arguments.
void complete_torch(const LiveConfig& config, LengthUnit unit, TorchArguments& arguments);

/// The same, understood: what is cut with into the result, what the program is told of its machine
/// into `torch`. Faults go to the reader.
BeamOptions understand_torch(const TorchArguments& arguments, OptionReader& reader,
                             TorchOptions& torch);

/// What can be known before anything is cut: that there will be no sheet to write.
void check_outline_wishes(const std::optional<Blank>& blank, const OutputPaths& outputs,
                          OptionReader& reader);

/// Reads --turret, if it is given; what a torch is told has no place beside it. The program is to
/// tell of what the punch may wait for. Null: none, or faults, which are told.
TurretPointer understand_turret(const TorchArguments& arguments, OptionReader& reader,
                                ProgramOptions& program);

}  // namespace kerf
