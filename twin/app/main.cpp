// kerf - a machine twin for LinuxCNC. The command line.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <new>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "twin/app/canon_command.h"
#include "twin/app/exit_code.h"
#include "twin/app/run_command.h"
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
    "  kerf canon part.ngc\n"
    "  kerf models\n"
    "  kerf tools\n";

constexpr const char* kRunExample =
    "Example:\n"
    "  kerf run part.ngc --stock box:0,0,-20:100,60,0 --tool 1=flat:6 --json - --stl part.stl\n";

constexpr const char* kCanonExample =
    "Each line is an object: line, file, kind, from, to, feed, tool, t, duration, and what else\n"
    "applies; mm, mm/min, s, degrees.\n\n"
    "Example:\n"
    "  kerf canon part.ngc | jq -c 'select(.kind == \"traverse\") | .to'\n";

constexpr const char* kModels =
    "zmap   one height a cell: three-axis milling, no undercuts; exact sweeps of straight moves "
    "and of arcs in XY\n"
    "auto   the model that the motions need (zmap in this version)\n";

void add_program_options(CLI::App& command, ProgramArguments& a) {
  command
      .add_option("PROGRAM", a.program,
                  "NC file, saved canonical listing (.canon), or - (rs274 text on stdin)")
      ->required();
  command
      .add_option("--ini", a.ini,
                  "LinuxCNC INI of the machine: limits, speeds, tool table, offsets, startup code")
      ->type_name("FILE");
  command.add_option("--tool-table", a.tool_table, "LinuxCNC tool table (tool.tbl)")
      ->type_name("FILE");
  command
      .add_option("--interp", a.interp,
                  "interpreter: bridge (kerf-interp) | text (LinuxCNC's rs274) (default bridge "
                  "where it is there)")
      ->type_name("NAME");
  command.add_option("--block-delete", a.block_delete, "skip lines that begin with / (default on)")
      ->type_name("on|off");
  command
      .add_option("--max-commands", a.max_commands,
                  "canonical commands after which a program counts as endless (default 50 million, "
                  "or 4 a line if that is more)")
      ->type_name("N");
  command
      .add_option("--max-seconds", a.max_seconds,
                  "silent seconds after which a program counts as endless")
      ->type_name("S");
}

void add_work_options(CLI::App& command, WorkArguments& a) {
  command
      .add_option("--tool", a.tools, "shape of tool N, repeatable; `kerf tools` lists the shapes")
      ->type_name("N=SHAPE")
      ->allow_extra_args(false);
  command
      .add_option("--stock", a.stock,
                  "blank: box:x0,y0,z0:x1,y1,z1 | cylinder:x,y,z0:z1:d | tube:x,y,z0:z1:d:inner | "
                  "state:FILE (a "
                  "saved workpiece); several joined by +")
      ->type_name("SPEC");
  command.add_option("--model", a.model, "workpiece model: zmap | auto (default auto)")
      ->type_name("NAME");
  command
      .add_option("--cell", a.cell,
                  "edge of a cell (default: suits the blank, at most 4 million cells)")
      ->type_name("MM");
  command
      .add_option("--margin", a.margin, "around a blank that is guessed from the moves (default 5)")
      ->type_name("MM");
  command
      .add_option("--path", a.path,
                  "what is cut: programmed | planned, with corners rounded as the machine does "
                  "under G64 (default programmed)")
      ->type_name("NAME");
  command
      .add_option("--threads", a.threads,
                  "cutting threads (default: one less than the cores, at most 8)")
      ->type_name("N");
  command.add_option("--kernel", a.kernel, "cutting kernel: auto | scalar | avx2; same result")
      ->type_name("NAME");
}

void add_output_options(CLI::App& command, OutputPaths& a, std::string& mesh_tolerance) {
  command.add_option("--json", a.json, "report, schema kerf-report/1")->type_name("FILE");
  command.add_option("--png", a.png, "picture of the finished part")->type_name("FILE");
  command.add_option("--stl", a.stl, "finished part as a closed mesh, binary STL")
      ->type_name("FILE");
  command.add_option("--ply", a.ply, "the same as binary PLY")->type_name("FILE");
  command.add_option("--state", a.state, "finished workpiece, for --stock state:FILE")
      ->type_name("FILE");
  command
      .add_option("--mesh-tolerance", mesh_tolerance,
                  "how far meshes may lie from the model (default 0.01; 0 = every cell)")
      ->type_name("MM");
}

void add_run_options(CLI::App& run, RunArguments& a) {
  add_program_options(run, a.source);
  add_work_options(run, a.work);
  run.add_option("--from-line", a.from_line,
                 "cut what comes before line N without a word, report from there")
      ->type_name("N");
  run.add_option("--until-line", a.until_line, "stop before the first move beyond line N")
      ->type_name("N");
  add_output_options(run, a.outputs, a.mesh_tolerance);
  run.add_flag("--quiet", a.quiet, "no summary, no progress bar, no warnings");
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
  fmt::print(stderr, "{}", to_string(d));
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
      fmt::print(stderr, "{}", to_string(d));
      code = kExitUsage;
    }
  }
  return code;
}

int run(int argc, char** argv) {
  CLI::App app("kerf: dry-runs NC programs for LinuxCNC through a model of the workpiece", "kerf");
  app.set_version_flag("--version", std::string("kerf ") + KERF_VERSION, "print the version");
  app.footer(std::string(kExamples) + "\n" + kExitCodes);
  app.allow_extras();
  RunArguments arguments;
  CLI::App* run_app = app.add_subcommand("run", "cut a program and report");
  add_run_options(*run_app, arguments);
  run_app->footer(std::string(kRunExample) + "\n" + kExitCodes);
  run_app->allow_extras();
  CanonArguments canon;
  CLI::App* canon_app = app.add_subcommand("canon", "print what a program commands as JSON lines");
  add_program_options(*canon_app, canon.source);
  canon_app->add_option("--out", canon.out, "where to (default -, standard output)")
      ->type_name("FILE");
  canon_app->add_flag("--quiet", canon.quiet, "no progress bar, no warnings");
  canon_app->footer(std::string(kCanonExample) + "\n" + kExitCodes);
  canon_app->allow_extras();
  CLI::App* models_app = app.add_subcommand("models", "list the workpiece models")->allow_extras();
  models_app->footer("Example:\n  kerf models\n");
  CLI::App* tools_app = app.add_subcommand("tools", "list the tool shapes")->allow_extras();
  tools_app->footer("Example:\n  kerf tools\n");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);  // --help, --version
  } catch (const CLI::ParseError& error) {
    // A mistyped option leaves others without what they need: name the cause, not the effect.
    Diagnostic d;
    d.message = error.what();
    d.hint = "kerf --help lists what there is";
    for (const CLI::App* command : {run_app, canon_app}) {
      const std::vector<std::string> left = command->remaining();
      if (const std::string* argument = worst_argument(left)) {
        return refuse_argument(*argument, *command, false);
      }
      if (command->parsed())
        d.hint = fmt::format("kerf {} --help lists what there is", command->get_name());
    }
    fmt::print(stderr, "{}", to_string(d));
    return kExitUsage;
  }
  for (const CLI::App* command : {run_app, canon_app, models_app, tools_app}) {
    const std::vector<std::string> left = command->remaining();
    if (const std::string* argument = worst_argument(left))
      return refuse_argument(*argument, *command, false);
  }
  const std::vector<std::string> left = app.remaining();
  if (const std::string* argument = worst_argument(left))
    return refuse_argument(*argument, app, true);
  if (models_app->parsed()) {
    fmt::print("{}", kModels);
    return kExitGood;
  }
  if (tools_app->parsed()) {
    fmt::print("{}\n", shape_help());
    return kExitGood;
  }
  if (run_app->parsed()) {
    if (const int code = refuse_empty_values(*run_app); code != kExitGood) return code;
    return run_command(arguments);
  }
  if (canon_app->parsed()) {
    if (const int code = refuse_empty_values(*canon_app); code != kExitGood) return code;
    return canon_command(canon);
  }
  fmt::print(stderr, "{}", app.help());
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
  try {
    return kerf::run(argc, argv);
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "kerf: error: out of memory\n");
    return kerf::kExitFailure;
  }
}
