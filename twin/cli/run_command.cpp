#include "twin/cli/run_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/exit_code.h"
#include "base/translate.h"
#include "base/wait_for_stop.h"
#include "interp_bridge/private_folder.h"
#include "twin/cli/command_line.h"
#include "twin/cli/console.h"
#include "twin/cli/cutting_options.h"
#include "twin/cli/finding_shots.h"
#include "twin/cli/option_reader.h"
#include "twin/cli/page_output.h"
#include "twin/cli/progress_bar.h"
#include "twin/cli/served_page.h"
#include "twin/cli/stdin_program.h"
#include "twin/cli/stop_deadline.h"
#include "twin/cli/stop_signals.h"
#include "twin/cli/torch_options.h"
#include "twin/cli/view_command.h"
#include "twin/cli/window_host.h"
#include "twin/process/load_curve.h"
#include "twin/process/run_curve.h"
#include "twin/program/session_parts.h"
#include "twin/report/motion_table.h"
#include "twin/serve/run_broadcast.h"

namespace kerf {
namespace {

/// Findings printed one by one; the rest are only counted (and all are in --json).
constexpr std::size_t kFindingsShown = 20;

void print(const Diagnostics& diagnostics) {
  for (const Diagnostic& d : diagnostics) print_diagnostic(stderr, d);
}

void print_findings(const Report& report, bool quiet) {
  std::size_t shown = 0;
  for (const Finding& finding : report.findings.kept()) {
    if (quiet && finding.severity != Severity::kError) continue;
    if (++shown > kFindingsShown) break;
    print_diagnostic(stderr, diagnostic_of(finding, report.program.files));
  }
  if (shown > kFindingsShown) {
    print_text(stderr, trf("kerf: note: {} findings in all; --json FILE lists the first {}\n",
                           report.findings.total(), FindingLog::kMaxKept));
  }
}

/// The second Ctrl-C: the interpreter ends on the stop request already made and takes its temporary
/// folder with it; it gets a moment for that. Half-written files go as well.
void abandon(const std::atomic<Session*>& session) {
  constexpr int kTries = 200;
  for (int i = 0; i < kTries && session.load() && session.load()->interpreting(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  remove_uncommitted_files();
}

int exit_code(Outcome outcome, const Report& report, const Diagnostics& diagnostics) {
  if (outcome == Outcome::kUsageError) return kExitUsage;
  const bool finished = outcome == Outcome::kFinished || outcome == Outcome::kLossy;
  if (!finished || has_error(diagnostics)) return kExitFailure;
  if (outcome == Outcome::kLossy) return kExitLossy;
  return report.findings.count(Severity::kError) > 0 ? kExitFindings : kExitGood;
}

/// Messages about the text of standard input are not about the file that it was kept in.
void rename_stdin(const StdinProgram& kept, Report& report, Diagnostics& diagnostics) {
  if (kept.path().empty()) return;
  report.program_path = StdinProgram::kName;
  for (std::string& file : report.program.files) file = kept.renamed(std::move(file));
  for (Diagnostic& d : diagnostics) {
    d.file = kept.renamed(std::move(d.file));
    d.message = kept.renamed(std::move(d.message));
  }
  report.findings.rename_files([&](std::string text) { return kept.renamed(std::move(text)); });
}

/// For a disk that is slow while files are written, and for what a stop asks to end by itself.
constexpr std::chrono::milliseconds kWritingPatience{1000}, kRunPatience{10'000};

void print_results(const RunRequest& request, const Report& report) {
  print_findings(report, request.quiet);
  if (request.quiet) return;
  const std::string command =
      request.is_of_job
          ? std::string()
          : command_line(with_guesses(request.written, rows_in(report.guesses, request.units)));
  const bool on_stderr = request.summary_on_stderr || request.outputs.uses_stdout();
  kerf::print(on_stderr ? stderr : stdout, "{}",
              summary_text(report, {request.verbose, command, request.units}));
}

/// The last words of a run that was interrupted where nothing looks at the stop: what is known, as
/// a partial report; and which files there will not be.
void tell_interrupted(const RunRequest& request, Report report, unsigned dealt_with,
                      const char* where) {
  if (report.partial_reason.empty()) {
    report.partial_reason = trf("interrupted {}", where);
    Finding finding;
    finding.id = FindingId::kInterrupted;
    finding.severity = Severity::kNote;
    finding.text = report.partial_reason;
    report.findings.add(std::move(finding));
  }
  OutputPaths paths;
  paths.json = request.outputs.json;
  Diagnostics diagnostics;
  write_outputs(paths, 0, nullptr, {}, report, diagnostics);
  print_results(request, report);
  if (const std::string left = names_left(request.outputs, dealt_with); !left.empty()) {
    Diagnostic d;
    d.message = trf("interrupted: not written: {}", left);
    diagnostics.push_back(std::move(d));
  }
  print(diagnostics);
}

/// Of a run that has not come to a report of its own.
Report report_of_nothing(const RunRequest& request) {
  Report report;
  report.version = KERF_VERSION;
  report.program_path = request.session.program.path;
  report.lines = request.session.lines;
  return report;
}

/// Of one that has not come to a report.
ListedProgram listed_fault(const RunRequest& request, const Diagnostics& diagnostics) {
  ListedProgram listed;
  listed.path = request.session.program.path;
  listed.faults = diagnostics;
  return listed;
}

/// What nobody has said is guessed, or asked for, by a first reading.
StdinProgram::Listings listings_of(const SessionOptions& session) {
  const bool tools_known = !session.tools.empty() || !session.libraries.empty() ||
                           !session.program.tool_table_path.empty();
  const bool all_known = session.blank && (tools_known || is_sheet(*session.blank));
  return all_known && session.guess ? StdinProgram::Listings::kStreamed
                                    : StdinProgram::Listings::kKept;
}

/// The session tells it of its motions; null, with a diagnostic, if it cannot be written.
std::unique_ptr<MotionTable> begin_table(const RunRequest& request, const StdinProgram& kept,
                                         Session& session, Diagnostics& diagnostics) {
  auto begun = MotionTable::create(
      request.outputs.csv, [&kept](std::string text) { return kept.renamed(std::move(text)); },
      request.engagement);
  if (!begun) {
    diagnostics.push_back(general_error(begun.error()));
    return nullptr;
  }
  session.record_by(*begun.value());
  return std::move(begun.value());
}

std::span<const CutLabel> labels_in(const Session& session) {
  return session.cut_labels() ? session.cut_labels()->all() : std::span<const CutLabel>();
}

void end_table(MotionTable& table, Diagnostics& diagnostics) {
  if (const Done written = table.commit(); !written)
    diagnostics.push_back(general_error(written.error()));
}

/// Its workpiece in between is kept as long as `folder`.
std::optional<EntryPlan> plan_entry_of(const RunRequest& request,
                                       std::optional<PrivateFolder>& folder, std::stop_token stop,
                                       Diagnostics& diagnostics) {
  Result<PrivateFolder> made = PrivateFolder::create();
  if (!made) {
    diagnostics.push_back(general_error(made.error()));
    return std::nullopt;
  }
  folder.emplace(std::move(*made));
  return plan_entry(request.session, request.entry, folder->path(), stop, diagnostics);
}

/// The exit code: `code`, or that of a list that cannot be written.
int list_findings(const OutputPaths& outputs, std::span<const ListedProgram> listed, int code) {
  Diagnostics diagnostics;
  write_finding_lists(outputs, listed, diagnostics);
  print(diagnostics);
  return has_error(diagnostics) ? kExitFailure : code;
}

/// What came of it may be looked at until somebody stops.
void keep_page(const RunRequest& request, const std::stop_token& stop) {
  if (!request.quiet) print_text(stderr, trf("kerf: the page stays until Ctrl-C\n"));
  flush_console();
  while (!wait_for_stop(stop, std::chrono::hours(1))) {
  }
}

RunBroadcastOptions broadcast_options(const RunRequest& request) {
  RunBroadcastOptions options;
  const std::string& path = request.session.program.path;
  options.has_file = path != "-";
  options.title = std::filesystem::path(path).filename().string();
  options.unit = request.units;
  return options;
}

}  // namespace

RunVerdict run_one(const Arguments& arguments, RunRequest request, const RunListener& finished) {
  Diagnostics diagnostics;
  check_output_places(request.outputs, diagnostics);
  make_finding_folder(request.finding_png, diagnostics);
  if (request.view && !has_display()) {
    Diagnostic d;
    d.message = tr("--view: no window: neither DISPLAY nor WAYLAND_DISPLAY is set");
    d.hint = tr("pictures need no display: --png FILE");
    diagnostics.push_back(std::move(d));
  }
  if (request.view) check_shapes(request.machine, diagnostics);
  const std::shared_ptr<const DesignFile> design = open_design(request.compare, diagnostics);
  Outcome outcome = Outcome::kFailed;
  std::unique_ptr<Session> session;
  StdinProgram kept;
  // Before the session is opened: filling a large blank takes its time, too.
  std::stop_source stop;
  std::atomic<Session*> opened{nullptr};
  const StopSignals signals(stop, [&] { abandon(opened); });
  std::optional<StopDeadline> deadline(std::in_place, stop.get_token(), kExitFailure);
  deadline->set_last_words(
      [&request, none = report_of_nothing(request)] {
        tell_interrupted(request, none, 0, tr("before the end of the program"));
      },
      kRunPatience);
  const RunBroadcastOptions of_page = broadcast_options(request);
  kept.take(request.session.program.path, listings_of(request.session), stop.get_token(),
            diagnostics);
  std::optional<PrivateFolder> between;  // of the workpiece as the entry finds it
  std::optional<EntryPlan> entry;
  if (!has_error(diagnostics) && request.entry.line > 0) {
    entry = plan_entry_of(request, between, stop.get_token(), diagnostics);
    if (entry) request.session = entry->session;
    if (!entry && !has_error(diagnostics)) outcome = Outcome::kInterrupted;
  }
  const bool can_open = !has_error(diagnostics) && (entry || request.entry.line == 0);
  request.session.stock.keeps_cut_ids =
      request.engagement || request.outputs.wants_page() || request.keeps_page;
  if (can_open) session = Session::open(request.session, diagnostics, outcome);
  Report none;
  rename_stdin(kept, session ? session->report() : none, diagnostics);
  std::unique_ptr<MotionTable> table;
  if (session && !request.outputs.csv.empty()) {
    table = begin_table(request, kept, *session, diagnostics);
    if (!table) session.reset();
  }
  if (session && (request.compare.is_wanted() || request.keeps_moves)) session->keep_moves();
  if (session && request.engagement)
    session->log_engagement(!request.outputs.engagement_png.empty());
  std::optional<RunCurve> curve;
  std::optional<LoadCurve> loads;
  if (session && (request.outputs.wants_page() || request.keeps_page)) {
    session->keep_cut_labels();
    session->record_by(curve.emplace());
    if (request.engagement) session->hear_loads(loads.emplace());
  }
  std::optional<ServedPage> page;
  std::optional<RunBroadcast> broadcast;
  if (session && request.serve) {
    if (!open_and_tell(page.emplace(), *request.serve)) {
      return {kExitFailure, stop.stop_requested(), listed_fault(request, diagnostics)};
    }
    session->set_observer(&broadcast.emplace(of_page, *session, page->scene()));
  }
  print(diagnostics);
  if (!session) {
    return {exit_code(outcome, Report{}, diagnostics), stop.stop_requested(),
            listed_fault(request, diagnostics)};
  }
  diagnostics.clear();
  opened = session.get();
  {
    const ProgressBar bar([&] { return session->progress(); }, !request.quiet);
    outcome = session->run(stop.get_token(), diagnostics);
  }
  if (entry) {
    session->report().entry = std::move(entry->report);
    for (Finding& finding : entry->findings) session->report().findings.add(std::move(finding));
  }
  rename_stdin(kept, session->report(), diagnostics);
  if (request.engagement && session->stock()) doubt_engagement(*session->stock(), diagnostics);
  Compared compared;
  PageFacts facts;
  if (!has_error(diagnostics) && design) {
    compared = compare_finished(request.compare, *design, session->stock(),
                                {labels_in(*session), session->kept_moves()}, session->report(),
                                diagnostics);
  }
  if (!has_error(diagnostics)) {
    std::atomic<unsigned> dealt_with{0};
    deadline->set_last_words(
        [&request, &dealt_with, report = session->report()] {
          tell_interrupted(request, report, dealt_with, tr("before all its files were written"));
        },
        kWritingPatience);
    facts = {labels_in(*session),
             curve ? &*curve : nullptr,
             request.is_of_job
                 ? std::string()
                 : command_line(with_guesses(request.written,
                                             rows_in(session->report().guesses, request.units))),
             request.units,
             compared.of_workpiece().get(),
             loads ? &*loads : nullptr,
             request.session.cutting};
    write_pages(request.outputs, session->report(), session->stock(), facts, diagnostics);
    dealt_with |= request.outputs.bit_of(request.outputs.html);
    dealt_with |= request.outputs.bit_of(request.outputs.pdf);
    if (table) {
      end_table(*table, diagnostics);
      dealt_with |= request.outputs.bit_of(request.outputs.csv);
    }
    write_outputs(request.outputs, request.mesh_tolerance_mm, session->stock(),
                  session->collisions(), session->report(), diagnostics, &dealt_with, compared);
    if (!request.finding_png.empty()) {
      std::atomic<double> share{0};
      const ProgressBar bar([&] { return share.load(); }, !request.quiet);
      write_finding_pictures(
          request.finding_png, request.session, request.machine, request.ini, session->report(),
          stop.get_token(), [&](double done) { share = done; }, diagnostics);
    }
    deadline->set_last_words({}, kWritingPatience);
    print_results(request, session->report());
  }
  const int code = exit_code(outcome, session->report(), diagnostics);
  if (finished && !has_error(diagnostics)) finished({*session, outcome, code, facts}, diagnostics);
  flush_console();
  print(diagnostics);
  ListedProgram listed = listed_program(session->report());
  listed.faults = diagnostics;
  if (broadcast) broadcast->end();
  const bool is_kept = broadcast && !request.view && session->stock() && !stop.stop_requested();
  if (is_kept) {
    deadline.reset();  // nothing is left that could take its time
    const int whole_code = list_findings(request.outputs, {&listed, 1}, code);
    keep_page(request, stop.get_token());
    return {whole_code, false, std::move(listed), true};
  }
  if (!request.view || stop.stop_requested() || !session->stock()) {
    return {code, stop.stop_requested(), std::move(listed)};
  }
  session.reset();
  opened = nullptr;
  deadline.reset();  // the window has its own
  const int shown = show_program(arguments, request, stop);
  return {shown == kExitGood ? code : shown, stop.stop_requested(), std::move(listed)};
}

namespace {

/// What one file or one window cannot take of several programs.
void refuse_shared_outputs(const RunRequest& request, std::size_t programs,
                           Diagnostics& diagnostics) {
  for (const auto& [option, path] : request.outputs.named()) {
    const bool takes_all = path == &request.outputs.junit || path == &request.outputs.sarif;
    if (path->empty() || takes_all) continue;
    add_fault(option, trf("{}: one file, and there are {} programs", *path, programs),
              tr("run them one by one, each with a file of its own"), diagnostics);
  }
  if (!request.finding_png.empty()) {
    add_fault("--finding-png",
              trf("{}: one folder, and there are {} programs", request.finding_png, programs),
              tr("run them one by one, each with a folder of its own"), diagnostics);
  }
  if (request.serve) {
    add_fault("--serve", tr("one page, and there are several programs"), {}, diagnostics);
  }
  if (request.view) {
    add_fault("--view", tr("one window, and there are several programs"), {}, diagnostics);
  }
}

}  // namespace

int run_command(const Arguments& arguments) {
  const std::vector<std::string> programs = arguments.options.texts("PROGRAM");
  Arguments one = arguments;
  if (!programs.empty()) one.options.set("PROGRAM", programs.front());
  Diagnostics diagnostics;
  RunRequest request = understand_run(one, diagnostics);
  check_sheet_options(request.session.blank, one, diagnostics);
  if (programs.size() > 1) refuse_shared_outputs(request, programs.size(), diagnostics);
  if (has_error(diagnostics)) {
    print(diagnostics);  // in the user's own words and units
    return kExitUsage;
  }
  show_lengths_in(request.units);
  print(diagnostics);  // warnings about files
  const OutputPaths outputs = request.outputs;
  std::vector<ListedProgram> listed;
  if (programs.size() <= 1) {
    RunVerdict end = run_one(one, std::move(request));
    if (end.is_listed) return end.code;
    listed.push_back(std::move(end.listed));
    return list_findings(outputs, listed, end.code);
  }
  RunVerdict worst;
  for (const std::string& program : programs) {
    RunRequest own = request;
    own.session.program.path = program;
    own.written.options.set("PROGRAM", program);
    RunVerdict end = run_one(one, std::move(own));
    worst.code = std::max(worst.code, end.code);
    listed.push_back(std::move(end.listed));
    if (end.interrupted) break;
  }
  return list_findings(outputs, listed, worst.code);
}

}  // namespace kerf
