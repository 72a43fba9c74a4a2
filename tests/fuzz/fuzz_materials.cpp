// Arbitrary bytes as a file of materials (--material FILE:NAME).
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "twin/config/material_reader.h"

namespace {

void check(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  kerf::Diagnostics diagnostics;
  const auto rows = kerf::parse_materials(text, "shop.yaml", diagnostics);
  check(rows.has_value() != kerf::has_error(diagnostics));
  for (const kerf::Diagnostic& one : diagnostics) {
    check(!kerf::to_string(one).empty() && !one.message.empty());
    check(one.line >= 0 && one.column >= (one.line > 0 ? 1 : 0));
  }
  if (!rows) return 0;
  for (const kerf::Material& row : *rows) {
    check(!row.name.empty());
    const auto found = kerf::need_material(*rows, row.name);
    check(static_cast<bool>(found));
  }
  return 0;
}
