// twin/compare/wall_finder.h - where between two cells a wall stands.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/geometry.h"
#include "mesh/column_lines.h"
#include "twin/process/kept_moves.h"

namespace kerf {

/// Of a grid of heights it is known that a wall stands between the middles of a low cell and of a
/// high one. The moves that cut there know where. One thread.
///
/// What a wall costs goes with the moves about it: it is given up for the rest of the walls once
/// kMostWork moves have been looked at (some seconds).
class WallFinder {
 public:
  /// `kept`: null: walls stand in the middle.
  WallFinder(const KeptMoves* kept, const ColumnGrid& grid) : kept_(kept), grid_(grid) {}

  struct Place {
    double share = 0.5;  ///< of the way from the low cell's middle to the high one's
    std::uint32_t label = MeshPatch::kNotCut;
    bool is_exact = false;  ///< to kFine of the way
  };
  /// Of the wall at this height, above the low cell. Cheapest for walls near each other.
  Place find(const Vec2& low_mm, const Vec2& high_mm, double z_mm);

  /// All that find() was asked for was exact.
  bool all_found() const { return all_found_; }

  static constexpr double kFine = 1.0 / 1024;
  static constexpr std::uint64_t kMostWork = 400'000'000;

 private:
  const KeptMoves::Near& near_to(const Vec2& at_mm);

  const KeptMoves* kept_;
  ColumnGrid grid_;
  std::optional<KeptMoves::Near> near_;
  int block_x_ = -1, block_y_ = -1;  ///< of cells, which `near_` is about
  std::uint64_t work_ = 0;
  bool all_found_ = true;
};

}  // namespace kerf
