#include "twin/cli/diff_command.h"

#include <cstdio>
#include <memory>
#include <optional>
#include <stop_token>
#include <utility>

#include "base/atomic_file.h"
#include "base/exit_code.h"
#include "base/translate.h"
#include "twin/cli/command_line.h"
#include "twin/cli/console.h"
#include "twin/cli/outputs.h"
#include "twin/cli/progress_bar.h"
#include "twin/cli/run_ends.h"
#include "twin/cli/run_options.h"
#include "twin/cli/stop_signals.h"
#include "twin/cli/torch_options.h"
#include "twin/cli/view_load.h"
#include "twin/diff/diff_text.h"
#include "twin/program/session_parts.h"

namespace kerf {
namespace {

/// Places printed one by one; more are in --json.
constexpr std::size_t kHunksShown = 20;

/// What both are cut with, and what is wanted.
struct DiffRequest {
  RunRequest run;  ///< of the program that is asked about
  double tolerance_mm = 0;
  std::string json;
};

DiffRequest understand_diff(Arguments arguments, const std::string& program,
                            Diagnostics& diagnostics) {
  arguments.options.set("PROGRAM", program);
  const std::optional<LiveConfig> read = read_config(arguments.options, diagnostics);
  const LiveConfig* const config = read ? &*read : nullptr;
  OptionReader reader(diagnostics, layers_of(arguments, config));
  DiffRequest request;
  request.run = understand_cut(config, reader);
  request.tolerance_mm = reader.length_mm("--tolerance");
  request.json = reader.text("--json");
  check_sheet_options(request.run.session.blank, arguments, diagnostics);
  return request;
}

/// A program that has been cut, or a saved workpiece.
struct CutSide {
  DiffSide side;
  std::unique_ptr<Session> session;  ///< of a program
  StockSetup saved;                  ///< of a workpiece
  std::vector<GuessRow> guesses;
  int code = kExitGood;  ///< what kept it from being compared

  const StockModel* stock() const { return session ? session->stock() : saved.stock.get(); }
  DiffedPart part() const { return {stock(), session ? session->cut_labels() : nullptr}; }
};

CutSide cut_program(const DiffRequest& request, const std::stop_token& stop) {
  CutSide out;
  Diagnostics diagnostics;
  Outcome outcome = Outcome::kFailed;
  out.side.path = request.run.session.program.path;
  SessionOptions options = request.run.session;
  options.stock.keeps_cut_ids = true;
  out.session = Session::open(std::move(options), diagnostics, outcome);
  print_diagnostics(diagnostics, request.run.quiet);
  if (!out.session) {
    out.code = end_code(outcome, diagnostics);
    return out;
  }
  diagnostics.clear();
  StepCollector collector;
  out.session->record_by(collector);
  out.session->keep_cut_labels();
  {
    const ProgressBar bar([&] { return out.session->progress(); }, !request.run.quiet);
    outcome = out.session->run(stop, diagnostics);
  }
  print_diagnostics(diagnostics, request.run.quiet);
  const Report& report = out.session->report();
  print_stops(report);
  out.code = end_code(outcome, diagnostics);
  if (!report.partial_reason.empty() && out.code == kExitGood) out.code = kExitFailure;
  out.side.files = report.program.files;
  out.side.steps = std::move(collector.steps);
  for (const ToolUse& use : report.tools) out.side.tools.emplace_back(use.number, use.shape);
  out.guesses = report.guesses;
  return out;
}

CutSide load_saved(const DiffRequest& request) {
  CutSide out;
  out.side.path = request.run.session.program.path;
  Diagnostics diagnostics;
  Outcome outcome = Outcome::kFailed;
  Result<Blank> blank = parse_blank("state:" + out.side.path);
  if (blank) {
    out.saved = make_stock(*blank, StockChoice{}, request.run.session.stock, out.side.path,
                           diagnostics, outcome);
  } else {
    diagnostics.push_back(fault_of(blank.error()));
  }
  print_diagnostics(diagnostics, request.run.quiet);
  if (!out.saved.stock) out.code = kExitFailure;
  return out;
}

CutSide side_of(const DiffRequest& request, ViewKind kind, const std::stop_token& stop) {
  return kind == ViewKind::kState ? load_saved(request) : cut_program(request, stop);
}

ViewKind kind_of(const std::string& name, const std::string& path, Diagnostics& diagnostics) {
  if (path == "-") {
    add_fault(name, tr("standard input cannot be read more than once"),
              tr("keep the program in a file"), diagnostics);
    return ViewKind::kProgram;
  }
  const ViewKind kind = view_kind_of(path);
  if (kind == ViewKind::kLog) {
    add_fault(name, trf("{}: a log is neither a program nor a workpiece", path),
              tr("kerf replay LOG --state FILE makes a workpiece of it"), diagnostics);
  }
  return kind;
}

/// What of the first one was guessed counts for both.
void print_common_guesses(const Arguments& arguments, const std::vector<GuessRow>& rows,
                          bool quiet) {
  if (quiet || rows.empty()) return;
  print_text(stderr, guess_text(rows, command_line(with_guesses(arguments, rows))));
}

int compare(const DiffRequest& request, CutSide& a, CutSide& b, ViewKind kind_a, ViewKind kind_b) {
  DiffReport report;
  report.a = std::move(a.side);
  report.b = std::move(b.side);
  report.tolerance_mm = request.tolerance_mm;
  if (kind_a == ViewKind::kProgram && kind_b == ViewKind::kProgram) {
    report.motion = diff_motions(report.a.steps, report.b.steps, request.tolerance_mm);
  }
  if (a.stock() && b.stock()) {
    const bool walls_count = !report.motion || !report.motion->is_same();
    report.part = diff_parts(a.part(), b.part(), request.tolerance_mm, walls_count);
  }
  const bool to_stdout = request.json == "-" || request.json == "/dev/stdout";
  if (!request.run.quiet) {
    print_lengths(to_stdout ? stderr : stdout, diff_text(report, kHunksShown));
  }
  if (!request.json.empty()) {
    if (const Done done = write_text(request.json, diff_json(report, KERF_VERSION)); !done) {
      print_diagnostics({fault_of(done.error())}, request.run.quiet);
      return kExitFailure;
    }
  }
  if (a.code == kExitLossy || b.code == kExitLossy) return kExitLossy;
  return report.is_same() ? kExitGood : kExitFindings;
}

}  // namespace

int diff_command(const Arguments& arguments) {
  Diagnostics diagnostics;
  const std::string path_a = arguments.options.text("A"), path_b = arguments.options.text("B");
  const DiffRequest first = understand_diff(arguments, path_a, diagnostics);
  const ViewKind kind_a = kind_of("A", path_a, diagnostics);
  const ViewKind kind_b = kind_of("B", path_b, diagnostics);
  const bool is_usage = has_error(diagnostics);
  OutputPaths places;
  places.json = first.json;
  check_output_places(places, diagnostics);
  print_diagnostics(diagnostics, first.run.quiet);
  if (has_error(diagnostics)) return is_usage ? kExitUsage : kExitFailure;
  show_lengths_in(first.run.units);
  std::stop_source stop;
  const StopSignals signals(stop, [] { remove_uncommitted_files(); });
  CutSide a = side_of(first, kind_a, stop.get_token());
  if (a.code != kExitGood && a.code != kExitLossy) return a.code;
  const std::vector<GuessRow> guesses = rows_in(a.guesses, first.run.units);
  print_common_guesses(arguments, guesses, first.run.quiet);
  Diagnostics told_already;
  const DiffRequest second =
      understand_diff(with_guesses(arguments, guesses), path_b, told_already);
  CutSide b = side_of(second, kind_b, stop.get_token());
  if (b.code != kExitGood && b.code != kExitLossy) return b.code;
  return compare(first, a, b, kind_a, kind_b);
}

}  // namespace kerf
