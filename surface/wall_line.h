// surface/wall_line.h - the line on the edges of cells that a wall of a height grid stands on.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>

namespace kerf {

/// Some steps of the line that divides high cells from low ones, followed both ways from one of its
/// edges, with the high cells on the left. Where only corners of cells touch it goes round its own
/// high cell. It ends at the grid's border.
class WallLine {
 public:
  static constexpr int kMaxReach = 8;  ///< steps of the line, and so cells

 protected:
  /// `from`, `to`: the edge, two corners (a corner has the number of the cell to its upper right).
  /// `ahead`, `behind`: steps beyond it, each up to kMaxReach; reads no cells farther away than
  /// that. `is_high(cell)`; `is_inside(cell)`: whether there is such a cell.
  template <class IsHigh, class IsInside>
  WallLine(glm::ivec2 from, glm::ivec2 to, int ahead, int behind, const IsHigh& is_high,
           const IsInside& is_inside) {
    line_[kMaxReach] = from;
    line_[kMaxReach + 1] = to;
    ahead_ = follow(to, to - from, true, ahead, is_high, is_inside);
    behind_ = follow(from, from - to, false, behind, is_high, is_inside);
  }

  static std::size_t index(int place) { return static_cast<std::size_t>(place); }
  glm::ivec2 corner(int place) const { return line_[index(place)]; }
  /// Places first < .. < last where it turns: a bit each, without those two themselves.
  unsigned turns_between(int first, int last) const {
    return turns_ & ((1u << last) - 1) & ~((2u << first) - 1);
  }

  int ahead_ = 0, behind_ = 0;  ///< steps found before and after the edge

 private:
  template <class IsHigh, class IsInside>
  int follow(glm::ivec2 at, glm::ivec2 way, bool is_ahead, int count, const IsHigh& is_high,
             const IsInside& is_inside);

  unsigned turns_ = 0;                              ///< a bit for each place in line_
  std::array<glm::ivec2, 2 * kMaxReach + 2> line_;  ///< the edge: from kMaxReach to the next
};

/// Puts the corners of up to `count` steps from `at` into line_, ahead of the edge or behind it,
/// and returns how many there are.
template <class IsHigh, class IsInside>
int WallLine::follow(glm::ivec2 at, glm::ivec2 way, bool is_ahead, int count, const IsHigh& is_high,
                     const IsInside& is_inside) {
  for (int n = 0; n < count; ++n) {
    const glm::ivec2 left(-way.y, way.x);
    const glm::ivec2 side = is_ahead ? left : -left;  // where the high cells are
    const std::size_t place = index(is_ahead ? kMaxReach + 1 + n : kMaxReach - n);  // of `at`
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
