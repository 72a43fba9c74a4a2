// Arbitrary bytes as a LinuxCNC tool table; what was read must survive the way into rs274's table.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "interp_bridge/tool_table.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  kerf::Diagnostics diagnostics;
  const auto rows = kerf::parse_tool_table(text, "fuzz.tbl", diagnostics);
  for (const kerf::Diagnostic& diagnostic : diagnostics) {
    if (kerf::to_string(diagnostic).empty()) std::abort();
  }
  const kerf::InterpreterToolTable table = kerf::interpreter_tool_table(rows, {});
  kerf::Diagnostics none;
  const auto again = kerf::parse_tool_table(table.text, "again.tbl", none);
  if (!none.empty() || again.size() + 1 != table.tool_by_index.size()) std::abort();
  return 0;
}
