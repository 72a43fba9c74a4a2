// base/growing_list.h - a list that grows by pieces, and moves nothing when it does.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace kerf {

/// Elements in pieces of 2^kShift. A vector of millions copies all of them each time it grows, and
/// holds up to twice of what it needs; this one a piece more at most, and a shift more to find one.
/// Begun pieces hold elements as T{} makes them.
template <class T, unsigned kShift = 13>
class GrowingList {
 public:
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const T& operator[](std::size_t k) const { return pieces_[k >> kShift][k & kMask]; }
  T& operator[](std::size_t k) { return pieces_[k >> kShift][k & kMask]; }
  void push_back(const T& element) {
    if (size_ == pieces_.size() << kShift) pieces_.push_back(std::make_unique<T[]>(kMask + 1));
    (*this)[size_++] = element;
  }
  void clear() {
    pieces_.clear();
    size_ = 0;
  }

 private:
  static constexpr std::size_t kMask = (std::size_t{1} << kShift) - 1;
  std::vector<std::unique_ptr<T[]>> pieces_;
  std::size_t size_ = 0;
};

}  // namespace kerf
