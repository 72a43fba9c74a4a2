// kerf - a machine twin for LinuxCNC. The command line.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/exit_code.h"
#include "base/suggest.h"
#include "base/translate.h"
#include "twin/cli/batch_command.h"
#include "twin/cli/canon_command.h"
#include "twin/cli/cli_options.h"
#include "twin/cli/command_examples.h"
#include "twin/cli/config_command.h"
#include "twin/cli/console.h"
#include "twin/cli/diff_command.h"
#include "twin/cli/job_command.h"
#include "twin/cli/live_command.h"
#include "twin/cli/machine_command.h"
#include "twin/cli/mcp_command.h"
#include "twin/cli/optimize_command.h"
#include "twin/cli/run_command.h"
#include "twin/cli/setup_command.h"
#include "twin/cli/tools_command.h"
#include "twin/cli/version.h"
#include "twin/cli/view_command.h"
#include "twin/job/stock_choice.h"

namespace kerf {
namespace {

constexpr const char* kSourceList = tr_noop(
    "modbus     registers of a Modbus device, TCP or RTU (reads only)\n"
    "can        signals of a CAN bus by SocketCAN, by map or DBC file (sends nothing)\n"
    "hal        pins of the LinuxCNC that runs on this computer\n"
    "mtconnect  the agent of a machine, as LinuxCNC 2.10's (asks with GET alone)\n"
    "log        recordings of kerf, CSV, halsampler files, candump -l files\n");

std::string model_list() {
  std::string list;
  for (const StockModelRow& row : stock_models()) {
    list += fmt::format("{:<8}{}\n", row.name, tr(row.purpose));
  }
  return list +
         tr("auto    sheet for a sheet, else the first of these that holds what tools, blank and "
            "motions need; the report says why\n");
}

bool has_option(Command command, const std::string& option) {
  return std::ranges::any_of(setting_table(), [&](const Setting& setting) {
    return (setting.commands & command) != 0 && setting.option == option;
  });
}

std::string in_quotes(const std::string& text) { return fmt::format("'{}'", text); }

/// An argument that no command knows: exit code 2, with the nearest known one.
int refuse_argument(const std::string& argument, const CLI::App& app, bool command_wanted) {
  Diagnostic d;
  std::vector<std::string> allowed;
  if (!argument.empty() && argument[0] == '-') {
    d.message = trf("unknown option {}", argument.substr(0, argument.find('=')));
    for (const CLI::Option* option : app.get_options()) {
      for (const std::string& name : option->get_lnames()) allowed.push_back("--" + name);
    }
  } else if (command_wanted) {
    d.message = trf("unknown command {}", in_quotes(argument));
    for (const CLI::App* command : app.get_subcommands({})) allowed.push_back(command->get_name());
  } else {
    d.message = trf("{}: one argument too many", in_quotes(argument));
  }
  const std::string written = argument.substr(0, argument.find('='));
  const std::string near = nearest_word(written, allowed);
  const bool is_of_run = app.get_name() == "job" && has_option(kRun, written);
  if (is_of_run) d.message += tr("; kerf run has it, for a single program");
  const bool is_beside_machine =
      !is_of_run && has_option(kShadow, written) && has_option(kReplay, written);
  if (is_beside_machine) d.message += tr("; kerf shadow and kerf replay have it");
  if (!is_of_run && !is_beside_machine && !near.empty())
    d.message += trf("; did you mean {}?", near);
  const std::string name = app.get_parent() ? "kerf " + app.get_name() : "kerf";
  d.hint = trf("{} --help lists what there is", name);
  kerf::print(stderr, "{}", to_string(d));
  return kExitUsage;
}

/// The argument to complain about: an option first, as its value may have been taken for the
/// PROGRAM.
const std::string* worst_argument(const std::vector<std::string>& left) {
  if (left.empty()) return nullptr;
  for (const std::string& argument : left) {
    if (argument.size() > 1 && argument[0] == '-') return &argument;
  }
  return &left[0];
}

/// `--stock ""` is what a script with an unset variable writes: not the same as no --stock. And
/// `--png --quiet` is no picture of the name --quiet.
int refuse_odd_values(const CLI::App& app) {
  int code = kExitGood;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& value : option->results()) {
      const bool is_option = value.starts_with("--") && app.get_option_no_throw(value) != nullptr;
      if (!value.empty() && !is_option) continue;
      Diagnostic d;
      d.message = value.empty() ? trf("{}: the value is empty", option->get_name())
                                : trf("{}: a value must follow, not the option {}",
                                      option->get_name(), value);
      kerf::print(stderr, "{}", to_string(d));
      code = kExitUsage;
    }
  }
  return code;
}

int print_list(const std::string& text) {
  kerf::print(stdout, "{}", text);
  return kExitGood;
}

/// What each command calls.
struct CommandCall {
  Command command;
  int (*call)(const Arguments&);
};

constexpr std::array kCalls{
    CommandCall{kRun, run_command},
    CommandCall{kView, view_command},
    CommandCall{kShadow, live_command},
    CommandCall{kReplay, live_command},
    CommandCall{kDiff, diff_command},
    CommandCall{kOptimize, optimize_command},
    CommandCall{kBatch, batch_command},
    CommandCall{kJob, job_command},
    CommandCall{kCanon, canon_command},
    CommandCall{kConfig, config_command},
    // Found and started by machine_command(), before this is asked.
    CommandCall{kMachine, [](const Arguments&) -> int { return kExitUsage; }},
    CommandCall{kSetup, setup_command},
    CommandCall{kModels, [](const Arguments&) { return print_list(model_list()); }},
    CommandCall{kSources, [](const Arguments&) { return print_list(tr(kSourceList)); }},
    CommandCall{kTools, tools_command},
    CommandCall{kMcp, mcp_command},
};

/// Calls are the same in all languages; what stands over them is not.
std::string footer_of(std::string examples) {
  constexpr std::string_view kHead = "Examples:\n";
  if (examples.starts_with(kHead))
    examples.replace(0, kHead.size(), tr("Examples:") + std::string("\n"));
  return examples + "\n" + tr(kExitCodes);
}

/// The commands with their arguments, and what each of them calls.
struct Commands {
  explicit Commands(CLI::App& app, const std::vector<std::string>& words) {
    for (const CommandRow& row : command_table()) {
      const auto* const call = std::find_if(kCalls.begin(), kCalls.end(), [&](const auto& one) {
        return one.command == row.command;
      });
      CLI::App* const command = app.add_subcommand(row.name, tr(row.purpose));
      command->group(tr("Commands"));
      command->get_help_ptr()->group(tr("Options"));
      command->footer(footer_of(tr(examples_of(row.command))));
      command->allow_extras();
      all.push_back(command);
      calls.push_back({command, call->call, std::make_unique<Arguments>()});
      Arguments& arguments = *calls.back().arguments;
      arguments.command = row.command;
      arguments.words = words;
      if (row.command != kMachine) add_options(*command, row.command, arguments.options);
    }
  }

  struct Call {
    CLI::App* app;
    int (*function)(const Arguments&);
    std::unique_ptr<Arguments> arguments;
  };
  std::vector<CLI::App*> all;
  std::vector<Call> calls;
};

/// A mistyped option leaves others without what they need: name the cause, not the effect.
int refuse(const CLI::ParseError& error, const Commands& commands) {
  Diagnostic d;
  d.message = words_of(error);
  d.hint = tr("kerf --help lists what there is");
  for (const CLI::App* command : commands.all) {
    const std::vector<std::string> left = command->remaining();
    if (const std::string* argument = worst_argument(left)) {
      return refuse_argument(*argument, *command, false);
    }
    if (command->parsed()) {
      d.hint = trf("kerf {} --help lists what there is", command->get_name());
    }
  }
  kerf::print(stderr, "{}", to_string(d));
  return kExitUsage;
}

int run(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "machine")
    return machine_command(argc - 1, argv + 1);
  if (argc == 3 && std::string_view(argv[1]) == "batch-unit") return batch_unit_command(argv[2]);
  CLI::App app(
      tr("kerf: a twin of a machine under LinuxCNC: runs NC programs through a model of the "
         "workpiece, beside the machine or without it"),
      "kerf");
  speak_language(app, "kerf " + version_text());
  app.footer(footer_of(examples_of_kerf()));
  app.allow_extras();
  std::vector<std::string> words = with_bare_options(std::vector<std::string>(argv, argv + argc));
  const Commands commands(app, words);
  for (CLI::App* const command : commands.all) {
    for (CLI::Option* const option : command->get_options({})) {
      if (option->get_items_expected_max() == 0) option->disable_flag_override();
    }
  }
  try {
    words.erase(words.begin(), words.begin() + std::min(argc, 1));
    std::reverse(words.begin(), words.end());  // as CLI11 wants them
    app.parse(std::move(words));
  } catch (const CLI::Success& success) {
    std::ostringstream text;
    const int code = app.exit(success, text, text);  // --help, --version
    kerf::print(stdout, "{}", text.str());
    return code;
  } catch (const CLI::ParseError& error) {
    return refuse(error, commands);
  }
  for (const CLI::App* command : commands.all) {
    const std::vector<std::string> left = command->remaining();
    if (const std::string* argument = worst_argument(left)) {
      return refuse_argument(*argument, *command, false);
    }
    if (!command->parsed()) continue;
    if (const int code = refuse_odd_values(*command); code != kExitGood) return code;
  }
  const std::vector<std::string> left = app.remaining();
  if (const std::string* argument = worst_argument(left)) {
    return refuse_argument(*argument, app, true);
  }
  for (const Commands::Call& call : commands.calls) {
    if (call.app->parsed()) return call.function(*call.arguments);
  }
  kerf::print(stderr, "{}", app.help());
  return kExitUsage;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  // A reader that has seen enough of `--json -` must not kill the run: the write fails instead, and
  // is reported.
  // The same for `ulimit -f`.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  int code = kerf::kExitFailure;
  try {
    kerf::use_language(kerf::language_of_environment());
    code = kerf::run(argc, argv);
  } catch (const std::bad_alloc&) {
    kerf::print_text(stderr, kerf::tr("kerf: error: out of memory\n"));
  } catch (const std::exception& failure) {
    kerf::print_text(stderr, kerf::trf("kerf: error: {}\n", failure.what()));
  }
  return kerf::end_console(code);
}
