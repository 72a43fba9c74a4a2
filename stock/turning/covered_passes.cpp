#include "stock/turning/covered_passes.h"

#include <algorithm>
#include <cstddef>
#include <glm/geometric.hpp>

namespace kerf::turning {
namespace {

/// Whether a part of an outline, moved by `by`, lies within another outline.
bool is_within(const ConvexChain& inner, const Vec2& by, const ThreadPass& outer) {
  const ConvexChain& chain = outer.corners();
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const Vec2& a = chain[i == 0 ? chain.size() - 1 : i - 1];
    const Vec2 edge = chain[i] - a;
    const double slack = kStill_mm * glm::length(edge);
    for (const Vec2& corner : inner) {
      const Vec2 p = corner + by - a;
      if (edge.x * p.y - edge.y * p.x < -slack) return false;
    }
  }
  return true;
}

}  // namespace

void drop_covered(const ThreadPass& pass, double at_way, double low_way, double high_way,
                  std::vector<PassBeside>& beside) {
  for (std::size_t i = 0; i < beside.size();) {
    const PassBeside& inner = beside[i];
    const double begin = std::max(inner.low_way, low_way), end = std::min(inner.high_way, high_way);
    const Vec2 at_begin = inner.offset + (begin - at_way) * inner.per_way;
    const Vec2 at_end = inner.offset + (end - at_way) * inner.per_way;
    const ConvexChain part =
        between_heights(inner.pass->corners(), pass.low_mm().y - std::max(at_begin.y, at_end.y),
                        pass.high_mm().y - std::min(at_begin.y, at_end.y));
    // Later ones are deeper as a rule.
    const bool is_covered = std::any_of(beside.rbegin(), beside.rend(), [&](const auto& outer) {
      if (&outer == &inner || outer.low_way > begin || outer.high_way < end) return false;
      const Vec2 outer_begin = outer.offset + (begin - at_way) * outer.per_way;
      const Vec2 outer_end = outer.offset + (end - at_way) * outer.per_way;
      return is_within(part, at_begin - outer_begin, *outer.pass) &&
             is_within(part, at_end - outer_end, *outer.pass);
    });
    if (is_covered) {
      beside.erase(beside.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
}

}  // namespace kerf::turning
