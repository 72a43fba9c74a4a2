#include "twin/cli/job_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "base/atomic_file.h"
#include "base/exit_code.h"
#include "base/translate.h"
#include "twin/cli/command_line.h"
#include "twin/cli/console.h"
#include "twin/cli/job_run.h"
#include "twin/cli/option_reader.h"
#include "twin/cli/outputs.h"
#include "twin/cli/page_output.h"
#include "twin/cli/run_options.h"
#include "twin/page/job_page.h"
#include "twin/program/session_parts.h"
#include "twin/report/motion_table.h"

namespace kerf {
namespace {

struct JobWishes {
  JobRun::Wishes run;
  OutputPaths own;  ///< json, junit, sarif, csv, html, pdf
  bool quiet = false;
  bool check_only = false;
};

/// The job's own and the last setup's: no two of them are the same file.
OutputPaths all_outputs(const JobWishes& wishes) {
  OutputPaths all = wishes.own;
  all.stl = wishes.run.last.stl;
  all.ply = wishes.run.last.ply;
  all.state = wishes.run.last.state;
  all.compare_png = wishes.run.last.compare_png;
  return all;
}

/// The page over all setups.
std::string page_of_job(const JobResult& result, const JobRun& run, const Arguments& arguments) {
  JobPage page;
  page.path = run.job().path;
  page.command = command_line(arguments);
  page.version = KERF_VERSION;
  page.units = shown_unit();
  page.not_run = result.not_run;
  for (std::size_t n = 0; n < result.setups.size(); ++n) {
    const JobResult::Setup& setup = result.setups[n];
    page.setups.push_back({run.title_of(n), run.job().setups[n].options.text("PROGRAM"), setup.lies,
                           setup.machining_s, setup.setup_s, setup.errors, setup.warnings,
                           setup.article});
  }
  for (const ToolOfSetups& tool : tools_of(result)) page.tools.push_back({tool.use, tool.setups});
  if (!result.setups.empty()) page.comparison = result.setups.back().comparison;
  return job_page(page);
}

void write_job_outputs(const OutputPaths& own, const JobRun& run, const Arguments& arguments,
                       Diagnostics& diagnostics) {
  const JobResult& result = run.result();
  const auto note = [&diagnostics](const Done& written) {
    if (!written) diagnostics.push_back(general_error(written.error()));
  };
  if (own.wants_page()) write_page(own, page_of_job(result, run, arguments), diagnostics);
  if (!own.csv.empty()) {
    std::vector<std::string> tables;
    for (const JobResult::Setup& setup : result.setups) tables.push_back(setup.table);
    note(join_motion_tables(own.csv, tables));
  }
  if (!own.json.empty()) note(write_text(own.json, job_json(result, run.job().path, KERF_VERSION)));
  write_finding_lists(own, result.listed, diagnostics);
}

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
  wishes.own.csv = reader.text("--csv");
  wishes.own.html = reader.text("--html");
  wishes.own.pdf = reader.text("--pdf");
  wishes.run.keeps_tables = !wishes.own.csv.empty();
  wishes.run.keeps_pages = wishes.own.wants_page();
  check_output_arguments(all_outputs(wishes), diagnostics);
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
  write_job_outputs(wishes.own, *run, arguments, diagnostics);
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

std::unique_ptr<ViewSetups> view_of_job(const Arguments& arguments, int& code) {
  Diagnostics diagnostics;
  OptionReader reader(diagnostics, layers_of(arguments, nullptr));
  const auto setup = static_cast<std::size_t>(reader.whole_number("--setup", 1)) - 1;
  if (arguments.options.has("--units"))
    reader.fault("--units", tr("is not for jobs in a window; kerf job shows lengths in inches"));
  std::unique_ptr<ViewSetups> setups;
  if (!has_error(diagnostics)) setups = ViewSetups::open(arguments, diagnostics);
  if (setups && setup >= setups->count())
    reader.fault("--setup",
                 trf("{} is not allowed; the job has {} setups", setup + 1, setups->count()));
  print_diagnostics(diagnostics, false);
  code = kExitUsage;
  if (!setups || has_error(diagnostics)) return nullptr;
  const std::optional<int> failed = setups->begin(setup);
  code = failed.value_or(kExitGood);
  return failed ? nullptr : std::move(setups);
}

}  // namespace kerf
