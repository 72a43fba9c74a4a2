// base/wall_course.h - which way a wall of a height grid faces: across its course, not its cells.
#pragma once

#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

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
/// 5 at worst with a reach of 8, see tests/stock/tile_patch_test.cpp. Some 0.1 us.
class WallCourse {
 public:
  static constexpr int kMaxReach = 8;    ///< steps of the line, and so cells
  static constexpr int kLongRun = 3;     ///< no straight line has such runs in x and in y
  static constexpr int kShortReach = 4;  ///< about sharp corners
  /// Cosine between the courses ahead and behind, below which there is a corner: about 50 degrees.
  static constexpr float kSharp = 0.64f;

  /// The edge that cell (i, j) shares with the one before it in x, or in y. `height(i, j)` is
  /// anything below `middle` without material; `inside(i, j)` tells whether there is such a cell.
  template <class Height, class Inside>
  WallCourse(int i, int j, bool across_x, float middle, int reach, const Height& height,
             const Inside& inside)
      : reach_(reach) {
    const bool cell_is_high = height(i, j) > middle;
    // With the high cells on the left.
    const glm::ivec2 along = across_x ? glm::ivec2(0, 1) : glm::ivec2(1, 0);
    const glm::ivec2 low_end(i, j), high_end = low_end + along;
    const bool is_upward = across_x ? !cell_is_high : cell_is_high;
    starts_low_ = is_upward;
    const glm::ivec2 from = is_upward ? low_end : high_end, to = is_upward ? high_end : low_end;
    line_[kMaxReach] = from;
    line_[kMaxReach + 1] = to;
    const auto is_high = [&](glm::ivec2 cell) { return height(cell.x, cell.y) > middle; };
    const auto is_inside = [&](glm::ivec2 cell) { return inside(cell.x, cell.y); };
    ahead_ = follow(to, to - from, true, reach, is_high, is_inside);
    behind_ = follow(from, from - to, false, reach, is_high, is_inside);
  }

  /// At the end of the edge with the lower (higher) x or y. Of unit length; `outward`, the way from
  /// the high cell to the low one, where there is no telling.
  glm::vec2 facing(bool at_higher_end, const glm::vec2& outward) const;

 private:
  using Line = std::array<glm::ivec2, 2 * kMaxReach + 2>;
  static std::size_t index(int place) { return static_cast<std::size_t>(place); }
  template <class IsHigh, class IsInside>
  int follow(glm::ivec2 at, glm::ivec2 way, bool is_ahead, int count, const IsHigh& is_high,
             const IsInside& is_inside);
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
  int ahead_ = 0, behind_ = 0;  ///< steps of the line before and after the edge
  unsigned turns_ = 0;          ///< a bit for each place in line_ where it turns
  Line line_;                   ///< the edge runs from kMaxReach to the next
};

/// Puts the corners of up to `count` steps from `at` into line_, ahead of the edge or behind it,
/// and returns how many there are.
template <class IsHigh, class IsInside>
int WallCourse::follow(glm::ivec2 at, glm::ivec2 way, bool is_ahead, int count,
                       const IsHigh& is_high, const IsInside& is_inside) {
  for (int n = 0; n < count; ++n) {
    const glm::ivec2 left(-way.y, way.x);
    const glm::ivec2 side = is_ahead ? left : -left;  // where the high cells are
    const std::size_t place = index(is_ahead ? kMaxReach + 1 + n : kMaxReach - n);  // of `at`
    // The two cells before us; a corner has the number of the cell to its upper right.
    const glm::ivec2 high = at + (way + side - 1) / 2, low = at + (way - side - 1) / 2;
    if (!is_inside(high) || !is_inside(low)) return n;
    const bool to_high = !is_high(high);  // also where only corners touch: round our own cell
    if (to_high || is_high(low)) {
      way = to_high ? side : -side;
      turns_ |= 1u << place;
    }
    at += way;
    line_[is_ahead ? place + 1 : place - 1] = at;
  }
  return count;
}

}  // namespace kerf
