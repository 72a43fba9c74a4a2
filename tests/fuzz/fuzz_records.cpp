// Any bytes as the records of kerf-interp.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "interp_bridge/record_reader.h"

namespace {

bool finite(const kerf::Vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kerf;
  if (size == 0) return 0;
  const MotionSink sink = [](std::span<const Motion> batch) {
    for (const Motion& motion : batch) {
      // What no stream may bring about: the stock models rely on it.
      if (!finite(motion.from_mm) || !finite(motion.to_mm) || !finite(motion.arc.center_mm) ||
          !finite(motion.arc.axis) || !std::isfinite(motion.arc.sweep_rad)) {
        std::abort();
      }
    }
    return true;
  };
  ProgramSummary summary;
  Diagnostics diagnostics;
  MotionFeederOptions options;
  options.max_commands = 1000;
  MotionFeeder feeder(options, sink, summary, diagnostics);
  RecordReader reader(
      feeder, [](const std::string& name) { return name; }, summary);
  // The first byte says in which pieces the rest arrives.
  const std::size_t piece = data[0] + std::size_t{1};
  for (std::size_t at = 1; at < size; at += piece) {
    const std::span<char> room = reader.room();
    const std::size_t bytes = std::min({piece, size - at, room.size()});
    std::memcpy(room.data(), data + at, bytes);
    if (!reader.received(bytes)) break;
  }
  feeder.finish();
  return 0;
}
