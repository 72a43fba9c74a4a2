// stock/zmap/part_pieces.h - the way of an upright tool in pieces along which times can be told in
// closed form.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/geometry.h"
#include "base/portable_math.h"
#include "stock/stock_model.h"
#include "stock/zmap/tile_grid.h"

namespace kerf {

/// Cells of a grid.
struct PartCells {
  int i0, i1, j0, j1;  ///< the last ones included; empty: i0 > i1 or j0 > j1
};

/// Those of a rectangle.
PartCells cells_of(const TileGrid& grid, const Vec2& low, const Vec2& high);

/// When something is over a column: times within 0..1.
struct PartWindow {
  double t0, t1;
};
using PartWindows = std::vector<PartWindow>;

/// Part of a move along which times can be told in closed form: straight, or about a vertical axis
/// with one radius. Z is linear in time.
struct PartPiece {
  Vec3 from{0}, step{0};  ///< of an arc only z of `step` counts
  bool turns = false;
  Vec2 center{0};
  double arm = 0, begin_rad = 0, sweep_rad = 0;

  double z(double t) const { return from.z + t * step.z; }
  Vec3 tip(double t) const {
    if (!turns) return from + t * step;
    const double angle = begin_rad + t * sweep_rad;
    return {center.x + arm * portable::cos(angle), center.y + arm * portable::sin(angle), z(t)};
  }
  /// Around the axis on all of it.
  void bounds(Vec2& low, Vec2& high) const;
  /// When (x, y) is within `radius` of the axis, in order.
  void windows(double x, double y, double radius, PartWindows& out) const;
  /// No more than the least distance between (x, y) and the axis during `window`.
  double distance(double x, double y, const PartWindow& window) const;
};

/// Arcs that are not about a vertical axis, and spirals, as chords within the tolerance.
std::vector<PartPiece> pieces_of(const CutMove& move, double tolerance_mm);

}  // namespace kerf
