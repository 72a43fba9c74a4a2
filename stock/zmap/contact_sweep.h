// stock/zmap/contact_sweep.h - a convex tool on a straight line, as the search for contacts sees
// it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "stock/zmap/cutter_components.h"

namespace kerf {

/// A tool, drawn in by the tolerance, on a straight line: height over one column as a convex
/// function of t in 0..1.
struct ShrunkSweep {
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  const ConvexTool& tool;
  double tolerance;
  Vec3 from, step;  ///< tip(t) = from + t * step

  double reach() const { return tool.radius - tolerance; }

  double height(double x, double y, double t) const {
    const double d = std::hypot(x - from.x - t * step.x, y - from.y - t * step.y);
    if (d > reach()) return kNone;
    return from.z + t * step.z + surface_height(tool, std::min(d + tolerance, tool.radius)) +
           tolerance;
  }

  /// The part of 0..1 during which the tool is over (x, y); false if none.
  bool over(double x, double y, double& t0, double& t1) const {
    const double length2 = step.x * step.x + step.y * step.y;
    const double px = x - from.x, py = y - from.y;
    const double r2 = reach() * reach();
    t0 = 0;
    t1 = 1;
    if (length2 < 1e-18) return px * px + py * py <= r2;
    const double along = (px * step.x + py * step.y) / length2;
    const double across2 = px * px + py * py - along * along * length2;
    if (across2 > r2) return false;
    const double half = std::sqrt((r2 - across2) / length2);
    t0 = std::max(0.0, along - half);
    t1 = std::min(1.0, along + half);
    return t0 <= t1;
  }

  /// Where in t0..t1 the height over (x, y) is least (ternary search on a convex function).
  double lowest(double x, double y, double t0, double t1) const {
    if (step.x == 0 && step.y == 0) return step.z < 0 ? t1 : t0;
    if (step.z == 0) {  // nearest approach
      const double length2 = step.x * step.x + step.y * step.y;
      return std::clamp(((x - from.x) * step.x + (y - from.y) * step.y) / length2, t0, t1);
    }
    for (int i = 0; i < 60 && t1 - t0 > 1e-9; ++i) {
      const double a = t0 + (t1 - t0) / 3, b = t1 - (t1 - t0) / 3;
      (height(x, y, a) <= height(x, y, b) ? t1 : t0) = height(x, y, a) <= height(x, y, b) ? b : a;
    }
    return 0.5 * (t0 + t1);
  }

  /// First t in t0..t_low at which the height is below `material`, given that it is at t_low.
  double first_below(double x, double y, double material, double t0, double t_low) const {
    if (height(x, y, t0) < material) return t0;
    double above = t0, below = t_low;
    for (int i = 0; i < 50; ++i) {
      const double t = 0.5 * (above + below);
      (height(x, y, t) < material ? below : above) = t;
    }
    return below;
  }
};

}  // namespace kerf
