// twin/cli/scheduling.h - running beside a machine's control without being noticed.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace kerf {

/// CPUs in the kernel's list notation ("0-2,5"), as /sys/devices/system/cpu/isolated has it.
/// Unreadable parts are left out.
std::vector<int> cpus_in(const std::string& list);

/// Makes room for the control, for this process and all that it starts: lowest ordinary priority
/// (nice 19, SCHED_BATCH), and off the CPUs that the kernel isolates for real-time threads.
/// Everything of it that the system refuses is left as it is: a sentence for each. `isolated` is
/// the kernel's list; empty: read from /sys.
std::vector<std::string> make_room(const std::string& isolated = {});

/// Refuses memory beyond `megabytes` of data to this process and all that it starts: kerf then ends
/// with "out of memory", and the machine keeps running. False with errno.
bool limit_memory(double megabytes);

/// Keeps this process below a share of one CPU: whoever works calls rest() now and then.
class CpuBudget {
 public:
  /// `percent` of one CPU; 0: no limit.
  explicit CpuBudget(double percent);

  /// How long to sleep now so that the share since the beginning of the present second is kept.
  /// At most 100 ms: samples wait meanwhile.
  std::chrono::microseconds rest();

 private:
  using Clock = std::chrono::steady_clock;
  double share_;
  Clock::time_point window_start_;
  double window_cpu_s_ = 0;
};

}  // namespace kerf
