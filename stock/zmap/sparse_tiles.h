// stock/zmap/sparse_tiles.h - patches of a height grid with few triangles where it is plain.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "stock/sparse_surface.h"
#include "stock/zmap/tile_grid.h"
#include "surface/tile_network.h"

namespace kerf {

/// A TileNetwork over the surface of each tile (tile_patch.h); rims that two tiles share have the
/// same corners. Walls, and cells at corners that are split, stay as they are. Shares the grid's
/// tiles. About 0.1 ms a tile, and as much for each patch; 0.5 KB a tile.
class SparseTiles final : public SparseSurface {
 public:
  SparseTiles(const TileGrid& grid, const SparseOptions& options);
  MeshPatch patch(std::uint32_t tile) const override;

 private:
  struct Tile {
    TileNetwork network;
    bool is_plain = false;  ///< below: a whole tile, of which all cells have material
  };
  void join_rims();
  const Tile* beside(std::size_t tile, int dx, int dy) const;

  TileGrid grid_;
  std::vector<Tile> tiles_;
};

}  // namespace kerf
