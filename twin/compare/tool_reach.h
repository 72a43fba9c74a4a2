// twin/compare/tool_reach.h - how deep a tool comes over a design without cutting into it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/geometry.h"
#include "stock/cutter/cutter.h"

namespace kerf {

/// A point of a design between the middles of cells, from the grid's corner of low x, y.
struct WallPoint {
  float x_mm = 0, y_mm = 0, z_mm = 0;
};

/// A design as one height a cell, over which upright tools are let down until they touch it.
///
///                 tool, as low as it comes        With D the design and h the tool's surface above
///      __            |      |       __            its tip (infinite beyond its radius) the tip's
///        \           |      |      /              lowest place is
///         \ _ _ _ _ _ \____/ _ _ _/  <- left      T(p) = max over c of D(c) - h(|c - p|), and what
///          \_____________________/   <- design    all places together leave is
///                                                 E(c) = min over p of T(p) + h(|c - p|):
/// the closing of the design by the tool. Nothing that is lower than E can be cut by it.
///
/// Cells count by their middles, the design is free beyond the grid, and the tool may stand there.
/// Its places p are the middles of cells, their corners and the middles of their edges; so a tool
/// goes into a slot along X or Y that is as wide as the tool, wherever the slot lies on the grid.
/// Shank and holder are not looked at, nor how long the flutes are; of a cutter with an undercut
/// the lower side counts.
///
/// A ball of 60 cells over all of 1000 x 1000 that it reaches nowhere alike: 0.9 s; far less where
/// the design is level, and for fewer cells. One thread.
/// Source: the inverse tool offset, as in A. Kishinami, T. Kondo, K. Saito, "Inverse offset method
/// for cutter path generation", 1987; grey-scale closing, S. Sternberg, "Grayscale morphology",
/// 1986.
class ToolReach {
 public:
  /// `design_mm`: row by row from low x, y; -infinity where there is no design. `walls`: what else
  /// the tool must not cut into.
  ToolReach(int nx, int ny, const Vec2& cell_mm, std::span<const float> design_mm,
            std::span<const WallPoint> walls = {});

  /// A wider cutter takes too much memory.
  static constexpr int kMostCellsAcross = 4096;
  bool takes(const Cutter& cutter) const;

  static constexpr float kNotAsked = std::numeric_limits<float>::infinity();
  /// E of the cells that are `wanted` (not 0), kNotAsked in others. Where the tool comes as near to
  /// the design as `enough_mm` it is not looked at more closely. -infinity: it goes through.
  std::vector<float> lowest_mm(const Cutter& cutter, std::span<const std::uint8_t> wanted,
                               float enough_mm) const;

 private:
  void raise_by_walls(const Cutter& cutter, const Vec2& shift, int bx, int by,
                      std::span<float> tips) const;

  int nx_, ny_;
  Vec2 cell_mm_;
  float low_mm_;  ///< of the design
  std::vector<float> design_mm_;
  std::vector<WallPoint> walls_;  ///< block by block
  std::vector<std::size_t> first_wall_;
};

}  // namespace kerf
