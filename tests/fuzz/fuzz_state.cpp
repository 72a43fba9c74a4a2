// Saved workpieces from arbitrary bytes, as they come and with a right checksum so that the parts
// behind it are reached.
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "stock/octree/octree_state.h"
#include "stock/sheet/sheet_state.h"
#include "stock/turning/turning_state.h"
#include "stock/zmap/mmap/mmap_state.h"
#include "stock/zmap/state_file.h"
#include "stock/zmap/zmap.h"

namespace {

/// With what its walls say of its volume.
void parse_heights(const std::string& bytes) {
  constexpr int kMostCells = 4096;
  kerf::Result<kerf::SavedState> state = kerf::parse_state(bytes, "fuzz");
  if (!state || state->grid.nx() > kMostCells / state->grid.ny()) return;
  (void)kerf::ZMap::of_heights(std::move(*state), 1, kerf::ZMapKernel::kScalar)->remaining_mm3();
}

/// By every model.
void parse(const std::string& bytes) {
  parse_heights(bytes);
  (void)kerf::parse_columns(bytes, "fuzz");
  (void)kerf::octree::parse_tree(bytes, "fuzz");
  (void)kerf::sheet::parse_sheet(bytes, "fuzz");
  (void)kerf::turning::parse_part(bytes, "fuzz");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  parse(bytes);
  XXH128_canonical_t sum;
  XXH128_canonicalFromHash(&sum, XXH3_128bits(bytes.data(), bytes.size()));
  bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  parse(bytes);
  return 0;
}
