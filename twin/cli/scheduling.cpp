#include "twin/cli/scheduling.h"

#include <fmt/format.h>
#include <sched.h>
#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>

#include "base/translate.h"

namespace kerf {
namespace {

constexpr int kLowestNice = 19;
constexpr double kWindow_s = 1.0;
constexpr double kLongestRest_s = 0.1;

std::string isolated_cpus() {
  std::ifstream file("/sys/devices/system/cpu/isolated");
  std::string list;
  std::getline(file, list);
  return list;
}

double process_cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

/// Nothing if there is no other CPU to go to.
std::string leave_cpus(const std::vector<int>& isolated) {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return {};
  cpu_set_t others = allowed;
  for (const int cpu : isolated) {
    if (cpu < CPU_SETSIZE) CPU_CLR(static_cast<std::size_t>(cpu), &others);
  }
  if (CPU_COUNT(&others) == 0) return tr("all CPUs are isolated; kerf runs on one of them");
  if (CPU_EQUAL(&others, &allowed)) return {};
  if (sched_setaffinity(0, sizeof others, &others) == 0) return {};
  return trf("cannot leave the isolated CPUs: {}", std::strerror(errno));
}

}  // namespace

std::vector<int> cpus_in(const std::string& list) {
  std::vector<int> cpus;
  const char* at = list.data();
  const char* const end = at + list.size();
  while (at < end) {
    int first = 0;
    const auto from = std::from_chars(at, end, first);
    if (from.ec != std::errc{}) {
      ++at;
      continue;
    }
    int last = first;
    at = from.ptr;
    if (at < end && *at == '-') {
      const auto to = std::from_chars(at + 1, end, last);
      if (to.ec == std::errc{}) at = to.ptr;
    }
    for (int cpu = std::max(first, 0); cpu <= std::min(last, CPU_SETSIZE - 1); ++cpu) {
      cpus.push_back(cpu);
    }
  }
  return cpus;
}

std::vector<std::string> make_room(const std::string& isolated) {
  std::vector<std::string> refused;
  if (setpriority(PRIO_PROCESS, 0, kLowestNice) != 0) {
    refused.push_back(trf("cannot lower the priority: {}", std::strerror(errno)));
  }
  const sched_param parameters{};
  if (sched_setscheduler(0, SCHED_BATCH, &parameters) != 0) {
    refused.push_back(trf("cannot become a batch process: {}", std::strerror(errno)));
  }
  const std::string stays = leave_cpus(cpus_in(isolated.empty() ? isolated_cpus() : isolated));
  if (!stays.empty()) refused.push_back(stays);
  return refused;
}

bool limit_memory(double megabytes) {
  constexpr double kMegabyte = 1024.0 * 1024.0;
  const rlim_t bytes = static_cast<rlim_t>(megabytes * kMegabyte);
  const rlimit limit{bytes, bytes};
  return setrlimit(RLIMIT_DATA, &limit) == 0;
}

CpuBudget::CpuBudget(double percent)
    : share_(percent / 100), window_start_(Clock::now()), window_cpu_s_(process_cpu_s()) {}

std::chrono::microseconds CpuBudget::rest() {
  if (share_ <= 0) return {};
  const auto now = Clock::now();
  const double cpu_s = process_cpu_s();
  const double elapsed_s = std::chrono::duration<double>(now - window_start_).count();
  const double owed_s = (cpu_s - window_cpu_s_) / share_ - elapsed_s;
  if (elapsed_s > kWindow_s && owed_s <= 0) {
    window_start_ = now;
    window_cpu_s_ = cpu_s;
  }
  const double rest_s = std::clamp(owed_s, 0.0, kLongestRest_s);
  return std::chrono::microseconds(static_cast<std::int64_t>(rest_s * 1e6));
}

}  // namespace kerf
