// surface/wall_shift.h - how far from the corners of the cells a round or oblique wall stands.
#pragma once

#include <array>
#include <cmath>
#include <glm/vec2.hpp>

#include "surface/wall_line.h"

namespace kerf {

/// The corners of the cells along a wall form a staircase. Whoever makes a surface of heights moves
/// each of them in x and y, with all that stands above and below it, to the course of the wall:
///
///      h h h h            h h h h      h, l  high, low cells
///     ---o h h h    ->    -._ h h h    The course is a parabola through the middles of the line's
///      l |---o---          l `-._      edges, by least squares, up to kMaxReach steps on either
///      l l l l l           l l l `     side (a line where there are few on one of them).
///
/// The heights are those at the cells' centres, so the true wall runs between high and low centres,
/// and a corner is never moved by more than kMost in x or y: below half a cell each cell keeps its
/// centre, and no cell turns over. Where the line turns sharply is a corner of the part: nothing
/// beyond it counts, and it is itself moved to where the two walls meet. Walls along x or y stay
/// exactly where they are, up to the corner.
///
/// Against the true wall, in cells (root of the mean square, and what 95 % stay below; the corners
/// of the cells are off by 0.37 and 0.63): circles of 10 .. 200 cells 0.12 and 0.24, of 6 cells
/// 0.15 and 0.26, straight walls of any direction 0.12 and 0.25. Most where a wall is so nearly
/// along x or y that its next step is farther off than kMaxReach. See
/// tests/surface/wall_shift_test.cpp. Some 0.1 us.
class WallShift : private WallLine {
 public:
  using WallLine::kMaxReach;
  static constexpr float kMost = 0.45f;
  /// The edges that leave a corner: each between one of the four cells about it and the next,
  /// counter-clockwise from the lower left.
  static constexpr std::array<glm::ivec2, 4> kWays{glm::ivec2(0, -1), {1, 0}, {0, 1}, {-1, 0}};
  /// Steps before and after a place that tell whether there is a corner, and the cosine between
  /// them below which there is: about 60 degrees. Of a smooth line these steps differ by 30.
  static constexpr int kChord = 4;
  static constexpr float kSharp = 0.48f;

  /// The wall at corner (i, j) on the edge that leaves the corner along `way`, with the high cells
  /// at its left or (`is_high_left` false) right. Else as WallCourse.
  template <class Height, class Inside>
  WallShift(glm::ivec2 at, glm::ivec2 way, bool is_high_left, float middle, int reach,
            const Height& height, const Inside& inside)
      : WallLine(
            is_high_left ? at : at + way, is_high_left ? at + way : at, reach - is_high_left,
            reach - !is_high_left, [&](glm::ivec2 cell) { return height(cell.x, cell.y) > middle; },
            [&](glm::ivec2 cell) { return inside(cell.x, cell.y); }),
        center_(kMaxReach + !is_high_left),
        first_(kMaxReach - behind_),
        last_(kMaxReach + 1 + ahead_) {}

  /// In cells. `free`: (1, 1), or with a 0 for the axis along which the corner may not be moved, as
  /// it lies on the grid's border.
  glm::vec2 shift(const glm::vec2& free) const;

 private:
  /// Where normal * p = distance, p from the corner that is asked about; no length: not known.
  struct Course {
    glm::vec2 normal{0};
    float distance = 0;
  };
  float straightness(int place) const;
  bool is_corner(int place) const;
  Course fit(int first, int last) const;

  int center_, first_, last_;  ///< places in the line: the corner that is asked about, its ends
};

/// How far to move corner (i, j), in cells. `heights`: of the cells about it, counter-clockwise
/// from the lower left; `is_linked`: whether there is a smooth surface, and no wall, between each
/// of them and the next. Of several walls that with the highest step decides. `height(i, j)`,
/// `inside(i, j)` as for WallCourse; `reach` up to WallShift::kMaxReach: no cells farther from the
/// corner are read.
template <class Height, class Inside>
glm::vec2 wall_shift(int i, int j, const std::array<float, 4>& heights,
                     const std::array<bool, 4>& is_linked, int reach, const Height& height,
                     const Inside& inside) {
  const std::array<bool, 4> is_inside{inside(i - 1, j - 1), inside(i, j - 1), inside(i, j),
                                      inside(i - 1, j)};
  float highest = 0;
  std::size_t edge = 4;
  for (std::size_t q = 0; q < 4; ++q) {
    const std::size_t next = (q + 1) % 4;
    const float step = std::abs(heights[next] - heights[q]);
    if (is_linked[q] || !is_inside[q] || !is_inside[next] || !(step > highest)) continue;
    highest = step;
    edge = q;
  }
  if (edge == 4) return glm::vec2(0);
  const std::size_t next = (edge + 1) % 4;
  const bool on_border_x = (is_inside[0] || is_inside[3]) != (is_inside[1] || is_inside[2]);
  const bool on_border_y = (is_inside[0] || is_inside[1]) != (is_inside[2] || is_inside[3]);
  const WallShift wall({i, j}, WallShift::kWays[edge], heights[next] > heights[edge],
                       0.5f * (heights[next] + heights[edge]), reach, height, inside);
  return wall.shift({on_border_x ? 0 : 1, on_border_y ? 0 : 1});
}

/// Of the two diagonals of a cell the one from low x, y to high x, y? By the heights of its corners
/// (counter-clockwise from low x, y) and twice that of the cell: the one whose middle is nearer to
/// the cell's height; but where the corners are moved only such as turns no triangle over.
inline bool has_rising_diagonal(const std::array<float, 4>& z, float twice) {
  return std::abs(z[0] + z[2] - twice) <= std::abs(z[1] + z[3] - twice);
}
bool has_rising_diagonal(const std::array<float, 4>& z, float twice,
                         const std::array<glm::vec2, 4>& shift);

}  // namespace kerf
