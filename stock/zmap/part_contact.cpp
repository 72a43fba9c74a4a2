#include "stock/zmap/part_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/portable_math.h"
#include "stock/zmap/part_pieces.h"

namespace kerf {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

class Search {
 public:
  Search(const TileGrid& grid, TileTops& tops, const Cutter& cutter, const CarriedPart& part,
         double tolerance)
      : grid_(grid),
        tops_(tops),
        cutter_(cutter),
        part_(part),
        reach_(part.radius_mm - tolerance),
        bottom_(part.from_z_mm + tolerance),
        flutes_((cutter.is_flute_length_assumed() ? kNever
                                                  : cutter.flute_length_mm().value_or(kNever)) +
                tolerance),
        tolerance_(tolerance) {}

  std::optional<PartContact> run(const CutMove& move);

 private:
  void scan(std::size_t piece);
  void scan_tile(std::size_t piece, const PartCells& range, double level);
  void look(std::size_t piece, double x, double y, double material);
  void note(std::size_t piece, double t, double deepest);
  bool was_cut(std::size_t piece, double x, double y, double material);
  void meet(std::size_t piece, double level, double a, double b);

  const TileGrid& grid_;
  TileTops& tops_;
  const Cutter& cutter_;
  const CarriedPart& part_;
  double reach_, bottom_, flutes_, tolerance_;
  std::vector<PartPiece> pieces_;
  PartWindows over_, cut_;  ///< of a column: by the part, by the cutter
  std::size_t first_piece_ = 0;
  double first_t_ = kNever;  ///< within that
  double depth_ = 0;
};

void Search::note(std::size_t piece, double t, double deepest) {
  depth_ = std::max(depth_, deepest + tolerance_);
  if (first_t_ == kNever) {
    first_piece_ = piece;
    first_t_ = t;
  } else if (piece == first_piece_) {
    first_t_ = std::min(first_t_, t);
  }
}

/// By a piece before, whose flutes reached as high as the material.
bool Search::was_cut(std::size_t piece, double x, double y, double material) {
  for (std::size_t i = 0; i < piece; ++i) {
    pieces_[i].windows(x, y, cutter_.radius_mm(), cut_);
    if (!cut_.empty()) return material <= pieces_[i].z(cut_[0].t0) + flutes_;
  }
  return false;
}

/// The part is over a column that is so high from a to b.
void Search::meet(std::size_t index, double level, double a, double b) {
  const PartPiece& p = pieces_[index];
  if (a > b || level <= grid_.floor_mm()) return;  // at the floor there is nothing
  const double least = std::min(p.z(a), p.z(b)) + bottom_;
  if (least >= level) return;
  double t = a;
  if (p.step.z < 0 && p.z(a) + part_.from_z_mm >= level)
    t = std::clamp((level - part_.from_z_mm - p.from.z) / p.step.z, a, b);
  note(index, t, level - least);
}

/// A column whose middle is at (x, y).
void Search::look(std::size_t index, double x, double y, double material) {
  const PartPiece& p = pieces_[index];
  p.windows(x, y, reach_, over_);
  if (over_.empty() || was_cut(index, x, y, material)) return;
  p.windows(x, y, cutter_.radius_mm(), cut_);
  if (cut_.empty() || material > p.z(cut_[0].t0) + flutes_) {  // it stays where it is
    for (const PartWindow& over : over_) meet(index, material, over.t0, over.t1);
    return;
  }
  for (const PartWindow& over : over_) {
    if (over.t0 < cut_[0].t0) meet(index, material, over.t0, std::min(over.t1, cut_[0].t0));
    double left = material;
    for (std::size_t k = 0; k < cut_.size() && cut_[k].t1 < over.t1; ++k) {
      left = std::min(
          left, std::min(p.z(cut_[k].t0), p.z(cut_[k].t1)) +
                    cutter_.height_mm(std::min(p.distance(x, y, cut_[k]), cutter_.radius_mm())));
      const double until = k + 1 < cut_.size() ? std::min(over.t1, cut_[k + 1].t0) : over.t1;
      meet(index, left, std::max(over.t0, cut_[k].t1), until);
    }
  }
}

void Search::scan_tile(std::size_t piece, const PartCells& range, double level) {
  const Box& box = grid_.bounds_mm();
  for (int j = range.j0; j <= range.j1; ++j) {
    const double y = box.min.y + (j + 0.5) * grid_.cell_y_mm();
    for (int i = range.i0; i <= range.i1; ++i) {
      const double material = static_cast<double>(grid_.height(i, j));
      if (material <= level || material <= grid_.floor_mm()) continue;
      look(piece, box.min.x + (i + 0.5) * grid_.cell_x_mm(), y, material);
    }
  }
}

void Search::scan(std::size_t index) {
  const PartPiece& p = pieces_[index];
  const double level = std::min(p.z(0), p.z(1)) + bottom_;
  if (level >= grid_.bounds_mm().max.z || reach_ <= 0) return;
  Vec2 low, high;
  p.bounds(low, high);
  const PartCells all = cells_of(grid_, low - reach_, high + reach_);
  if (all.i0 > all.i1 || all.j0 > all.j1) return;
  for (int ty = all.j0 / kTileCells; ty <= all.j1 / kTileCells; ++ty) {
    for (int tx = all.i0 / kTileCells; tx <= all.i1 / kTileCells; ++tx) {
      const std::size_t tile =
          static_cast<std::size_t>(ty) * static_cast<std::size_t>(grid_.tiles_x()) +
          static_cast<std::size_t>(tx);
      if (static_cast<double>(tops_.top_mm(grid_, tile)) <= level) continue;
      const Box box = grid_.tile_box(tile);
      const Vec3 middle = 0.5 * (box.min + box.max);
      const double around = 0.5 * portable::hypot(box.size().x, box.size().y);
      p.windows(middle.x, middle.y, reach_ + around, over_);
      if (over_.empty()) continue;
      scan_tile(index,
                {std::max(all.i0, tx * kTileCells), std::min(all.i1, (tx + 1) * kTileCells - 1),
                 std::max(all.j0, ty * kTileCells), std::min(all.j1, (ty + 1) * kTileCells - 1)},
                level);
    }
  }
}

std::optional<PartContact> Search::run(const CutMove& move) {
  pieces_ = pieces_of(move, tolerance_);
  for (std::size_t i = 0; i < pieces_.size(); ++i) scan(i);
  if (first_t_ == kNever) return std::nullopt;
  const double t =
      (static_cast<double>(first_piece_) + first_t_) / static_cast<double>(pieces_.size());
  return PartContact{pieces_[first_piece_].tip(first_t_), t, depth_};
}

}  // namespace

float TileTops::top_mm(const TileGrid& grid, std::size_t tile) {
  if (tops_.size() != grid.tile_count()) tops_.assign(grid.tile_count(), Top{});
  Top& top = tops_[tile];
  if (!top.known || top.version != grid.version(tile)) {
    const float* heights = grid.tile(tile);
    float most = heights[0];
    for (int i = 1; i < kTileFloats; ++i) most = std::max(most, heights[i]);
    top = {most, true, grid.version(tile)};
  }
  return top.top_mm;
}

std::optional<PartContact> find_part_contact(const TileGrid& grid, TileTops& tops,
                                             const Cutter& cutter, const CarriedPart& part,
                                             const CutMove& move, double tolerance_mm) {
  return Search(grid, tops, cutter, part, tolerance_mm).run(move);
}

}  // namespace kerf
