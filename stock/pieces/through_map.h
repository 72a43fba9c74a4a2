// stock/pieces/through_map.h - where a workpiece of heights has been cut through to its floor, and
// what comes free of it so: seen from above, move by move.
//
//      +---------------------+        A slot right through (.) goes round the island. As long as
//      | ##### ............. |        the two banks meet round its front (the ring of what the last
//      | ##### . ##### ### . |        step took away hangs together) nothing has come free; only
//      | ##### ......... # . |        where they do not, more is looked at.
//      +---------------------+
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "stock/cutter/cutter.h"
#include "stock/pieces/bit_plane.h"
#include "stock/stock_model.h"
#include "surface/height_grid.h"

namespace kerf {

struct PartPiece;

/// What a step of a move has parted, all of which was one before.
struct ThroughSplit {
  std::vector<CellSet> bodies;  ///< as they are then; each with a square of 2 x 2 cells
  Vec3 tip_mm{0};               ///< at the end of the step
  double share = 0;             ///< of the move
  double way_mm = 0;            ///< seen from above, from the start of the move
};

/// Cells are those of the heights. One is material as long as the cutter has not been over its
/// middle at the floor's height (and kThinnest_mm above it): by the cutter's exact radius there, in
/// the order of the moves, whatever the model does with them. Cells that share a side or a corner
/// hang together: a bridge of a cell's width is always seen, a gap that is 1.5 cells wide as well.
/// Costs about a microsecond a move that goes through, nothing any other. One thread.
class ThroughMap {
 public:
  /// A skin that is thinner holds nothing.
  static constexpr double kThinnest_mm = 0.01;

  explicit ThroughMap(const HeightGrid& heights);

  /// Whether a move goes so low. Cheap.
  static bool reaches(const CutMove& move, double floor_mm);
  /// Cutters that do not undercut, standing upright. Moves longer than the cutter is wide in steps
  /// of that length: what is parted and cut up within one is not seen. Appends to `splits`.
  void cut(const Cutter& cutter, const CutMove& move, std::vector<ThroughSplit>& splits);

  const BitPlane& material() const { return solid_; }
  /// What the move that was cut last took away after its first split, with the way up to then.
  struct Removed {
    double way_mm = 0;
    CellSet cells;
  };
  const std::vector<Removed>& removed_after_split() const { return removed_after_; }
  /// All bodies that there are, each with a square of 2 x 2 cells. About a millisecond for a
  /// million cells.
  std::vector<CellSet> bodies();
  /// Plane of the same size, all 0; to be left so.
  BitPlane& scratch() { return scratch_; }

 private:
  double radius_at(const Cutter& cutter, double above_tip_mm);
  void sweep(const Vec2& from, const Vec2& to, double radius_mm);
  void widen_by_disk(const Vec2& middle, int first_row, double radius_mm);
  void widen_by_side(const Vec2& from, const Vec2& to, int first_row);
  void take_row(int row, double low_cell, double high_cell);
  bool is_under_slope(int i, int j) const;
  bool is_under_arc(int i, int j) const;
  /// What the step that has filled removed_ has parted: one split for each body that was one.
  void find_splits(const ThroughSplit& step, std::vector<ThroughSplit>& splits);
  void find_ring();
  bool hangs_together(const CellSet& ring);
  /// Appends to `parts` what hangs together in `within`, of these cells of it.
  void part(const BitPlane& within, const CellSet& cells, std::vector<CellSet>& parts);
  /// Which of the parts were one before: a number for each.
  std::vector<std::size_t> former_bodies(const std::vector<CellSet>& parts);

  Box bounds_mm_;
  Vec2 cell_mm_{0};
  double level_mm_ = 0;
  BitPlane solid_, scratch_, ring_, near_;
  // The step that is taken.
  Vec3 step_from_{0}, step_to_{0};
  double radius_mm_ = 0;                ///< at the floor
  const Cutter* slope_ = nullptr;       ///< a cone on its way up or down
  const PartPiece* arc_ = nullptr;      ///< it is a part of this arc
  Vec2 arc_middle_{1, 0};               ///< direction from the arc's centre to the part's middle
  double arc_cosine_ = 0;               ///< of half the angle of the part
  std::vector<double> low_x_, high_x_;  ///< of what is swept, by row from the first
  CellSet removed_;
  CellSet ring_cells_;    ///< material beside them
  CellSet open_, found_;  ///< of a search
  std::vector<Removed> removed_after_;
  double cached_above_mm_ = -1, cached_radius_mm_ = 0;
  std::string cached_spec_;
};

}  // namespace kerf
