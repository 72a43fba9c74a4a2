// stock/sheet/tile.h - the part of the sheet that lies in one square of the tiling.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "stock/sheet/polygon.h"

namespace kerf::sheet {

/// A ring as tiles share it: never changed once it is made.
struct TileRing {
  Ring points;
  Rect box;
  std::int64_t area2 = 0;  ///< twice the area; negative for a hole
  bool is_outer() const { return area2 > 0; }
};
using TileRingPointer = std::shared_ptr<const TileRing>;
TileRingPointer make_tile_ring(Ring points);

/// Sides of a tile, and the one opposite: (side + 2) % 4.
enum BorderSide : std::uint8_t { kLeft, kBottom, kRight, kTop };

/// A stretch of a tile's border on which its material reaches the border: along x for kBottom and
/// kTop, along y for the others.
struct BorderRun {
  Unit low = 0, high = 0;
  std::uint32_t ring = 0;  ///< an outer one
  BorderSide side = kLeft;
};

/// Two runs that share less than this (1 um) do not hold two tiles' material together.
inline constexpr Unit kMinBridge = 10;

inline bool bridges(const BorderRun& a, const BorderRun& b) {
  return (a.low > b.low ? a.low : b.low) + kMinBridge <= (a.high < b.high ? a.high : b.high);
}

inline constexpr std::uint32_t kNoPiece = 0xffff'ffff;

/// Never changed while copies of a sheet share it. Copying one copies pointers.
struct Tile {
  std::vector<TileRingPointer> rings;
  /// Of each ring: the piece of the sheet that it belongs to (pieces.h); kNoPiece for holes.
  std::vector<std::uint32_t> pieces;
  /// By side, then along it. Those of a side: from first_run[side] to first_run[side + 1].
  std::vector<BorderRun> runs;
  std::array<std::uint32_t, 5> first_run{};
  std::int64_t area2 = 0;
  /// Equal numbers mean equal rings, whichever copies of a sheet the tiles come from.
  std::uint64_t version = 0;
};
using TilePointer = std::shared_ptr<const Tile>;

inline std::span<const BorderRun> runs_of(const Tile& tile, BorderSide side) {
  return std::span(tile.runs).subspan(tile.first_run[side],
                                      tile.first_run[side + 1u] - tile.first_run[side]);
}

/// Takes rings of a region within `rect`; all of no piece yet. Gives it a version of its own.
Tile make_tile(const Rect& rect, std::vector<TileRingPointer> rings);

/// For each ring the outer ring that it lies in: itself if it is outer, the owner of a hole.
std::vector<std::uint32_t> owners(const Tile& tile);

/// The outer ring of `tile`, one of `candidates`, that `ring` - a region cut out of the tile's
/// material, or a hole in it - is a part of. Borders move by half a unit in rounding, so the first
/// corner that is clearly in one ring tells.
std::uint32_t origin_of(const Ring& ring, const Tile& tile,
                        std::span<const std::uint32_t> candidates);

/// A fresh number, never the same twice in a process.
std::uint64_t next_version();

}  // namespace kerf::sheet
