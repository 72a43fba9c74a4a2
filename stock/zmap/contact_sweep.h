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
    const double dx = x - from.x - t * step.x, dy = y - from.y - t * step.y;
    const double d = std::sqrt(dx * dx + dy * dy);
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
      if (height(x, y, a) <= height(x, y, b))
        t1 = b;
      else
        t0 = a;
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

/// A tool on a straight line as all of a rectangle sees it: the lowest height over any of its
/// points, again a convex function of t in 0..1. The distance of a convex area from the axis takes
/// the place of that of a point.
struct AreaSweep {
  static constexpr double kNone = ShrunkSweep::kNone;

  const ConvexTool& tool;
  Vec3 from, step;
  double x0, y0, x1, y1;

  double distance(double t) const {
    const double x = from.x + t * step.x, y = from.y + t * step.y;
    const double dx = std::max({x0 - x, 0.0, x - x1}), dy = std::max({y0 - y, 0.0, y - y1});
    return std::sqrt(dx * dx + dy * dy);
  }
  /// For t within over().
  double height(double t) const {
    return from.z + t * step.z + surface_height(tool, std::min(distance(t), tool.radius));
  }

  /// The part of 0..1 during which the tool is over the rectangle; false if none. It is within the
  /// radius of the rectangle, if it is within one of the rectangles that are longer or wider by the
  /// radius, or one of the circles about the corners.
  bool over(double& t0, double& t1) const {
    t0 = kNone;
    t1 = -kNone;
    const double r = tool.radius;
    add_rectangle(x0 - r, y0, x1 + r, y1, t0, t1);
    add_rectangle(x0, y0 - r, x1, y1 + r, t0, t1);
    for (const double x : {x0, x1})
      for (const double y : {y0, y1}) add_circle(x, y, t0, t1);
    return t0 <= t1;
  }

  /// Where in t0..t1 the height is least.
  double lowest(double t0, double t1) const {
    for (int i = 0; i < 60 && t1 - t0 > 1e-9; ++i) {
      const double a = t0 + (t1 - t0) / 3, b = t1 - (t1 - t0) / 3;
      if (height(a) <= height(b))
        t1 = b;
      else
        t0 = a;
    }
    return height(t0) <= height(t1) ? t0 : t1;
  }

  /// First t in t0..t_low at which the height is below `level`, given that it is at t_low.
  double first_below(double level, double t0, double t_low) const {
    if (height(t0) < level) return t0;
    double above = t0, below = t_low;
    for (int i = 0; i < 50; ++i) {
      const double t = 0.5 * (above + below);
      (height(t) < level ? below : above) = t;
    }
    return below;
  }

 private:
  void add_rectangle(double low_x, double low_y, double high_x, double high_y, double& t0,
                     double& t1) const {
    double begin = 0, end = 1;
    const auto clip = [&](double start, double way, double low, double high) {
      if (way == 0) {
        if (start < low || start > high) end = -1;
        return;
      }
      const double a = (low - start) / way, b = (high - start) / way;
      begin = std::max(begin, std::min(a, b));
      end = std::min(end, std::max(a, b));
    };
    clip(from.x, step.x, low_x, high_x);
    clip(from.y, step.y, low_y, high_y);
    if (begin > end) return;
    t0 = std::min(t0, begin);
    t1 = std::max(t1, end);
  }
  void add_circle(double x, double y, double& t0, double& t1) const {
    const double length2 = step.x * step.x + step.y * step.y;
    const double px = x - from.x, py = y - from.y, r2 = tool.radius * tool.radius;
    if (length2 < 1e-18) {
      if (px * px + py * py > r2) return;
      t0 = 0;
      t1 = 1;
      return;
    }
    const double along = (px * step.x + py * step.y) / length2;
    const double across2 = px * px + py * py - along * along * length2;
    if (across2 > r2) return;
    const double half = std::sqrt((r2 - across2) / length2);
    const double begin = std::max(0.0, along - half), end = std::min(1.0, along + half);
    if (begin > end) return;
    t0 = std::min(t0, begin);
    t1 = std::max(t1, end);
  }
};

}  // namespace kerf
