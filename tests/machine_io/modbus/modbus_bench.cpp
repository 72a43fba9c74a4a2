// What polling costs: N seconds of 500 polls/s of 9 axes over TCP on loopback. The polling thread's
// CPU time and the age of the newest sample are printed; the server's thread is not counted.
//
//     modbus_bench [seconds] [polls/s]
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <thread>
#include <vector>

#include "machine_io/modbus/modbus_source.h"
#include "machine_io/modbus/poll_schedule.h"
#include "tests/machine_io/modbus/faulty_device.h"

namespace {

using kerf::SteadyClock;

double thread_cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

std::int64_t real_ns() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

/// Sorted ages, ms, of what `newest_ns` holds, looked at every millisecond until `end`.
std::vector<double> watch_age(const std::atomic<std::int64_t>& newest_ns,
                              SteadyClock::time_point end) {
  std::vector<double> ages;
  auto next = SteadyClock::now();
  while ((next += std::chrono::microseconds(997)) < end) {
    kerf::sleep_until(next);
    const std::int64_t newest = newest_ns;
    if (newest != 0) ages.push_back(static_cast<double>(real_ns() - newest) * 1e-6);
  }
  std::sort(ages.begin(), ages.end());
  return ages;
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 10;
  const auto device = kerf::FaultyDevice::tcp();
  kerf::ModbusSettings settings;
  settings.host = "127.0.0.1";
  settings.port = device->port();
  settings.poll_hz = argc > 2 ? std::atof(argv[2]) : 500;
  for (std::size_t i = 0; i < kerf::kMaxPositions; ++i) {
    settings.axes[i] = kerf::ModbusRegister{static_cast<int>(20 + 2 * i)};
  }
  if (!kerf::validate(settings).empty()) return EXIT_FAILURE;

  std::atomic<std::int64_t> newest_ns = 0;
  std::uint64_t samples = 0;
  std::uint64_t errors = 0;
  double cpu_s = 0;
  const auto begin = SteadyClock::now();
  const auto end = begin + std::chrono::duration_cast<SteadyClock::duration>(
                               std::chrono::duration<double>(seconds));
  std::thread poller([&] {
    kerf::ModbusSource source(settings);
    kerf::AxisSample sample;
    const double cpu_begin_s = thread_cpu_s();
    while (SteadyClock::now() < end) {
      if (source.next(sample, std::chrono::milliseconds(100)) ==
          kerf::PositionSource::Next::kSample) {
        newest_ns = sample.host_ns;
      }
    }
    cpu_s = thread_cpu_s() - cpu_begin_s;
    samples = source.status().samples;
    errors = source.status().errors;
  });
  const std::vector<double> ages = watch_age(newest_ns, end);
  poller.join();
  const double took_s = std::chrono::duration<double>(SteadyClock::now() - begin).count();
  fmt::print("samples {} in {:.2f} s ({:.1f}/s), errors {}, poller CPU {:.2f} % of one core\n",
             samples, took_s, static_cast<double>(samples) / took_s, errors, 100 * cpu_s / took_s);
  if (ages.empty()) return EXIT_FAILURE;
  const auto at = [&](double share) {
    return ages[static_cast<std::size_t>(share * static_cast<double>(ages.size() - 1))];
  };
  fmt::print("age of the newest sample, ms: median {:.2f}, p99 {:.2f}, max {:.2f}\n", at(0.5),
             at(0.99), ages.back());
  return EXIT_SUCCESS;
}
