// twin/app/torch_options.h - the options about torches, lasers and jets, which run and view share.
#pragma once

#include <string>
#include <vector>

#include "interp_bridge/program.h"
#include "twin/app/option_reader.h"
#include "twin/beam_settings.h"

namespace kerf {

/// The arguments as written. Empty = not given.
struct TorchArguments {
  std::string beam;
  std::string kerf;
  std::string pierce;
  std::string slats;
  std::string density;
  std::string qtplasmac;
  std::string materials;
  std::vector<std::string> hal;
};

/// The same, understood: what is cut with into the result, what the program is told of its machine
/// into `torch`. Faults go to the reader.
BeamOptions understand_torch(const TorchArguments& arguments, OptionReader& reader,
                             TorchOptions& torch);

}  // namespace kerf
