// Arbitrary bytes as a turret of a punch press.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "twin/config/turret_reader.h"

namespace {

void check(bool holds) {
  if (!holds) std::abort();
}

/// Shapes from files: what these hold has a fuzzer of its own. Escapes may spell their names.
bool names_a_file(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  for (const char* const word : {"dxf", "svg", "\\"}) {
    if (lower.find(word) != lower.npos) return true;
  }
  return false;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (names_a_file(text)) return 0;
  kerf::Diagnostics diagnostics;
  const kerf::TurretPointer turret = kerf::parse_turret(text, "dir/t.yaml", diagnostics);
  check((turret != nullptr) != kerf::has_error(diagnostics));
  for (const kerf::Diagnostic& one : diagnostics) {
    check(!kerf::to_string(one).empty() && !one.message.empty() && one.file == "dir/t.yaml");
  }
  if (turret == nullptr) return 0;
  check(!turret->stations.empty());
  for (const auto& [number, station] : turret->stations) {
    check(number >= 1 && station.number == number);
    check(station.punch.footprint() != nullptr && station.punch.radius_mm() > 0);
  }
  for (const int code : turret->user_codes()) check(code >= 100 && code <= 199);
  return 0;
}
