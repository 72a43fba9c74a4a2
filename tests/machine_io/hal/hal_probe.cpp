// Reads a HalSource until SIGTERM, inside a LinuxCNC's namespaces, for hal_live_test.
// hal_probe KERF_HAL RATE_HZ OUT: writes OUT.csv (one line a sample) and OUT.states (one line each
// time that state or trouble changes; counters at the end).
#include <fmt/format.h>
#include <fmt/os.h>
#include <signal.h>

#include <charconv>
#include <cstring>

#include "machine_io/hal/hal_source.h"

namespace {

volatile sig_atomic_t is_ending = 0;
void on_signal(int /*number*/) { is_ending = 1; }

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  kerf::HalSettings settings;
  settings.kerf_hal_path = argv[1];
  std::from_chars(argv[2], argv[2] + std::strlen(argv[2]), settings.rate_hz);
  // A number that is known otherwise stands for a drive's load: another pin's.
  settings.load = kerf::HalLoad{"joint.2.pos-fb", kerf::LoadUnit::kPercentOfPower, 2.0, 1.0};
  const std::string out = argv[3];
  for (const std::string& fault : kerf::validate(settings)) {
    fmt::print(stderr, "hal_probe: {}\n", fault);
    return 2;
  }
  signal(SIGTERM, on_signal);

  fmt::ostream samples = fmt::output_file(out + ".csv");
  fmt::ostream states = fmt::output_file(out + ".states");
  kerf::HalSource source(settings);
  kerf::HalStatus shown;
  shown.collision_ahead = true;
  shown.collision_seconds = 3.5;
  shown.finding_line = 7;
  shown.off_path_mm = 0.25;
  std::string before;
  while (is_ending == 0) {
    source.show(shown);
    kerf::AxisSample sample;
    const auto next = source.next(sample, std::chrono::milliseconds(50));
    const kerf::SourceStatus& status = source.status();
    const std::string now = fmt::format("{} {}", static_cast<int>(status.state), status.trouble);
    if (now != before) states.print("{}\n", now);
    before = now;
    if (next == kerf::PositionSource::Next::kEnd) break;
    if (next != kerf::PositionSource::Next::kSample) continue;
    samples.print("{} {} {} {} {} {} {} {} {} {} {}\n", sample.host_ns, sample.device_ns,
                  sample.known, sample.tool, sample.line, sample.tool_offset_z_mm,
                  sample.spindle_rpm, sample.position[0], sample.position[1], sample.position[2],
                  sample.load);
  }
  const kerf::SourceStatus& status = source.status();
  states.print("samples {} errors {} reconnects {} lost {}\n", status.samples, status.errors,
               status.reconnects, status.lost);
  return 0;
}
