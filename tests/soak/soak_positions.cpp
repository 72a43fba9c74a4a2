// soak_positions PROGRAM SECONDS RATE_HZ: what a machine that runs PROGRAM again and again for so
// long says of itself, as a recording of kerf on stdout. Made as fast as it can be, not in real
// time. With "once" behind it the machine runs PROGRAM once and stands at its end for the rest.
#include <fmt/format.h>
#include <fmt/os.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <string_view>
#include <utility>

#include "twin/cli/kerf_machine/machine_player.h"

namespace kerf {
namespace {

constexpr std::int64_t kStart_ns = 1'800'000'000'000'000'000;
constexpr std::size_t kBlock_bytes = std::size_t{1} << 20U;

/// The way that is left of `seconds`, waiting for the interpreter where the player would stand.
/// False: the program is over.
bool advance(MachinePlayer& player, StepFeed& feed, double seconds) {
  const double due_s = player.program_s() + seconds;
  while (due_s - player.program_s() > 1e-9) {
    const double before_s = player.program_s();
    if (!player.advance(due_s - before_s)) return false;
    if (player.program_s() - before_s <= 0) feed.wait({});
  }
  return true;
}

void append_head(fmt::memory_buffer& text, double rate_hz) {
  fmt::format_to(std::back_inserter(text),
                 "# kerf-recording/1\n# source: simulated machine, {:g} Hz\n# units: mm\n"
                 "# coordinates: axes workpiece\n# start: 2027-01-15T08:00:00.000000000Z\n"
                 "t_host,t_device,x,y,z,tool,line,tool_offset_z,spindle_rpm\n",
                 rate_hz);
}

void append_sample(fmt::memory_buffer& text, std::int64_t elapsed_ns, const SimulatedState& state) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const std::int64_t host_ns = kStart_ns + elapsed_ns;
  fmt::format_to(std::back_inserter(text), "{}.{:09},{}.{:09},{:.4f},{:.4f},{:.4f},{},{},{},{}\n",
                 host_ns / kSecond_ns, host_ns % kSecond_ns, elapsed_ns / kSecond_ns,
                 elapsed_ns % kSecond_ns, state.position[0], state.position[1], state.position[2],
                 state.tool, state.line, state.tool_offset_z_mm, state.spindle_rpm);
}

/// False if stdout does not take it.
bool flush(fmt::memory_buffer& text) {
  const bool good = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  text.clear();
  return good;
}

int make(const char* path, double seconds, double rate_hz, bool once) {
  StepFeedOptions options;
  options.program.path = path;
  options.program.max_commands = 0;
  options.program.max_silent_s = 1e9;
  options.repeat = !once;
  Diagnostics diagnostics;
  auto program = Program::open(options.program, diagnostics);
  for (const Diagnostic& d : diagnostics) fmt::print(stderr, "{}", to_string(d));
  if (!program) return 1;
  StepFeed feed(options, std::move(program));
  MachinePlayer player(feed, ServedFrame::kWorkpiece);
  player.prepare({});
  fmt::memory_buffer text;
  append_head(text, rate_hz);
  const auto samples = static_cast<std::int64_t>(std::llround(seconds * rate_hz));
  const auto period_ns = static_cast<std::int64_t>(std::llround(1e9 / rate_hz));
  bool runs = true;
  double ended_s = seconds;
  for (std::int64_t i = 0; i < samples; ++i) {
    append_sample(text, i * period_ns, player.state());
    if (text.size() > kBlock_bytes && !flush(text)) break;
    if (runs && !advance(player, feed, 1 / rate_hz)) {
      runs = false;
      ended_s = player.program_s();
    }
  }
  fmt::format_to(std::back_inserter(text), "# end samples={}\n", samples);
  if (!flush(text) || std::fflush(stdout) != 0) {
    fmt::print(stderr, "soak_positions: stdout: {}\n", std::strerror(errno));
    return 1;
  }
  fmt::print(stderr, "soak_positions: {} samples of {:g} s; the program moved until {:.1f} s\n",
             samples, seconds, ended_s);
  return 0;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  const bool once = argc == 5 && std::string_view(argv[4]) == "once";
  const double seconds = argc > 3 ? std::atof(argv[2]) : 0;
  const double rate_hz = argc > 3 ? std::atof(argv[3]) : 0;
  if (!(seconds > 0 && rate_hz > 0) || argc > 5 || (argc == 5 && !once)) {
    fmt::print(stderr, "usage: soak_positions PROGRAM SECONDS RATE_HZ [once]\n");
    return 2;
  }
  return kerf::make(argv[1], seconds, rate_hz, once);
}
