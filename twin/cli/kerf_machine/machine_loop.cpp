#include "twin/cli/kerf_machine/machine_loop.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cmath>

#include "base/translate.h"

namespace kerf {
namespace {

constexpr double kNanoseconds = 1e9;

class Deadlines {
 public:
  explicit Deadlines(double rate_hz) : period_s_(1 / rate_hz) {
    clock_gettime(CLOCK_MONOTONIC, &start_);
  }

  /// Sleeps until the next deadline; its time since the start.
  double wait(std::uint64_t& skipped) {
    ++count_;
    const double now = elapsed();
    const double missed = std::floor((now - static_cast<double>(count_) * period_s_) / period_s_);
    if (missed >= 1) {
      skipped += static_cast<std::uint64_t>(missed);
      count_ += static_cast<std::uint64_t>(missed);
    }
    const double due = static_cast<double>(count_) * period_s_;
    const timespec at = later(due);
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) == EINTR) {
    }
    return due;
  }

 private:
  double elapsed() const {
    timespec now = {};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec - start_.tv_sec) +
           static_cast<double>(now.tv_nsec - start_.tv_nsec) / kNanoseconds;
  }
  timespec later(double seconds) const {
    const double whole = std::floor(seconds);
    timespec at = start_;
    at.tv_sec += static_cast<time_t>(whole);
    at.tv_nsec += static_cast<long>((seconds - whole) * kNanoseconds);
    if (at.tv_nsec >= static_cast<long>(kNanoseconds)) {
      at.tv_nsec -= static_cast<long>(kNanoseconds);
      ++at.tv_sec;
    }
    return at;
  }

  double period_s_;
  std::uint64_t count_ = 0;
  timespec start_{};
};

void tell_faults(const ActiveFaults& before, const ActiveFaults& now, double time_s,
                 const SayLine& say) {
  if (before.mask == now.mask) return;
  for (std::size_t i = 0; i < kFaultKinds; ++i) {
    const auto kind = static_cast<FaultKind>(i);
    if (before.has(kind) == now.has(kind)) continue;
    say(fmt::format("fault {} {} at {:.3f} s", to_string(kind), now.has(kind) ? "on" : "off",
                    time_s));
  }
}

}  // namespace

void publish_start(const MachinePlayer& player, const MachineLoopOptions& options,
                   StateBoard& board) {
  board.publish(FaultInjector(options.faults).serve(player.state(), -1));
}

MachineLoopResult run_machine_loop(const MachineLoopOptions& options, MachinePlayer& player,
                                   StateBoard& board, CanSender* can, const SayLine& say,
                                   const std::stop_token& stop) {
  MachineLoopResult result;
  FaultInjector injector(options.faults);
  Deadlines deadlines(options.rate_hz);
  SimulatedState state = player.state();
  ActiveFaults faults;
  bool started = false;
  double begins_s = options.start_delay_s;
  bool waits = static_cast<bool>(options.has_reader);
  double before_s = -options.start_delay_s;
  double sent_s = 0;
  while (!stop.stop_requested()) {
    const double clock_s = deadlines.wait(result.skipped);
    if (waits) begins_s = clock_s + options.start_delay_s;
    waits = waits && !options.has_reader();
    const double time_s = clock_s - begins_s;
    if (time_s >= 0 && !waits && !started) {
      started = true;
      before_s = 0;
      say("started");
    }
    bool ends = false;
    if (started && !result.finished) {
      ends = !player.advance((time_s - before_s) * options.speed);
      result.elapsed_s = time_s;
    }
    const std::uint16_t scan = state.scan;
    state = player.state();
    state.scan = static_cast<std::uint16_t>(scan + 1);
    state.load = options.load.at(std::max(0.0, time_s) * options.speed, state.scan);
    const ServedState served = injector.serve(state, time_s);
    board.publish(served);
    if (can != nullptr) can->send(served, result.updates > 0 ? time_s - sent_s : 0);
    sent_s = time_s;
    ++result.updates;
    tell_faults(faults, served.faults, time_s, say);
    faults = served.faults;
    before_s = time_s;
    if (!ends) continue;
    result.finished = true;
    say(fmt::format("finished after {:.3f} s", time_s));
    if (!options.hold) return result;
  }
  return result;
}

}  // namespace kerf
