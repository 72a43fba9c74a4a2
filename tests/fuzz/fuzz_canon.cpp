// Arbitrary bytes as a canonical listing, in pieces of arbitrary size: parsed, counted, folded.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "interp_bridge/canonical_reader.h"

namespace {

bool finite(const kerf::Vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  kerf::ProgramSummary summary;
  kerf::Diagnostics diagnostics;
  const kerf::MotionSink sink = [](std::span<const kerf::Motion> batch) {
    for (const kerf::Motion& motion : batch) {
      // What no listing may bring about: the stock models rely on it.
      if (!finite(motion.from_mm) || !finite(motion.to_mm) || !finite(motion.arc.center_mm) ||
          !finite(motion.arc.axis) || !std::isfinite(motion.arc.sweep_rad)) {
        std::abort();
      }
    }
    return true;
  };
  kerf::CanonicalReaderOptions options;
  options.listing_name = "fuzz";
  options.numbered_source = (data[0] & 1) != 0;
  options.unnumbered = {{0, 3}, {0, 9}};
  options.feeder.diameters.all = (data[0] & 2) != 0;
  kerf::CanonicalReader reader(options, sink, summary, diagnostics);
  const std::size_t step = 1 + data[0] / 4u;
  for (std::size_t at = 1; at < size; at += step) {
    const std::size_t bytes = std::min(step, size - at);
    std::copy_n(data + at, bytes, reader.room().begin());
    if (!reader.received(bytes)) break;
  }
  reader.finish();
  return 0;
}
