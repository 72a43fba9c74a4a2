// Arbitrary bytes as a log: each format that they may be, read to the end. Samples are in order and
// finite, and every line is accounted for.
#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "machine_io/logs/log_source.h"

namespace {

/// A file of our own that holds the bytes, without a name.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : file_(std::tmpfile()) {
    if (file_ == nullptr) std::abort();
    // Of an empty input `data` may be null.
    if (size != 0 && std::fwrite(data, 1, size, file_) != size) std::abort();
    if (std::fflush(file_) != 0) std::abort();
  }
  ~Bytes() { std::fclose(file_); }
  Bytes(const Bytes&) = delete;
  Bytes& operator=(const Bytes&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(fileno(file_)); }

 private:
  std::FILE* file_;
};

void read_all(kerf::LogSettings settings) {
  kerf::Diagnostics diagnostics;
  const auto source = kerf::LogSource::open(std::move(settings), diagnostics);
  if ((source == nullptr) != kerf::has_error(diagnostics)) std::abort();
  for (const kerf::Diagnostic& diagnostic : diagnostics) {
    if (kerf::to_string(diagnostic).empty()) std::abort();
  }
  if (source == nullptr) return;
  kerf::AxisSample sample;
  std::uint64_t samples = 0;
  while (source->next(sample, std::chrono::milliseconds{0}) != kerf::PositionSource::Next::kEnd) {
    ++samples;
    if ((sample.fresh & ~sample.known) != 0 || sample.known >> kerf::kMaxPositions != 0) {
      std::abort();
    }
    for (std::size_t i = 0; i < kerf::kMaxPositions; ++i) {
      if (sample.has(i) && !std::isfinite(sample.position[i])) std::abort();
    }
    if (sample.tool < kerf::AxisSample::kUnknown || sample.line < kerf::AxisSample::kUnknown) {
      std::abort();
    }
  }
  if (source->status().samples != samples) std::abort();
  if (source->status().state != kerf::SourceState::kEnded) std::abort();
  if (source->notes().size() > 100) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Bytes bytes(data, size);
  kerf::LogSettings settings;
  settings.path = bytes.path();
  read_all(settings);

  settings.pins = {"joint.0.pos-fb", "axis.x.pos-cmd", "motion.program-line"};
  read_all(settings);

  settings.pins.clear();
  settings.can_map.emplace();
  settings.can_map->axes[0] = kerf::cia402_position(1, 0.001);
  settings.can_map->axes[1] = kerf::odrive_position(1, 5.0);
  read_all(settings);

  const std::string text(reinterpret_cast<const char*>(data), size);
  kerf::Diagnostics diagnostics;
  if (kerf::pins_from_hal_text(text, "fuzz.hal", 0, diagnostics).empty() !=
      kerf::has_error(diagnostics)) {
    std::abort();
  }
  return 0;
}
