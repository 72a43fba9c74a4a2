#include "stock/zmap/wall_volume.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "stock/zmap/cell_step.h"
#include "stock/zmap/height_mesh_relief.h"
#include "stock/zmap/height_mesh_steps.h"

namespace kerf {
namespace {

/// Squares of the mesher's lattice in x and y that are looked at together, and the cells about them
/// on which it depends how walls run through them: StepSquares looks three squares back.
constexpr int kWindowSquares = kTileCells;
constexpr int kMarginCells = 5;

struct WallSquare {
  int i, j;  ///< the node of low x, y: Relief has them
};

/// The two squares beside the edge of the lattice on which a step is.
std::array<WallSquare, 2> squares_beside(const CellStep& step) {
  const WallSquare ahead{step.i + 1, step.j + 1};
  return {ahead,
          step.axis == 0 ? WallSquare{ahead.i, ahead.j - 1} : WallSquare{ahead.i - 1, ahead.j}};
}

/// Cells [first, last) of one axis for squares from `from` on.
struct WindowCells {
  int first, last;
  WindowCells(int from, int cells)
      : first(std::max(0, from - 1 - kMarginCells)),
        last(std::min(cells, from + kWindowSquares + kMarginCells)) {}
  int count() const { return last - first; }
};

/// Middles meet a web that is thinner than a cell by chance: where they do, a whole cell stands for
/// what is lost elsewhere. Without that webs, and the tips of wedges, would have too little.
void drop_thin_webs(const TileGrid& grid, std::vector<CellStep>& steps) {
  const auto key = [&](int i, int j, int axis) {
    return 2 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.nx()) +
                static_cast<std::size_t>(i)) +
           static_cast<std::size_t>(axis);
  };
  const auto find = [&](int i, int j, int axis) {
    const std::size_t at = key(i, j, axis);
    const auto found = std::lower_bound(
        steps.begin(), steps.end(), at,
        [&](const CellStep& step, std::size_t k) { return key(step.i, step.j, step.axis) < k; });
    return found != steps.end() && key(found->i, found->j, found->axis) == at ? &*found : nullptr;
  };
  std::vector<bool> is_thin(steps.size());
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const CellStep& step = steps[n];
    const int di = step.axis == 0 ? 1 : 0, dj = 1 - di;
    const CellStep* const next = find(step.i + di, step.j + dj, step.axis);
    if (next == nullptr || next->part >= step.part) continue;
    const float web = grid.height(step.i + di, step.j + dj);
    if (grid.height(step.i, step.j) >= web) continue;
    if (grid.height(step.i + 2 * di, step.j + 2 * dj) >= web) continue;
    is_thin[n] = is_thin[static_cast<std::size_t>(next - steps.data())] = true;
  }
  std::size_t kept = 0;
  for (std::size_t n = 0; n < steps.size(); ++n)
    if (!is_thin[n]) steps[kept++] = steps[n];
  steps.resize(kept);
}

class WallWindow {
 public:
  /// `steps`: of the whole grid.
  WallWindow(const TileGrid& grid, std::span<const CellStep> steps, const WallSquare& from)
      : grid_(grid),
        from_(from),
        x_(from.i, grid.nx()),
        y_(from.j, grid.ny()),
        is_known_(std::size_t{kWindowSquares} * kWindowSquares) {
    take_heights();
    take_steps(steps);
  }

  double surplus_mm3() const {
    const Relief relief({x_.count(), y_.count(), bounds_mm(), heights_, steps_}, false);
    const StepSquares squares(relief, steps_, true);
    double sum = 0;
    for (std::size_t at = 0; at < is_known_.size(); ++at) {
      if (!is_known_[at]) continue;
      const int i = from_.i + static_cast<int>(at) % kWindowSquares - x_.first,
                j = from_.j + static_cast<int>(at) / kWindowSquares - y_.first;
      sum += squares.surplus_mm3(i, j);
    }
    return sum;
  }

 private:
  void take_heights() {
    heights_.reserve(static_cast<std::size_t>(x_.count()) * static_cast<std::size_t>(y_.count()));
    for (int j = y_.first; j < y_.last; ++j)
      for (int i = x_.first; i < x_.last; ++i) heights_.push_back(grid_.height(i, j));
  }

  void take_steps(std::span<const CellStep> steps) {
    const auto is_left_of = [](const CellStep& step, const WallSquare& cell) {
      return step.j != cell.j ? step.j < cell.j : step.i < cell.i;
    };
    auto step = steps.begin();
    for (int j = y_.first; j < y_.last; ++j) {
      step = std::lower_bound(step, steps.end(), WallSquare{x_.first, j}, is_left_of);
      for (; step != steps.end() && step->j == j && step->i < x_.last; ++step) {
        if ((step->axis == 0 ? step->i + 1 == x_.last : step->j + 1 == y_.last)) continue;
        steps_.push_back(*step);
        steps_.back().i -= x_.first;
        steps_.back().j -= y_.first;
        for (const WallSquare& square : squares_beside(*step)) {
          const int i = square.i - from_.i, k = square.j - from_.j;
          if (i >= 0 && k >= 0 && i < kWindowSquares && k < kWindowSquares)
            is_known_[static_cast<std::size_t>(k * kWindowSquares + i)] = true;
        }
      }
    }
  }

  Box bounds_mm() const {
    Box box = grid_.bounds_mm();
    const Vec3 low = box.min;
    box.min.x = low.x + x_.first * grid_.cell_x_mm();
    box.min.y = low.y + y_.first * grid_.cell_y_mm();
    if (x_.last < grid_.nx()) box.max.x = low.x + x_.last * grid_.cell_x_mm();
    if (y_.last < grid_.ny()) box.max.y = low.y + y_.last * grid_.cell_y_mm();
    return box;
  }

  const TileGrid& grid_;
  WallSquare from_;
  WindowCells x_, y_;
  std::vector<float> heights_;
  std::vector<CellStep> steps_;
  std::vector<bool> is_known_;  ///< of the window's squares, row by row: one has a wall in it
};

}  // namespace

double wall_volume_mm3(const TileGrid& grid, const WallMarks& marks) {
  if (!marks.any() || std::min(grid.nx(), grid.ny()) < 2) return 0;
  std::vector<CellStep> steps = cell_steps(grid, marks, WallKind::kAll);
  drop_thin_webs(grid, steps);
  const int across = grid.nx() / kWindowSquares + 1, up = grid.ny() / kWindowSquares + 1;
  std::vector<bool> has_wall(static_cast<std::size_t>(across) * static_cast<std::size_t>(up));
  for (const CellStep& step : steps)
    for (const WallSquare& square : squares_beside(step))
      has_wall[static_cast<std::size_t>(square.j / kWindowSquares * across +
                                        square.i / kWindowSquares)] = true;
  double sum = 0;
  for (int wj = 0, at = 0; wj < up; ++wj)
    for (int wi = 0; wi < across; ++wi, ++at)
      if (has_wall[static_cast<std::size_t>(at)])
        sum += WallWindow(grid, steps, {wi * kWindowSquares, wj * kWindowSquares}).surplus_mm3();
  return sum;
}

}  // namespace kerf
