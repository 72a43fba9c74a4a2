// stock/zmap/packed_tile.h - a tile of heights in less memory, to the bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kerf {

/// Heights of a tile and, where they are kept, the numbers of moves behind them (sweep_ops.h), for
/// as long as nobody looks at them. A surface that was cut takes some 16 bits a height and some 4 a
/// number; what is flat takes next to none. Nothing is lost: -0, infinities and NaN stay what they
/// are.
///
/// A cell is told from its neighbours of the same lane in the blocks to the left, below and between
/// the two; each kKind of doing so is tried for 64 cells, and what is left of them is written in as
/// many bits as the greatest one takes. 2 to 4 GB a second, either way.
class PackedTile {
 public:
  PackedTile(const float* cells, bool has_cut_ids);
  /// Into as many cells as it was made of.
  void unpack(float* cells) const;
  std::size_t bytes() const { return sizeof *this + data_.capacity(); }

 private:
  std::vector<std::uint8_t> data_;
  bool has_cut_ids_;
};

}  // namespace kerf
