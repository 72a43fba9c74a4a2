// base/wait_for_stop.h - to sleep, and wake when a stop is asked for.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>

namespace kerf {

/// Until `stop` is requested (true) or `time` has passed (false).
inline bool wait_for_stop(const std::stop_token& stop, std::chrono::milliseconds time) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  never.wait_for(lock, stop, time, [] { return false; });
  return stop.stop_requested();
}

}  // namespace kerf
