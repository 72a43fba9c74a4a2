// kerf - a machine twin for LinuxCNC. The command line.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <functional>
#include <new>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "twin/app/canon_command.h"
#include "twin/app/cli_options.h"
#include "twin/app/config_command.h"
#include "twin/app/console.h"
#include "twin/app/exit_code.h"
#include "twin/app/live_command.h"
#include "twin/app/machine_command.h"
#include "twin/app/option_reader.h"
#include "twin/app/run_command.h"
#include "twin/app/view_command.h"
#include "twin/stock_choice.h"
#include "twin/suggest.h"

namespace kerf {
namespace {

constexpr const char* kExitCodes =
    "Exit codes:\n"
    "  0  finished, no findings\n"
    "  1  finished, findings of severity error\n"
    "  2  usage or configuration error\n"
    "  3  finished, but data was lost or stale\n"
    "  4  file, interpreter or device failure, or interrupted (the report is partial)\n";

constexpr const char* kExamples =
    "Examples:\n"
    "  kerf run part.ngc --stock box:0,0,-20:100,60,0 --tool 1=flat:6 --png part.png\n"
    "  kerf shadow -c mill.yaml --program part.ngc\n"
    "  kerf replay run.csv --speed max --stock box:0,0,-20:100,60,0\n"
    "  kerf view part.ngc --stock box:0,0,-20:100,60,0 --tool 1=flat:6\n"
    "  kerf canon part.ngc\n"
    "  kerf models\n"
    "  kerf tools\n";

constexpr const char* kRunExample =
    "Examples:\n"
    "  kerf run part.ngc --stock box:0,0,-20:100,60,0 --tool 1=flat:6 --json - --stl part.stl\n"
    "  kerf run plate.ngc --stock sheet:0,0:600,400:3 --kerf 1.2 --pierce 3 --dxf rest.dxf\n";

constexpr const char* kViewExample =
    "Examples:\n"
    "  kerf view part.ngc --stock box:0,0,-20:100,60,0 --tool 1=flat:6\n"
    "  kerf view part.ngc --frames film --fps 25 --speed 10\n";

constexpr const char* kCanonExample =
    "Each line is an object: line, file, kind, from, to, feed, tool, t, duration, and what else\n"
    "applies; mm, mm/min, s, degrees.\n\n"
    "Example:\n"
    "  kerf canon part.ngc | jq -c 'select(.kind == \"traverse\") | .to'\n";

constexpr const char* kShadowExample =
    "Examples:\n"
    "  kerf shadow --set source.type=hal --ini mill.ini --program part.ngc --stock "
    "box:0,0,-20:100,60,0\n"
    "  kerf shadow -c mill.yaml --record run.csv\n";

constexpr const char* kReplayExample =
    "Example:\n"
    "  kerf replay run.csv --stock box:0,0,-20:100,60,0 --tool 1=flat:6 --speed max --png "
    "part.png\n";

constexpr const char* kConfigExample =
    "Examples:\n"
    "  kerf config check mill.yaml\n"
    "  kerf config print mill.yaml\n"
    "  kerf config schema\n";

constexpr const char* kMachineExample =
    "Example:\n"
    "  kerf machine part.ngc --modbus-tcp 127.0.0.1:1502 --frame workpiece\n";

constexpr const char* kSources =
    "modbus   registers of a Modbus device, TCP or RTU (reads only)\n"
    "can      signals of a CAN bus by SocketCAN, by map or DBC file (sends nothing)\n"
    "hal      pins of the LinuxCNC that runs on this computer\n"
    "log      recordings of kerf, CSV, halsampler files, candump -l files\n";

std::string model_list() {
  std::string list;
  for (const StockModelRow& row : stock_models()) {
    list += fmt::format("{:<7} {}\n", row.name, row.purpose);
  }
  return list +
         "auto    sheet for a sheet, else the first of these that holds what tools, blank and "
         "motions need; the report says why\n";
}

std::string in_quotes(const std::string& text) { return fmt::format("'{}'", text); }

/// An argument that no command knows: exit code 2, with the nearest known one.
int refuse_argument(const std::string& argument, const CLI::App& app, bool command_wanted) {
  Diagnostic d;
  std::vector<std::string> allowed;
  if (!argument.empty() && argument[0] == '-') {
    d.message = fmt::format("unknown option {}", argument.substr(0, argument.find('=')));
    for (const CLI::Option* option : app.get_options()) {
      for (const std::string& name : option->get_lnames()) allowed.push_back("--" + name);
    }
  } else if (command_wanted) {
    d.message = fmt::format("unknown command {}", in_quotes(argument));
    for (const CLI::App* command : app.get_subcommands({})) allowed.push_back(command->get_name());
  } else {
    d.message = fmt::format("{}: one argument too many", in_quotes(argument));
  }
  const std::string near = nearest_word(argument.substr(0, argument.find('=')), allowed);
  if (!near.empty()) d.message += fmt::format("; did you mean {}?", near);
  const std::string name = app.get_parent() ? "kerf " + app.get_name() : "kerf";
  d.hint = fmt::format("{} --help lists what there is", name);
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

/// `--stock ""` is what a script with an unset variable writes: not the same as no --stock.
int refuse_empty_values(const CLI::App& app) {
  int code = kExitGood;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& value : option->results()) {
      if (!value.empty()) continue;
      Diagnostic d;
      d.message = fmt::format("{}: the value is empty", option->get_name());
      kerf::print(stderr, "{}", to_string(d));
      code = kExitUsage;
    }
  }
  return code;
}

int list_tools(const std::string& units) {
  Diagnostics diagnostics;
  const LengthUnit unit = understand_units(units, std::nullopt, diagnostics);
  for (const Diagnostic& d : diagnostics) print_diagnostic(stderr, d);
  if (has_error(diagnostics)) return kExitUsage;
  kerf::print(stdout, "{}\n", shape_help(unit));
  return kExitGood;
}

/// The commands with their arguments, and what each of them calls.
struct Commands {
  explicit Commands(CLI::App& app) {
    CLI::App* const run = add(app, "run", "cut a program and report", kRunExample,
                              [this] { return run_command(run_arguments); });
    add_run_options(*run, run_arguments);
    CLI::App* const view = add(app, "view", "a program, a log or a saved workpiece in a window",
                               kViewExample, [this] { return view_command(view_arguments); });
    add_view_options(*view, view_arguments);
    CLI::App* const shadow =
        add(app, "shadow", "follow a machine that runs", kShadowExample,
            [this] { return live_command(shadow_arguments, LiveCommand::kShadow); });
    add_live_options(*shadow, shadow_arguments, LiveCommand::kShadow);
    CLI::App* const replay =
        add(app, "replay", "run a log of a machine again", kReplayExample,
            [this] { return live_command(replay_arguments, LiveCommand::kReplay); });
    add_live_options(*replay, replay_arguments, LiveCommand::kReplay);
    CLI::App* const canon = add(app, "canon", "print what a program commands as JSON lines",
                                kCanonExample, [this] { return canon_command(canon_arguments); });
    add_canon_options(*canon, canon_arguments);
    CLI::App* const config =
        add(app, "config", "check or print a configuration, or list every key", kConfigExample,
            [this] { return config_command(config_arguments); });
    config->add_option("ACTION", config_arguments.action, "check | print | schema")->required();
    config->add_option("FILE", config_arguments.file, "the configuration");
    config->add_option("--set", config_arguments.sets, "any key of the configuration, repeatable")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    // Found and started by machine_command(), before this is asked.
    add(app, "machine", "a simulated machine that serves its positions", kMachineExample,
        [] { return kExitUsage; });
    add_list(app, "models", "list the workpiece models", model_list());
    add_list(app, "sources", "list where positions may come from", kSources);
    CLI::App* const tools = add(app, "tools", "list the tool shapes", "Example:\n  kerf tools\n",
                                [this] { return list_tools(tools_units); });
    tools->add_option("--units", tools_units, "of the lengths (default mm)")->type_name("mm|inch");
  }

  std::vector<CLI::App*> all;
  std::vector<std::pair<CLI::App*, std::function<int()>>> calls;
  RunArguments run_arguments;
  ViewArguments view_arguments;
  LiveArguments shadow_arguments;
  LiveArguments replay_arguments;
  CanonArguments canon_arguments;
  ConfigArguments config_arguments;
  std::string tools_units;

 private:
  CLI::App* add(CLI::App& app, const char* name, const char* purpose, const std::string& footer,
                std::function<int()> call) {
    CLI::App* const command = app.add_subcommand(name, purpose);
    command->footer(footer + "\n" + kExitCodes);
    command->allow_extras();
    all.push_back(command);
    calls.emplace_back(command, std::move(call));
    return command;
  }
  void add_list(CLI::App& app, const char* name, const char* purpose, std::string text) {
    add(app, name, purpose, fmt::format("Example:\n  kerf {}\n", name), [text = std::move(text)] {
      kerf::print(stdout, "{}", text);
      return static_cast<int>(kExitGood);
    });
  }
};

/// A mistyped option leaves others without what they need: name the cause, not the effect.
int refuse(const CLI::ParseError& error, const Commands& commands) {
  Diagnostic d;
  d.message = error.what();
  d.hint = "kerf --help lists what there is";
  for (const CLI::App* command : commands.all) {
    const std::vector<std::string> left = command->remaining();
    if (const std::string* argument = worst_argument(left)) {
      return refuse_argument(*argument, *command, false);
    }
    if (command->parsed()) {
      d.hint = fmt::format("kerf {} --help lists what there is", command->get_name());
    }
  }
  kerf::print(stderr, "{}", to_string(d));
  return kExitUsage;
}

int run(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "machine")
    return machine_command(argc - 1, argv + 1);
  CLI::App app(
      "kerf: a twin of a machine under LinuxCNC: runs NC programs through a model of the "
      "workpiece, beside the machine or without it",
      "kerf");
  app.set_version_flag("--version", std::string("kerf ") + KERF_VERSION, "print the version");
  app.footer(std::string(kExamples) + "\n" + kExitCodes);
  app.allow_extras();
  Commands commands(app);
  if (argc > 0) commands.run_arguments.kerf = commands.view_arguments.run.kerf = argv[0];
  commands.view_arguments.command.assign(argv, argv + argc);
  commands.shadow_arguments.command = commands.view_arguments.command;
  commands.replay_arguments.command = commands.view_arguments.command;
  try {
    app.parse(argc, argv);
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
    if (const int code = refuse_empty_values(*command); code != kExitGood) return code;
  }
  const std::vector<std::string> left = app.remaining();
  if (const std::string* argument = worst_argument(left)) {
    return refuse_argument(*argument, app, true);
  }
  for (const auto& [command, call] : commands.calls) {
    if (command->parsed()) return call();
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
    code = kerf::run(argc, argv);
  } catch (const std::bad_alloc&) {
    kerf::print(stderr, "kerf: error: out of memory\n");
  } catch (const std::exception& failure) {
    kerf::print(stderr, "kerf: error: {}\n", failure.what());
  }
  return kerf::end_console(code);
}
