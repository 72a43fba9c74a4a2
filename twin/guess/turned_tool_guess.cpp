#include "twin/guess/turned_tool_guess.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/translate.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

constexpr double kAlong_mm = 1e-6;
/// Threads are no more slanting to the axis, as a tangent.
constexpr double kMostTaper = 0.3;
/// What an 80 degree insert in its usual holder follows.
constexpr double kFall_deg = 4;
/// Straight in that far below the end it is a groove, not a face.
constexpr double kFace_mm = 3;

}  // namespace

void TurnedTrace::add(const Motion& m) {
  if (!m.start_known) return;
  if (!is_feed(m)) {
    const double away = std::abs(m.to_mm.x) - std::abs(m.from_mm.x);
    if (last_fed_ && std::abs(away) > kAlong_mm) outward_ += away > 0 ? 1 : -1;
    last_fed_ = false;
    return;
  }
  if (stands_still(m)) return;
  const Box way = bounds_of(m);
  if (!feeds_) {
    lowest_mm_ = way.min.z;
    least_mm_ = std::min(std::abs(m.from_mm.x), std::abs(m.to_mm.x));
  }
  feeds_ = last_fed_ = true;
  widest_mm_ = std::max({widest_mm_, std::abs(way.min.x), std::abs(way.max.x)});
  least_mm_ = std::min({least_mm_, std::abs(m.from_mm.x), std::abs(m.to_mm.x)});
  lowest_mm_ = std::min(lowest_mm_, way.min.z);
  side_sum_mm_ += m.from_mm.x + m.to_mm.x;
  // What slants is the way in or out of a pass, with a lead of its own.
  if (m.kind == MotionKind::kThread &&
      std::abs(m.to_mm.x - m.from_mm.x) <= kMostTaper * std::abs(m.to_mm.z - m.from_mm.z)) {
    pitch_mm_ = std::max(pitch_mm_, m.feed_mm_per_min);
  }
  const double dz = m.to_mm.z - m.from_mm.z;
  const double dx = std::abs(m.to_mm.x) - std::abs(m.from_mm.x);
  if (std::abs(dz) < kAlong_mm && m.kind != MotionKind::kArc) {
    if (dx >= 0) return;
    highest_in_mm_ = goes_in_ ? std::max(highest_in_mm_, m.to_mm.z) : m.to_mm.z;
    goes_in_ = true;
    return;
  }
  along_mm_ += path_length_mm(m);
  (dz < 0 ? chuckward_mm_ : outward_z_mm_) += std::abs(dz);
  const double ahead = m.kind == MotionKind::kArc ? std::abs(dz) : dz < 0 ? -dz : 0;
  if (dx < 0 && ahead > kAlong_mm) steepest_ = std::max(steepest_, -dx / ahead);
}

ShapeGuess TurnedTrace::guess(double top_mm) const {
  ShapeGuess out;
  const bool below_axis = side_sum_mm_ < 0;
  const bool bores = outward_ < 0;
  // External and seen from +X, or in a bore from -X: the tool lies towards +X.
  const bool up = bores == below_axis;
  if (widest_mm_ <= kAlong_mm) {
    const double depth = std::max(1.0, top_mm - lowest_mm_);
    out.shape = fmt::format("drill:{:g}:118", std::clamp(std::round(depth / 5), 3.0, 16.0));
    out.reason = tr("it is fed on the axis alone");
  } else if (pitch_mm_ > 0) {
    out.shape = fmt::format("thread:60:{:g}:orient={}", pitch_mm_, up ? 6 : 8);
    out.reason = trf("it cuts a thread of {:g} mm", pitch_mm_);
  } else if (goes_in_ && along_mm_ <= kAlong_mm && highest_in_mm_ < top_mm - kFace_mm) {
    const bool parts = least_mm_ < 0.5;
    out.shape = fmt::format("{}:3:orient={}", parts ? "part" : "groove", up ? 2 : 3);
    out.reason = parts ? tr("it goes straight in, to the axis") : tr("it goes straight in");
  } else {
    const bool slim = std::atan(steepest_) * 180 / kPi > kFall_deg;
    const bool left = outward_z_mm_ > 2 * chuckward_mm_;
    // 85 and 5 degrees: an insert C in its usual holder; with 50 for 5 one like V.
    const int orientation = up ? (left ? 1 : 2) : (left ? 4 : 3);
    const int face = left ? 95 : 85, along = left ? (slim ? 130 : 175) : (slim ? 50 : 5);
    out.shape = up ? fmt::format("turn:0.4:{}:{}:{}", orientation, face, along)
                   : fmt::format("turn:0.4:{}:{}:{}", orientation, 360 - face, 360 - along);
    out.reason =
        slim ? tr("the contour falls: an insert of 35 degrees") : tr("an insert of 80 degrees");
  }
  if (bores) out.reason += tr(", in a bore");
  return out;
}

}  // namespace kerf
