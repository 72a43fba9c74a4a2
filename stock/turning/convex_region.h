// stock/turning/convex_region.h - what a convex tool sweeps on a straight way: a convex polygon.
#pragma once

#include <cstddef>
#include <vector>

#include "stock/turning/grid.h"

namespace kerf::turning {

/// Strictly convex, counter-clockwise. Where one of its corners or edges lies on a line or a point
/// of something else, it counts as larger by a length below all others, about a point in its
/// inside: so nothing ever lies on anything, and material that only touches it, or is as thin as a
/// line, is in it.
///
/// Source of the idea: H. Edelsbrunner, E. Mücke, "Simulation of simplicity", 1990.
class ConvexRegion {
 public:
  /// Of corners that go round counter-clockwise; where rounding has made them hollow they are
  /// bridged. Of any others it is the convex hull. empty() where less than a triangle is left.
  void assign(std::vector<Point>& corners);

  bool empty() const { return corners_.size() < 3; }
  const std::vector<Point>& corners() const { return corners_; }
  const Rect& box() const { return box_; }
  const Point& corner(std::size_t i) const { return corners_[i]; }
  const Point& after(std::size_t i) const { return corners_[i + 1 == corners_.size() ? 0 : i + 1]; }

  /// The corners from 0 to this one are the lower side, by rising z, those from it on and corner 0
  /// the upper side, by falling z.
  std::size_t rightmost() const { return rightmost_; }
  /// Of the lower side the first edge (by the corner where it begins) that ends at `low_z` or
  /// beyond, of the upper side the first that ends at `high_z` or before; the last edge where there
  /// is none. Looked for from `hint` on, an answer to another question: O(edges between them).
  std::size_t first_lower(Unit low_z, std::size_t hint) const;
  std::size_t first_upper(Unit high_z, std::size_t hint) const;

  /// Whether p lies inward of the edge's line.
  bool is_inward(std::size_t edge, const Point& p) const {
    return turn(corners_[edge], after(edge), p) >= 0;
  }
  bool holds(const Point& p) const;
  /// Whether corner `i`, whose turn(a, b, corner) is known, lies to the left of the line from a to
  /// b.
  bool is_left(const Point& a, const Point& b, std::int64_t turned) const {
    return turned != 0 ? turned > 0 : is_right_of_inside(a, b);
  }
  /// The corner that is highest.
  std::size_t top() const { return top_; }

 private:
  /// Whether the inner point lies to the right of the line, on which a corner lies: then the larger
  /// region's corner lies to the left.
  bool is_right_of_inside(const Point& a, const Point& b) const;
  void bridge(const std::vector<Point>& corners);
  bool runs_once_round();
  void hull(const std::vector<Point>& there_and_back, std::size_t n);

  std::vector<Point> corners_;  // from the one of lowest z, of these the lowest
  std::size_t rightmost_ = 0;   // the one of highest z, of these the highest
  std::size_t top_ = 0;
  Rect box_;
};

}  // namespace kerf::turning
