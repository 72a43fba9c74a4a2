#include "stock/zmap/tile_patch.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <array>
#include <cassert>
#include <optional>

#include "stock/stock_model.h"
#include "stock/zmap/tile_cut_ids.h"
#include "stock/zmap/tile_patch_builder.h"
#include "surface/tile_relief.h"

namespace kerf {
namespace {

/// A neighbour's border lies, whatever its level, no lower than all cells that the coarsest level
/// joins with those about the border.
PatchSides sides_of(const TileGrid& grid, std::uint32_t tile) {
  constexpr int kReach = 1 << (StockModel::kPatchLevels - 1);
  const int tx = static_cast<int>(tile) % grid.tiles_x();
  const int ty = static_cast<int>(tile) / grid.tiles_x();
  const int x0 = tx * kTileCells, y0 = ty * kTileCells;
  const int x1 = x0 + kTileCells, y1 = y0 + kTileCells;
  const auto across_x = [&](bool has_neighbor, int x) {
    return PatchSide{has_neighbor, glm::vec2(x == x0 ? -1 : 1, 0),
                     grid.lowest_mm(x - kReach, y0 - kReach, x + kReach, y1 + kReach)};
  };
  const auto across_y = [&](bool has_neighbor, int y) {
    return PatchSide{has_neighbor, glm::vec2(0, y == y0 ? -1 : 1),
                     grid.lowest_mm(x0 - kReach, y - kReach, x1 + kReach, y + kReach)};
  };
  return {across_x(tx > 0, x0), across_x(tx + 1 < grid.tiles_x(), x1), across_y(ty > 0, y0),
          across_y(ty + 1 < grid.tiles_y(), y1)};
}

}  // namespace

MeshPatch make_tile_patch(const TileGrid& grid, std::uint32_t tile, int level) {
  assert(tile < grid.tile_count() && level >= 0 && level < StockModel::kPatchLevels);
  MeshPatch patch;
  patch.tile = tile;
  patch.level = level;
  patch.tiles_in_row = static_cast<std::uint32_t>(grid.tiles_x());
  const TileRelief relief(grid, tile, level);
  std::optional<TileCutIds> cut_ids;
  if (grid.keeps_cut_ids()) cut_ids.emplace(grid, tile, level);
  TilePatchBuilder builder(relief, cut_ids ? &*cut_ids : nullptr, sides_of(grid, tile), patch);
  builder.add_surface();
  builder.add_skirts();
  if (cut_ids) patch.cut_by.resize(patch.vertices.size(), MeshPatch::kNotCut);
  // A level tile fills a small part of what was reserved, and patches are kept until uploaded.
  if (2 * patch.vertices.size() < patch.vertices.capacity()) patch.vertices.shrink_to_fit();
  if (2 * patch.cut_by.size() < patch.cut_by.capacity()) patch.cut_by.shrink_to_fit();
  if (2 * patch.indices.size() < patch.indices.capacity()) patch.indices.shrink_to_fit();
  return patch;
}

std::uint64_t tile_patch_version(const TileGrid& grid, std::uint32_t tile) {
  const int tx = static_cast<int>(tile) % grid.tiles_x();
  const int ty = static_cast<int>(tile) / grid.tiles_x();
  std::array<std::uint64_t, 9> versions{};
  std::size_t n = 0;
  for (int y = ty - 1; y <= ty + 1; ++y) {
    for (int x = tx - 1; x <= tx + 1; ++x, ++n) {
      if (x < 0 || y < 0 || x >= grid.tiles_x() || y >= grid.tiles_y()) continue;
      versions[n] = grid.version(static_cast<std::size_t>(y * grid.tiles_x() + x));
    }
  }
  return XXH3_64bits(versions.data(), sizeof versions);
}

}  // namespace kerf
