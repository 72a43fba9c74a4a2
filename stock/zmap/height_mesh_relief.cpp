#include "stock/zmap/height_mesh_relief.h"

#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace kerf {
namespace {

/// Edge of the grid, centres of the cells, edge of the grid.
std::vector<double> lattice_lines(double from_mm, double to_mm, int cells) {
  std::vector<double> lines(std::size_t(cells) + 2);
  const double cell_mm = (to_mm - from_mm) / cells;
  lines.front() = from_mm;
  for (int i = 1; i <= cells; ++i) lines[std::size_t(i)] = from_mm + (i - 0.5) * cell_mm;
  lines.back() = to_mm;
  return lines;
}

}  // namespace

Relief::Relief(const CellHeights& grid, bool alternating)
    : alternating_(alternating),
      has_steps_(grid.steps && std::min(grid.nx, grid.ny) >= 2),
      floor_mm_(static_cast<float>(grid.bounds_mm.min.z)) {
  assert(grid.nx >= 1 && grid.ny >= 1);
  assert(grid.heights_mm.size() == std::size_t(grid.nx) * std::size_t(grid.ny));
  const int repeat_x = alternating && grid.nx == 1 ? 2 : 1;
  const int repeat_y = alternating && grid.ny == 1 ? 2 : 1;
  nx_ = grid.nx * repeat_x;
  ny_ = grid.ny * repeat_y;
  assert(node_count() < (std::size_t{1} << 31));  // two keys a node
  x_mm_ = lattice_lines(grid.bounds_mm.min.x, grid.bounds_mm.max.x, nx_);
  y_mm_ = lattice_lines(grid.bounds_mm.min.y, grid.bounds_mm.max.y, ny_);
  take_cells(grid, repeat_x, repeat_y);
  if (has_holes_ && has_material_ && !has_steps_) close_narrow_holes();
}

void Relief::take_cells(const CellHeights& grid, int repeat_x, int repeat_y) {
  float greatest = floor_mm_;
  for (const float h : grid.heights_mm) {
    const bool solid = h > floor_mm_;
    has_holes_ |= !solid;
    has_material_ |= solid;
    greatest = h > greatest ? h : greatest;
  }
  greatest_magnitude_mm_ = std::max(std::abs(floor_mm_), std::abs(greatest));
  if (!has_holes_ && repeat_x == 1 && repeat_y == 1) {
    cells_mm_ = grid.heights_mm;
    return;
  }
  own_cells_mm_.resize(std::size_t(nx_) * std::size_t(ny_));
  for (int j = 0; j < ny_; ++j) {
    const float* const source =
        grid.heights_mm.data() + std::size_t(j / repeat_y) * std::size_t(grid.nx);
    float* const row = own_cells_mm_.data() + cell(0, j);
    for (int i = 0; i < nx_; ++i) {
      const float h = source[repeat_x == 1 ? i : 0];
      row[i] = h > floor_mm_ ? h : floor_mm_;
    }
  }
  cells_mm_ = own_cells_mm_;
}

glm::vec3 Relief::position_mm(NodeKey key) const {
  const bool floor = on_floor(key);
  const NodeKey node = floor ? key - NodeKey(node_count()) : key;
  const int i = int(node % NodeKey(width()));
  const int j = int(node / NodeKey(width()));
  return {float(x_mm(i)), float(y_mm(j)), floor ? floor_mm_ : node_mm(i, j)};
}

bool Relief::at_hole(NodeKey key) const {
  if (!has_holes_ || !on_floor(key)) return false;
  const NodeKey node = key - NodeKey(node_count());
  return !node_is_solid(int(node % NodeKey(width())), int(node / NodeKey(width())));
}

// ---- Narrow holes -------------------------------------------------------------------------------
// A triangle with all corners on the floor is left out of both the surface and the floor. An edge
// that lies on the floor between two triangles that are not left out would be in four triangles:
// two of the surface, two of the floor. One of its ends is then raised by a film. That makes new
// triangles count, so its neighbourhood is looked at again, until no such edge is left.

void Relief::close_narrow_holes() {
  std::vector<std::size_t> pending;
  for (std::size_t at = own_cells_mm_.size(); at-- > 0;) {
    const bool hole = !(own_cells_mm_[at] > floor_mm_);
    if (hole && count_hole_neighbours(at) < 8) pending.push_back(at);
  }
  while (!pending.empty()) {
    const std::size_t at = pending.back();
    pending.pop_back();
    visit_hole_cell(at, pending);
  }
}

/// Raises what must be raised at the hole cell `start`; cells to look at again go to `pending`.
void Relief::visit_hole_cell(std::size_t start, std::vector<std::size_t>& pending) {
  const float film_mm = std::max(floor_mm_ + kHoleFilmMm,
                                 std::nextafter(floor_mm_, std::numeric_limits<float>::infinity()));
  const std::size_t row = std::size_t(nx_);
  std::size_t other = 0;
  while (!(own_cells_mm_[start] > floor_mm_) &&
         find_touching_edge(int(start % row), int(start / row), other)) {
    // The end with fewer holes around it is the tip of a narrow hole: so the hole is closed from
    // its tip up to where it is wide enough, and no further.
    const int here = count_hole_neighbours(start);
    const int there = count_hole_neighbours(other);
    const std::size_t raised = there < here || (there == here && other > start) ? other : start;
    own_cells_mm_[raised] = film_mm;
    const int ci = int(raised % row);
    const int cj = int(raised / row);
    for (int j = std::max(cj - 1, 0); j <= std::min(cj + 1, ny_ - 1); ++j) {
      for (int i = std::max(ci - 1, 0); i <= std::min(ci + 1, nx_ - 1); ++i) {
        if (!cell_is_solid(i, j)) pending.push_back(cell(i, j));
      }
    }
  }
}

/// Among the eight around it; cells outside the grid are not counted.
int Relief::count_hole_neighbours(std::size_t at) const {
  const int ci = int(at % std::size_t(nx_));
  const int cj = int(at / std::size_t(nx_));
  int count = -1;  // itself
  for (int j = std::max(cj - 1, 0); j <= std::min(cj + 1, ny_ - 1); ++j) {
    for (int i = std::max(ci - 1, 0); i <= std::min(ci + 1, nx_ - 1); ++i) {
      count += cell_is_solid(i, j) ? 0 : 1;
    }
  }
  return count;
}

/// Looks at all edges that end at a node of cell (ci, cj); `other` is the cell at the other end.
bool Relief::find_touching_edge(int ci, int cj, std::size_t& other) const {
  const int i_last = ci == nx_ - 1 ? nx_ + 1 : ci + 1;
  const int j_last = cj == ny_ - 1 ? ny_ + 1 : cj + 1;
  for (int j = cj == 0 ? 0 : cj + 1; j <= j_last; ++j) {
    for (int i = ci == 0 ? 0 : ci + 1; i <= i_last; ++i) {
      for (int dj = -1; dj <= 1; ++dj) {
        for (int di = -1; di <= 1; ++di) {
          const Node a{i, j};
          const Node b{i + di, j + dj};
          if (!is_edge(a, di, dj)) continue;
          const bool in_order = std::pair(a.j, a.i) < std::pair(b.j, b.i);
          if (in_order ? !touches_itself(a, b) : !touches_itself(b, a)) continue;
          other = cell_of_node(b.i, b.j);
          return true;
        }
      }
    }
  }
  return false;
}

bool Relief::is_edge(Node a, int di, int dj) const {
  const Node b{a.i + di, a.j + dj};
  if ((di == 0 && dj == 0) || b.i < 0 || b.j < 0 || b.i >= width() || b.j >= height()) return false;
  if (di == 0 || dj == 0) return true;
  return diagonal_rises(std::min(a.i, b.i), std::min(a.j, b.j)) == (di == dj);
}

/// Of the square whose low corner is node (i, j). In the outermost squares both ways would do: two
/// of their corners have the heights of the other two.
bool Relief::diagonal_rises(int i, int j) const {
  return !alternating_ || i < 1 || j < 1 || i >= nx_ || j >= ny_ || (i + j) % 2 == 0;
}

bool Relief::is_solid_node(Node n) const {
  return n.i >= 0 && n.j >= 0 && n.i < width() && n.j < height() && node_is_solid(n.i, n.j);
}

/// a before b in row order. True if both are on the floor, and both triangles at a-b are not.
bool Relief::touches_itself(Node a, Node b) const {
  if (node_is_solid(a.i, a.j) || node_is_solid(b.i, b.j)) return false;
  const auto [i, j] = a;
  if (b.j == j) {  // along x: the squares above and below
    return is_solid_node(diagonal_rises(i, j) ? Node{i + 1, j + 1} : Node{i, j + 1}) &&
           is_solid_node(diagonal_rises(i, j - 1) ? Node{i, j - 1} : Node{i + 1, j - 1});
  }
  if (b.i == i) {  // along y: the squares to the right and left
    return is_solid_node(diagonal_rises(i, j) ? Node{i + 1, j + 1} : Node{i + 1, j}) &&
           is_solid_node(diagonal_rises(i - 1, j) ? Node{i - 1, j} : Node{i - 1, j + 1});
  }
  return is_solid_node({b.i, a.j}) && is_solid_node({a.i, b.j});
}

}  // namespace kerf
