// stock/zmap/tip_traces.h - where the tips of tools went that are finer than the cells show.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "stock/stock_model.h"
#include "stock/zmap/rim_traces.h"
#include "stock/zmap/sweep_ops.h"
#include "stock/zmap/tile_grid.h"

namespace kerf {

struct MeshBody;

/// Heights are those of the cells' middles; between them a pointed tool may have cut deeper. This
/// remembers, by cell, how deep: the tip's lowest place over each cell that its axis came over.
/// With it the material over a whole cell has a lower bound (lower_bound_mm) that holds for all
/// points of it. No part of the workpiece: it changes no height, no digest, and is not saved.
///
/// Why it is a bound: a tool that reaches a point p at height z reaches all points nearer to its
/// axis at z or below. Half a cell's diagonal from p toward the axis there is a cell whose middle
/// is no farther from the axis than p, so that its height is no more than z. Only where p is nearer
/// to the axis than that the middle may be higher, by what the tool rises within half a diagonal:
/// nothing for a flat one, little for a large ball (that is subtracted), and much for a point, of
/// which the axis itself is remembered. Beside the grid there are no middles: where an axis passes
/// there, the cells at the border that the tool can reach are remembered as well, of any tool.
/// Nor are there any that tell where the side of a blank is that ends within the border's cells,
/// as a round one does where it touches the grid's edge: such cells have no bound.
///
/// Cost: nothing for flat tools within the grid; for others a few ns for each cell that the tip
/// comes over, and 4 bytes a cell in tiles where a pointed tool was. Copies share tiles.
class TipTraces {
 public:
  explicit TipTraces(const TileGrid& grid);
  TipTraces(const TipTraces& other);
  TipTraces& operator=(const TipTraces&) = delete;

  /// What add() needs to know of a cutter that is the union of `tools`.
  struct Tip {
    bool pointed = false;  ///< its tip is to be remembered
    double low_mm = 0;     ///< lowest point above the tip
    double radius_mm = 0;
    double rise_mm = 0;  ///< of the others: their rise within half a diagonal
    /// The tip goes deeper than the middles of cells tell.
    bool is_finer_than_cells() const { return pointed || rise_mm > 0; }
  };
  Tip tip_of(std::span<const ConvexTool> tools) const;
  /// How deep the tip of a straight move goes into what is there at least, at the most; 0: not at
  /// all, or it is not known. Looks at nothing within `clear_mm` (in XY) of the way from
  /// held->first to held->second, if there is one: what is cut there is not in the heights yet.
  using Way = std::pair<Vec3, Vec3>;
  double depth_mm(const TileGrid& grid, const Tip& tip, const CutMove& move,
                  const std::optional<Way>& held, double clear_mm) const;
  /// Nothing is cut yet, and these are the bodies: their round sides are exact (RimTraces), and
  /// cells at the grid's border that a box does not fill are not taken for full.
  void follow_sides(std::span<const BlankBody> bodies);
  /// The same of a blank from a mesh: where that is lower over a cell than over its middle, no more
  /// is taken to be there. What lies on the edge of a cell alone is not in it.
  void follow_mesh(const TileGrid& grid, const MeshBody& body);
  const RimTraces& rims() const { return rims_; }
  /// The move is cut. Arcs are taken as chords.
  void add(const Tip& tip, const CutMove& move);
  /// Nothing is known of what was cut before, as of a workpiece that was loaded: no bound holds.
  /// What comes is not remembered then, either.
  void forget() {
    slack_mm_ = std::numeric_limits<double>::infinity();
    tiles_.assign(tiles_.size(), nullptr);
    own_.assign(own_.size(), 0);
    any_ = false;
  }
  bool knows() const { return slack_mm_ < std::numeric_limits<double>::infinity(); }

  /// Material reaches up to here at least over all of cell (i, j) and up to `margin_mm` around it,
  /// as far as that is in the grid; the grid's floor where nothing is known.
  double lower_bound_mm(const TileGrid& grid, int i, int j, double margin_mm) const;

  /// A straight way over one cell.
  struct Passage {
    int i, j;       ///< within the grid: for a way beside it the cell at its border
    bool inside;    ///< the way is over the grid
    double t0, t1;  ///< parts of the way
  };
  /// Calls visit(Passage) for the cells that a straight way from a to b comes over, in order, and
  /// for those at the grid's border that it passes within a cell.
  template <class Visit>
  void each_cell(const Vec3& a, const Vec3& b, const Visit& visit) const;

 private:
  using Tile = std::array<float, kTileFloats>;
  void lower(int i, int j, double z);
  double full_to_mm(int i, int j) const;
  bool leaves_grid(const CutMove& move) const;
  void trace(const Tip& tip, const Vec3& a, const Vec3& b);
  void trace_border(const Tip& tip, const Vec3& a, const Vec3& b);
  void trace_side(const Tip& tip, const Vec3& a, const Vec3& b, int axis, bool upper);
  double at(int i, int j) const {
    const Tile* tile = tiles_[tile_index(i, j)].get();
    return tile ? static_cast<double>((*tile)[TileGrid::offset(i, j)])
                : std::numeric_limits<double>::infinity();
  }
  std::size_t tile_index(int i, int j) const {
    return static_cast<std::size_t>(j / kTileCells) * static_cast<std::size_t>(tiles_x_) +
           static_cast<std::size_t>(i / kTileCells);
  }

  double x0_, y0_, cell_x_, cell_y_, half_diagonal_;
  int nx_, ny_, tiles_x_;
  bool any_ = false;
  RimTraces rims_;
  bool border_full_ = true;  ///< no cell there is only partly in a body
  std::vector<Box> boxes_;   ///< bodies, otherwise
  double slack_mm_ = 0;      ///< greatest Tip::rise_mm of all that has cut
  std::vector<std::shared_ptr<Tile>> tiles_;
  mutable std::vector<std::uint8_t> own_;  ///< no copy has the tile
};

template <class Visit>
void TipTraces::each_cell(const Vec3& a, const Vec3& b, const Visit& visit) const {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  // In cells; one cell around the grid counts.
  const double start[2] = {(a.x - x0_) / cell_x_, (a.y - y0_) / cell_y_};
  const double step[2] = {(b.x - a.x) / cell_x_, (b.y - a.y) / cell_y_};
  const int count[2] = {nx_, ny_};
  double t = 0, end = 1;
  for (int k = 0; k < 2; ++k) {
    const double low = -1 - start[k], high = count[k] + 1 - start[k];
    if (step[k] == 0) {
      if (low > 0 || high < 0) return;
      continue;
    }
    t = std::max(t, std::min(low / step[k], high / step[k]));
    end = std::min(end, std::max(low / step[k], high / step[k]));
  }
  if (t > end) return;
  int cell[2];
  double next[2], each[2];
  for (int k = 0; k < 2; ++k) {
    const double place = start[k] + t * step[k];
    cell[k] = static_cast<int>(std::floor(place));
    each[k] = step[k] == 0 ? kFar : std::abs(1 / step[k]);
    const double border = step[k] > 0 ? cell[k] + 1 - start[k] : cell[k] - start[k];
    next[k] = step[k] == 0 ? kFar : border / step[k];
  }
  for (;;) {
    const int k = next[0] < next[1] ? 0 : 1;
    const double until = std::clamp(next[k], t, end);
    const bool inside = cell[0] >= 0 && cell[0] < nx_ && cell[1] >= 0 && cell[1] < ny_;
    visit(Passage{std::clamp(cell[0], 0, nx_ - 1), std::clamp(cell[1], 0, ny_ - 1), inside, t,
                  until});
    if (next[k] >= end) return;
    t = until;
    next[k] += each[k];
    cell[k] += step[k] > 0 ? 1 : -1;
  }
}

}  // namespace kerf
