#include "stock/turning/convex_region.h"

#include <algorithm>

namespace kerf::turning {
namespace {

bool comes_first(const Point& a, const Point& b) { return a.X != b.X ? a.X < b.X : a.Y < b.Y; }

}  // namespace

void ConvexRegion::assign(std::vector<Point>& corners) {
  corners_.clear();
  box_ = {};
  if (corners.size() < 3) return;
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end(), comes_first),
              corners.end());
  for (const Point& p : corners) {
    while (corners_.size() >= 2 && turn(corners_[corners_.size() - 2], corners_.back(), p) <= 0)
      corners_.pop_back();
    if (corners_.empty() || !(corners_.back() == p)) corners_.push_back(p);
  }
  while (corners_.size() >= 3 &&
         turn(corners_[corners_.size() - 2], corners_.back(), corners_.front()) <= 0)
    corners_.pop_back();
  if (empty()) return;
  rightmost_ = top_ = 0;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    box_.extend(corners_[i]);
    if (comes_first(corners_[rightmost_], corners_[i])) rightmost_ = i;
    if (corners_[i].Y > corners_[top_].Y) top_ = i;
  }
}

std::size_t ConvexRegion::first_lower(Unit low_z, std::size_t hint) const {
  std::size_t edge = std::min(hint, rightmost_ - 1);
  while (edge > 0 && corners_[edge].X >= low_z) --edge;
  while (edge + 1 < rightmost_ && corners_[edge + 1].X < low_z) ++edge;
  return edge;
}

std::size_t ConvexRegion::first_upper(Unit high_z, std::size_t hint) const {
  std::size_t edge = std::clamp(hint, rightmost_, corners_.size() - 1);
  while (edge > rightmost_ && corners_[edge].X <= high_z) --edge;
  while (edge + 1 < corners_.size() && corners_[edge + 1].X > high_z) ++edge;
  return edge;
}

bool ConvexRegion::holds(const Point& p) const {
  if (!box_.holds(p)) return false;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    if (!is_inward(i, p)) return false;
  }
  return true;
}

bool ConvexRegion::is_right_of_inside(const Point& a, const Point& b) const {
  const std::size_t n = corners_.size();
  const std::int64_t inside =
      turn(a, b, corners_[0]) + turn(a, b, corners_[n / 3]) + turn(a, b, corners_[2 * n / 3]);
  if (inside != 0) return inside < 0;
  // The inner point is itself off every line: a little further along z, and less so along r.
  return a.Y != b.Y ? b.Y > a.Y : b.X < a.X;
}

}  // namespace kerf::turning
