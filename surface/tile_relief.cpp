#include "surface/tile_relief.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>

namespace kerf {
namespace {

constexpr int kTileCells = HeightGrid::kTileCells;
constexpr int kBlockFloats = HeightGrid::kBlockX * HeightGrid::kBlockY;
static_assert(HeightGrid::kBlockX == 2 && TileRelief::kHalo % 2 == 0);

/// Calls `take(k, height)` for each cell first + k of row j below `last`; `first` is even.
template <class Take>
void for_row(const TilesAbout& about, int j, int first, int last, const Take& take) {
  for (int i = first; i < last;) {
    const float* from = about.tile(i / kTileCells, j / kTileCells) + HeightGrid::offset(i, j);
    const int end = std::min(last, (i / kTileCells + 1) * kTileCells);
    for (; i + 1 < end; i += 2, from += kBlockFloats) {
      take(i - first, from[0]);
      take(i + 1 - first, from[1]);
    }
    if (i < end) {
      take(i - first, from[0]);
      ++i;
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

TileRelief::TileRelief(const TilesAbout& about, int level)
    : wall_reach_(wall_reach(level)), floor_(about.floor_mm) {
  const int span = 1 << level;
  const auto cells = [span](int total, int t) {
    return (std::min(kTileCells, total - t * kTileCells) + span - 1) / span;
  };
  nx_ = cells(about.cells.x, about.at.x);
  ny_ = cells(about.cells.y, about.at.y);
  grid_begin_ = -about.at * (kTileCells / span);
  grid_end_ = grid_begin_ + (about.cells + (span - 1)) / span;
  // From the cell's number in the grid, so that neighbours agree to the bit.
  const auto line = [span](int t, int i, int total, double origin, double edge) {
    return static_cast<float>(origin + std::min(t * kTileCells + i * span, total) * edge);
  };
  const Vec3& low = about.bounds_mm.min;
  for (int i = 0; i <= nx_; ++i)
    x_[index(i)] = line(about.at.x, i, about.cells.x, low.x, about.cell_x_mm);
  for (int j = 0; j <= ny_; ++j)
    y_[index(j)] = line(about.at.y, j, about.cells.y, low.y, about.cell_y_mm);
  cell_mm_ = glm::dvec2(about.cell_x_mm * span, about.cell_y_mm * span);
  const glm::ivec2 beyond = (grid_end_ - grid_begin_) * span - about.cells;
  last_share_ = 1.0f - glm::vec2(beyond) / static_cast<float>(span);
  height_.fill(floor_);
  if (level == 0) {
    load_cells(about);
  } else {
    load_blocks(about, level);
  }
}

void TileRelief::find_surface() {
  find_links(cell_mm_.x, cell_mm_.y);
  find_corners(cell_mm_.x, cell_mm_.y);
  turn_steep_normals();
}

void TileRelief::load_cells(const TilesAbout& about) {
  const glm::ivec2 begin = about.at * kTileCells;
  const int first = std::max(0, begin.x - kHalo);
  const int last = std::min(about.cells.x, begin.x + nx_ + kHalo);
  const int end = std::min(about.cells.y, begin.y + ny_ + kHalo);
  for (int j = std::max(0, begin.y - kHalo); j < end; ++j) {
    float* const out = height_.data() + slot(first - begin.x, j - begin.y);
    const float floor = floor_;
    for_row(about, j, first, last, [=](int k, float z) { out[k] = std::max(z, floor); });
  }
}

void TileRelief::load_blocks(const TilesAbout& about, int level) {
  constexpr float kNone = std::numeric_limits<float>::infinity();
  const int span = 1 << level;
  const int halo = wall_reach_;
  const glm::ivec2 begin = about.at * kTileCells - halo * span;
  const int first = std::max(0, begin.x);
  const int last = std::min(about.cells.x, begin.x + (nx_ + 2 * halo) * span);
  std::array<float, 2 * kTileCells + kTileCells + 2> low;
  for (int row = 0; row < ny_ + 2 * halo; ++row) {
    const int from = std::max(0, begin.y + row * span);
    const int to = std::min(about.cells.y, begin.y + (row + 1) * span);
    if (from >= to) continue;
    low.fill(kNone);
    float* const lowest = low.data() + (first - begin.x);
    for (int j = from; j < to; ++j)
      for_row(about, j, first, last, [=](int k, float z) { lowest[k] = std::min(lowest[k], z); });
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

bool TileRelief::is_level() const {
  if (nx_ < kTileCells || ny_ < kTileCells) return false;
  constexpr int kCells = kTileCells + 2 * kCornerReach;
  const float z = height(slot(0, 0));
  for (int j = -kCornerReach; j < kTileCells + kCornerReach; ++j) {
    const float* const row = height_.data() + slot(-kCornerReach, j);
    if (!std::all_of(row, row + kCells, [z](float other) { return other == z; })) return false;
  }
  return true;
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

unsigned TileRelief::group_of(const std::array<bool, 4>& links, std::size_t quadrant) {
  unsigned group = 1u << quadrant;
  for (int round = 0; round < 2; ++round) {
    for (std::size_t q = 0; q < 4; ++q) {
      const unsigned both = 1u << q | 1u << (q + 1) % 4;
      if (links[q] && (group & both) != 0) group |= both;
    }
  }
  return group;
}

/// In the order of the quadrants, whoever asks, for the same rounding.
TileRelief::Meeting TileRelief::meeting_of(int corner, unsigned group) const {
  const std::array<int, 4> cells = cells_about(corner);
  constexpr float kMost = std::numeric_limits<float>::infinity();
  float sum = 0, low = kMost, high = -kMost, count = 0;
  glm::vec2 slope(0);
  for (std::size_t q = 0; q < 4; ++q) {
    if ((group & 1u << q) == 0) continue;
    const std::size_t cell = index(cells[q]);
    sum += height_[cell];
    low = std::min(low, height_[cell]);
    high = std::max(high, height_[cell]);
    slope += glm::vec2(slope_x_[cell], slope_y_[cell]);
    count += 1;
  }
  return {std::clamp(sum / count, low, high), turned_if_steep(corner, slope / count)};
}

TileRelief::Meeting TileRelief::meeting(int corner, std::size_t quadrant) const {
  return meeting_of(corner, group_of(links_about(cells_about(corner)), quadrant));
}

TileRelief::Split TileRelief::split(int corner) const {
  const std::array<bool, 4> links = links_about(cells_about(corner));
  Split out;
  for (std::size_t q = 0; q < 4; ++q) {
    const unsigned group = group_of(links, q);
    const auto first = static_cast<std::size_t>(std::countr_zero(group));
    out.group[q] = static_cast<std::uint8_t>(first);
    if (first != q) {
      out.z[q] = out.z[first];
      out.slope[q] = out.slope[first];
      continue;
    }
    const Meeting at = meeting_of(corner, group);
    out.z[q] = at.z;
    out.slope[q] = at.slope;
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

glm::vec2 TileRelief::shift(int i, int j) const {
  const std::array<int, 4> cells = cells_about(slot(i, j));
  const std::array<float, 4> heights{height(cells[0]), height(cells[1]), height(cells[2]),
                                     height(cells[3])};
  const std::array<bool, 4> links = links_about(cells);
  return with_surroundings([&](const auto& height_of, const auto& in_grid) {
    return wall_shift(i, j, heights, links, wall_reach_, height_of, in_grid);
  });
}

}  // namespace kerf
