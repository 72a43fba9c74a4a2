#include "interp_bridge/timing/merge.h"

#include <cstring>
#include <glm/geometric.hpp>

namespace kerf {
namespace {

/// Points that are looked at together.
using Two = double __attribute__((vector_size(16)));
constexpr std::size_t kAtOnce = 2;

Two two_at(const double* values) {
  Two two;
  std::memcpy(&two, values, sizeof two);
  return two;
}

}  // namespace

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
  for (std::size_t i = 0; i < ends_.size(); i += kAtOnce) {
    const Two x = two_at(&out_x_[i]), y = two_at(&out_y_[i]), z = two_at(&out_z_[i]);
    Two part = (chord.x * x + chord.y * y + chord.z * z) / square;
    part = part < 0 ? Two{} : part;
    part = part > 1 ? Two{1, 1} : part;
    const Two off_x = x - part * chord.x, off_y = y - part * chord.y, off_z = z - part * chord.z;
    const Two off = off_x * off_x + off_y * off_y + off_z * off_z;
    if (off[0] > most || off[1] > most) return false;
  }
  return true;
}

void MergeChain::append(const Vec3& end) {
  const std::size_t i = ends_.size();
  ends_.push_back(end);
  const Vec3 out = end - start_;
  // Twice, in case that nothing comes behind it.
  out_x_[i] = out_x_[i + 1] = out.x;
  out_y_[i] = out_y_[i + 1] = out.y;
  out_z_[i] = out_z_[i + 1] = out.z;
}

}  // namespace kerf
