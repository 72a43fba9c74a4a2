// stock/column_runs.h - a workpiece as solid runs of its columns: what hangs together is found from
// these.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/geometry.h"

namespace kerf {

/// Where a column is solid, mm.
struct SolidRun {
  float low_mm = 0, high_mm = 0;
};

/// The columns of a tile, x fastest; the runs of each from below upward.
struct ColumnRuns {
  int nx = 0, ny = 0;
  std::vector<std::uint32_t> first;  ///< run of each column; one more: the end of all
  std::vector<SolidRun> runs;

  std::size_t column(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i);
  }
};

/// How columns lie.
struct ColumnLayout {
  Vec2 low_mm{0};                ///< border of the first column
  Vec2 cell_mm{0};               ///< of a column
  std::array<int, 3> tiles{};    ///< numbers: x fastest, then y, then z
  std::array<int, 2> columns{};  ///< of a tile; the last ones may have fewer
  double thick_mm = 0;           ///< so much of a run shows that it is no film
};

/// A model that can be read so. Moves held back do not count.
class ColumnSource {
 public:
  virtual ~ColumnSource() = default;
  virtual ColumnLayout column_layout() const = 0;
  /// Each column is at most one run, on the floor, and will be.
  virtual bool has_heights_only() const { return false; }
  /// Another number whenever the tile's columns have changed.
  virtual std::uint64_t column_version(std::uint32_t tile) const = 0;
  /// A run that goes on in the tile above ends where that one's begins, exactly; no other does.
  virtual void read_columns(std::uint32_t tile, ColumnRuns& out) const = 0;
};

}  // namespace kerf
