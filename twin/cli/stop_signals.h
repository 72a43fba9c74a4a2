// twin/cli/stop_signals.h - Ctrl-C (SIGINT), SIGTERM and SIGHUP as a stop request.
#pragma once

#include <signal.h>

#include <array>
#include <functional>
#include <stop_token>
#include <thread>

namespace kerf {

/// While it lives, the first signal requests a stop; a second one calls `abandon` (clean up what
/// must not be left behind, quickly) and ends the process with exit code 4. Handlers only write a
/// byte to a pipe; a thread of its own does the rest. Signals that were ignored before (nohup,
/// background jobs of a script) stay ignored. Child processes start with the default handlers, as
/// exec() resets them. One at a time.
class StopSignals {
 public:
  StopSignals(std::stop_source& stop, std::function<void()> abandon);
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

 private:
  void watch(std::stop_source stop, const std::function<void()>& abandon);
  static constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, 3> before_{};  ///< what the signals did before
  int read_fd_ = -1;
  std::thread thread_;
};

}  // namespace kerf
