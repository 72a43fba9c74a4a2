#include "twin/cli/run_ends.h"

#include "base/exit_code.h"
#include "base/translate.h"
#include "twin/cli/console.h"
#include "twin/findings/finding.h"

namespace kerf {

int end_code(Outcome outcome, const Diagnostics& diagnostics) {
  if (outcome == Outcome::kUsageError) return kExitUsage;
  if (outcome == Outcome::kFailed || outcome == Outcome::kInterrupted || has_error(diagnostics)) {
    return kExitFailure;
  }
  return outcome == Outcome::kLossy ? kExitLossy : kExitGood;
}

void print_stops(const Report& report) {
  for (const Finding& finding : report.findings.kept()) {
    if (finding.id != FindingId::kInterpreterError) continue;
    print_diagnostic(stderr, diagnostic_of(finding, report.program.files));
  }
  if (report.partial_reason.empty()) return;
  Diagnostic d;
  d.message = trf("{}: not run to its end: {}", report.program_path, report.partial_reason);
  print_diagnostic(stderr, d);
}

}  // namespace kerf
