// twin/compare/design_columns.h - a design part over the cells of a grid: what of each column is
// material.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "base/geometry.h"
#include "mesh/column_lines.h"
#include "twin/compare/design_part.h"

namespace kerf {

/// The vertical lines through the middles of the cells, cut with the design's triangles
/// (column_lines.h). 20 bytes a cell; some 10 ns a triangle and 5 ns a line through one.
class DesignColumns {
 public:
  /// `heights_mm`: up to where the workpiece reaches in each cell of the grid, whose z goes from
  /// the floor to the top of the blank.
  DesignColumns(const DesignPart& design, const ColumnGrid& grid,
                std::span<const float> heights_mm);

  static constexpr float kNone = -std::numeric_limits<float>::infinity();
  /// The highest and lowest point of the design on the line; kNone where there is none.
  float top_mm(std::size_t cell) const { return top_[cell]; }
  float bottom_mm(std::size_t cell) const { return bottom_[cell]; }
  /// Length of it within the blank below the height of the cell, and above it, mm.
  float below_mm(std::size_t cell) const { return below_[cell]; }
  float above_mm(std::size_t cell) const { return above_[cell]; }

 private:
  std::vector<float> top_, bottom_, below_, above_;
};

}  // namespace kerf
