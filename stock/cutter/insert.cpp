#include "stock/cutter/insert.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace kerf {
namespace {

/// A mirror turns the way round, so the chain is walked backward.
InsertOutline mirrored(const InsertOutline& outline, const Vec2& factor) {
  InsertOutline result;
  for (const InsertPart& part : outline.parts) {
    InsertPart& turned = result.parts.emplace_back();
    for (std::size_t i = part.size(); i-- > 0;) {
      InsertEdge edge = part[i];
      edge.end_mm = factor * part[i == 0 ? part.size() - 1 : i - 1].end_mm;
      if (edge.center_mm) edge.center_mm = factor * *edge.center_mm;
      turned.push_back(edge);
    }
  }
  return result;
}

}  // namespace

double outline_reach_mm(const InsertOutline& outline) {
  double reach = 0;
  for (const InsertPart& part : outline.parts) {
    for (const InsertEdge& edge : part) {
      reach = std::max(reach, glm::length(edge.end_mm));
      if (!edge.center_mm) continue;
      reach = std::max(reach,
                       glm::length(*edge.center_mm) + glm::distance(*edge.center_mm, edge.end_mm));
    }
  }
  return reach;
}

InsertOutline mirrored_in_x(const InsertOutline& outline) { return mirrored(outline, {1, -1}); }
InsertOutline mirrored_in_z(const InsertOutline& outline) { return mirrored(outline, {-1, 1}); }

}  // namespace kerf
