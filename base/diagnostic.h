// base/diagnostic.h - what kerf says about the user's input: `file:line:column: severity: message`,
// excerpt, hint.
#pragma once

#include <string>
#include <vector>

namespace kerf {

enum class Severity { kNote, kWarning, kError };

/// "error", "warning", "note".
const char* to_string(Severity severity);

/// One remark about one place. Lines and columns are 1-based; 0 = not known, and then not printed.
struct Diagnostic {
  Severity severity = Severity::kError;
  std::string
      file;  ///< As the user wrote it; empty for a command line argument or the program as a whole.
  int line = 0;
  int column = 0;       ///< In bytes.
  std::string message;  ///< What was found, and what is allowed.
  std::string excerpt;  ///< The source line, shown with a caret under `column`. May be empty.
  std::string hint;     ///< What to do. May be empty.
};

using Diagnostics = std::vector<Diagnostic>;

/// The text a person reads; ends in a newline:
///     part.yaml:14:12: error: stock.cell_mm: 0 is not allowed; must be above 0 (mm)
///        14 |   cell_mm: 0
///           |            ^
///        hint: 0.05 to 0.2 suits most parts
/// Without a file the line begins with "kerf: ". Control characters in excerpt and message are
/// shown as '?'.
std::string to_string(const Diagnostic& diagnostic);

bool has_error(const Diagnostics& diagnostics);

}  // namespace kerf
