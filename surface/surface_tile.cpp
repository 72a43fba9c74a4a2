#include "surface/surface_tile.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "base/mesh_patch.h"
#include "surface/tile_relief.h"

namespace kerf {
namespace {

constexpr int kCells = SurfaceTile::kCells;
static_assert(TileRelief::kCornerReach <= kSurfaceReach);

std::size_t index(int i) { return static_cast<std::size_t>(i); }
int slot(int i, int j) { return TileRelief::slot(i, j); }

/// Of the surface over the cell, if corners are moved: no less than any cell's whose corners are
/// the cell's neighbours'.
float highest_about(const TileRelief& relief, int cell) {
  float highest = relief.floor();
  for (int row = -2; row <= 2; ++row)
    for (int k = -2; k <= 2; ++k)
      highest = std::max(highest, relief.height(cell + row * TileRelief::kStride + k));
  return highest;
}

/// By corner, row by row.
using Shifts = std::array<glm::vec2, (kCells + 1) * (kCells + 1)>;

/// Fills in one cell and returns the greatest height of the surface over it, or more.
float add_cell(const TileRelief& relief, const Shifts& shifts, int i, int j,
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
    return highest_about(relief, cell);
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
      if (!relief.is_split(corner[k])) {
        at.z[k] = z[k] = relief.corner_z(corner[k]);
        at.normal[k] = relief.corner_normal(corner[k]);
        continue;
      }
      const TileRelief::Meeting meeting = relief.meeting(corner[k], (k + 2) % 4);
      at.z[k] = z[k] = meeting.z;
      at.normal[k] = pack_normal(glm::normalize(glm::vec3(-meeting.slope, 1)));
    }
  } else {
    for (std::size_t k = 0; k < 4; ++k) z[k] = relief.corner_z(corner[k]);
  }
  const float twice = 2 * relief.height(cell);
  const bool rising =
      is_moved ? has_rising_diagonal(z, twice, shift) : has_rising_diagonal(z, twice);
  code = static_cast<std::uint16_t>(1u | (rising ? 2u : 0u) | split << 2);
  if (is_moved) return highest_about(relief, cell);
  return std::max(std::max(z[0], z[1]), std::max(z[2], z[3]));
}

}  // namespace

SurfaceTile make_surface_tile(const HeightGrid& grid, int tx, int ty) {
  TileRelief relief(TilesAbout(grid, tx, ty), 0);
  SurfaceTile tile;
  tile.block_top.fill(SurfaceTile::kNothing);
  if (relief.is_level()) {
    if (relief.solid(slot(0, 0))) tile.top = relief.height(slot(0, 0));
    tile.block_top.fill(tile.top);
    return tile;
  }
  relief.find_surface();
  auto detail = std::make_unique<SurfaceTile::Detail>();
  detail->code.fill(0);
  Shifts shifts;
  shifts.fill(glm::vec2(0));
  for (int j = 0; j <= relief.ny(); ++j) {
    for (int i = 0; i <= relief.nx(); ++i) {
      if (relief.is_split(slot(i, j))) shifts[index(j * (kCells + 1) + i)] = relief.shift(i, j);
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
