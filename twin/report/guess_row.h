// twin/report/guess_row.h - what was taken for want of better, as options of the command line.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/length_unit.h"

namespace kerf {

/// One thing that was guessed; lengths are mm.
struct GuessRow {
  std::string what;    ///< "blank", "beam", "tool 1"
  std::string option;  ///< --stock, --tool, --beam, --kerf; empty: no option can say it
  std::string value;   ///< "box:0,0,-5:10,10,0"
  std::string reason;
};

/// The same with their lengths, and those in their reasons, in `unit`.
std::vector<GuessRow> rows_in(std::span<const GuessRow> rows, LengthUnit unit);

/// The rows, and the command that says what they say (`command`; may be empty), as the summary
/// shows them; empty: nothing was guessed.
std::string guess_text(std::span<const GuessRow> rows, const std::string& command);

}  // namespace kerf
