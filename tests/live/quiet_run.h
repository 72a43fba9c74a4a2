// tests/live/quiet_run.h - a run beside a LinuxCNC that kerf has seen whole.
#pragma once

#include <algorithm>
#include <chrono>
#include <iostream>
#include <limits>
#include <memory>
#include <stop_token>
#include <thread>

namespace kerf {

/// How long this computer has let a thread wait that wanted to run, at most. kerf, at the lowest
/// priority, waits no less.
class WakeProbe {
 public:
  /// From now on.
  WakeProbe()
      : thread_([this](const std::stop_token& stop) {
          constexpr std::chrono::milliseconds kStep{5};
          while (!stop.stop_requested()) {
            const auto due = std::chrono::steady_clock::now() + kStep;
            std::this_thread::sleep_until(due);
            const std::chrono::duration<double> late = std::chrono::steady_clock::now() - due;
            worst_s_ = std::max(worst_s_, late.count());
          }
        }) {}
  /// Ends it.
  double worst_s() {
    if (thread_.joinable()) {
      thread_.request_stop();
      thread_.join();
    }
    return worst_s_;
  }

 private:
  double worst_s_ = 0;
  std::jthread thread_;
};

/// The run of LinuxCNC that all tests of a program look at. Where a computer had no time for its
/// processes, positions are missing, and kerf says so (Run::gaps()), or LinuxCNC complains: it is
/// made again, and what comes from kerf stays. Where this computer stands still in each of the
/// runs, and each has gaps, nothing can be said of it.
template <typename Run>
struct QuietRun {
  std::unique_ptr<Run> run;
  double least_stall_s = std::numeric_limits<double>::infinity();  ///< WakeProbe's, of all runs
  bool has_gaps = false;                                           ///< of the last one

  /// Positions that are half a second apart are a gap, and kerf waits longer than others do.
  bool stood_still() const { return has_gaps && least_stall_s > 0.1; }

  QuietRun() {
    constexpr int kRuns = 3;
    for (int i = 0; i < kRuns; ++i) {
      run.reset();
      WakeProbe probe;
      run = std::make_unique<Run>();
      const double stall_s = probe.worst_s();
      least_stall_s = std::min(least_stall_s, stall_s);
      has_gaps = run->gaps() > 0;
      if (run->status == 0 && !has_gaps) return;
      std::cout << "status " << run->status << ", kerf told of " << run->gaps()
                << " gaps; this computer stood still for up to " << stall_s << " s\n";
    }
  }
};

}  // namespace kerf
