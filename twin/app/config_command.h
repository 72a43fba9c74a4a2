// twin/app/config_command.h - `kerf config`: check, print, schema.
#pragma once

#include <string>
#include <vector>

namespace kerf {

struct ConfigArguments {
  std::string action;  ///< check | print | schema
  std::string file;
  std::vector<std::string> sets;
};

/// check: says what is wrong, or that all is well. print: the configuration with all defaults.
/// schema: every key with unit, range, default. Returns the exit code.
int config_command(const ConfigArguments& arguments);

}  // namespace kerf
