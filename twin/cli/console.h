// twin/cli/console.h - print.h for texts of kerf's own, whose lengths are shown in the unit that
// was asked for.
#pragma once

#include <cstdio>
#include <string_view>

#include "base/diagnostic.h"
#include "base/length_unit.h"
#include "base/print.h"

namespace kerf {

/// The unit of the lengths that print_lengths() and print_diagnostic() show; mm until it is set,
/// which is done once, before anything is shown.
void show_lengths_in(LengthUnit unit);
LengthUnit shown_unit();

/// A text of kerf's own, made in mm (in_unit()).
void print_lengths(std::FILE* stream, std::string_view text);
void print_diagnostic(std::FILE* stream, const Diagnostic& diagnostic);

/// To stderr, each as print_diagnostic() does. `quiet`: errors alone.
void print_diagnostics(const Diagnostics& diagnostics, bool quiet);

}  // namespace kerf
