// stock/zmap/mmap/gap_grid.h - what is hollow below the heights of a grid, in copy-on-write tiles.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "stock/zmap/sweep_ops.h"

namespace kerf {

/// Material of a column that is not there, between its floor and its height, mm. The numbers are
/// those of the moves that made its two ends (MeshPatch::kNotCut if unknown).
struct Gap {
  float low = 0, high = 0;
  std::uint32_t low_id = 0, high_id = 0;
  bool operator==(const Gap&) const = default;
};

/// Material thinner than this between two gaps, above a gap or below one is not kept, mm. It comes
/// from rounding where sweeps touch: the accuracy that heights are promised with.
inline constexpr float kThinnest_mm = 1e-4f;

/// The gaps of one tile: for each cell a list from the top downward, with material between them.
class GapTile {
 public:
  static constexpr float kNoTop = -std::numeric_limits<float>::infinity();

  GapTile() {
    first_.fill(kNone);
    tops_.fill(kNoTop);
  }
  bool empty() const { return count_ == 0; }
  bool has(std::size_t cell) const { return first_[cell] != kNone; }
  /// All gaps lie below this: the highest that there has been. kNoTop: there was none.
  float below_mm() const { return below_mm_; }
  /// Upper ends of the topmost gaps by cell, kNoTop where there is none. Stays where it is.
  const float* tops() const { return tops_.data(); }
  /// Calls see(gap) for each of a cell's gaps, the topmost first.
  template <class See>
  void each(std::size_t cell, const See& see) const {
    for (std::int32_t n = first_[cell]; n != kNone; n = nodes_[index(n)].next)
      see(nodes_[index(n)].gap);
  }
  /// Appends them to `out`.
  void read(std::size_t cell, std::vector<Gap>& out) const {
    each(cell, [&](const Gap& gap) { out.push_back(gap); });
  }
  void write(std::size_t cell, std::span<const Gap> gaps);
  /// Takes the topmost gap out of a cell that has one.
  Gap pop(std::size_t cell);
  std::size_t bytes() const { return sizeof *this + nodes_.capacity() * sizeof(Node); }
  /// `ids`: numbers of moves count as well.
  bool equals(const GapTile& other, bool ids) const;
  std::uint64_t hash() const;

 private:
  static constexpr std::int32_t kNone = -1;
  struct Node {
    Gap gap;
    std::int32_t next = kNone;
  };
  static std::size_t index(std::int32_t n) { return static_cast<std::size_t>(n); }

  void free_node(std::int32_t node) {
    nodes_[index(node)].next = free_;
    free_ = node;
    --count_;
  }
  void set_top(std::size_t cell) {
    tops_[cell] = first_[cell] == kNone ? kNoTop : nodes_[index(first_[cell])].gap.high;
  }

  alignas(64) std::array<float, kTileFloats> tops_;
  std::array<std::int32_t, kTileFloats> first_;
  std::vector<Node> nodes_;
  std::int32_t free_ = kNone;
  std::size_t count_ = 0;
  float below_mm_ = kNoTop;
};

/// A tile without gaps is a null pointer. Copies share tiles until one of them writes; they may be
/// read and dropped on different threads (as with TileGrid).
class GapGrid {
 public:
  explicit GapGrid(std::size_t tile_count)
      : tiles_(tile_count), meetings_(std::make_shared<std::atomic<unsigned>>(0)) {}
  GapGrid(const GapGrid&) = default;
  ~GapGrid() { meet_other_grids(); }

  const GapTile* tile(std::size_t i) const { return tiles_[i].get(); }
  bool any() const;
  /// Where the tile's gaps may be written until the grid is copied. Calls for different tiles may
  /// run at the same time.
  GapTile& make_writable(std::size_t i);
  /// To be called when a tile was written: an empty one is forgotten.
  void drop_if_empty(std::size_t i);
  /// Memory of the tiles that no other grid shares.
  std::size_t unique_bytes() const;

 private:
  void meet_other_grids() const { meetings_->fetch_add(1, std::memory_order_acq_rel); }
  std::vector<std::shared_ptr<GapTile>> tiles_;
  std::shared_ptr<std::atomic<unsigned>> meetings_;  ///< one for all copies of a grid
};

}  // namespace kerf
