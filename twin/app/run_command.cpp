#include "twin/app/run_command.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <stop_token>
#include <thread>

#include "base/atomic_file.h"
#include "twin/app/console.h"
#include "twin/app/exit_code.h"
#include "twin/app/progress_bar.h"
#include "twin/app/stop_signals.h"
#include "twin/app/view_command.h"
#include "twin/app/window_host.h"

namespace kerf {
namespace {

/// Findings printed one by one; the rest are only counted (and all are in --json).
constexpr std::size_t kFindingsShown = 20;

void print(const Diagnostics& diagnostics) {
  for (const Diagnostic& d : diagnostics) kerf::print(stderr, "{}", to_string(d));
}

void print_findings(const Report& report, bool quiet) {
  std::size_t shown = 0;
  for (const Finding& finding : report.findings.kept()) {
    if (quiet && finding.severity != Severity::kError) continue;
    if (++shown > kFindingsShown) break;
    kerf::print(stderr, "{}", to_string(diagnostic_of(finding, report.program.files)));
  }
  if (shown > kFindingsShown) {
    kerf::print(stderr, "kerf: note: {} findings in all; --json FILE lists the first {}\n",
                report.findings.total(), FindingLog::kMaxKept);
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

}  // namespace

int run_command(const RunArguments& arguments) {
  Diagnostics diagnostics;
  const RunRequest request = understand(arguments, diagnostics);
  if (has_error(diagnostics)) {
    print(diagnostics);
    return kExitUsage;
  }
  check_output_places(request.outputs, diagnostics);
  if (request.view && !has_display()) {
    Diagnostic d;
    d.message = "--view: no window: neither DISPLAY nor WAYLAND_DISPLAY is set";
    d.hint = "pictures need no display: --png FILE";
    diagnostics.push_back(std::move(d));
  }
  if (request.view) check_shapes(request.machine, diagnostics);
  Outcome outcome = Outcome::kFailed;
  std::unique_ptr<Session> session;
  // Before the session is opened: filling a large blank takes its time, too.
  std::stop_source stop;
  std::atomic<Session*> opened{nullptr};
  const StopSignals signals(stop, [&] { abandon(opened); });
  if (!has_error(diagnostics)) session = Session::open(request.session, diagnostics, outcome);
  print(diagnostics);
  if (!session) return exit_code(outcome, Report{}, diagnostics);
  diagnostics.clear();
  opened = session.get();
  {
    const ProgressBar bar([&] { return session->progress(); }, !request.quiet);
    outcome = session->run(stop.get_token(), diagnostics);
  }
  if (!has_error(diagnostics)) {
    write_outputs(request.outputs, request.mesh_tolerance_mm, session->stock(), session->report(),
                  diagnostics);
    print_findings(session->report(), request.quiet);
    if (!request.quiet) {
      kerf::print(request.outputs.uses_stdout() ? stderr : stdout, "{}",
                  summary_text(session->report()));
    }
  }
  flush_console();
  print(diagnostics);
  const int code = exit_code(outcome, session->report(), diagnostics);
  if (!request.view || stop.stop_requested() || !session->stock()) return code;
  session.reset();
  opened = nullptr;
  const int shown = show_program(request, stop);
  return shown == kExitGood ? code : shown;
}

}  // namespace kerf
