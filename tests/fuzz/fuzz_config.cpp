// Arbitrary bytes as a configuration; behind a line of dashes, the text of one --set.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "twin/config/live_config.h"

namespace {

void check(bool holds) {
  if (!holds) std::abort();
}

/// Texts that make the reader open files: what these hold has fuzzers of its own.
bool names_a_file(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  for (const char* const word : {"profile", "dbc", "pins_file", "material", "\\"}) {
    if (lower.find(word) != lower.npos) return true;
  }
  return false;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (names_a_file(text)) return 0;
  const std::size_t parting = text.find("\n----\n");
  std::vector<std::string> sets;
  if (parting != text.npos) sets.emplace_back(text.substr(parting + 6));

  kerf::Diagnostics diagnostics;
  const auto config = kerf::parse_config(text.substr(0, parting), "dir/m.yaml", sets, diagnostics);
  check(config.has_value() != kerf::has_error(diagnostics));
  for (const kerf::Diagnostic& diagnostic : diagnostics) {
    check(!kerf::to_string(diagnostic).empty());
    check(diagnostic.line >= 0 && diagnostic.column >= (diagnostic.line > 0 ? 1 : 0));
  }
  if (!config) return 0;
  // What was accepted is printed so that it means the same.
  const std::string printed = kerf::effective_yaml(*config);
  kerf::Diagnostics again;
  const auto second = kerf::parse_config(printed, "", {}, again);
  check(second && again.empty());
  check(kerf::effective_yaml(*second) == printed);
  return 0;
}
