// twin/batch/option_table.h - options by program, from a file; and options as words of a command.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "twin/config/written_options.h"

namespace kerf {

/// One line: what of a program's options it says.
struct OptionRow {
  std::string pattern;  ///< as a shell's; `*` goes over '/', too
  /// Each option of the line with its value; "" of a flag.
  std::vector<std::pair<std::string, std::string>> said;
  int line = 0;
};

/// Lines of "PATTERN: --option VALUE ..". Words are those of a shell: blanks part them, '..' and
/// ".." hold them together, \ takes the next sign as it is. Empty lines, and those that begin with
/// #, say nothing. Faults, all of them, with line and column: no pattern, an option that a batch
/// does not pass on (is_passed_on()), a value that is missing, a quote that is not closed.
std::vector<OptionRow> parse_option_table(std::string_view text, const std::string& path,
                                          Diagnostics& diagnostics);

/// The pattern is of the path as it was written, or of its end behind a '/':
/// "slot.ngc" and "parts/*.ngc" fit "work/parts/slot.ngc".
bool fits(const OptionRow& row, const std::string& program);

/// A value takes the place of what was said before; those of a repeatable option are added.
void apply(const OptionRow& row, WrittenOptions& options);

/// What a batch passes on of these, as words for `kerf run`: "--cell=0.1". In the order of the
/// setting table.
std::vector<std::string> run_words(const WrittenOptions& options);

}  // namespace kerf
