// twin/program/batch_queue.h - motions from the interpreter's thread to the cutter's, in batches,
// bounded.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <span>
#include <vector>

#include "interp_bridge/motion.h"

namespace kerf {

/// One producer, one consumer. At most kMaxBatches of kBatchMotions each wait (about 18 MB): a
/// producer that is ahead waits, nothing is lost. Buffers are used again, so that in steady state
/// nothing is allocated.
class BatchQueue {
 public:
  /// So few that they stay within a core's own cache while they are looked at and cut.
  static constexpr std::size_t kBatchMotions = 512;
  static constexpr std::size_t kMaxBatches = 64;

  /// Copies the motions in. False once the queue is closed: the producer should stop.
  bool push(std::span<const Motion> motions);
  /// An empty batch behind those that wait: the producer has something to ask. False as push().
  bool push_mark();
  /// Swaps the oldest batch into `batch`. Waits for one; false when the queue is closed and empty.
  bool pop(std::vector<Motion>& batch);
  /// The same without waiting: false if there is none just now.
  bool try_pop(std::vector<Motion>& batch);
  /// Closed, and all is handed out.
  bool drained() const;
  /// Either side: no more motions come, or no more are wanted. What waits is still handed out.
  void close();

 private:
  void take_oldest(std::vector<Motion>& batch);

  mutable std::mutex mutex_;
  std::condition_variable not_full_;
  std::condition_variable not_empty_;
  std::deque<std::vector<Motion>> full_;
  std::vector<std::vector<Motion>> spare_;
  bool closed_ = false;
};

}  // namespace kerf
