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
  bridge(corners);
  if (!runs_once_round()) {
    // More than a hollow or two: whatever the order, the hull is what holds them all.
    std::sort(corners.begin(), corners.end(), comes_first);
    const std::size_t n = corners.size();
    for (std::size_t i = n - 1; i-- > 0;) corners.push_back(corners[i]);
    hull(corners, n);
  }
  if (empty()) return;
  top_ = 0;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    box_.extend(corners_[i]);
    if (corners_[i].Y > corners_[top_].Y) top_ = i;
  }
}

/// Leaves out corners at which the way round does not turn left.
void ConvexRegion::bridge(const std::vector<Point>& corners) {
  for (const Point& p : corners) {
    while (corners_.size() >= 2 && turn(corners_[corners_.size() - 2], corners_.back(), p) <= 0)
      corners_.pop_back();
    if (corners_.empty() || !(corners_.back() == p)) corners_.push_back(p);
  }
  while (corners_.size() >= 3 &&
         turn(corners_[corners_.size() - 2], corners_.back(), corners_.front()) <= 0)
    corners_.pop_back();
}

/// Whether the corners, at each but the first and last of which the way turns left, are those of a
/// convex polygon: z rises, then falls. Finds the rightmost.
bool ConvexRegion::runs_once_round() {
  if (empty()) return true;
  const std::size_t n = corners_.size();
  rightmost_ = 0;
  while (rightmost_ + 1 < n && comes_first(corners_[rightmost_], corners_[rightmost_ + 1]))
    ++rightmost_;
  for (std::size_t i = rightmost_; i + 1 < n; ++i) {
    if (!comes_first(corners_[i + 1], corners_[i])) return false;
  }
  return turn(corners_[n - 1], corners_[0], corners_[1]) > 0;
}

/// Of corners by rising z up to `n`, then by falling z. Source: A. Andrew, "Another efficient
/// algorithm for convex hulls in two dimensions", 1979.
void ConvexRegion::hull(const std::vector<Point>& there_and_back, std::size_t n) {
  corners_.clear();
  std::size_t least = 0;  // corners that stay
  for (std::size_t i = 0; i < there_and_back.size(); ++i) {
    const Point& p = there_and_back[i];
    while (corners_.size() >= least + 2 &&
           turn(corners_[corners_.size() - 2], corners_.back(), p) <= 0)
      corners_.pop_back();
    if (corners_.empty() || !(corners_.back() == p)) corners_.push_back(p);
    if (i + 1 == n) {
      rightmost_ = corners_.size() - 1;
      least = rightmost_;
    }
  }
  if (corners_.size() > 1 && corners_.back() == corners_.front()) corners_.pop_back();
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
