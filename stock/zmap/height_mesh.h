// stock/zmap/height_mesh.h - closed triangle mesh of a height grid: top, walls, floor.
#pragma once

#include <optional>
#include <span>

#include "base/geometry.h"
#include "base/triangle_mesh.h"
#include "stock/zmap/cell_step.h"

namespace kerf {

/// Heights of nx x ny cells, row by row (y outer), mm. bounds_mm: x, y edges of the grid, min.z the
/// floor (max.z is not used). A cell whose height is <= the floor holds no material (a hole through
/// the workpiece, or outside a round blank). Neighbouring cell centres must differ in single
/// precision, and 2 (nx + 2) (ny + 2) must stay below 2^32.
struct CellHeights {
  int nx = 0;
  int ny = 0;
  Box bounds_mm;
  std::span<const float> heights_mm;
  /// Where walls stand between middles of cells, in the order of cell_steps(); none: nobody knows.
  std::optional<std::span<const CellStep>> steps{};
};

/// Where a hole is so narrow that the surface would touch itself along an edge, the cells there are
/// given this much material, because a closed mesh cannot say it otherwise. Less than any cell that
/// a machine resolves, yet many steps of single precision at the coordinates of a workpiece.
inline constexpr float kHoleFilmMm = 0.001f;

/// The surface that interpolates the heights at the cell centres linearly over triangles, is
/// carried on level from the outer centres to the edge of the grid, and is closed by vertical walls
/// and a floor.
///
///     |---o-----o-----o              o  cell centre
///     |                \             At a hole the surface falls to the floor between the last
///     |_________________o     o      centre with material and the first without.
///
/// tolerance_mm = 0: every cell is a vertex and all squares are divided along the same diagonal
/// (from low x, y to high x, y). The enclosed volume is the sum of (height - floor) x cell area,
/// except that the two corner cells on that diagonal count 1/12 more and the other two 1/12 less
/// (no choice of diagonals avoids this), and except for the films: at most kHoleFilmMm x the area
/// of the cells without material.
///
/// tolerance_mm > 0: fewer triangles. Nowhere further than the tolerance, measured vertically and
/// up to the rounding to single precision, from the surface of all cells with the squares divided
/// along alternating diagonals; so also at each cell centre, films aside. The worst case is
/// measured, not estimated, wherever that saves triangles. Around holes every cell stays a vertex.
/// Source: W. Evans, D. Kirkpatrick, G. Townsend, "Right-triangulated irregular networks",
/// Algorithmica 30, 2001.
///
/// Where CellHeights::steps are given (and the grid is at least two cells wide and deep), walls
/// stand upright there, with a sharp edge above and below; half way between a cell with material
/// and one without where none is given. Then there are no films, and the surface is that of all
/// cells beside the squares through which walls run, in which it is within the cells' own heights.
///
/// Result: closed, every edge in exactly two triangles, normals outward, no triangle without area;
/// empty if no cell holds material. threads >= 1; same result for any. O(cells) time; memory beside
/// the result: 2 bits per cell, a float more with a tolerance, 5 bytes more if there are holes; of
/// walls some 200 bytes for each square with one.
TriangleMesh mesh_height_grid(const CellHeights& grid, double tolerance_mm, int threads = 1);

}  // namespace kerf
