// stock/zmap/wall_marks.h - where upright walls stand between the middles of two cells.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "stock/zmap/blank_grid.h"
#include "stock/zmap/cell_step.h"
#include "stock/zmap/tile_grid.h"

namespace kerf {

/// One way from the middle of a cell to that of a neighbour.
enum class CellWay : std::uint8_t { kRight, kLeft, kUp, kDown };  ///< along x, y

/// A tool that covered the middle of a cell, but not that of its neighbour, ended between the two
/// with an upright side: `reach` of the way there. From `foot_mm` upward nothing is left of the
/// way up to there.
struct WallMark {
  std::uint16_t cell = 0;  ///< TileGrid::offset() of the cell, and its CellWay above 12 bits
  std::uint8_t reach = 0;  ///< the part [reach, reach + 1) / 256
  std::uint8_t none = 0;
  float foot_mm = 0;

  static WallMark of(std::size_t offset, CellWay way, double part, double foot_mm) {
    const int units = static_cast<int>(part * kUnits);
    return {static_cast<std::uint16_t>(offset | static_cast<std::size_t>(way) << kWayShift),
            static_cast<std::uint8_t>(units < 0            ? 0
                                      : units > kUnits - 1 ? kUnits - 1
                                                           : units),
            0, static_cast<float>(foot_mm) + 0.0f};
  }
  std::size_t offset() const { return cell & ((std::size_t{1} << kWayShift) - 1); }
  CellWay way() const { return static_cast<CellWay>(cell >> kWayShift); }
  float part() const { return (static_cast<float>(reach) + 0.5f) / kUnits; }
  bool operator==(const WallMark&) const = default;

  static constexpr int kUnits = 256;
  static constexpr int kWayShift = 12;
  static_assert(kTileFloats == 1 << kWayShift);
};

struct PlacedMark {
  std::uint32_t tile = 0;
  WallMark mark;
};

/// The marks of a grid of heights, as a sparse table by tile. What counts is the profile that they
/// leave between two middles: of the marks of one way, those that reach farther than all deeper
/// ones, and stand lower than the neighbour. So it matters neither in which order marks come, nor
/// how often, nor when the others are dropped: heights only fall, and a mark that says nothing now
/// never will.
///
/// Copies share tiles; each changes its own from then on. Copying an object that nobody changes is
/// safe on several threads at once.
///
/// Memory: 8 bytes for each way that ends at a wall, and at most as much again for what has not
/// been dropped yet. Crossings on the
/// lines of a grid are the idea of enhanced Z-maps ("EZ-map").
class WallMarks {
 public:
  WallMarks() = default;
  explicit WallMarks(const TileGrid& grid) : tiles_(grid.tile_count()) {}
  WallMarks(const WallMarks& other);
  WallMarks(WallMarks&& other) noexcept : WallMarks() { *this = std::move(other); }
  WallMarks& operator=(const WallMarks&) = delete;
  WallMarks& operator=(WallMarks&& other) noexcept {
    tiles_.swap(other.tiles_);
    owner_.store(other.owner_.exchange(owner_.load()));
    return *this;
  }

  bool is_kept() const { return !tiles_.empty(); }
  /// `grid`: heights that already have what the mark's tool left.
  void add(std::size_t tile, const WallMark& mark, const TileGrid& grid);
  /// Drops what does not count, of tiles to which marks have been added since the last call.
  void settle(const TileGrid& grid);
  /// Those of a tile that count, by way and from the deepest up.
  std::vector<WallMark> marks(std::size_t tile, const TileGrid& grid) const;
  bool any() const;
  bool has_marks(std::size_t tile) const { return is_kept() && tiles_[tile] != nullptr; }
  /// Of tables that nobody shares.
  std::size_t unique_bytes() const;

 private:
  struct Tile {
    std::uint64_t owner = 0;
    bool is_settled = true;
    std::size_t drop_at = kLeastDrop;  ///< so many marks are looked through for what counts
    std::vector<WallMark> marks;
  };
  static constexpr std::size_t kLeastDrop = 256;
  static std::uint64_t next_owner();
  Tile& writable(std::size_t tile);

  std::vector<std::shared_ptr<Tile>> tiles_;
  /// Who may write to a tile: neither of the two after one was copied from the other.
  mutable std::atomic<std::uint64_t> owner_{next_owner()};
};

/// Of a mark that can be one of the grid's: as files may have it.
bool is_sound(const WallMark& mark, std::size_t tile, const TileGrid& grid);

/// Which marks are walls. Where heights go on smoothly from one cell to the next there is none.
enum class WallKind : std::uint8_t {
  kSharp,  ///< as surfaces show them (SurfaceSlopes): no low steps, none in a flank however steep
  kAll,    ///< all that do not lie in a slope below 45 degrees that goes on beyond the two cells
};

/// The walls between middles of cells, in order (by row, then column, then axis).
std::vector<CellStep> cell_steps(const TileGrid& grid, const WallMarks& marks,
                                 WallKind kind = WallKind::kSharp);

}  // namespace kerf
