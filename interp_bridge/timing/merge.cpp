#include "interp_bridge/timing/merge.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace kerf {

void MergeChain::begin(const Vec3& start, double speed, double blend_tolerance_mm,
                       std::uint64_t first_piece) {
  ends_.clear();
  start_ = start;
  speed_ = speed;
  blend_tolerance_mm_ = blend_tolerance_mm;
  first_piece_ = first_piece;
}

bool MergeChain::links(const Vec3& end, double merge_tolerance_mm) const {
  if (ends_.size() >= kMost || end == start_) return false;
  const Vec3 chord = end - start_;
  const double square = glm::dot(chord, chord);
  const double most = merge_tolerance_mm * merge_tolerance_mm;
  for (const Vec3& point : ends_) {
    const Vec3 out = point - start_;
    const double part = std::clamp(glm::dot(chord, out) / square, 0.0, 1.0);
    const Vec3 off = out - part * chord;
    if (glm::dot(off, off) > most) return false;
  }
  return true;
}

}  // namespace kerf
