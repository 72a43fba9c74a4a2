// twin/live/sample_queue.h - samples from a source's thread to the one that cuts, bounded.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "machine_io/position_source.h"

namespace kerf {

/// A sample with the time of its arrival on this computer's own clock, which nobody sets.
struct ArrivedSample {
  AxisSample sample;
  std::chrono::steady_clock::time_point arrival;
  std::uint64_t lost = 0;         ///< samples known to be lost before this one, in all
  std::int64_t clock_set_ns = 0;  ///< by which this computer's clock was set before it
};

/// One producer, one consumer. Nothing is allocated after the first rounds.
class SampleQueue {
 public:
  /// What is held while nobody takes it: 16 s of a machine's samples at 1 kHz (2 MB). A log waits,
  /// so of it there need be no more than one side takes in one go; a few stay in the cache.
  static constexpr std::size_t kCapacity = 16384, kLogCapacity = 1024;

  /// A machine does not wait: false, and counted, if the queue is full.
  bool push_or_drop(const ArrivedSample& sample);
  /// A log does. False once the queue is closed.
  bool push_waiting(const ArrivedSample& sample);
  /// Swaps all that is there into `out`, after waiting for the first sample for at most `patience`.
  /// False when the queue is closed and empty.
  bool pop_all(std::vector<ArrivedSample>& out, std::chrono::milliseconds patience);
  void close();
  std::uint64_t dropped() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable not_full_;
  std::condition_variable not_empty_;
  std::vector<ArrivedSample> waiting_;
  std::uint64_t dropped_ = 0;
  bool closed_ = false;
};

}  // namespace kerf
