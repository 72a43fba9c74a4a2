// Arbitrary bytes as what kerf-status says, parted at any place.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "machine_io/hal/status_lines.h"

namespace {

void check(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  kerf::StatusLines whole, parted;
  whole.take(text);
  const std::size_t half = size > 0 ? data[0] % size : 0;
  parted.take(text.substr(0, half));
  parted.take(text.substr(half));
  check(whole.program() == parted.program());
  if (whole.program()) {
    check(whole.program()->size() < kerf::StatusLines::kLongestLine);
    check(text.find(*whole.program()) != text.npos);
    check(whole.program()->find('\n') == std::string_view::npos);
  }
  whole.forget();
  check(!whole.program());
  return 0;
}
