#include "twin/program/batch_queue.h"

#include <algorithm>
#include <utility>

namespace kerf {

bool BatchQueue::push(std::span<const Motion> motions) {
  while (!motions.empty()) {
    const std::size_t count = std::min(motions.size(), kBatchMotions);
    std::vector<Motion> batch;
    {
      std::unique_lock lock(mutex_);
      not_full_.wait(lock, [&] { return closed_ || full_.size() < kMaxBatches; });
      if (closed_) return false;
      if (!spare_.empty()) {
        batch = std::move(spare_.back());
        spare_.pop_back();
      }
    }
    batch.assign(motions.begin(), motions.begin() + static_cast<std::ptrdiff_t>(count));
    {
      const std::lock_guard lock(mutex_);
      full_.push_back(std::move(batch));
    }
    not_empty_.notify_one();
    motions = motions.subspan(count);
  }
  return true;
}

bool BatchQueue::push_mark() {
  {
    std::unique_lock lock(mutex_);
    not_full_.wait(lock, [&] { return closed_ || full_.size() < kMaxBatches; });
    if (closed_) return false;
    full_.emplace_back();
  }
  not_empty_.notify_one();
  return true;
}

bool BatchQueue::pop(std::vector<Motion>& batch) {
  std::unique_lock lock(mutex_);
  not_empty_.wait(lock, [&] { return closed_ || !full_.empty(); });
  if (full_.empty()) return false;
  take_oldest(batch);
  lock.unlock();
  not_full_.notify_one();
  return true;
}

bool BatchQueue::try_pop(std::vector<Motion>& batch) {
  std::unique_lock lock(mutex_);
  if (full_.empty()) return false;
  take_oldest(batch);
  lock.unlock();
  not_full_.notify_one();
  return true;
}

bool BatchQueue::drained() const {
  const std::lock_guard lock(mutex_);
  return closed_ && full_.empty();
}

void BatchQueue::take_oldest(std::vector<Motion>& batch) {
  if (batch.capacity() > 0) spare_.push_back(std::move(batch));
  batch = std::move(full_.front());
  full_.pop_front();
}

void BatchQueue::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  not_full_.notify_all();
  not_empty_.notify_all();
}

}  // namespace kerf
