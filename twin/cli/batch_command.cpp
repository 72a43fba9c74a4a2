#include "twin/cli/batch_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/exit_code.h"
#include "base/small_file.h"
#include "base/translate.h"
#include "twin/batch/batch_pages.h"
#include "twin/batch/batch_run.h"
#include "twin/batch/option_table.h"
#include "twin/batch/work_list.h"
#include "twin/batch/work_unit.h"
#include "twin/cli/console.h"
#include "twin/cli/outputs.h"
#include "twin/cli/run_options.h"
#include "twin/cli/stop_signals.h"
#include "twin/cli/torch_options.h"
#include "twin/cli/view_load.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxTableBytes = 64U << 20U;

/// What is wrong with the options that a program is run with, as `kerf run` would say it.
void check_run_options(const WrittenOptions& options, const std::string& program,
                       Diagnostics& diagnostics) {
  Arguments run;
  run.command = kRun;
  run.options = options;
  run.options.set("PROGRAM", program);
  run.options.set("--png", "part.png");  // what --section asks for
  const RunRequest request = understand_run(run, diagnostics);
  check_sheet_options(request.session.blank, run, diagnostics);
}

std::vector<OptionRow> read_table(const std::string& path, Diagnostics& diagnostics) {
  if (path.empty()) return {};
  const Result<std::string> text = read_small_file(path, kMaxTableBytes);
  if (text) return parse_option_table(*text, path, diagnostics);
  add_fault("--options", text.error(), {}, diagnostics);
  return {};
}

void warn_of_unused(const std::vector<OptionRow>& rows, const std::set<int>& used,
                    const std::string& path, Diagnostics& diagnostics) {
  for (const OptionRow& row : rows) {
    if (used.contains(row.line)) continue;
    Diagnostic d;
    d.severity = Severity::kWarning;
    d.file = path;
    d.line = row.line;
    d.column = 1;
    d.message = trf("{} fits none of the programs", row.pattern);
    diagnostics.push_back(std::move(d));
  }
}

/// Each program with its words; what is wrong with them is told once, at the place that says it.
std::vector<BatchUnit> units_of(const Arguments& arguments,
                                const std::vector<std::string>& programs, OptionReader& reader) {
  Diagnostics& diagnostics = reader.diagnostics();
  const std::string table = reader.text("--options");
  const std::vector<OptionRow> rows = read_table(table, diagnostics);
  std::set<int> used;
  std::set<std::vector<std::string>> checked;
  std::vector<BatchUnit> units;
  for (const std::string& program : programs) {
    WrittenOptions options = arguments.options;
    int line = 0;
    for (const OptionRow& row : rows) {
      if (!fits(row, program)) continue;
      apply(row, options);
      used.insert(line = row.line);
    }
    units.push_back({program, run_words(options)});
    if (!checked.insert(units.back().words).second) continue;
    Diagnostics found;
    check_run_options(options, program, found);
    for (Diagnostic& d : found) {
      if (d.file.empty() && line > 0) {
        d.file = table;
        d.line = line;
      }
      diagnostics.push_back(std::move(d));
    }
  }
  warn_of_unused(rows, used, table, diagnostics);
  return units;
}

BatchPlan understand_batch(const Arguments& arguments, Diagnostics& diagnostics) {
  OptionReader reader(diagnostics, layers_of(arguments, nullptr));
  BatchPlan plan;
  plan.out = reader.text("--out");
  plan.again = reader.is_yes("--again");
  plan.bounds.seconds = reader.number("--each-seconds");
  plan.bounds.memory_mb = reader.number("--each-memory");
  reader.word("--engine", {BatchEngine::kLocal, BatchEngine::kParallel, BatchEngine::kSlurm},
              plan.engine);
  plan.jobs = static_cast<int>(reader.whole_number("--jobs", 0));
  if (plan.engine == BatchEngine::kLocal) {
    const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    if (plan.jobs == 0) plan.jobs = cores;
    plan.threads_each = std::clamp(cores / plan.jobs, 1, 8);
  }
  const std::vector<std::string> programs =
      programs_of(arguments.options.texts("WHAT"), diagnostics);
  plan.units = units_of(arguments, programs, reader);
  if (programs.empty() && !has_error(diagnostics)) {
    reader.fault("WHAT", tr("there is no program in it"));
  }
  return plan;
}

void print_result(const BatchResult& result, std::size_t done, std::size_t all) {
  std::string line =
      fmt::format("[{}/{}] {}: {}", done, all, result.program, shown_verdict(result.verdict));
  if (!result.message.empty()) line += " (" + result.message + ")";
  print_text(stdout, line + "\n");
  flush_console();
}

/// Told at most once of each file.
void write_pages_of(const BatchPlan& plan, const BatchEnd& end, Diagnostics& diagnostics) {
  const std::filesystem::path out = plan.out;
  const std::size_t all = plan.units.size();
  for (const auto& [name, text] :
       {std::pair("summary.json", batch_summary_json(end, all, KERF_VERSION)),
        std::pair("junit.xml", batch_junit(end, plan.out, KERF_VERSION)),
        std::pair("index.html", batch_index_html(end, all, KERF_VERSION))}) {
    if (const Done done = write_text((out / name).string(), text); !done) {
      diagnostics.push_back(fault_of(done.error()));
    }
  }
}

int worst_code(const BatchEnd& end) {
  int code = kExitGood;
  for (const BatchResult& result : end.results) {
    code = std::max<int>(code, exit_code_of(result.verdict));
  }
  return code;
}

}  // namespace

int batch_unit_command(const std::string& path) {
  std::stop_source stop;
  const StopSignals signals(stop, [] { remove_uncommitted_files(); });
  const Done done = run_unit_file(path, stop.get_token());
  if (done) return kExitGood;
  print_diagnostics({fault_of(done.error())}, false);
  return kExitFailure;
}

int batch_command(const Arguments& arguments) {
  const bool quiet = arguments.options.has("--quiet");
  Diagnostics diagnostics;
  const BatchPlan plan = understand_batch(arguments, diagnostics);
  print_diagnostics(diagnostics, quiet);
  if (has_error(diagnostics)) return kExitUsage;
  std::stop_source stop;
  const StopSignals signals(stop, [] { remove_uncommitted_files(); });
  const std::size_t all = plan.units.size();
  const BatchEnd end =
      run_batch(plan, stop.get_token(), [&](const BatchResult& result, std::size_t done) {
        if (!quiet) print_result(result, done, all);
      });
  diagnostics.clear();
  if (!end.fault.empty()) diagnostics.push_back(fault_of(end.fault));
  const bool was_begun = std::filesystem::exists(std::filesystem::path(plan.out) / "results.jsonl");
  if (was_begun) write_pages_of(plan, end, diagnostics);
  if (end.interrupted) {
    Diagnostic d;
    d.message = trf("interrupted: {} of {} programs have a result", end.results.size(), all);
    d.hint = tr("the same command goes on where it stopped");
    diagnostics.push_back(std::move(d));
  }
  if (!quiet) {
    std::string line = batch_counts_text(end, all);
    if (end.reused > 0) line += trf("; {} of them from before", end.reused);
    print_text(stdout, line + "\n");
    if (was_begun && !has_error(diagnostics)) {
      print_text(stdout, (std::filesystem::path(plan.out) / "index.html").string() + "\n");
    }
  }
  flush_console();
  print_diagnostics(diagnostics, quiet);
  return has_error(diagnostics) ? kExitFailure : worst_code(end);
}

}  // namespace kerf
