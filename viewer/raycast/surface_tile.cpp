#include "viewer/raycast/surface_tile.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "base/mesh_patch.h"
#include "base/wall_course.h"

namespace kerf {
namespace {

constexpr int kCells = SurfaceTile::kCells;
constexpr int kHalo = 4;  // a corner depends on three cells beyond it
static_assert(kHalo <= kSurfaceReach);
constexpr int kStride = kCells + 2 * kHalo;
constexpr int kSlots = kStride * kStride;

std::size_t index(int i) { return static_cast<std::size_t>(i); }
int slot(int i, int j) { return (j + kHalo) * kStride + i + kHalo; }

std::uint32_t packed(float x, float y, float z) {
  const auto bits = [](float v) {
    const float steps = v * 511.0f;
    return static_cast<std::uint32_t>(static_cast<int>(steps + (steps < 0 ? -0.5f : 0.5f))) &
           0x3ffu;
  };
  return bits(x) | bits(y) << 10 | bits(z) << 20;
}

/// The four cells about a corner, counter-clockwise from the lower left: A, B, C, D. A corner has
/// the slot of its C.
constexpr std::array<int, 4> kQuadrantOffset{-kStride - 1, -kStride, 0, -1};

/// Heights of a tile and around it, and what follows from them. Arrays are indexed by slot.
class Relief {
 public:
  Relief(const HeightGrid& grid, int tx, int ty)
      : grid_(grid),
        i0_(tx * kCells),
        j0_(ty * kCells),
        floor_(grid.floor_mm()),
        nx_(std::min(kCells, grid.nx() - tx * kCells)),
        ny_(std::min(kCells, grid.ny() - ty * kCells)) {
    load(grid, tx * kCells, ty * kCells);
  }

  int nx() const { return nx_; }
  int ny() const { return ny_; }
  float floor() const { return floor_; }
  float height(int cell) const { return height_[index(cell)]; }
  bool solid(int cell) const { return height(cell) > floor_; }
  /// Every cell, also around the tile, has the same height.
  bool is_level() const;

  /// To be called before what follows.
  void find_surface(float cell_x, float cell_y) {
    find_links(cell_x, cell_y);
    find_corners(cell_x, cell_y);
    turn_steep_normals();
  }
  bool is_split(int corner) const { return link_count_[index(corner)] < 2.5f; }
  float corner_z(int corner) const { return corner_z_[index(corner)]; }
  std::uint32_t corner_normal(int corner) const { return corner_normal_[index(corner)]; }

  struct Vertex {
    float z;
    std::uint32_t normal;
  };
  /// The corner as the cell in this quadrant has it.
  Vertex vertex(int corner, std::size_t quadrant) const;
  /// How far corner (i, j) is moved, in cells.
  glm::vec2 shift(int i, int j) const;
  /// Of the surface over the cell, if corners are moved: no less than any cell's whose corners are
  /// the cell's neighbours'.
  float highest_about(int cell) const;

 private:
  using Field = std::array<float, kSlots>;
  /// Along the way round: A-B, B-C, C-D, D-A.
  std::array<bool, 4> links_about(int corner) const {
    const auto cell = [corner](std::size_t q) { return index(corner + kQuadrantOffset[q]); };
    return {link_x_[cell(0)] > 0.5f, link_y_[cell(1)] > 0.5f, link_x_[cell(3)] > 0.5f,
            link_y_[cell(0)] > 0.5f};
  }

  void load(const HeightGrid& grid, int i0, int j0);
  void find_links(float cell_x, float cell_y);
  void find_corners(float cell_x, float cell_y);
  void turn_steep_normals();
  glm::vec2 turned_if_steep(int corner, const glm::vec2& slope) const;

  const HeightGrid& grid_;
  int i0_, j0_;  // first cell of the tile
  float floor_;
  int nx_, ny_;
  alignas(64) Field height_;
  alignas(64) Field step_x_, step_y_;  ///< to the next cell; 0 where one has no material
  alignas(64) Field link_x_, link_y_;  ///< 1 or 0
  alignas(64) Field slope_x_, slope_y_;
  alignas(64) Field link_count_, corner_z_;
  alignas(64) std::array<std::uint32_t, kSlots> corner_normal_;
};

void Relief::load(const HeightGrid& grid, int i0, int j0) {
  height_.fill(floor_);
  const int first = std::max(0, i0 - kHalo), last = std::min(grid.nx(), i0 + nx_ + kHalo);
  for (int j = std::max(0, j0 - kHalo); j < std::min(grid.ny(), j0 + ny_ + kHalo); ++j) {
    float* const out = height_.data() + slot(-i0, j - j0);
    for (int i = first; i < last;) {
      const float* from = grid.tile(i / kCells, j / kCells) + HeightGrid::offset(i, j);
      const int end = std::min(last, (i / kCells + 1) * kCells);
      // `first` is even, as tiles and the halo are.
      for (; i + 1 < end; i += 2, from += HeightGrid::kBlockX * HeightGrid::kBlockY) {
        out[i] = std::max(from[0], floor_);
        out[i + 1] = std::max(from[1], floor_);
      }
      if (i < end) {
        out[i] = std::max(from[0], floor_);
        ++i;
      }
    }
  }
}
static_assert(HeightGrid::kBlockX == 2 && kHalo % 2 == 0);

bool Relief::is_level() const {
  const float z = height(slot(0, 0));
  if (nx_ < kCells || ny_ < kCells) return false;
  return std::all_of(height_.begin(), height_.end(), [z](float other) { return other == z; });
}

void Relief::find_links(float cell_x, float cell_y) {
  const float floor = floor_;
  const int rows = ny_ + 2 * kHalo;
  const auto steps = [&](int next, int count, Field& step) {
    const float* const h = height_.data();
    for (int k = 0; k < count; ++k)
      step[index(k)] = ((h[k] > floor) & (h[k + next] > floor)) ? h[k + next] - h[k] : 0.0f;
  };
  steps(1, rows * kStride - 1, step_x_);
  steps(kStride, (rows - 1) * kStride, step_y_);
  const auto links = [&](int next, int begin, int end, float cell, const Field& step, Field& link) {
    const float* const h = height_.data();
    const float* const d = step.data();
    float* const out = link.data();
    for (int k = begin; k < end; ++k) {
      const bool alike = (h[k] > floor) == (h[k + next] > floor);
      out[k] =
          (alike & SurfaceSlopes::is_smooth(d[k], d[k - next], d[k + next], cell)) ? 1.0f : 0.0f;
    }
  };
  links(1, 1, rows * kStride - 2, cell_x, step_x_, link_x_);
  links(kStride, kStride, (rows - 2) * kStride, cell_y, step_y_, link_y_);
}

void Relief::find_corners(float cell_x, float cell_y) {
  // Links are good from one cell within the halo's edge on, slopes from two, corners from three.
  const int begin = 2 * kStride + 2, end = (ny_ + 2 * kHalo - 2) * kStride - 2;
  const auto slopes = [&](int next, float cell, const Field& step, const Field& link,
                          Field& slope) {
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

/// Where corners are not split. As patches do it.
void Relief::turn_steep_normals() {
  constexpr std::uint32_t kZShift = 20;
  const float scale = 1 / std::sqrt(1 + SurfaceSlopes::kSteepest * SurfaceSlopes::kSteepest);
  const std::uint32_t steep = packed(0, 0, scale) >> kZShift;
  for (int j = 0; j <= ny_; ++j) {
    for (int i = 0; i <= nx_; ++i) {
      const int corner = slot(i, j);
      std::uint32_t& packed_normal = corner_normal_[index(corner)];
      if (packed_normal >> kZShift >= steep || is_split(corner)) continue;
      glm::vec2 mean(0);
      for (const int offset : kQuadrantOffset)
        mean +=
            0.25f * glm::vec2(slope_x_[index(corner + offset)], slope_y_[index(corner + offset)]);
      const glm::vec3 normal = glm::normalize(glm::vec3(-turned_if_steep(corner, mean), 1));
      packed_normal = packed(normal.x, normal.y, normal.z);
    }
  }
}

glm::vec2 Relief::turned_if_steep(int corner, const glm::vec2& slope) const {
  if (glm::dot(slope, slope) <= SurfaceSlopes::kSteepest * SurfaceSlopes::kSteepest) return slope;
  const int i = i0_ + corner % kStride - kHalo, j = j0_ + corner / kStride - kHalo;
  return slope_across_course(
      i, j, slope, WallCourse::kMaxReach - 1,
      [this](int x, int y) { return std::max(grid_.height(x, y), floor_); },
      [this](int x, int y) { return grid_.contains(x, y); });
}

Relief::Vertex Relief::vertex(int corner, std::size_t quadrant) const {
  if (!is_split(corner)) return {corner_z(corner), corner_normal(corner)};
  const auto cell = [corner](std::size_t q) { return index(corner + kQuadrantOffset[q]); };
  const std::array<bool, 4> link = links_about(corner);  // at most two of the four
  unsigned group = 1u << quadrant;
  for (int round = 0; round < 2; ++round) {
    for (std::size_t q = 0; q < 4; ++q) {
      const unsigned both = 1u << q | 1u << (q + 1) % 4;
      if (link[q] && (group & both) != 0) group |= both;
    }
  }
  // In the order of the quadrants, as the patches do, for the same rounding.
  float sum = 0, low = height_[cell(quadrant)], high = low, count = 0;
  glm::vec2 slope(0);
  for (std::size_t q = 0; q < 4; ++q) {
    if ((group & 1u << q) == 0) continue;
    const float h = height_[cell(q)];
    sum += h;
    low = std::min(low, h);
    high = std::max(high, h);
    slope += glm::vec2(slope_x_[cell(q)], slope_y_[cell(q)]);
    count += 1;
  }
  slope = turned_if_steep(corner, slope / count);
  return {std::clamp(sum / count, low, high),
          pack_normal(glm::normalize(glm::vec3(-slope.x, -slope.y, 1)))};
}

glm::vec2 Relief::shift(int i, int j) const {
  const int corner = slot(i, j);
  if (!is_split(corner)) return glm::vec2(0);
  const auto about = [&](std::size_t q) { return height(corner + kQuadrantOffset[q]); };
  return wall_shift(
      i0_ + i, j0_ + j, {about(0), about(1), about(2), about(3)}, links_about(corner),
      WallShift::kMaxReach, [this](int x, int y) { return std::max(grid_.height(x, y), floor_); },
      [this](int x, int y) { return grid_.contains(x, y); });
}

float Relief::highest_about(int cell) const {
  float highest = floor_;
  for (int row = -2; row <= 2; ++row)
    for (int k = -2; k <= 2; ++k) highest = std::max(highest, height(cell + row * kStride + k));
  return highest;
}

/// By corner, row by row.
using Shifts = std::array<glm::vec2, (kCells + 1) * (kCells + 1)>;

/// Fills in one cell and returns the greatest height of the surface over it, or more.
float add_cell(const Relief& relief, const Shifts& shifts, int i, int j,
               SurfaceTile::Detail* detail) {
  const int cell = slot(i, j);
  std::uint16_t& code = detail->code[index(j * kCells + i)];
  const std::size_t low = index(j * (kCells + 1) + i), high = low + kCells + 1;
  const std::array<glm::vec2, 4> shift{shifts[low], shifts[low + 1], shifts[high + 1],
                                       shifts[high]};
  const bool is_moved = std::any_of(shift.begin(), shift.end(),
                                    [](const glm::vec2& by) { return by != glm::vec2(0); });
  if (!relief.solid(cell)) {
    code = 0;
    if (!is_moved) return SurfaceTile::kNothing;
    detail->splits.push_back({{}, {}, shift, true});
    code = static_cast<std::uint16_t>(detail->splits.size() << 2);
    return relief.highest_about(cell);
  }
  const std::array<int, 4> corner{slot(i, j), slot(i + 1, j), slot(i + 1, j + 1), slot(i, j + 1)};
  std::array<float, 4> z;
  unsigned split = 0;
  const bool is_split = relief.is_split(corner[0]) || relief.is_split(corner[1]) ||
                        relief.is_split(corner[2]) || relief.is_split(corner[3]);
  if (is_split) [[unlikely]] {
    SurfaceTile::SplitCell& at = detail->splits.emplace_back();
    at.shift = shift;
    at.is_moved = is_moved;
    split = static_cast<unsigned>(detail->splits.size());
    for (std::size_t k = 0; k < 4; ++k) {
      // The cell is the C of its corner a, the D of b, the A of c, the B of d.
      const Relief::Vertex vertex = relief.vertex(corner[k], (k + 2) % 4);
      at.z[k] = z[k] = vertex.z;
      at.normal[k] = vertex.normal;
    }
  } else {
    for (std::size_t k = 0; k < 4; ++k) z[k] = relief.corner_z(corner[k]);
  }
  const float twice = 2 * relief.height(cell);
  const bool rising =
      is_moved ? has_rising_diagonal(z, twice, shift) : has_rising_diagonal(z, twice);
  code = static_cast<std::uint16_t>(1u | (rising ? 2u : 0u) | split << 2);
  if (is_moved) return relief.highest_about(cell);
  return std::max(std::max(z[0], z[1]), std::max(z[2], z[3]));
}

}  // namespace

SurfaceTile make_surface_tile(const HeightGrid& grid, int tx, int ty) {
  Relief relief(grid, tx, ty);
  SurfaceTile tile;
  tile.block_top.fill(SurfaceTile::kNothing);
  if (relief.is_level()) {
    if (relief.solid(slot(0, 0))) tile.top = relief.height(slot(0, 0));
    tile.block_top.fill(tile.top);
    return tile;
  }
  relief.find_surface(static_cast<float>(grid.cell_x_mm()), static_cast<float>(grid.cell_y_mm()));
  auto detail = std::make_unique<SurfaceTile::Detail>();
  detail->code.fill(0);
  Shifts shifts;
  shifts.fill(glm::vec2(0));
  for (int j = 0; j <= relief.ny(); ++j) {
    for (int i = 0; i <= relief.nx(); ++i) {
      shifts[index(j * (kCells + 1) + i)] = relief.shift(i, j);
      detail->z[index(j * (kCells + 1) + i)] = relief.corner_z(slot(i, j));
      detail->normal[index(j * (kCells + 1) + i)] = relief.corner_normal(slot(i, j));
    }
  }
  for (int j = 0; j < relief.ny(); ++j) {
    for (int i = 0; i < relief.nx(); ++i) {
      const float top = add_cell(relief, shifts, i, j, detail.get());
      float& of_block = tile.block_top[index(j / SurfaceTile::kBlockCells * SurfaceTile::kBlocks +
                                             i / SurfaceTile::kBlockCells)];
      of_block = std::max(of_block, top);
    }
  }
  tile.top = *std::max_element(tile.block_top.begin(), tile.block_top.end());
  if (tile.top > SurfaceTile::kNothing) tile.detail = std::move(detail);
  return tile;
}

}  // namespace kerf
