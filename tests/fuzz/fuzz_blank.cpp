// --stock text from arbitrary bytes.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "stock/blank.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto blank = kerf::parse_blank(std::string(data, data + size));
  if (!blank) {
    if (blank.error().empty()) std::abort();
    return 0;
  }
  if (kerf::describe(*blank).empty()) std::abort();
  // What a file holds is not known before it is read.
  const bool in_a_file =
      !blank->state_file.empty() || blank->mesh || (blank->sheet && !blank->sheet->file.empty());
  if (!in_a_file && !(blank->bounds_mm().volume_mm3() > 0)) std::abort();
  return 0;
}
