#include "twin/job/turned_blank_guess.h"

#include <algorithm>
#include <cmath>

#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

constexpr double kAlong_mm = 1e-6;

/// As fine as a person writes it. Whole millimetres would lay a skin over every inch program's bar,
/// and its sound traverses would touch it.
double shown_mm(double value) { return std::round(value * 1e3) / 1e3 + 0.0; }

}  // namespace

void TurnedBlankGuess::add(const Motion& m) {
  if (!is_feed(m) && !is_traverse(m)) return;
  moves_ = true;
  if (!is_feed(m) || stands_still(m) || !m.start_known) return;
  const Box way = bounds_of(m);
  const double widest = std::max(std::abs(way.min.x), std::abs(way.max.x));
  const bool straight = m.kind != MotionKind::kArc && way.max.z - way.min.z < kAlong_mm;
  if (!feeds_) {
    lowest_mm_ = way.min.z;
    highest_mm_ = way.max.z;
  }
  feeds_ = true;
  widest_mm_ = std::max(widest_mm_, widest);
  if (!straight) along_mm_ = std::max(along_mm_, widest);
  lowest_mm_ = std::min(lowest_mm_, way.min.z);
  highest_mm_ = std::max(highest_mm_, way.max.z);
  if (straight && std::abs(m.to_mm.x) < std::abs(m.from_mm.x)) {
    faces_mm_.extend(Vec3(std::abs(m.to_mm.x), 0, m.to_mm.z));
  }
}

Blank TurnedBlankGuess::blank() const {
  const double radius = std::max(1.0, along_mm_ > 0 ? along_mm_ : widest_mm_);
  const bool is_faced = !faces_mm_.empty() && faces_mm_.min.x < radius / 2;
  double top = highest_mm_;
  if (is_faced) {
    top = faces_mm_.max.z;
  } else if (lowest_mm_ < 0 && highest_mm_ > 0) {
    top = 0;
  }
  const double floor = std::floor(std::min(lowest_mm_ - margin_mm_, top - 1));
  BlankBody bar;
  bar.kind = BlankBody::Kind::kCylinder;
  bar.axis = 'z';
  bar.diameter_mm = shown_mm(2 * radius);
  const double r = bar.diameter_mm / 2;
  bar.bounds_mm = Box{{-r, -r, floor}, {r, r, shown_mm(top)}};
  Blank blank;
  blank.bodies.push_back(bar);
  return blank;
}

}  // namespace kerf
