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
  turn_ = top_ = 0;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    box_.extend(corners_[i]);
    if (comes_first(corners_[turn_], corners_[i])) turn_ = i;
    if (corners_[i].Y > corners_[top_].Y) top_ = i;
  }
}

ConvexRegion::EdgeRange ConvexRegion::lower_edges(Unit low_z, Unit high_z) const {
  const auto begin = corners_.begin(), end = begin + static_cast<std::ptrdiff_t>(turn_) + 1;
  // The first edge that ends at low_z or beyond; the last that begins at high_z or before.
  auto first = std::lower_bound(begin, end, low_z, [](const Point& p, Unit z) { return p.X < z; });
  const auto last =
      std::upper_bound(begin, end, high_z, [](Unit z, const Point& p) { return z < p.X; });
  if (first != begin) --first;
  const auto from = static_cast<std::size_t>(first - begin);
  return {from, std::max(from, std::min(static_cast<std::size_t>(last - begin), turn_))};
}

ConvexRegion::EdgeRange ConvexRegion::upper_edges(Unit low_z, Unit high_z) const {
  const auto begin = corners_.begin() + static_cast<std::ptrdiff_t>(turn_), end = corners_.end();
  auto first = std::lower_bound(begin, end, high_z, [](const Point& p, Unit z) { return p.X > z; });
  const auto last =
      std::upper_bound(begin, end, low_z, [](Unit z, const Point& p) { return p.X < z; });
  if (first != begin) --first;
  return {static_cast<std::size_t>(first - corners_.begin()),
          static_cast<std::size_t>(last - corners_.begin())};
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
