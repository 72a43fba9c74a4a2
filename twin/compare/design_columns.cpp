#include "twin/compare/design_columns.h"

#include <algorithm>

namespace kerf {

DesignColumns::DesignColumns(const DesignPart& design, const ColumnGrid& grid,
                             std::span<const float> heights_mm) {
  const std::size_t cells = grid.size();
  top_.assign(cells, kNone);
  bottom_.assign(cells, kNone);
  below_.assign(cells, 0);
  above_.assign(cells, 0);
  const float outward = design.is_inside_out() ? -1.0f : 1.0f;
  const auto floor = static_cast<float>(grid.bounds_mm.min.z);
  const auto ceiling = static_cast<float>(grid.bounds_mm.max.z);
  const auto take = [&](std::size_t at, float z, int up) {
    const float sign = static_cast<float>(up) * outward;
    const float height = std::clamp(heights_mm[at], floor, ceiling);
    top_[at] = std::max(top_[at], z);
    bottom_[at] = bottom_[at] == kNone ? z : std::min(bottom_[at], z);
    below_[at] += sign * std::clamp(z, floor, height);
    above_[at] += sign * std::clamp(z, height, ceiling);
  };
  for (std::uint32_t t = 0; t < design.size(); ++t) each_column_line(design.corners(t), grid, take);
}

}  // namespace kerf
