// twin/cli/serve_option.h - --serve, of the commands that have it.
#pragma once

#include <optional>

#include "twin/cli/option_reader.h"
#include "twin/serve/serve_address.h"

namespace kerf {

/// Nothing: it is not given, or is no address, which is told.
std::optional<ServeAddress> understand_serve(OptionReader& reader);

}  // namespace kerf
