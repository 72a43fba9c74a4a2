// stock/octree/brick_tree.h - the whole workpiece: columns of tiles of bricks.
//
//   column   a stack of tiles from the floor to the top, 32 x 32 nodes seen from above
//   tile     4 x 4 x 4 bricks (32 nodes along an axis)
//   brick    8 x 8 x 8 nodes
// A tile or brick that is all empty or all solid is one word. Below the bricks the halving goes on
// while cutting (blocks of 4 nodes, then nodes).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "stock/octree/brick.h"

namespace kerf::octree {

inline constexpr int kTileBricks = 4;                    ///< along an axis
inline constexpr int kTileNodes = kTileBricks * kBrick;  ///< along an axis
inline constexpr int kBricksInTile = kTileBricks * kTileBricks * kTileBricks;

/// Where the nodes are. The outermost ones lie half a cell outside of the blank, so that its faces
/// cut edges in half.
struct Lattice {
  Box bounds_mm;      ///< of the blank
  Vec3 origin_mm{0};  ///< node (0, 0, 0)
  Vec3 cell_mm{0};
  std::array<int, 3> cells{};  ///< of the blank; nodes 1 .. cells are inside
  std::array<int, 3> tiles{};

  static Lattice over(const Box& blank, double cell_mm);
  static Lattice of_cells(const Box& blank, const std::array<int, 3>& cells);
  double place_mm(int axis, int node) const { return origin_mm[axis] + node * cell_mm[axis]; }
  double node_mm3() const { return cell_mm.x * cell_mm.y * cell_mm.z; }
  int column_count() const { return tiles[0] * tiles[1]; }
  std::array<int, 3> tile_at(std::uint32_t tile) const {
    const int n = static_cast<int>(tile);
    return {n % tiles[0], n / tiles[0] % tiles[1], n / (tiles[0] * tiles[1])};
  }
};

struct Tile : Counted {
  std::uint64_t version = 0;       ///< a new number with every change
  BrickRef bricks[kBricksInTile];  ///< x fastest, then y
  static void destroy(Tile* tile) { delete tile; }
};
using TileRef = SparseRef<Tile>;

struct Column : Counted {
  std::vector<TileRef> tiles;
  static void destroy(Column* column) { delete column; }
};
using ColumnRef = SparseRef<Column>;

/// Copying is cheap: copies share columns until one of them writes.
class BrickTree {
 public:
  explicit BrickTree(const Lattice& lattice);  ///< all empty
  const Lattice& lattice() const { return lattice_; }
  bool keeps_ids() const { return keeps_ids_; }
  void keep_ids(bool keep);

  /// Tile numbers: x fastest, then y, then z.
  std::size_t tile_count() const {
    return columns_.size() * static_cast<std::size_t>(lattice_.tiles[2]);
  }
  const TileRef& tile(std::uint32_t number) const {
    return columns_[number % columns_.size()]->tiles[number / columns_.size()];
  }
  const TileRef& tile(int column, int level) const {
    return columns_[static_cast<std::size_t>(column)]->tiles[static_cast<std::size_t>(level)];
  }
  /// Of a brick by its place in the whole; empty beyond the ends.
  const BrickRef& brick(int bx, int by, int bz) const;

  /// The tile as an object that is nobody else's, to be written: with `version`. Different columns
  /// may be written at the same time.
  Tile& own_tile(int column, int level, std::uint64_t version);
  /// To be called after writing: a tile that has become all empty or all solid is one word.
  void settle_tile(int column, int level);
  void set_tile(int column, int level, TileRef tile);

  /// Bits of the 2 x 2 x 2 blocks of a brick that no sweep has come near so far: there the blank is
  /// as it was. None unless follow_reach() was called before the first.
  unsigned untouched(int bx, int by, int bz) const {
    return reached_ ? ~unsigned{(*reached_)[brick_index(bx, by, bz)]} & 0xffu : 0u;
  }
  void follow_reach();
  /// Before note_reach(), which may be called for different bricks at the same time.
  void own_reach();
  void note_reach(int bx, int by, int bz, unsigned blocks) {
    if (reached_) (*reached_)[brick_index(bx, by, bz)] |= static_cast<std::uint8_t>(blocks);
  }
  std::size_t unique_bytes() const;
  std::size_t brick_count() const;
  /// Hash of all but ids, 32 hex digits.
  std::string digest() const;
  /// Tiles that differ, ascending; ids count if both keep them.
  std::vector<std::uint32_t> differing(const BrickTree& other) const;
  std::uint64_t version(std::uint32_t tile) const;

 private:
  Column& own_column(int column);
  std::size_t brick_index(int bx, int by, int bz) const {
    const auto along = [&](std::size_t axis) {
      return static_cast<std::size_t>(lattice_.tiles[axis]) * kTileBricks;
    };
    const auto at = [](int n) { return static_cast<std::size_t>(n); };
    return (at(bz) * along(1) + at(by)) * along(0) + at(bx);
  }
  Lattice lattice_;
  bool keeps_ids_ = false;
  std::vector<ColumnRef> columns_;
  std::shared_ptr<std::vector<std::uint8_t>> reached_;  ///< by brick_index(); copies share it
};

/// Never the same twice in a process.
std::uint64_t next_version();

}  // namespace kerf::octree
