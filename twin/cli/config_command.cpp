#include "twin/cli/config_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>

#include "base/exit_code.h"
#include "base/translate.h"
#include "twin/cli/console.h"
#include "twin/cli/man_page.h"
#include "twin/cli/shell_completion.h"
#include "twin/config/live_config.h"

namespace kerf {
namespace {

int refuse(std::string message, std::string hint = {}) {
  Diagnostic fault;
  fault.message = std::move(message);
  fault.hint = std::move(hint);
  kerf::print(stderr, "{}", to_string(fault));
  return kExitUsage;
}

int print_completion(const std::string& shell) {
  if (shell == "bash" || shell == "zsh") {
    kerf::print(stdout, "{}", shell == "bash" ? bash_completion() : zsh_completion());
    return kExitGood;
  }
  return refuse(trf("config completion: '{}' is no shell; allowed: bash, zsh", shell),
                "source <(kerf config completion bash)");
}

/// A manual page by its name. The names of commands alone are commands, wherever they stand.
int print_manual(const std::string& page) {
  if (page.empty() || page == "kerf") {
    kerf::print(stdout, "{}", man_page());
    return kExitGood;
  }
  std::vector<std::string> names{"kerf"};
  for (const CommandRow& row : command_table()) {
    names.push_back(name_of_page(row));
    if (names.back() != page) continue;
    kerf::print(stdout, "{}", man_page_of(row));
    return kExitGood;
  }
  return refuse(trf("config man: '{}' is no page; allowed: {}", page, fmt::join(names, ", ")),
                "kerf config man kerf-run");
}

int read_and_say(const std::string& action, const std::string& file,
                 const std::vector<std::string>& sets) {
  Diagnostics diagnostics;
  const std::optional<LiveConfig> config = read_config(file, sets, diagnostics);
  for (const Diagnostic& d : diagnostics) kerf::print(stderr, "{}", to_string(d));
  if (!config) return kExitUsage;
  if (action == "print") {
    kerf::print(stdout, "{}", effective_yaml(*config));
  } else {
    print_text(stdout, trf("{}: all is well\n", file.empty() ? "--set" : file));
  }
  return kExitGood;
}

}  // namespace

int config_command(const Arguments& arguments) {
  const std::string& action = arguments.options.text("ACTION");
  const std::string& file = arguments.options.text("FILE");
  const std::vector<std::string>& sets = arguments.options.texts("--set");
  const std::vector<std::string> actions = parts_of(setting_of("ACTION", kConfig).words);
  if (std::find(actions.begin(), actions.end(), action) == actions.end()) {
    return refuse(trf("config: '{}' is no action; allowed: {}", action, fmt::join(actions, ", ")));
  }
  if (action == "completion" && sets.empty()) return print_completion(file);
  if (action == "man" && sets.empty()) return print_manual(file);
  if (action == "check" || action == "print") {
    if (!file.empty() || !sets.empty()) return read_and_say(action, file, sets);
    return refuse(trf("config {}: no file is named", action), trf("kerf config {} FILE", action));
  }
  if (action == "schema") {
    if (!file.empty() || !sets.empty()) {
      return refuse(tr("config schema lists every key; it takes no file and no --set"));
    }
    kerf::print(stdout, "{}", schema_text());
    return kExitGood;
  }
  return refuse(trf("config {} is about kerf itself; it takes no --set", action));
}

}  // namespace kerf
