#include "stock/zmap/tile_relief.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>

namespace kerf {
namespace {

/// Lowers low[i - first] to the heights of cells first .. last-1 of row j; `first` is even. Room
/// for one more is needed.
void lower_to_row(const TileGrid& grid, int j, int first, int last, float* low) {
  for (int i = first; i < last;) {
    const float* from = grid.tile(i / kTileCells, j / kTileCells) + TileGrid::offset(i, j);
    const int end = std::min(last, (i / kTileCells + 1) * kTileCells);
    for (; i < end; i += kBlockX, from += kBlockFloats) {
      float* const to = low + (i - first);
      to[0] = std::min(to[0], from[0]);
      to[1] = std::min(to[1], from[1]);
    }
  }
}

std::uint32_t packed(float x, float y, float z) {
  const auto bits = [](float v) {
    const float steps = v * 511.0f;
    return static_cast<std::uint32_t>(static_cast<int>(steps + (steps < 0 ? -0.5f : 0.5f))) &
           0x3ffu;
  };
  return bits(x) | bits(y) << 10 | bits(z) << 20;
}

}  // namespace

TileRelief::TileRelief(const TileGrid& grid, std::size_t tile, int level)
    : wall_reach_(wall_reach(level)), floor_(grid.floor_mm()) {
  const int tx = static_cast<int>(tile) % grid.tiles_x();
  const int ty = static_cast<int>(tile) / grid.tiles_x();
  const int span = 1 << level;
  const auto cells = [span](int total, int t) {
    return (std::min(kTileCells, total - t * kTileCells) + span - 1) / span;
  };
  nx_ = cells(grid.nx(), tx);
  ny_ = cells(grid.ny(), ty);
  const int per_tile = kTileCells / span;
  grid_begin_ = {-tx * per_tile, -ty * per_tile};
  grid_end_ =
      grid_begin_ + glm::ivec2((grid.nx() + span - 1) / span, (grid.ny() + span - 1) / span);
  // From the cell's number in the grid, so that neighbours agree to the bit.
  const auto line = [span](int t, int i, int total, double origin, double edge) {
    return static_cast<float>(origin + std::min(t * kTileCells + i * span, total) * edge);
  };
  const Box& box = grid.bounds_mm();
  for (int i = 0; i <= nx_; ++i) x_[index(i)] = line(tx, i, grid.nx(), box.min.x, grid.cell_x_mm());
  for (int j = 0; j <= ny_; ++j) y_[index(j)] = line(ty, j, grid.ny(), box.min.y, grid.cell_y_mm());
  load_heights(grid, tx, ty, level);
  cell_mm_ = glm::dvec2(grid.cell_x_mm() * span, grid.cell_y_mm() * span);
  const glm::ivec2 beyond = (grid_end_ - grid_begin_) * span - glm::ivec2(grid.nx(), grid.ny());
  last_share_ = 1.0f - glm::vec2(beyond) / static_cast<float>(span);
  find_links(cell_mm_.x, cell_mm_.y);
  find_corners(cell_mm_.x, cell_mm_.y);
  turn_steep_normals();
}

void TileRelief::load_heights(const TileGrid& grid, int tx, int ty, int level) {
  constexpr float kNone = std::numeric_limits<float>::infinity();
  const int span = 1 << level;
  const int halo = wall_reach_;
  const int left = tx * kTileCells - halo * span, bottom = ty * kTileCells - halo * span;
  const int first = std::max(0, left);
  const int last = std::min(grid.nx(), left + (nx_ + 2 * halo) * span);
  std::array<float, 2 * kTileCells + kTileCells + 2> low;
  height_.fill(floor_);
  for (int row = 0; row < ny_ + 2 * halo; ++row) {
    const int from = std::max(0, bottom + row * span);
    const int to = std::min(grid.ny(), bottom + (row + 1) * span);
    if (from >= to) continue;
    low.fill(kNone);
    for (int j = from; j < to; ++j) lower_to_row(grid, j, first, last, low.data() + (first - left));
    low[index(last - left)] = kNone;  // the other half of a pair of cells
    int width = (nx_ + 2 * halo) * span;
    for (int l = 0; l < level; ++l) {
      width /= 2;
      for (int i = 0; i < width; ++i)
        low[index(i)] = std::min(low[index(2 * i)], low[index(2 * i + 1)]);
    }
    float* const out = height_.data() + slot(-halo, row - halo);
    for (int i = 0; i < width; ++i)
      out[i] = low[index(i)] == kNone ? floor_ : std::max(low[index(i)], floor_);
  }
}

void TileRelief::find_links(float cell_x, float cell_y) {
  const float floor = floor_;
  // Of rows that corners depend on.
  const int begin = slot(-kHalo, -kCornerReach), end = slot(-kHalo, ny_ + kCornerReach);
  const auto steps = [&](int next, int last, Field<float>& step) {
    const float* const h = height_.data();
    for (int k = begin; k < last; ++k)
      step[index(k)] = ((h[k] > floor) & (h[k + next] > floor)) ? h[k + next] - h[k] : 0.0f;
  };
  steps(1, end - 1, step_x_);
  steps(kStride, end - kStride, step_y_);
  const auto links = [&](int next, int first, int last, float cell, const Field<float>& step,
                         Field<float>& link) {
    const float* const h = height_.data();
    const float* const d = step.data();
    float* const out = link.data();
    for (int k = first; k < last; ++k) {
      const bool alike = (h[k] > floor) == (h[k + next] > floor);
      out[k] =
          (alike & SurfaceSlopes::is_smooth(d[k], d[k - next], d[k + next], cell)) ? 1.0f : 0.0f;
    }
  };
  links(1, begin + 1, end - 2, cell_x, step_x_, link_x_);
  links(kStride, begin + kStride, end - 2 * kStride, cell_y, step_y_, link_y_);
}

void TileRelief::find_corners(float cell_x, float cell_y) {
  // Of four cells about the tile, links are good from the second on, slopes from the third,
  // corners from the fourth.
  const int begin = slot(-2, -2), end = slot(nx_ + 2, ny_ + 1);
  const auto slopes = [&](int next, float cell, const Field<float>& step, const Field<float>& link,
                          Field<float>& slope) {
    const float* const d = step.data();
    const float* const l = link.data();
    float* const out = slope.data();
    const float whole = 1 / cell, half = 0.5f / cell;
    for (int k = begin; k < end; ++k)
      out[k] =
          (d[k - next] * l[k - next] + d[k] * l[k]) * (l[k - next] + l[k] > 1.5f ? half : whole);
  };
  slopes(1, cell_x, step_x_, link_x_, slope_x_);
  slopes(kStride, cell_y, step_y_, link_y_, slope_y_);

  // Compilers do not see by themselves that the fields do not overlap.
  const float* __restrict__ const h = height_.data();
  const float* __restrict__ const lx = link_x_.data();
  const float* __restrict__ const ly = link_y_.data();
  const float* __restrict__ const sx = slope_x_.data();
  const float* __restrict__ const sy = slope_y_.data();
  float* __restrict__ const count = link_count_.data();
  float* __restrict__ const z = corner_z_.data();
  std::uint32_t* __restrict__ const normal = corner_normal_.data();
  const int first = slot(0, 0), last = slot(nx_, ny_);
  for (int k = first; k <= last; ++k) {
    const int a = k - kStride - 1, b = k - kStride, c = k, d = k - 1;
    count[k] = (lx[a] + lx[d]) + (ly[a] + ly[b]);
    z[k] = ((h[a] + h[b]) + (h[c] + h[d])) * 0.25f;
  }
  for (int k = first; k <= last; ++k) {
    const int a = k - kStride - 1, b = k - kStride, c = k, d = k - 1;
    const float gx = ((sx[a] + sx[b]) + (sx[c] + sx[d])) * 0.25f;
    const float gy = ((sy[a] + sy[b]) + (sy[c] + sy[d])) * 0.25f;
    const float scale = 1 / std::sqrt(1 + gx * gx + gy * gy);
    normal[k] = packed(-gx * scale, -gy * scale, scale);
  }
}

template <class With>
auto TileRelief::with_surroundings(const With& with) const {
  const auto height_of = [this](int x, int y) { return height(slot(x, y)); };
  const int reach = wall_reach_;
  if (std::max(grid_begin_.x, grid_begin_.y) <= -reach && nx_ + reach <= grid_end_.x &&
      ny_ + reach <= grid_end_.y) [[likely]]
    return with(height_of, [](int, int) { return true; });
  return with(height_of, [this](int x, int y) {
    return x >= grid_begin_.x && y >= grid_begin_.y && x < grid_end_.x && y < grid_end_.y;
  });
}

/// Where corners are not split.
void TileRelief::turn_steep_normals() {
  constexpr std::uint32_t kZShift = 20;
  const float scale = 1 / std::sqrt(1 + SurfaceSlopes::kSteepest * SurfaceSlopes::kSteepest);
  const std::uint32_t steep = packed(0, 0, scale) >> kZShift;
  for (int j = 0; j <= ny_; ++j) {
    const std::uint32_t* const row = corner_normal_.data() + slot(0, j);
    int count = 0;  // without a way out of the loop, so that several are looked at at a time
    for (int i = 0; i <= nx_; ++i) count += row[i] >> kZShift < steep;
    for (int i = 0; count > 0 && i <= nx_; ++i) {
      const int corner = slot(i, j);
      if (row[i] >> kZShift >= steep || is_split(corner)) continue;
      glm::vec2 mean(0);
      for (const int cell : cells_about(corner))
        mean += 0.25f * glm::vec2(slope_x_[index(cell)], slope_y_[index(cell)]);
      const glm::vec2 slope = turned_if_steep(corner, mean);
      const glm::vec3 normal = glm::normalize(glm::vec3(-slope, 1));
      corner_normal_[index(corner)] = packed(normal.x, normal.y, normal.z);
    }
  }
}

glm::vec2 TileRelief::turned_if_steep(int corner, const glm::vec2& slope) const {
  if (glm::dot(slope, slope) <= SurfaceSlopes::kSteepest * SurfaceSlopes::kSteepest) return slope;
  const int i = corner % kStride - kHalo, j = corner / kStride - kHalo;
  return with_surroundings([&](const auto& height_of, const auto& in_grid) {
    return slope_across_course(i, j, slope, wall_reach_ - 1, height_of, in_grid);
  });
}

TileRelief::Split TileRelief::split(int corner) const {
  const std::array<int, 4> cells = cells_about(corner);
  const std::array<bool, 4> link = links_about(cells);
  Split out;
  out.group = {0, 1, 2, 3};
  for (int round = 0; round < 2; ++round) {
    for (std::size_t q = 0; q < 4; ++q) {
      const std::size_t next = (q + 1) % 4;
      if (link[q]) out.group[q] = out.group[next] = std::min(out.group[q], out.group[next]);
    }
  }
  for (std::size_t q = 0; q < 4; ++q) {
    if (const std::size_t first = out.group[q]; first != q) {
      out.z[q] = out.z[first];
      out.slope[q] = out.slope[first];
      continue;
    }
    float sum = 0, low = height(cells[q]), high = low, count = 0;
    glm::vec2 slope(0);
    for (std::size_t r = 0; r < 4; ++r) {
      if (out.group[r] != out.group[q]) continue;
      const std::size_t cell = index(cells[r]);
      sum += height_[cell];
      low = std::min(low, height_[cell]);
      high = std::max(high, height_[cell]);
      slope += glm::vec2(slope_x_[cell], slope_y_[cell]);
      count += 1;
    }
    out.z[q] = std::clamp(sum / count, low, high);
    out.slope[q] = turned_if_steep(corner, slope / count);
  }
  return out;
}

WallCourse TileRelief::wall_course(int i, int j, bool across_x) const {
  const float middle =
      0.5f * (height(slot(i, j)) + height(across_x ? slot(i - 1, j) : slot(i, j - 1)));
  return with_surroundings([&](const auto& height_of, const auto& in_grid) {
    return WallCourse(i, j, across_x, middle, wall_reach_, height_of, in_grid);
  });
}

glm::vec2 TileRelief::shift_mm(int i, int j) const {
  const std::array<int, 4> cells = cells_about(slot(i, j));
  const std::array<float, 4> heights{height(cells[0]), height(cells[1]), height(cells[2]),
                                     height(cells[3])};
  const std::array<bool, 4> links = links_about(cells);
  const glm::vec2 shift = with_surroundings([&](const auto& height_of, const auto& in_grid) {
    return wall_shift(i, j, heights, links, wall_reach_, height_of, in_grid);
  });
  return to_mm(shift, i, j);
}

}  // namespace kerf
