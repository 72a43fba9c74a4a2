// stock/turning/insert_sweep.h - an insert on the grid, and what it sweeps on a straight way.
#pragma once

#include <span>
#include <vector>

#include "stock/cutter/insert.h"
#include "stock/turning/convex_region.h"

namespace kerf::turning {

/// Arcs of outlines are polygons of the same area that keep within this of them (0.09 um, and a
/// unit of rounding: 0.1 um). Where a way touches an arc the polygon has the very point: so a cone
/// or a cylinder is as exact as the grid, whatever the nose.
inline constexpr double kArcBound_mm = 9e-5;
/// The same for the way itself: less, since what it makes are surfaces.
inline constexpr double kWayBound_mm = 2e-5;

/// An arc as a chain: half a step, `count` - 1 whole ones, half a step. The corners between stick
/// out so far that the area is that of the arc. None of an arc without radius or angle.
struct ArcSteps {
  int count = 0;  ///< corners between the ends, at (i + 1/2) step_rad
  double step_rad = 0;
  double outward = 1;  ///< their distance from the centre, over the radius
};
ArcSteps arc_steps(double radius_mm, double sweep_rad, double bound_mm);

/// A convex part of an outline.
class GridPart {
 public:
  explicit GridPart(const InsertPart& part);

  /// The part without a border of this width; empty where that is all of it. Sides stay known.
  GridPart inset(double width_mm) const;
  bool empty() const { return corners_.size() < 3; }
  const std::vector<Point>& corners() const { return corners_; }
  /// Of the edge that ends at each corner.
  const std::vector<InsertSide>& sides() const { return sides_; }

  /// Some of the part's edges as they lie across the way, in units, rising: where the tool goes
  /// first.
  struct Lead {
    std::vector<double> across;     ///< of corners; one more than edges
    std::vector<double> along;      ///< of the same, at the way's beginning
    std::vector<InsertSide> sides;  ///< of the edges between them
  };

  /// Kept between sweeps for its memory.
  struct Scratch {
    std::vector<Point> touched, swept;
  };

  /// What it sweeps while the controlled point goes straight from one place to the other. `lead` is
  /// empty if it stays where it is.
  void sweep(const Point& from, const Point& to, Scratch& scratch, ConvexRegion& swept,
             Lead& lead) const;

  double reach_mm() const { return reach_mm_; }  ///< no corner is farther from the controlled point

 private:
  struct Arc {
    Vec2 center;  // units
    double radius = 0, start_rad = 0, sweep_rad = 0;
    ArcSteps steps;
    std::size_t first = 0;  // corner
  };

  GridPart() = default;
  void add_arc(const Vec2& from_mm, const InsertEdge& edge);
  void touch(const Vec2& normal, std::vector<Point>& corners) const;

  std::vector<Point> corners_;
  std::vector<InsertSide> sides_;  // of the edge that ends at each corner
  std::vector<Arc> arcs_;
  double reach_mm_ = 0;
};

}  // namespace kerf::turning
