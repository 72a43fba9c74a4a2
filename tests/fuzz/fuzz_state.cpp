// Saved workpieces from arbitrary bytes, as they come and with a right checksum so that the parts
// behind it are reached.
#include <cstddef>
#include <cstdint>
#include <string>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "stock/zmap/state_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  (void)kerf::parse_state(bytes, "fuzz");
  XXH128_canonical_t sum;
  XXH128_canonicalFromHash(&sum, XXH3_128bits(bytes.data(), bytes.size()));
  bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  (void)kerf::parse_state(bytes, "fuzz");
  return 0;
}
