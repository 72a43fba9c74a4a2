#include "twin/live/sample_queue.h"

namespace kerf {

bool SampleQueue::push_or_drop(const ArrivedSample& sample) {
  const std::lock_guard lock(mutex_);
  if (waiting_.size() >= kCapacity) {
    ++dropped_;
    return false;
  }
  waiting_.push_back(sample);
  if (waiting_.size() == 1) not_empty_.notify_one();
  return true;
}

bool SampleQueue::push_waiting(const ArrivedSample& sample) {
  std::unique_lock lock(mutex_);
  not_full_.wait(lock, [this] { return closed_ || waiting_.size() < kLogCapacity; });
  if (closed_) return false;
  waiting_.push_back(sample);
  if (waiting_.size() == 1) not_empty_.notify_one();
  return true;
}

bool SampleQueue::pop_all(std::vector<ArrivedSample>& out, std::chrono::milliseconds patience) {
  out.clear();
  std::unique_lock lock(mutex_);
  not_empty_.wait_for(lock, patience, [this] { return closed_ || !waiting_.empty(); });
  const bool was_full = waiting_.size() >= kLogCapacity;
  out.swap(waiting_);
  if (was_full) not_full_.notify_one();
  return !(closed_ && out.empty());
}

void SampleQueue::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  not_full_.notify_all();
  not_empty_.notify_all();
}

std::uint64_t SampleQueue::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

}  // namespace kerf
