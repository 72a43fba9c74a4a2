#include "twin/process/contact_grounds.h"

#include "base/translate.h"

namespace kerf {

Severity severity_of(FindingId id, const Grounds& grounds) {
  return doubt_of(id, grounds).empty() ? Severity::kError : Severity::kWarning;
}

std::string doubt_of(FindingId id, const Grounds& grounds) {
  const bool tool = grounds.tool_guessed && id != FindingId::kBelowStock;
  if (grounds.blank_guessed && tool) return tr(" (of a guessed blank, with a guessed tool)");
  if (grounds.blank_guessed) return tr(" (of a guessed blank)");
  return tool ? tr(" (with a guessed tool)") : "";
}

}  // namespace kerf
