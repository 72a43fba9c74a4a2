#include "twin/cli/console.h"

#include <atomic>
#include <string>

#include "twin/report/shown_lengths.h"

namespace kerf {
namespace {

std::atomic<LengthUnit> g_unit{LengthUnit::kMm};

}  // namespace

void show_lengths_in(LengthUnit unit) { g_unit = unit; }

LengthUnit shown_unit() { return g_unit; }

void print_lengths(std::FILE* stream, std::string_view text) {
  print_text(stream, in_unit(text, shown_unit()));
}

void print_diagnostic(std::FILE* stream, const Diagnostic& diagnostic) {
  print_text(stream, to_string(in_unit(diagnostic, shown_unit())));
}

void print_diagnostics(const Diagnostics& diagnostics, bool quiet) {
  for (const Diagnostic& d : diagnostics) {
    if (!quiet || d.severity == Severity::kError) print_diagnostic(stderr, d);
  }
}

}  // namespace kerf
