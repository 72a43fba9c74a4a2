#include "stock/zmap/part_gap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "base/portable_math.h"
#include "stock/zmap/part_pieces.h"

namespace kerf {
namespace {

/// Arcs that are chords: what these leave.
constexpr double kChord_mm = 0.001;
/// A ramp is taken as steps of this height, each as low as its lowest place.
constexpr double kLevel_mm = 0.02;
constexpr PartWindow kWhole{0, 1};

/// A disc's distance, in its plane and below.
double gap_of(double across_mm, double above_mm) {
  const double across = std::max(0.0, across_mm), above = std::max(0.0, above_mm);
  return across == 0 ? above : above == 0 ? across : std::sqrt(across * across + above * above);
}

/// Cells that are within `around_mm` of the axis, in boxes.
PartCells cells_around(const TileGrid& grid, const PartPiece& piece, double around_mm) {
  Vec2 low, high;
  piece.bounds(low, high);
  return cells_of(grid, low - around_mm, high + around_mm);
}

/// Calls visit(tile, low) for each tile that may be nearer to the part than `within`: nothing of it
/// is nearer than low. visit() may lessen `within`.
template <class Visit>
void for_each_near_tile(const TileGrid& grid, TileTops& tops, const CarriedPart& part,
                        const PartPiece& piece, double& within, const Visit& visit) {
  const double bottom = std::min(piece.z(0), piece.z(1)) + part.from_z_mm;
  if (bottom - grid.bounds_mm().max.z >= within) return;
  const PartCells all = cells_around(grid, piece, part.radius_mm + std::max(0.0, within));
  if (all.i0 > all.i1 || all.j0 > all.j1) return;
  for (int ty = all.j0 / kTileCells; ty <= all.j1 / kTileCells; ++ty) {
    for (int tx = all.i0 / kTileCells; tx <= all.i1 / kTileCells; ++tx) {
      const std::size_t tile =
          static_cast<std::size_t>(ty) * static_cast<std::size_t>(grid.tiles_x()) +
          static_cast<std::size_t>(tx);
      const double above = bottom - static_cast<double>(tops.top_mm(grid, tile));
      if (above >= within) continue;
      const Box box = grid.tile_box(tile);
      const double half = 0.5 * portable::hypot(box.size().x, box.size().y);
      const Vec3 middle = 0.5 * (box.min + box.max);
      const double across = piece.distance(middle.x, middle.y, kWhole) - half - part.radius_mm;
      const double least = gap_of(across, above);
      if (least < within) visit(tile, least);
    }
  }
}

/// Calls visit(x, y, material) for each of those cells of a tile that is higher than `level`.
template <class Visit>
void for_each_high_cell(const TileGrid& grid, std::size_t tile, const PartCells& cells,
                        double level, const Visit& visit) {
  const Box& box = grid.bounds_mm();
  const int i0 = static_cast<int>(tile) % grid.tiles_x() * kTileCells;
  const int j0 = static_cast<int>(tile) / grid.tiles_x() * kTileCells;
  const float* const heights = grid.tile(tile);
  for (int j = std::max(j0, cells.j0); j < j0 + kTileCells && j <= cells.j1; ++j) {
    const double y = box.min.y + (j + 0.5) * grid.cell_y_mm();
    for (int i = std::max(i0, cells.i0); i < i0 + kTileCells && i <= cells.i1; ++i) {
      const double material = static_cast<double>(heights[TileGrid::offset(i, j)]);
      if (material <= level || material <= grid.floor_mm()) continue;
      visit(box.min.x + (i + 0.5) * grid.cell_x_mm(), y, material);
    }
  }
}

/// A part of a piece that is level, but for kLevel_mm: there the nearest place is the one that is
/// nearest seen from above.
struct LevelPiece {
  std::size_t piece;
  double from_t, to_t;
  double z;        ///< of the tip, the lowest
  Vec2 a, b;       ///< where it begins and ends
  Vec2 middle{0};  ///< of an arc: unit vector from the centre to the middle of it
  double cos_half = 0;
};

class GapSearch {
 public:
  GapSearch(const Cutter& cutter, const CarriedPart& part, const CutMove& move, double below_mm)
      : cutter_(cutter), part_(part), pieces_(pieces_of(move, kChord_mm)), least_mm_(below_mm) {}

  void run(const TileGrid& grid, TileTops& tops);
  double least_mm() const { return least_mm_; }
  PartGap found() const {
    const double t = (static_cast<double>(piece_) + t_) / static_cast<double>(pieces_.size());
    return {least_mm_, t, pieces_[piece_].tip(t_)};
  }

 private:
  void divide(double top_mm);
  double across(const LevelPiece& level, double x, double y) const;
  double time_of(const LevelPiece& level, double x, double y) const;
  void look(const LevelPiece& level, double x, double y, double material);
  double left_of(double x, double y, double material);

  const Cutter& cutter_;
  const CarriedPart& part_;
  std::vector<PartPiece> pieces_;
  std::vector<LevelPiece> levels_;
  double least_mm_;
  double floor_mm_ = 0;
  std::size_t piece_ = 0;
  double t_ = 0;
  PartWindows cut_;
};

/// Into level pieces, the lowest first: those above them mostly need no look.
void GapSearch::divide(double top_mm) {
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const PartPiece& piece = pieces_[i];
    const bool upright = !piece.turns && piece.step.x == 0 && piece.step.y == 0;
    const double rise = std::abs(piece.step.z);
    const int parts = upright ? 1 : std::max(1, static_cast<int>(std::ceil(rise / kLevel_mm)));
    for (int n = 0; n < parts; ++n) {
      LevelPiece level{};
      level.piece = i;
      level.from_t = static_cast<double>(n) / parts;
      level.to_t = static_cast<double>(n + 1) / parts;
      level.z = std::min(piece.z(level.from_t), piece.z(level.to_t));
      if (level.z + part_.from_z_mm - top_mm >= least_mm_) continue;
      level.a = Vec2(piece.tip(level.from_t));
      level.b = Vec2(piece.tip(level.to_t));
      if (piece.turns) {
        const double half = 0.5 * std::abs(piece.sweep_rad) * (level.to_t - level.from_t);
        const double angle = piece.begin_rad + 0.5 * (level.from_t + level.to_t) * piece.sweep_rad;
        level.middle = {portable::cos(angle), portable::sin(angle)};
        level.cos_half = half >= kPi ? -2 : portable::cos(half);
      }
      levels_.push_back(level);
    }
  }
  std::stable_sort(levels_.begin(), levels_.end(),
                   [](const LevelPiece& a, const LevelPiece& b) { return a.z < b.z; });
}

/// Of (x, y) from the axis.
double GapSearch::across(const LevelPiece& level, double x, double y) const {
  const PartPiece& piece = pieces_[level.piece];
  const Vec2 p(x, y);
  if (!piece.turns) {
    const Vec2 way = level.b - level.a;
    const double length2 = glm::dot(way, way);
    const double along =
        length2 > 0 ? std::clamp(glm::dot(p - level.a, way) / length2, 0.0, 1.0) : 0.0;
    return glm::length(p - level.a - along * way);
  }
  const Vec2 out = p - piece.center;
  const double distance = glm::length(out);
  if (glm::dot(out, level.middle) >= distance * level.cos_half)
    return std::abs(distance - piece.arm);
  return std::min(glm::length(p - level.a), glm::length(p - level.b));
}

/// The fraction of the piece at which it is nearest to (x, y).
double GapSearch::time_of(const LevelPiece& level, double x, double y) const {
  const PartPiece& piece = pieces_[level.piece];
  constexpr int kSteps = 256;
  double best = level.from_t, nearest = std::numeric_limits<double>::infinity();
  for (int n = 0; n <= kSteps; ++n) {
    const double t = level.from_t + (level.to_t - level.from_t) * n / kSteps;
    const Vec3 tip = piece.tip(t);
    const double distance =
        gap_of(glm::length(Vec2(x, y) - Vec2(tip)) - part_.radius_mm, tip.z - level.z);
    if (distance < nearest) best = t;
    nearest = std::min(nearest, distance);
  }
  return best;
}

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

void GapSearch::look(const LevelPiece& level, double x, double y, double material) {
  const double beside = across(level, x, y) - part_.radius_mm;
  const double bottom = level.z + part_.from_z_mm;
  if (beside >= least_mm_ || gap_of(beside, bottom - material) >= least_mm_) return;
  const double left = left_of(x, y, material);
  if (left <= floor_mm_) return;  // there is nothing
  const double gap = gap_of(beside, bottom - left);
  if (gap >= least_mm_) return;
  least_mm_ = gap;
  piece_ = level.piece;
  t_ = time_of(level, x, y);
}

void GapSearch::run(const TileGrid& grid, TileTops& tops) {
  divide(grid.bounds_mm().max.z);
  floor_mm_ = grid.floor_mm();
  for (const LevelPiece& level : levels_) {
    const PartPiece& piece = pieces_[level.piece];
    PartPiece part = piece;
    part.begin_rad += level.from_t * piece.sweep_rad;
    part.sweep_rad *= level.to_t - level.from_t;
    part.from = {level.a.x, level.a.y, level.z};
    part.step = {level.b.x - level.a.x, level.b.y - level.a.y, 0};
    const PartCells cells = cells_around(grid, part, part_.radius_mm + least_mm_);
    for_each_near_tile(grid, tops, part_, part, least_mm_, [&](std::size_t tile, double) {
      const double lowest = level.z + part_.from_z_mm - least_mm_;
      for_each_high_cell(grid, tile, cells, lowest,
                         [&](double x, double y, double material) { look(level, x, y, material); });
    });
  }
}

}  // namespace

double find_part_spare_mm(const TileGrid& grid, TileTops& tops, const CarriedPart& part,
                          const CutMove& move, double enough_mm, double most_mm) {
  const double half_cell = 0.5 * portable::hypot(grid.cell_x_mm(), grid.cell_y_mm());
  double spare = most_mm;
  for (const PartPiece& piece : pieces_of(move, kChord_mm)) {
    const double bottom = std::min(piece.z(0), piece.z(1)) + part.from_z_mm;
    const PartCells cells = cells_around(grid, piece, part.radius_mm + enough_mm + half_cell);
    for_each_near_tile(grid, tops, part, piece, spare, [&](std::size_t tile, double low) {
      if (low >= enough_mm) {
        spare = std::min(spare, low);
        return;
      }
      // Cells that are farther than `enough_mm` are not told apart.
      double least = std::min(spare, enough_mm);
      for_each_high_cell(
          grid, tile, cells, bottom - least, [&](double x, double y, double material) {
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
