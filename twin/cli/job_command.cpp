#include "twin/cli/job_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "base/atomic_file.h"
#include "base/exit_code.h"
#include "base/translate.h"
#include "twin/cli/console.h"
#include "twin/cli/job_run.h"
#include "twin/cli/option_reader.h"
#include "twin/cli/outputs.h"
#include "twin/cli/run_options.h"
#include "twin/program/session_parts.h"

namespace kerf {
namespace {

struct JobWishes {
  JobRun::Wishes run;
  OutputPaths own;  ///< json, junit, sarif
  bool quiet = false;
  bool check_only = false;
};

JobWishes understand_job(const Arguments& arguments, Diagnostics& diagnostics) {
  OptionReader reader(diagnostics, layers_of(arguments, nullptr));
  JobWishes wishes;
  wishes.quiet = reader.is_yes("--quiet");
  wishes.check_only = reader.is_yes("--check");
  wishes.run.folder = reader.text("--png");
  wishes.run.last.stl = reader.text("--stl");
  wishes.run.last.ply = reader.text("--ply");
  wishes.run.last.state = reader.text("--state");
  wishes.run.last.compare_png = reader.text("--compare-png");
  wishes.own.json = reader.text("--json");
  wishes.own.junit = reader.text("--junit");
  wishes.own.sarif = reader.text("--sarif");
  check_output_arguments(wishes.run.last, diagnostics);
  check_output_arguments(wishes.own, diagnostics);
  wishes.run.on_stderr = wishes.own.uses_stdout() || wishes.run.last.uses_stdout();
  if (arguments.options.has("--section") && wishes.run.folder.empty())
    reader.fault("--section", tr("is for --png, and there is none"));
  show_lengths_in(reader.unit());
  return wishes;
}

void make_folder(const std::string& path, Diagnostics& diagnostics) {
  if (path.empty()) return;
  std::error_code failed;
  std::filesystem::create_directories(path, failed);
  if (failed || !std::filesystem::is_directory(path))
    add_fault("--png", trf("cannot make the folder {}: {}", path, failed.message()), {},
              diagnostics);
}

}  // namespace

int job_command(const Arguments& arguments) {
  Diagnostics diagnostics;
  const JobWishes wishes = understand_job(arguments, diagnostics);
  std::optional<JobRun> run;
  if (!has_error(diagnostics))
    run = JobRun::open(arguments, arguments.options.text("JOB"), diagnostics);
  if (run) run->check(diagnostics);
  if (run && wishes.run.last.compare_png.size() > 0 && !run->job().compare.has("--compare"))
    add_fault("--compare-png", tr("the job has no compare: {design: part.stl}"), {}, diagnostics);
  if (has_error(diagnostics)) {
    print_diagnostics(diagnostics, wishes.quiet);
    return kExitUsage;
  }
  if (wishes.check_only) {
    print_diagnostics(diagnostics, wishes.quiet);
    if (!wishes.quiet)
      print_text(stdout, trf("{}: good, {} setups\n", run->job().path, run->count()));
    return kExitGood;
  }
  check_output_places(wishes.own, diagnostics);
  check_output_places(wishes.run.last, diagnostics);
  make_folder(wishes.run.folder, diagnostics);
  print_diagnostics(diagnostics, wishes.quiet);
  if (has_error(diagnostics)) return kExitFailure;
  diagnostics.clear();

  run->run(0, run->count(), wishes.run);
  const JobResult& result = run->result();
  if (!wishes.own.json.empty()) {
    const Done written =
        write_text(wishes.own.json, job_json(result, run->job().path, KERF_VERSION));
    if (!written) diagnostics.push_back(general_error(written.error()));
  }
  write_finding_lists(wishes.own, result.listed, diagnostics);
  if (!wishes.quiet)
    kerf::print(wishes.run.on_stderr ? stderr : stdout, "{}", job_text(result, shown_unit()));
  flush_console();
  if (!result.not_run.empty()) {
    const std::string left = fmt::format("{}", fmt::join(result.not_run, ", "));
    diagnostics.push_back(general_error(
        result.stopped_between
            ? trf("the workpiece does not go on; not run: {}", left)
            : trf("{} did not come to its end; not run: {}", result.setups.back().name, left)));
  }
  print_diagnostics(diagnostics, wishes.quiet);
  if (result.stopped_between) return result.code;
  return has_error(diagnostics) ? std::max<int>(result.code, kExitFailure) : result.code;
}

std::optional<Arguments> view_of_job(const Arguments& arguments, std::unique_ptr<JobRun>& run,
                                     int& code) {
  Diagnostics diagnostics;
  OptionReader reader(diagnostics, layers_of(arguments, nullptr));
  const auto setup = static_cast<std::size_t>(reader.whole_number("--setup", 1)) - 1;
  if (arguments.options.has("--units"))
    reader.fault("--units", tr("is not for jobs in a window; kerf job shows lengths in inches"));
  Arguments before = arguments;
  before.options.set_flag("--quiet");
  std::optional<JobRun> opened;
  if (!has_error(diagnostics))
    opened = JobRun::open(before, arguments.options.text("PROGRAM"), diagnostics);
  if (opened) opened->check(diagnostics);
  if (opened && setup >= opened->count())
    reader.fault("--setup",
                 trf("{} is not allowed; the job has {} setups", setup + 1, opened->count()));
  code = kExitUsage;
  print_diagnostics(diagnostics, false);
  if (!opened || has_error(diagnostics)) return std::nullopt;
  run = std::make_unique<JobRun>(std::move(*opened));
  JobRun::Wishes wishes;
  wishes.compares = false;
  run->run(0, setup, wishes);
  code = std::max<int>(run->result().code, kExitFailure);
  if (!run->is_ready(setup)) return std::nullopt;
  code = kExitGood;
  Arguments out = run->view_arguments(setup);
  if (!arguments.options.has("--quiet")) {
    out.options.clear("--quiet");
    if (setup + 1 < run->count()) {
      print_text(stderr, trf("setup {} of {}; the next one: kerf view {} --setup {}\n", setup + 1,
                             run->count(), arguments.options.text("PROGRAM"), setup + 2));
    }
  }
  return out;
}

}  // namespace kerf
