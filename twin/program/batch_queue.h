// twin/program/batch_queue.h - motions from the interpreter's thread to the cutter's, in batches,
// bounded.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <span>
#include <vector>

#include "interp_bridge/motion.h"

namespace kerf {

/// One producer, one consumer. At most kMaxBatches of kBatchMotions each wait (2 MB of a CAM
/// program, 19 MB at most): a producer that is ahead waits until half of them are taken, since
/// waking it costs as much as some hundred motions; nothing is lost. Buffers are used again, so
/// that in steady state nothing is allocated.
///
/// Most motions differ from the one before in their way and their line alone. Of those nothing else
/// goes from one core to the other, and nothing else is written again where the consumer reads
/// them: 64 bytes instead of 520.
class BatchQueue {
 public:
  /// So few that they stay within a core's own cache while they are looked at and cut.
  static constexpr std::size_t kBatchMotions = 512;
  static constexpr std::size_t kMaxBatches = 64;

  /// Copies the motions in. False once the queue is closed: the producer should stop.
  bool push(std::span<const Motion> motions);
  /// An empty batch behind those that wait: the producer has something to ask. False as push().
  bool push_mark();
  /// The oldest batch, bit for bit as it was pushed, until the next call. Waits for one; false when
  /// the queue is closed and empty.
  bool pop(std::span<const Motion>& batch);
  /// The same without waiting: false if there is none just now.
  bool try_pop(std::span<const Motion>& batch);
  /// Closed, and all is handed out.
  bool drained() const;
  /// Either side: no more motions come, or no more are wanted. What waits is still handed out.
  void close();

 private:
  /// What differs between most motions; the rest is that of kind number `kind`.
  struct alignas(64) Step {
    SourceRef source;
    Vec3 from_mm{0}, to_mm{0};
    std::uint64_t kind = 0;
  };
  struct Batch {
    std::vector<Step> steps;  ///< the first `count`; more are there to be used again
    std::size_t count = 0;
    std::vector<Motion> kinds;  ///< that begin in this batch, in the order of their steps
  };
  void wait_for_room(std::unique_lock<std::mutex>& lock);
  void pack(std::span<const Motion> motions, Batch& batch);
  void put(Batch batch);
  Batch take_oldest(std::unique_lock<std::mutex>& lock);
  std::span<const Motion> unpack(const Batch& batch);
  void give_back(Batch batch);

  mutable std::mutex mutex_;
  std::condition_variable not_full_;
  std::condition_variable not_empty_;
  std::deque<Batch> full_;
  std::vector<Batch> spare_;
  bool producer_waits_ = false, consumer_waits_ = false;
  bool closed_ = false;

  // Of the producer.
  Motion pushed_;  ///< the last one
  std::uint64_t pushed_kind_ = 0;

  // Of the consumer.
  Motion popped_;  ///< one of the kind that was unpacked last
  std::uint64_t popped_kind_ = 0;
  std::vector<Motion> motions_;
  std::vector<std::uint64_t> kinds_of_motions_;
};

}  // namespace kerf
