// interp_bridge/timing/merge.h - the chain of short feeds that LinuxCNC runs as one line
// ("naive CAM detector").
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/geometry.h"

namespace kerf {

/// Feeds whose ends all lie within the tolerance of the straight line from the first start to the
/// last end. At most kMost of them.
class MergeChain {
 public:
  static constexpr std::size_t kMost = 101;

  MergeChain() { ends_.reserve(kMost); }

  bool empty() const { return ends_.empty(); }
  const Vec3& start() const { return start_; }
  const Vec3& last() const { return ends_.back(); }
  double speed() const { return speed_; }
  double tolerance_mm() const { return blend_tolerance_mm_; }
  std::uint64_t first_piece() const { return first_piece_; }
  std::uint32_t piece_count() const { return static_cast<std::uint32_t>(ends_.size()); }

  void begin(const Vec3& start, double speed, double blend_tolerance_mm, std::uint64_t first_piece);
  void append(const Vec3& end);
  /// May a feed to `end` join? O(length of the chain).
  bool links(const Vec3& end, double merge_tolerance_mm) const;
  void clear() { ends_.clear(); }

 private:
  std::vector<Vec3> ends_;
  /// The same from start_ on, with one more behind the last.
  std::array<double, kMost + 1> out_x_{}, out_y_{}, out_z_{};
  Vec3 start_{0};
  double speed_ = 0;
  double blend_tolerance_mm_ = 0;
  std::uint64_t first_piece_ = 0;
};

}  // namespace kerf
