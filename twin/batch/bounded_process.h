// twin/batch/bounded_process.h - another kerf as a process, within bounds of time and memory.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"

namespace kerf {

/// 0: none.
struct ProcessBounds {
  double seconds = 0;  ///< of the clock
  /// What each process may allocate for writing (RLIMIT_DATA: heap, stacks, private maps of memory;
  /// not code, not files that are mapped), so kerf and the interpreter that it starts for itself.
  double memory_mb = 0;
  double file_mb = 0;  ///< of each file that it writes (RLIMIT_FSIZE)
};

struct ProcessEnd {
  int exit_code = -1;  ///< -1: ended by a signal
  int signal = 0;
  bool out_of_time = false;
  bool stopped = false;  ///< by stop()
  double wall_s = 0;
  double peak_rss_mb = 0;  ///< of the largest of its processes
};

/// This very executable with other arguments, in a process group of its own, with standard input
/// empty and both outputs in a file. It ends with this process, at the latest. Asked to end by
/// SIGTERM, upon which kerf writes what it knows, which may take it 10 s; some time later its whole
/// group is killed.
class BoundedProcess {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kGrace{12};
  /// After stop(): nobody wants its results.
  static constexpr std::chrono::seconds kStopGrace{3};

  /// Error: what the system refused.
  static Result<BoundedProcess> start(const std::vector<std::string>& words,
                                      const std::string& said_path, const ProcessBounds& bounds);
  BoundedProcess(BoundedProcess&& other) noexcept;
  BoundedProcess& operator=(BoundedProcess&& other) noexcept;
  /// Kills what still runs.
  ~BoundedProcess();

  /// Readable once the process has ended: for poll().
  int ended_fd() const { return ended_fd_; }
  /// When look() has something to do, if the process has not ended by then.
  Clock::time_point next_look() const { return deadline_; }
  /// Asks it to end, or kills it, if its time has come; what it was if it has ended.
  std::optional<ProcessEnd> look(Clock::time_point now);
  void stop();

 private:
  BoundedProcess() = default;
  void ask_to_end(Clock::time_point now);

  pid_t pid_ = -1;
  int ended_fd_ = -1;
  bool asked_ = false;
  ProcessEnd end_;
  Clock::time_point begun_;
  Clock::time_point deadline_ = Clock::time_point::max();
};

}  // namespace kerf
