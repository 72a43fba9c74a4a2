// tests/stock/insert_points.h - outlines of inserts as polygons.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "base/geometry.h"
#include "stock/cutter/insert.h"

namespace kerf {

/// Corners, and points between them on arcs: so many chords for each.
inline std::vector<Vec2> insert_points(const InsertPart& part, int chords) {
  std::vector<Vec2> points;
  Vec2 from = part.back().end_mm;
  for (const InsertEdge& edge : part) {
    if (edge.center_mm) {
      const Vec2 a = from - *edge.center_mm, b = edge.end_mm - *edge.center_mm;
      double sweep = std::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b));
      if (sweep <= 0) sweep += 2 * kPi;
      for (int i = 1; i < chords; ++i) {
        const double c = std::cos(sweep * i / chords), s = std::sin(sweep * i / chords);
        points.push_back(*edge.center_mm + Vec2(c * a.x - s * a.y, s * a.x + c * a.y));
      }
    }
    points.push_back(edge.end_mm);
    from = edge.end_mm;
  }
  return points;
}

}  // namespace kerf
