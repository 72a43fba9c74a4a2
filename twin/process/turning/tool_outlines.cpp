#include "twin/process/turning/tool_outlines.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>

#include "stock/turning/turning_stock.h"

namespace kerf {

bool is_cutting(InsertSide side) {
  return side == InsertSide::kNose || side == InsertSide::kFront || side == InsertSide::kBack;
}

ToolOutlines outlines_of(const Cutter& cutter) {
  ToolOutlines outlines;
  const std::shared_ptr<const InsertOutline> whole = turning_outline(cutter);
  if (!whole) return outlines;
  for (const InsertPart& part : whole->parts) {
    const bool edged =
        std::ranges::any_of(part, [](const InsertEdge& edge) { return is_cutting(edge.side); });
    (edged ? outlines.cutter : outlines.holder).parts.push_back(part);
  }
  return outlines;
}

void outline_box(const InsertOutline& outline, Vec2& low_mm, Vec2& high_mm) {
  low_mm = Vec2(std::numeric_limits<double>::infinity());
  high_mm = -low_mm;
  const auto extend = [&](const Vec2& a, const Vec2& b) {
    low_mm = glm::min(low_mm, a);
    high_mm = glm::max(high_mm, b);
  };
  for (const InsertPart& part : outline.parts) {
    for (const InsertEdge& edge : part) {
      extend(edge.end_mm, edge.end_mm);
      if (!edge.center_mm) continue;
      const double r = glm::distance(edge.end_mm, *edge.center_mm);
      extend(*edge.center_mm - r, *edge.center_mm + r);
    }
  }
}

}  // namespace kerf
