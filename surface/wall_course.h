// surface/wall_course.h - which way a wall of a height grid faces: across its course, not its
// cells.
#pragma once

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "surface/wall_line.h"

namespace kerf {

/// Walls of a height grid stand on the edges of cells, so a round or oblique one is a staircase.
/// Its course is that of the line which divides the cells above half the wall's height from those
/// below. This follows the line from one of its edges both ways, and tells the direction in which
/// the wall faces at the edge's ends, as if it stood where the staircase means it to:
///
///      h h h h h h h      h, l  high, low cells
///     -------o h h h      o     the end that is asked about
///      l l l |-------     Tangent: least squares over the line's corners up to `reach` steps
///      l l l l l l l      from o. The wall faces the low side, at right angles to it.
///
/// Where a run of kLongRun steps or more meets another at a right angle is a corner of the part,
/// and nothing beyond it counts; so a straight wall along x or y faces exactly across it up to its
/// end. At other sharp corners the line is looked at less far. The line ends at the grid's border.
///
/// Depends on heights alone, so it is the same from either side of a border between tiles. Reads
/// cells no farther than `reach` from o; a circle's wall is right to about 1 degree in the mean and
/// 5 at worst with a reach of 8, see tests/stock/patch_walls_test.cpp. Some 0.1 us.
class WallCourse : private WallLine {
 public:
  using WallLine::kMaxReach;
  static constexpr int kLongRun = 3;     ///< no straight line has such runs in x and in y
  static constexpr int kShortReach = 4;  ///< about sharp corners
  /// Cosine between the courses ahead and behind, below which there is a corner: about 50 degrees.
  static constexpr float kSharp = 0.64f;

  /// The edge that cell (i, j) shares with the one before it in x, or in y. `height(i, j)` is
  /// anything below `middle` without material; `inside(i, j)` tells whether there is such a cell.
  template <class Height, class Inside>
  WallCourse(int i, int j, bool across_x, float middle, int reach, const Height& height,
             const Inside& inside)
      : WallCourse({i, j}, across_x ? glm::ivec2(0, 1) : glm::ivec2(1, 0),
                   (height(i, j) > middle) != across_x, middle, reach, height, inside) {}

  /// At the end of the edge with the lower (higher) x or y. Of unit length; `outward`, the way from
  /// the high cell to the low one, where there is no telling.
  glm::vec2 facing(bool at_higher_end, const glm::vec2& outward) const;

 private:
  /// `starts_low`: the line runs from the edge's lower end to its higher one.
  template <class Height, class Inside>
  WallCourse(glm::ivec2 low_end, glm::ivec2 along, bool starts_low, float middle, int reach,
             const Height& height, const Inside& inside)
      : WallLine(
            starts_low ? low_end : low_end + along, starts_low ? low_end + along : low_end, reach,
            reach, [&](glm::ivec2 cell) { return height(cell.x, cell.y) > middle; },
            [&](glm::ivec2 cell) { return inside(cell.x, cell.y); }),
        reach_(reach),
        starts_low_(starts_low) {}

  /// The line on one side of the end that is asked about.
  struct Half {
    int steps;
    glm::ivec2 sum{0}, moment{0};  ///< of the ways to its corners, and of those times their number
    /// Slope of the half alone against the steps, by least squares, times a positive number.
    glm::ivec2 course() const { return 2 * moment - steps * sum; }
  };
  Half half(int center, int sign, int steps) const;
  static bool is_sharp(const Half& behind, const Half& ahead);

  int reach_;
  bool starts_low_;
};

/// The slope (dz/dx, dz/dy) of a surface at corner (i, j) of the cells, turned to where a wall
/// there would face: across the course of the highest of the four steps about the corner. For steep
/// slopes, of which the differences of heights tell how much the surface falls but not well which
/// way: all the fall there is may lie within a cell or two. Turned by up to 50 degrees or not at
/// all; where there is an edge of the part, the highest step may be another surface's. As
/// WallCourse, but reads cells up to `reach` + 1 away from the corner. Some 0.1 us.
template <class Height, class Inside>
glm::vec2 slope_across_course(int i, int j, const glm::vec2& slope, int reach, const Height& height,
                              const Inside& inside) {
  constexpr float kMostTurned = WallCourse::kSharp;  // cosine
  // Cells about the corner, counter-clockwise from the lower left. Between each and the next is an
  // edge: that which the cell `beside` shares with the one before it.
  constexpr std::array<glm::ivec2, 4> kCells{glm::ivec2(-1, -1), {0, -1}, {0, 0}, {-1, 0}};
  constexpr std::array<glm::ivec2, 4> kBeside{glm::ivec2(0, -1), {0, 0}, {0, 0}, {-1, 0}};
  const glm::ivec2 corner(i, j);
  float highest = 0;
  std::size_t edge = 4;
  std::array<float, 4> z{};
  for (std::size_t q = 0; q < 4; ++q) {
    const glm::ivec2 cell = corner + kCells[q];
    if (!inside(cell.x, cell.y)) return slope;
    z[q] = height(cell.x, cell.y);
  }
  for (std::size_t q = 0; q < 4; ++q) {
    const float step = std::abs(z[(q + 1) % 4] - z[q]);
    if (!(step > highest)) continue;
    highest = step;
    edge = q;
  }
  if (edge == 4) return slope;
  const std::size_t next = (edge + 1) % 4;
  const glm::ivec2 beside = corner + kBeside[edge];
  const bool across_x = edge % 2 == 0, at_higher_end = edge == 0 || edge == 3;
  const glm::vec2 way(kCells[next] - kCells[edge]);
  const WallCourse course(beside.x, beside.y, across_x, 0.5f * (z[edge] + z[next]), reach, height,
                          inside);
  const glm::vec2 facing = course.facing(at_higher_end, z[next] < z[edge] ? way : -way);
  const float size = glm::length(slope);
  return glm::dot(facing, -slope) > kMostTurned * size ? -size * facing : slope;
}

}  // namespace kerf
