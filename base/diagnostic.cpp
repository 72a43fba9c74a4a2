#include "base/diagnostic.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/translate.h"

namespace kerf {
namespace {

std::string printable(const std::string& text) {
  std::string out = text;
  for (char& c : out) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return out;
}

}  // namespace

const char* to_string(Severity severity) {
  switch (severity) {
    case Severity::kNote:
      return tr_noop("note");
    case Severity::kWarning:
      return tr_noop("warning");
    case Severity::kError:
      return tr_noop("error");
  }
  return "error";
}

std::string to_string(const Diagnostic& d) {
  std::string out;
  if (d.file.empty()) {
    out = "kerf: ";
  } else {
    out = printable(d.file) + ":";
    if (d.line > 0) out += fmt::format("{}:", d.line);
    if (d.line > 0 && d.column > 0) out += fmt::format("{}:", d.column);
    out += " ";
  }
  out += fmt::format("{}: {}\n", tr(to_string(d.severity)), printable(d.message));
  if (!d.excerpt.empty()) {
    out += fmt::format("{:>6} | {}\n", d.line, printable(d.excerpt));
    if (d.column > 0)
      out += fmt::format("{:>6} | {}^\n", "",
                         std::string(static_cast<std::size_t>(d.column) - 1, ' '));
  }
  if (!d.hint.empty()) out += trf("   hint: {}\n", printable(d.hint));
  return out;
}

bool has_error(const Diagnostics& diagnostics) {
  return std::any_of(diagnostics.begin(), diagnostics.end(),
                     [](const Diagnostic& d) { return d.severity == Severity::kError; });
}

}  // namespace kerf
