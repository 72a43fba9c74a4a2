// bench_interp PROGRAM.. - kerf-interp with and without its fast numbers against LinuxCNC's rs274,
// and a second look at a program whose records are kept. Says nothing of a result that is not
// equal.
#include <fmt/format.h>
#include <stdlib.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "interp_bridge/program.h"

namespace {

using namespace kerf;
using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

/// Of this process, without the interpreter's.
double cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

struct Timed {
  double first_cpu_ms = 0;
  double open_ms = 0;   ///< the text has been looked over
  double first_ms = 0;  ///< the first motions are there
  double all_ms = 0;
  std::uint64_t motions = 0;
  std::uint64_t sum = 0;  ///< of the bits of all ends and lines
};

Timed run(const ProgramOptions& options) {
  Timed timed;
  Diagnostics diagnostics;
  const double cpu_begin_ms = cpu_ms();
  const auto begin = Clock::now();
  const std::unique_ptr<Program> program = Program::open(options, diagnostics);
  if (!program) {
    for (const Diagnostic& one : diagnostics) fmt::print(stderr, "{}", to_string(one));
    std::exit(4);
  }
  timed.open_ms = ms_since(begin);
  program->run(
      [&](std::span<const Motion> batch) {
        if (timed.motions == 0) {
          timed.first_ms = ms_since(begin);
          timed.first_cpu_ms = cpu_ms() - cpu_begin_ms;
        }
        timed.motions += batch.size();
        for (const Motion& motion : batch) {
          for (int i = 0; i < 3; ++i) {
            std::uint64_t bits = 0;
            std::memcpy(&bits, &motion.to_mm[i], sizeof bits);
            timed.sum = timed.sum * 1099511628211U + bits;
          }
          timed.sum = timed.sum * 1099511628211U + motion.source.line;
        }
        return true;
      },
      {}, diagnostics);
  timed.all_ms = ms_since(begin);
  return timed;
}

/// Median of three, by the whole time; they must be equal.
Timed median(const ProgramOptions& options) {
  std::vector<Timed> runs = {run(options), run(options), run(options)};
  std::sort(runs.begin(), runs.end(),
            [](const Timed& a, const Timed& b) { return a.all_ms < b.all_ms; });
  return runs[1];
}

double command_ms(const std::string& command) {
  std::vector<double> runs;
  for (int i = 0; i < 3; ++i) {
    const auto begin = Clock::now();
    if (std::system(command.c_str()) != 0) return 0;
    runs.push_back(ms_since(begin));
  }
  std::sort(runs.begin(), runs.end());
  return runs[1];
}

void measure(const std::string& path, const std::string& folder) {
  const std::string listing = folder + "/listing", none = folder + "/none/parameters";
  const double rs274_ms = command_ms(fmt::format(
      "HOME='{}' rs274 -n 2 -v '{}' -g '{}' > '{}' 2>/dev/null", folder, none, path, listing));
  const auto alone = [&](const char* fast) {
    return command_ms(fmt::format("'{}' --fast {} --parameters '{}' '{}' 3>'{}' >/dev/null",
                                  KERF_INTERP_EXECUTABLE, fast, none, path, listing));
  };
  const double off_ms = alone("off"), on_ms = alone("must");
  ProgramOptions options;
  options.path = path;
  options.interpreter = InterpreterChoice::kBridge;
  options.kerf_interp_path = KERF_INTERP_EXECUTABLE;
  options.interp_fast = false;
  const Timed slow = median(options);
  options.interp_fast = true;
  const Timed fast = median(options);
  options.cache_folder = folder + "/cache";
  const Timed cold = run(options);
  const Timed warm = median(options);
  if (fast.sum != slow.sum || cold.sum != slow.sum || warm.sum != slow.sum) {
    fmt::print(stderr, "{}: the motions differ\n", path);
    std::exit(1);
  }
  fmt::print(
      "{}: {} motions, equal\n"
      "  rs274 to a file {:.0f} ms; kerf-interp to a file {:.0f} ms ({:.2f} of it), fast {:.0f} ms "
      "({:.2f})\n"
      "  in kerf, all motions: {:.0f} ms, fast {:.0f}, the first time that is kept {:.0f}, "
      "kept {:.0f}\n"
      "  until the first motions: {:.1f} ms, fast {:.1f}, kept {:.1f} (of which text {:.1f}); "
      "processor time of the last {:.1f}\n",
      path, slow.motions, rs274_ms, off_ms, off_ms / rs274_ms, on_ms, on_ms / rs274_ms, slow.all_ms,
      fast.all_ms, cold.all_ms, warm.all_ms, slow.first_ms, fast.first_ms, warm.first_ms,
      warm.open_ms, warm.first_cpu_ms);
}

}  // namespace

int main(int argc, char** argv) {
  std::string folder = (std::filesystem::temp_directory_path() / "bench_interp-XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) return 4;
  setenv("INI_FILE_NAME", "", 1);
  for (int i = 1; i < argc; ++i) measure(argv[i], folder);
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
}
