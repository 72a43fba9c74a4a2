// interp_bridge/timing/ring.h - a queue in one block of memory, addressed by running number.
#pragma once

#include <cassert>
#include <cstdint>
#include <vector>

namespace kerf {

/// First in, first out; items are addressed by the number of items put in before them, which stays
/// theirs. Grows by doubling when full, never shrinks: steady use allocates nothing.
template <typename T>
class Ring {
 public:
  explicit Ring(std::size_t capacity_power_of_2) : items_(capacity_power_of_2) {}

  std::uint64_t begin() const { return begin_; }
  std::uint64_t end() const { return end_; }
  bool empty() const { return begin_ == end_; }
  std::uint64_t size() const { return end_ - begin_; }

  T& operator[](std::uint64_t number) {
    assert(number >= begin_ && number < end_);
    return items_[number & (items_.size() - 1)];
  }
  T& front() { return (*this)[begin_]; }
  T& back() { return (*this)[end_ - 1]; }
  /// A place at the end, not initialised: it may hold an old item.
  T& push() {
    if (size() == items_.size()) grow();
    ++end_;
    return back();
  }
  void clear() { begin_ = end_; }
  void pop_front() {
    assert(!empty());
    ++begin_;
  }
  void pop_back() {
    assert(!empty());
    --end_;
  }

 private:
  void grow() {
    std::vector<T> larger(items_.size() * 2);
    for (std::uint64_t i = begin_; i != end_; ++i) {
      larger[i & (larger.size() - 1)] = items_[i & (items_.size() - 1)];
    }
    items_.swap(larger);
  }

  std::vector<T> items_;
  std::uint64_t begin_ = 0;
  std::uint64_t end_ = 0;
};

}  // namespace kerf
