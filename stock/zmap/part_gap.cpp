#include "stock/zmap/part_gap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "stock/zmap/part_pieces.h"

namespace kerf {
namespace {

/// Arcs that are chords: what these leave.
constexpr double kChord_mm = 0.001;
/// Where on a ramp a part is nearest is found to (2/3)^n of the ramp.
constexpr int kThirds = 40;
constexpr PartWindow kWhole{0, 1};

/// A disc's distance, in its plane and below.
double gap_of(double across_mm, double above_mm) {
  const double across = std::max(0.0, across_mm), above = std::max(0.0, above_mm);
  return across == 0 ? above : above == 0 ? across : std::hypot(across, above);
}

/// Calls visit(tile, low) for each tile that may be nearer to the part than `within`: nothing of it
/// is nearer than low. visit() may lessen `within`.
template <class Visit>
void for_each_near_tile(const TileGrid& grid, TileTops& tops, const CarriedPart& part,
                        const PartPiece& piece, double& within, const Visit& visit) {
  const double bottom = std::min(piece.z(0), piece.z(1)) + part.from_z_mm;
  if (bottom - grid.bounds_mm().max.z >= within) return;
  Vec2 low, high;
  piece.bounds(low, high);
  const double around = part.radius_mm + std::max(0.0, within);
  const PartCells all = cells_of(grid, low - around, high + around);
  if (all.i0 > all.i1 || all.j0 > all.j1) return;
  for (int ty = all.j0 / kTileCells; ty <= all.j1 / kTileCells; ++ty) {
    for (int tx = all.i0 / kTileCells; tx <= all.i1 / kTileCells; ++tx) {
      const std::size_t tile =
          static_cast<std::size_t>(ty) * static_cast<std::size_t>(grid.tiles_x()) +
          static_cast<std::size_t>(tx);
      const double above = bottom - static_cast<double>(tops.top_mm(grid, tile));
      if (above >= within) continue;
      const Box box = grid.tile_box(tile);
      const double half = 0.5 * std::hypot(box.size().x, box.size().y);
      const Vec3 middle = 0.5 * (box.min + box.max);
      const double across = piece.distance(middle.x, middle.y, kWhole) - half - part.radius_mm;
      const double least = gap_of(across, above);
      if (least < within) visit(tile, least);
    }
  }
}

/// Calls visit(x, y, material) for each cell of a tile that is higher than `level`.
template <class Visit>
void for_each_high_cell(const TileGrid& grid, std::size_t tile, double level, const Visit& visit) {
  const Box& box = grid.bounds_mm();
  const int tx = static_cast<int>(tile) % grid.tiles_x(),
            ty = static_cast<int>(tile) / grid.tiles_x();
  const int i1 = std::min(grid.nx(), (tx + 1) * kTileCells);
  const int j1 = std::min(grid.ny(), (ty + 1) * kTileCells);
  for (int j = ty * kTileCells; j < j1; ++j) {
    const double y = box.min.y + (j + 0.5) * grid.cell_y_mm();
    for (int i = tx * kTileCells; i < i1; ++i) {
      const double material = static_cast<double>(grid.height(i, j));
      if (material <= level || material <= box.min.z) continue;
      visit(box.min.x + (i + 0.5) * grid.cell_x_mm(), y, material);
    }
  }
}

class GapSearch {
 public:
  GapSearch(const Cutter& cutter, const CarriedPart& part, const CutMove& move, double below_mm)
      : cutter_(cutter), part_(part), pieces_(pieces_of(move, kChord_mm)), least_mm_(below_mm) {}

  void run(const TileGrid& grid, TileTops& tops) {
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const double bottom = std::min(pieces_[i].z(0), pieces_[i].z(1)) + part_.from_z_mm;
      for_each_near_tile(grid, tops, part_, pieces_[i], least_mm_, [&](std::size_t tile, double) {
        for_each_high_cell(grid, tile, bottom - least_mm_,
                           [&](double x, double y, double material) { look(i, x, y, material); });
      });
    }
  }
  double least_mm() const { return least_mm_; }
  PartGap found() const {
    const double t = (static_cast<double>(piece_) + t_) / static_cast<double>(pieces_.size());
    return {least_mm_, t, pieces_[piece_].tip(t_)};
  }

 private:
  void look(std::size_t piece, double x, double y, double material);
  double left_of(double x, double y, double material);
  double nearest_at(const PartPiece& piece, double x, double y, double material) const;

  const Cutter& cutter_;
  const CarriedPart& part_;
  std::vector<PartPiece> pieces_;
  double least_mm_;
  std::size_t piece_ = 0;
  double t_ = 0;
  PartWindows cut_;
};

/// What the move leaves of a column.
double GapSearch::left_of(double x, double y, double material) {
  double left = material;
  for (const PartPiece& piece : pieces_) {
    piece.windows(x, y, cutter_.radius_mm(), cut_);
    for (const PartWindow& window : cut_) {
      const double across = std::min(piece.distance(x, y, window), cutter_.radius_mm());
      left = std::min(left,
                      std::min(piece.z(window.t0), piece.z(window.t1)) + cutter_.height_mm(across));
    }
  }
  return left;
}

/// The t at which the part is nearest to a column: the distance is convex in t on straight pieces,
/// and on arcs as far as the column's own side of the circle goes.
double GapSearch::nearest_at(const PartPiece& piece, double x, double y, double material) const {
  const auto gap = [&](double t) {
    const Vec3 tip = piece.tip(t);
    return gap_of(std::hypot(x - tip.x, y - tip.y) - part_.radius_mm,
                  tip.z + part_.from_z_mm - material);
  };
  double from = 0, to = 1;
  if (piece.turns) {
    // The best of so many places a turn, then between its neighbours.
    const int steps = std::max(8, static_cast<int>(std::ceil(std::abs(piece.sweep_rad) * 8)));
    int best = 0;
    for (int n = 1; n <= steps; ++n)
      if (gap(static_cast<double>(n) / steps) < gap(static_cast<double>(best) / steps)) best = n;
    from = static_cast<double>(std::max(0, best - 1)) / steps;
    to = static_cast<double>(std::min(steps, best + 1)) / steps;
  }
  for (int n = 0; n < kThirds; ++n) {
    const double a = from + (to - from) / 3, b = to - (to - from) / 3;
    (gap(a) <= gap(b) ? to : from) = gap(a) <= gap(b) ? b : a;
  }
  return 0.5 * (from + to);
}

void GapSearch::look(std::size_t index, double x, double y, double material) {
  const PartPiece& piece = pieces_[index];
  const double across = piece.distance(x, y, kWhole) - part_.radius_mm;
  if (across >= least_mm_) return;
  const double bottom = std::min(piece.z(0), piece.z(1)) + part_.from_z_mm;
  if (gap_of(across, bottom - material) >= least_mm_) return;
  const double left = left_of(x, y, material);
  if (gap_of(across, bottom - left) >= least_mm_) return;
  const double t = nearest_at(piece, x, y, left);
  const Vec3 tip = piece.tip(t);
  const double gap =
      gap_of(std::hypot(x - tip.x, y - tip.y) - part_.radius_mm, tip.z + part_.from_z_mm - left);
  if (gap >= least_mm_) return;
  least_mm_ = gap;
  piece_ = index;
  t_ = t;
}

}  // namespace

double find_part_spare_mm(const TileGrid& grid, TileTops& tops, const CarriedPart& part,
                          const CutMove& move, double enough_mm, double most_mm) {
  const double half_cell = 0.5 * std::hypot(grid.cell_x_mm(), grid.cell_y_mm());
  double spare = most_mm;
  for (const PartPiece& piece : pieces_of(move, kChord_mm)) {
    const double bottom = std::min(piece.z(0), piece.z(1)) + part.from_z_mm;
    for_each_near_tile(grid, tops, part, piece, spare, [&](std::size_t tile, double low) {
      if (low >= enough_mm) {
        spare = std::min(spare, low);
        return;
      }
      // Nothing of it is farther than `spare`, or it is not among these cells.
      double least = spare;
      for_each_high_cell(grid, tile, bottom - spare, [&](double x, double y, double material) {
        const double across = piece.distance(x, y, kWhole) - half_cell - part.radius_mm;
        least = std::min(least, gap_of(across, bottom - material));
      });
      spare = std::min(spare, least);
    });
    if (spare <= 0) return 0;
  }
  return spare;
}

std::optional<PartGap> find_part_gap(const TileGrid& grid, TileTops& tops, const Cutter& cutter,
                                     const CarriedPart& part, const CutMove& move,
                                     double below_mm) {
  GapSearch search(cutter, part, move, below_mm);
  search.run(grid, tops);
  if (search.least_mm() >= below_mm) return std::nullopt;
  return search.found();
}

}  // namespace kerf
