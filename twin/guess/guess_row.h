// twin/guess/guess_row.h - what was taken for want of better, as options of the command line.
#pragma once

#include <span>
#include <string>

namespace kerf {

/// One thing that was guessed.
struct GuessRow {
  std::string what;    ///< "blank", "beam", "tool 1"
  std::string option;  ///< "--stock"; empty: no option can say it
  std::string value;   ///< "box:0,0,-5:10,10,0"
  std::string reason;
};

/// "kerf run part.ngc --stock box:.. --tool 1=flat:6": what was written (`arguments`, kerf itself
/// first) and what was guessed, quoted for a shell.
std::string command_with(std::span<const std::string> arguments, std::span<const GuessRow> rows);

/// The rows and that command, as the summary shows them; empty: nothing was guessed.
std::string guess_text(std::span<const GuessRow> rows, std::span<const std::string> arguments);

}  // namespace kerf
