#include "twin/app/config_command.h"

#include <fmt/format.h>

#include <cstdio>

#include "twin/app/console.h"
#include "twin/app/exit_code.h"
#include "twin/config/live_config.h"

namespace kerf {

int config_command(const ConfigArguments& a) {
  Diagnostic fault;
  if (a.action == "schema") {
    if (a.file.empty() && a.sets.empty()) {
      kerf::print(stdout, "{}", schema_text());
      return kExitGood;
    }
    fault.message = "config schema lists every key; it takes no file and no --set";
  } else if (a.action != "check" && a.action != "print") {
    fault.message =
        fmt::format("config: '{}' is no action; allowed: check, print, schema", a.action);
  } else if (a.file.empty() && a.sets.empty()) {
    fault.message = fmt::format("config {}: no file is named", a.action);
    fault.hint = fmt::format("kerf config {} FILE", a.action);
  }
  if (!fault.message.empty()) {
    kerf::print(stderr, "{}", to_string(fault));
    return kExitUsage;
  }
  Diagnostics diagnostics;
  const std::optional<LiveConfig> config = read_config(a.file, a.sets, diagnostics);
  for (const Diagnostic& d : diagnostics) kerf::print(stderr, "{}", to_string(d));
  if (!config) return kExitUsage;
  if (a.action == "print") {
    kerf::print(stdout, "{}", effective_yaml(*config));
  } else {
    kerf::print(stdout, "{}: all is well\n", a.file.empty() ? "--set" : a.file);
  }
  return kExitGood;
}

}  // namespace kerf
