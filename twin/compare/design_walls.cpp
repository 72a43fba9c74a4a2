#include "twin/compare/design_walls.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace kerf {
namespace {

constexpr float kNoDesign = -std::numeric_limits<float>::infinity();
/// What rises by so much of its length is a wall: steeper slopes than 80 degrees.
constexpr float kWallRise = 6;
/// And what rises by so much of it is steep: 63 degrees.
constexpr float kSteepRise = 2;

std::vector<float> tops(const DesignPart& design, const ColumnGrid& grid) {
  std::vector<float> top(grid.size(), kNoDesign);
  const auto take = [&](std::size_t at, float z, int) { top[at] = std::max(top[at], z); };
  for (std::uint32_t t = 0; t < design.size(); ++t) each_column_line(design.corners(t), grid, take);
  return top;
}

/// The walls along one row of fine heights. `point(k, z)`: one is at the k-th, `drop(cell)`: the
/// middle of that cell stands too near to one.
template <class Point, class Drop>
void find_walls(std::span<const float> fine, float step_mm, const Point& point, const Drop& drop) {
  const float rise_mm = kWallRise * step_mm;
  const auto count = static_cast<std::ptrdiff_t>(fine.size());
  const auto at = [&](std::ptrdiff_t k) { return fine[static_cast<std::size_t>(k)]; };
  for (std::ptrdiff_t k = 0; k + 1 < count; ++k) {
    const bool rises = at(k + 1) - at(k) > rise_mm;
    if (!rises && !(at(k) - at(k + 1) > rise_mm)) continue;
    // `high` is the first place on the wall's high side, `inward` leads away from it.
    const std::ptrdiff_t high = rises ? k + 1 : k, inward = rises ? 1 : -1;
    const std::ptrdiff_t next = high + inward;
    const bool goes_on = next >= 0 && next < count && at(high) - at(next) <= rise_mm;
    const std::ptrdiff_t stands = goes_on ? next : high;
    point(stands, goes_on ? std::min(at(high), at(next)) : at(high));
    // The wall stands `edge` steps from the row's begin. Middles are half way of kFinePerCell.
    const std::ptrdiff_t edge = k + 1;
    for (const std::ptrdiff_t middle : {edge, edge + inward}) {
      const std::ptrdiff_t cell = middle / kFinePerCell;
      if (middle % kFinePerCell == kFinePerCell / 2 && middle >= 0 && middle < count)
        drop(static_cast<int>(cell));
    }
  }
}

/// Of the four fine heights of a cell: as low as it is a quarter of a cell to either side, if they
/// are steep; else `z`.
float relaxed(float z, float a, float b, float c, float d, float cell_mm) {
  static_assert(kFinePerCell == 4);
  if (!(std::abs(d - a) > kSteepRise * 0.75f * cell_mm)) return z;
  return std::min({z, 0.5f * (a + b), 0.5f * (c + d)});
}

}  // namespace

DesignFromAbove with_walls(const ColumnGrid& grid, std::vector<float> middles,
                           std::span<const float> along_x, std::span<const float> along_y) {
  DesignFromAbove out;
  const Vec2 cell = grid.cell_mm();
  out.top_mm = middles;
  out.whole_mm = std::move(middles);
  const std::vector<float>& whole = out.whole_mm;
  const auto nx = static_cast<std::size_t>(grid.nx), ny = static_cast<std::size_t>(grid.ny);
  const auto cell_x = static_cast<float>(cell.x), cell_y = static_cast<float>(cell.y);
  for (std::size_t j = 0, at = 0; j < ny; ++j) {
    for (std::size_t i = 0; i < nx; ++i, ++at) {
      const float* const x = &along_x[(j * nx + i) * kFinePerCell];
      const float* const y = &along_y[j * kFinePerCell * nx + i];
      float& top = out.top_mm[at];
      top = relaxed(top, x[0], x[1], x[2], x[3], cell_x);
      top = relaxed(top, y[0], y[nx], y[2 * nx], y[3 * nx], cell_y);
    }
  }
  // A middle that is on a wall's high side, near it; others are as low as the wall's foot.
  const auto drop_at = [&](std::size_t index, float least_mm) {
    if (whole[index] >= least_mm) out.top_mm[index] = kNoDesign;
  };
  float last_z = 0;
  for (std::size_t j = 0; j < ny; ++j) {
    const auto y = static_cast<float>((static_cast<double>(j) + 0.5) * cell.y);
    const double step = cell.x / kFinePerCell;
    find_walls(
        along_x.subspan(j * nx * kFinePerCell, nx * kFinePerCell), static_cast<float>(step),
        [&](std::ptrdiff_t k, float z) {
          out.walls.push_back({static_cast<float>((static_cast<double>(k) + 0.5) * step), y, z});
          last_z = z;
        },
        [&](int i) { drop_at(j * nx + static_cast<std::size_t>(i), last_z); });
  }
  std::vector<float> column(ny * kFinePerCell);
  for (std::size_t i = 0; i < nx; ++i) {
    for (std::size_t k = 0; k < column.size(); ++k) column[k] = along_y[k * nx + i];
    const auto x = static_cast<float>((static_cast<double>(i) + 0.5) * cell.x);
    const double step = cell.y / kFinePerCell;
    find_walls(
        column, static_cast<float>(step),
        [&](std::ptrdiff_t k, float z) {
          out.walls.push_back({x, static_cast<float>((static_cast<double>(k) + 0.5) * step), z});
          last_z = z;
        },
        [&](int j) { drop_at(static_cast<std::size_t>(j) * nx + i, last_z); });
  }
  return out;
}

DesignFromAbove design_from_above(const DesignPart& design, const ColumnGrid& grid) {
  std::vector<float> middles = tops(design, grid);
  if (grid.size() > kMostCellsWithWalls) return {middles, middles, {}};
  ColumnGrid fine_x = grid, fine_y = grid;
  fine_x.nx *= kFinePerCell;
  fine_y.ny *= kFinePerCell;
  return with_walls(grid, std::move(middles), tops(design, fine_x), tops(design, fine_y));
}

}  // namespace kerf
