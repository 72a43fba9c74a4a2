#include "stock/zmap/part_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stock/zmap/path_builder.h"

namespace kerf {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

struct CellRange {
  int i0, i1, j0, j1;  ///< the last ones included; empty: i0 > i1 or j0 > j1
};

CellRange cells_of(const TileGrid& grid, const Vec2& low, const Vec2& high) {
  const Box& box = grid.bounds_mm();
  const auto cell = [](double position, double origin, double edge, int count) {
    return static_cast<int>(
        std::clamp(std::floor((position - origin) / edge), -1.0, static_cast<double>(count)));
  };
  return {std::max(0, cell(low.x, box.min.x, grid.cell_x_mm(), grid.nx())),
          std::min(grid.nx() - 1, cell(high.x, box.min.x, grid.cell_x_mm(), grid.nx())),
          std::max(0, cell(low.y, box.min.y, grid.cell_y_mm(), grid.ny())),
          std::min(grid.ny() - 1, cell(high.y, box.min.y, grid.cell_y_mm(), grid.ny()))};
}

/// When something is over a column: times within 0..1.
struct Window {
  double t0, t1;
};
using Windows = std::vector<Window>;

/// Part of a move along which times can be told in closed form: straight, or about a vertical axis
/// with one radius. Z is linear in time.
struct Piece {
  Vec3 from{0}, step{0};  ///< of an arc only z of `step` counts
  bool turns = false;
  Vec2 center{0};
  double arm = 0, begin_rad = 0, sweep_rad = 0;

  double z(double t) const { return from.z + t * step.z; }
  Vec3 tip(double t) const {
    if (!turns) return from + t * step;
    const double angle = begin_rad + t * sweep_rad;
    return {center.x + arm * std::cos(angle), center.y + arm * std::sin(angle), z(t)};
  }
  /// When (x, y) is within `radius` of the axis, in order.
  void windows(double x, double y, double radius, Windows& out) const;
  /// No more than the least distance between (x, y) and the axis during `window`.
  double distance(double x, double y, const Window& window) const {
    if (turns) return std::abs(std::hypot(x - center.x, y - center.y) - arm);
    const double t = 0.5 * (window.t0 + window.t1);
    return std::hypot(x - from.x - t * step.x, y - from.y - t * step.y);
  }
};

void Piece::windows(double x, double y, double radius, Windows& out) const {
  out.clear();
  if (!turns) {
    const double px = x - from.x, py = y - from.y;
    const double length2 = step.x * step.x + step.y * step.y;
    if (length2 < 1e-18) {
      if (px * px + py * py <= radius * radius) out.push_back({0, 1});
      return;
    }
    const double along = (px * step.x + py * step.y) / length2;
    const double across2 = px * px + py * py - along * along * length2;
    const double half2 = (radius * radius - across2) / length2;
    if (half2 < 0) return;
    const double half = std::sqrt(half2);
    const Window window{std::max(0.0, along - half), std::min(1.0, along + half)};
    if (window.t0 <= window.t1) out.push_back(window);
    return;
  }
  const double qx = x - center.x, qy = y - center.y, q = std::hypot(qx, qy);
  if (std::abs(q - arm) > radius) return;
  if (q + arm <= radius) {
    out.push_back({0, 1});
    return;
  }
  // The law of cosines: the distance is `radius` so far on either side of the column's own angle.
  const double cosine = (q * q + arm * arm - radius * radius) / (2 * q * arm);
  const double half = std::acos(std::clamp(cosine, -1.0, 1.0));
  const double end_rad = begin_rad + sweep_rad;
  const double low = std::min(begin_rad, end_rad), high = std::max(begin_rad, end_rad);
  const double own = std::atan2(qy, qx);
  double middle = own + 2 * kPi * std::ceil((low - half - own) / (2 * kPi));
  for (; middle - half <= high; middle += 2 * kPi) {
    const double a = std::max(low, middle - half), b = std::min(high, middle + half);
    const double ta = (a - begin_rad) / sweep_rad, tb = (b - begin_rad) / sweep_rad;
    out.push_back({std::min(ta, tb), std::max(ta, tb)});
  }
  if (sweep_rad < 0) std::reverse(out.begin(), out.end());
}

/// Arcs whose radius differs so much from end to end are spirals.
constexpr double kSameRadius_mm = 0.002;

/// Nothing, if its times are told by chords only.
std::optional<Piece> arc_piece(const CutMove& move) {
  const CutArc& arc = *move.arc;
  if (std::abs(arc.axis.z) < 1 - 1e-12 || arc.sweep_rad == 0) return std::nullopt;
  const double begin =
      std::hypot(move.from_mm.x - arc.center_mm.x, move.from_mm.y - arc.center_mm.y);
  const double end = std::hypot(move.to_mm.x - arc.center_mm.x, move.to_mm.y - arc.center_mm.y);
  if (std::abs(begin - end) > kSameRadius_mm || begin == 0) return std::nullopt;
  Piece piece;
  piece.turns = true;
  piece.from = move.from_mm;
  piece.step = {0, 0, move.to_mm.z - move.from_mm.z};
  piece.center = {arc.center_mm.x, arc.center_mm.y};
  piece.arm = 0.5 * (begin + end);
  piece.begin_rad = std::atan2(move.from_mm.y - arc.center_mm.y, move.from_mm.x - arc.center_mm.x);
  piece.sweep_rad = arc.axis.z < 0 ? -arc.sweep_rad : arc.sweep_rad;
  return piece;
}

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
  void scan_tile(std::size_t piece, const CellRange& range, double level);
  void look(std::size_t piece, double x, double y, double material);
  void note(std::size_t piece, double t, double deepest);
  bool was_cut(std::size_t piece, double x, double y, double material);
  void meet(std::size_t piece, double level, double a, double b);

  const TileGrid& grid_;
  TileTops& tops_;
  const Cutter& cutter_;
  const CarriedPart& part_;
  double reach_, bottom_, flutes_, tolerance_;
  std::vector<Piece> pieces_;
  Windows over_, cut_;  ///< of a column: by the part, by the cutter
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
  const Piece& p = pieces_[index];
  if (a > b) return;
  const double least = std::min(p.z(a), p.z(b)) + bottom_;
  if (least >= level) return;
  double t = a;
  if (p.step.z < 0 && p.z(a) + part_.from_z_mm >= level)
    t = std::clamp((level - part_.from_z_mm - p.from.z) / p.step.z, a, b);
  note(index, t, level - least);
}

/// A column whose middle is at (x, y).
void Search::look(std::size_t index, double x, double y, double material) {
  const Piece& p = pieces_[index];
  p.windows(x, y, reach_, over_);
  if (over_.empty() || was_cut(index, x, y, material)) return;
  p.windows(x, y, cutter_.radius_mm(), cut_);
  if (cut_.empty() || material > p.z(cut_[0].t0) + flutes_) {  // it stays where it is
    for (const Window& over : over_) meet(index, material, over.t0, over.t1);
    return;
  }
  for (const Window& over : over_) {
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

void Search::scan_tile(std::size_t piece, const CellRange& range, double level) {
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
  const Piece& p = pieces_[index];
  const double level = std::min(p.z(0), p.z(1)) + bottom_;
  if (level >= grid_.bounds_mm().max.z || reach_ <= 0) return;
  Vec2 low{std::min(p.from.x, p.from.x + p.step.x), std::min(p.from.y, p.from.y + p.step.y)};
  Vec2 high{std::max(p.from.x, p.from.x + p.step.x), std::max(p.from.y, p.from.y + p.step.y)};
  if (p.turns) {
    low = p.center - p.arm;
    high = p.center + p.arm;
  }
  const CellRange all = cells_of(grid_, low - reach_, high + reach_);
  if (all.i0 > all.i1 || all.j0 > all.j1) return;
  for (int ty = all.j0 / kTileCells; ty <= all.j1 / kTileCells; ++ty) {
    for (int tx = all.i0 / kTileCells; tx <= all.i1 / kTileCells; ++tx) {
      const std::size_t tile =
          static_cast<std::size_t>(ty) * static_cast<std::size_t>(grid_.tiles_x()) +
          static_cast<std::size_t>(tx);
      if (static_cast<double>(tops_.top_mm(grid_, tile)) <= level) continue;
      const Box box = grid_.tile_box(tile);
      const Vec3 middle = 0.5 * (box.min + box.max);
      const double around = 0.5 * std::hypot(box.size().x, box.size().y);
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
  const std::optional<Piece> whole = move.arc ? arc_piece(move) : std::nullopt;
  if (whole) {
    pieces_.push_back(*whole);
  } else {
    std::vector<Vec3> points{move.to_mm};
    if (move.arc) points = arc_chord_points(move, tolerance_);
    Vec3 from = move.from_mm;
    for (const Vec3& to : points) {
      Piece piece;
      piece.from = from;
      piece.step = to - from;
      pieces_.push_back(piece);
      from = to;
    }
  }
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

double TileTops::highest_mm(const TileGrid& grid, const Vec2& low, const Vec2& high) {
  const CellRange range = cells_of(grid, low, high);
  double most = -kNever;
  if (range.i0 > range.i1 || range.j0 > range.j1) return most;
  for (int ty = range.j0 / kTileCells; ty <= range.j1 / kTileCells; ++ty) {
    for (int tx = range.i0 / kTileCells; tx <= range.i1 / kTileCells; ++tx) {
      const std::size_t tile =
          static_cast<std::size_t>(ty) * static_cast<std::size_t>(grid.tiles_x()) +
          static_cast<std::size_t>(tx);
      most = std::max(most, static_cast<double>(top_mm(grid, tile)));
    }
  }
  return most;
}

std::optional<PartContact> find_part_contact(const TileGrid& grid, TileTops& tops,
                                             const Cutter& cutter, const CarriedPart& part,
                                             const CutMove& move, double tolerance_mm) {
  return Search(grid, tops, cutter, part, tolerance_mm).run(move);
}

}  // namespace kerf
