// interp_bridge/rs274_messages.h - what rs274 says on stderr, as a diagnostic with the user's file
// and line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "interp_bridge/motion.h"

namespace kerf {

/// rs274 ends a failed run with its message and, in a line of its own, the text of the line it had
/// read last.
struct InterpreterMessage {
  std::string message;  ///< in rs274's words; empty: it said nothing
  std::string echo;     ///< the line of the numbered copy
};
InterpreterMessage parse_interpreter_message(std::string_view stderr_text);

/// Whether LinuxCNC's words, which it says in no other language, are of a missing program end.
bool is_missing_end(std::string_view message);

/// The diagnostic of a run that ended with exit status 1. `files` as in ProgramSummary;
/// `last_source` is where the last command came from, for lines without a number; `program_lines`
/// is the length of files[0]. A missing program end is a warning (LinuxCNC would stop there too,
/// after all moves), everything else an error.
Diagnostic interpreter_diagnostic(std::string_view stderr_text,
                                  const std::vector<std::string>& files, SourceRef last_source,
                                  std::size_t program_lines);

/// The first line of a file, from `after` on, that begins with `text`; `after` if there is none.
std::uint32_t find_line(const std::string& path, const std::string& text, std::uint32_t after);

/// The lines of a message as one, "a; b", without those that are said on every run.
std::string one_line(std::string_view text);

/// The same for a fault of kerf-interp, which knows its place.
Diagnostic placed_diagnostic(const std::string& message, SourceRef place,
                             const std::vector<std::string>& files, std::size_t program_lines);

}  // namespace kerf
