#include "twin/program/batch_queue.h"

#include <algorithm>
#include <cstring>
#include <type_traits>
#include <utility>

#include "base/block_copy.h"

namespace kerf {
namespace {

static_assert(std::is_trivially_copyable_v<Motion>);
constexpr std::size_t kWayBegins = offsetof(Motion, source);
constexpr std::size_t kWayEnds = offsetof(Motion, from_abc_deg);
static_assert(offsetof(Motion, from_mm) >= kWayBegins + sizeof(SourceRef) &&
                  offsetof(Motion, from_mm) < kWayBegins + 2 * sizeof(SourceRef) &&
                  offsetof(Motion, to_mm) == offsetof(Motion, from_mm) + sizeof(Vec3) &&
                  offsetof(Motion, to_mm) + sizeof(Vec3) == kWayEnds,
              "source, from_mm and to_mm stand side by side");

/// They are equal but for their way and their line. What fills the gaps between members counts, and
/// may make different what is equal.
bool is_same_kind(const Motion& a, const Motion& b) {
  const auto* const bytes_a = reinterpret_cast<const std::byte*>(&a);
  const auto* const bytes_b = reinterpret_cast<const std::byte*>(&b);
  return std::memcmp(bytes_a, bytes_b, kWayBegins) == 0 &&
         std::memcmp(bytes_a + kWayEnds, bytes_b + kWayEnds, sizeof(Motion) - kWayEnds) == 0;
}

}  // namespace

void BatchQueue::wait_for_room(std::unique_lock<std::mutex>& lock) {
  producer_waits_ = true;
  not_full_.wait(lock, [&] { return closed_ || full_.size() < kMaxBatches; });
  producer_waits_ = false;
}

void BatchQueue::put(Batch batch) {
  bool wakes = false;
  {
    const std::lock_guard lock(mutex_);
    full_.push_back(std::move(batch));
    wakes = consumer_waits_;
  }
  if (wakes) not_empty_.notify_one();
}

void BatchQueue::pack(std::span<const Motion> motions, Batch& batch) {
  batch.count = motions.size();
  if (batch.steps.size() < batch.count) batch.steps.resize(batch.count);
  Step* step = batch.steps.data();
  for (const Motion& motion : motions) {
    if (pushed_kind_ == 0 || !is_same_kind(motion, pushed_)) {
      copy_block(pushed_, motion);
      ++pushed_kind_;
      batch.kinds.push_back(motion);
    }
    step->source = motion.source;
    step->from_mm = motion.from_mm;
    step->to_mm = motion.to_mm;
    step->kind = pushed_kind_;
    ++step;
  }
}

std::span<const Motion> BatchQueue::unpack(const Batch& batch) {
  const std::size_t count = batch.count;
  // They come from another core: asked for all at once, they arrive in less time.
  for (std::size_t i = 0; i < count; ++i) __builtin_prefetch(&batch.steps[i]);
  if (motions_.size() < count) {
    motions_.resize(count);
    kinds_of_motions_.resize(count);
  }
  std::size_t kinds = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Step& step = batch.steps[i];
    if (step.kind != popped_kind_) {
      copy_block(popped_, batch.kinds[kinds++]);
      popped_kind_ = step.kind;
    }
    Motion& motion = motions_[i];
    if (kinds_of_motions_[i] != step.kind) {
      copy_block(motion, popped_);
      kinds_of_motions_[i] = step.kind;
    }
    motion.source = step.source;
    motion.from_mm = step.from_mm;
    motion.to_mm = step.to_mm;
  }
  return std::span<const Motion>(motions_).first(count);
}

void BatchQueue::give_back(Batch batch) {
  batch.count = 0;
  batch.kinds.clear();
  const std::lock_guard lock(mutex_);
  spare_.push_back(std::move(batch));
}

bool BatchQueue::push(std::span<const Motion> motions) {
  while (!motions.empty()) {
    const std::size_t count = std::min(motions.size(), kBatchMotions);
    Batch batch;
    {
      std::unique_lock lock(mutex_);
      wait_for_room(lock);
      if (closed_) return false;
      if (!spare_.empty()) {
        batch = std::move(spare_.back());
        spare_.pop_back();
      }
    }
    pack(motions.first(count), batch);
    put(std::move(batch));
    motions = motions.subspan(count);
  }
  return true;
}

bool BatchQueue::push_mark() {
  {
    std::unique_lock lock(mutex_);
    wait_for_room(lock);
    if (closed_) return false;
  }
  put({});
  return true;
}

bool BatchQueue::pop(std::span<const Motion>& batch) {
  std::unique_lock lock(mutex_);
  consumer_waits_ = true;
  not_empty_.wait(lock, [&] { return closed_ || !full_.empty(); });
  consumer_waits_ = false;
  if (full_.empty()) return false;
  Batch oldest = take_oldest(lock);
  batch = unpack(oldest);
  give_back(std::move(oldest));
  return true;
}

bool BatchQueue::try_pop(std::span<const Motion>& batch) {
  std::unique_lock lock(mutex_);
  if (full_.empty()) return false;
  Batch oldest = take_oldest(lock);
  batch = unpack(oldest);
  give_back(std::move(oldest));
  return true;
}

bool BatchQueue::drained() const {
  const std::lock_guard lock(mutex_);
  return closed_ && full_.empty();
}

/// Unlocks.
BatchQueue::Batch BatchQueue::take_oldest(std::unique_lock<std::mutex>& lock) {
  Batch oldest = std::move(full_.front());
  full_.pop_front();
  const bool wakes = producer_waits_ && full_.size() <= kMaxBatches / 2;
  lock.unlock();
  if (wakes) not_full_.notify_one();
  return oldest;
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
