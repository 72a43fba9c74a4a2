// twin/program/motion_archive.h - many motions in little memory, in their order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interp_bridge/motion.h"

namespace kerf {

/// A motion is kept as what differs from the one before, a word of 8 bytes at a time, and comes out
/// bit for bit as it went in. One of a CAM program takes about 50 bytes of the kilobyte that it has
/// else; both ways cost about 0.1 us. Values.
class MotionArchive {
 public:
  void append(std::span<const Motion> motions);
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return words_.capacity() * sizeof(std::uint64_t); }

  /// Reads from the first motion on, forward only. The archive outlives it, and does not grow
  /// meanwhile.
  class Reader {
   public:
    explicit Reader(const MotionArchive& archive) : archive_(archive) {}
    /// The next `count` motions, appended; there must be so many.
    void take(std::size_t count, std::vector<Motion>& out);

   private:
    const MotionArchive& archive_;
    std::size_t at_ = 0;
    Motion last_ = before_first();
  };

 private:
  /// The same bits for all: what lies between its members, too, counts as it happens to be.
  static const Motion& before_first();
  std::vector<std::uint64_t> words_;
  Motion last_ = before_first();
  std::size_t size_ = 0;
};

}  // namespace kerf
