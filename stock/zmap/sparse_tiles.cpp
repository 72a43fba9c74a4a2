#include "stock/zmap/sparse_tiles.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "stock/zmap/height_mesh_parallel.h"
#include "stock/zmap/tile_cut_ids.h"
#include "stock/zmap/tile_patch_builder.h"
#include "surface/tile_relief.h"
#include "surface/wall_shift.h"

namespace kerf {
namespace {

using Side = TileNetwork::Side;
constexpr int kLine = TileNetwork::kLine;

/// Of a tile's corners, by corner of the lattice.
using Groups = std::array<std::uint32_t, std::size_t{kLine} * kLine>;

/// The number of a move's group; asks once for moves that come one after another.
class GroupOf {
 public:
  explicit GroupOf(const SparseOptions& options) : options_(options) {}
  std::uint32_t operator()(std::uint32_t move) {
    if (!is_known_ || move != move_) {
      move_ = move;
      group_ = options_.group_of(move);
      is_known_ = true;
    }
    return group_;
  }

 private:
  const SparseOptions& options_;
  bool is_known_ = false;
  std::uint32_t move_ = 0, group_ = 0;
};

void find_groups(const TileRelief& relief, const TileCutIds& cut_ids, const SparseOptions& options,
                 Groups& groups) {
  GroupOf group_of(options);
  for (int j = 0; j <= relief.ny(); ++j) {
    for (int i = 0; i <= relief.nx(); ++i)
      groups[TileNetwork::Lattice::corner(i, j)] =
          group_of(cut_ids.at_corner(relief, TileRelief::slot(i, j)));
  }
}

void fill_lattice(const TileRelief& relief, const Groups* groups, TileNetwork::Lattice& lattice) {
  using Lattice = TileNetwork::Lattice;
  lattice.cell.fill(TileNetwork::Cell::kVoid);
  for (int j = 0; j <= relief.ny(); ++j) {
    for (int i = 0; i <= relief.nx(); ++i)
      lattice.z[Lattice::corner(i, j)] = relief.corner_z(TileRelief::slot(i, j));
  }
  for (int j = 0; j < relief.ny(); ++j) {
    for (int i = 0; i < relief.nx(); ++i) {
      const int cell = TileRelief::slot(i, j);
      if (!relief.solid(cell)) continue;
      const std::array<std::size_t, 4> corner{Lattice::corner(i, j), Lattice::corner(i + 1, j),
                                              Lattice::corner(i + 1, j + 1),
                                              Lattice::corner(i, j + 1)};
      bool is_kept = relief.is_split(cell) || relief.is_split(cell + 1) ||
                     relief.is_split(cell + TileRelief::kStride) ||
                     relief.is_split(cell + TileRelief::kStride + 1);
      std::array<float, 4> z;
      for (std::size_t k = 0; k < 4; ++k) {
        z[k] = lattice.z[corner[k]];
        is_kept = is_kept || (groups && (*groups)[corner[k]] != (*groups)[corner[0]]);
      }
      const bool is_rising = has_rising_diagonal(z, 2 * relief.height(cell));
      lattice.middle[Lattice::at(i, j)] = (is_rising ? z[0] + z[2] : z[1] + z[3]) / 2;
      lattice.cell[Lattice::at(i, j)] =
          is_kept ? TileNetwork::Cell::kKept : TileNetwork::Cell::kFree;
    }
  }
}

/// Whether a wall that reaches the floor has moved the floor's corner.
bool is_moved_below(const TileRelief& relief, int i, int j) {
  const int corner = TileRelief::slot(i, j);
  if (!relief.is_split(corner) || relief.shift(i, j) == glm::vec2(0)) return false;
  return std::ranges::any_of(TileRelief::cells_about(corner),
                             [&](int cell) { return !relief.solid(cell); });
}

bool has_plain_floor(const TileRelief& relief) {
  constexpr int n = kTileCells;
  if (relief.nx() != n || relief.ny() != n) return false;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i)
      if (!relief.solid(TileRelief::slot(i, j))) return false;
  }
  for (int k = 0; k <= n; ++k) {
    if (is_moved_below(relief, k, 0) || is_moved_below(relief, k, n) ||
        is_moved_below(relief, 0, k) || is_moved_below(relief, n, k))
      return false;
  }
  return true;
}

}  // namespace

SparseTiles::SparseTiles(const TileGrid& grid, const SparseOptions& options)
    : grid_(grid), tiles_(grid.tile_count()) {
  parallel_parts(tiles_.size(), 8, options.threads, [&](std::size_t begin, std::size_t end) {
    const auto lattice = std::make_unique<TileNetwork::Lattice>();
    const auto groups = std::make_unique<Groups>();
    const bool has_groups = options.group_of && grid_.keeps_cut_ids();
    for (std::size_t tile = begin; tile < end; ++tile) {
      const TileRelief relief(grid_, tile, 0);
      if (has_groups) find_groups(relief, TileCutIds(grid_, tile, 0), options, *groups);
      fill_lattice(relief, has_groups ? groups.get() : nullptr, *lattice);
      tiles_[tile].network = TileNetwork(*lattice, static_cast<float>(options.most_mm));
      tiles_[tile].is_plain = has_plain_floor(relief);
    }
  });
  join_rims();
}

/// What one tile needs of a rim the other needs as well, and what it needs for that.
void SparseTiles::join_rims() {
  const auto row = static_cast<std::size_t>(grid_.tiles_x());
  for (bool is_changed = true; is_changed;) {
    is_changed = false;
    const auto join = [&](std::size_t one, Side side, std::size_t other, Side its_side) {
      const bool is_first = tiles_[one].network.add_rim(side, tiles_[other].network.rim(its_side));
      const bool is_other = tiles_[other].network.add_rim(its_side, tiles_[one].network.rim(side));
      is_changed = is_changed || is_first || is_other;
    };
    for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
      if (tile % row + 1 < row) join(tile, Side::kRight, tile + 1, Side::kLeft);
      if (tile + row < tiles_.size()) join(tile, Side::kHigh, tile + row, Side::kLow);
    }
  }
}

const SparseTiles::Tile* SparseTiles::beside(std::size_t tile, int dx, int dy) const {
  const int x = static_cast<int>(tile) % grid_.tiles_x() + dx;
  const int y = static_cast<int>(tile) / grid_.tiles_x() + dy;
  if (x < 0 || y < 0 || x >= grid_.tiles_x() || y >= grid_.tiles_y()) return nullptr;
  return &tiles_[static_cast<std::size_t>(y * grid_.tiles_x() + x)];
}

MeshPatch SparseTiles::patch(std::uint32_t tile) const {
  MeshPatch patch;
  patch.tile = tile;
  const TileRelief relief(grid_, tile, 0);
  std::optional<TileCutIds> cut_ids;
  if (grid_.keeps_cut_ids()) cut_ids.emplace(grid_, tile, 0);
  const auto is_plain = [&](int dx, int dy) {
    const Tile* const other = beside(tile, dx, dy);
    return other && other->is_plain;
  };
  PatchSides sides;
  sides.left.has_neighbor = beside(tile, -1, 0) != nullptr;
  sides.right.has_neighbor = beside(tile, 1, 0) != nullptr;
  sides.low.has_neighbor = beside(tile, 0, -1) != nullptr;
  sides.high.has_neighbor = beside(tile, 0, 1) != nullptr;
  TilePatchBuilder builder(relief, cut_ids ? &*cut_ids : nullptr, sides, patch);
  builder.add_sparse_surface(
      tiles_[tile].network,
      {tiles_[tile].is_plain, is_plain(-1, 0), is_plain(1, 0), is_plain(0, -1), is_plain(0, 1)});
  if (cut_ids) patch.cut_by.resize(patch.vertices.size(), MeshPatch::kNotCut);
  return patch;
}

}  // namespace kerf
