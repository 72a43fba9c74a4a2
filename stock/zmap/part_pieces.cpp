#include "stock/zmap/part_pieces.h"

#include <glm/geometric.hpp>
#include <optional>

#include "base/portable_math.h"
#include "stock/zmap/path_builder.h"

namespace kerf {

PartCells cells_of(const TileGrid& grid, const Vec2& low, const Vec2& high) {
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

void PartPiece::bounds(Vec2& low, Vec2& high) const {
  low = {std::min(from.x, from.x + step.x), std::min(from.y, from.y + step.y)};
  high = {std::max(from.x, from.x + step.x), std::max(from.y, from.y + step.y)};
  if (!turns) return;
  low = center - arm;
  high = center + arm;
}

double PartPiece::distance(double x, double y, const PartWindow& window) const {
  if (turns) return std::abs(glm::length(Vec2(x, y) - center) - arm);
  const Vec2 p(x - from.x, y - from.y), way(step);
  const double length2 = glm::dot(way, way);
  const double along = length2 > 0 ? glm::dot(p, way) / length2 : 0.0;
  return glm::length(p - std::clamp(along, window.t0, window.t1) * way);
}

void PartPiece::windows(double x, double y, double radius, PartWindows& out) const {
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
    const PartWindow window{std::max(0.0, along - half), std::min(1.0, along + half)};
    if (window.t0 <= window.t1) out.push_back(window);
    return;
  }
  const double qx = x - center.x, qy = y - center.y, q = portable::hypot(qx, qy);
  if (std::abs(q - arm) > radius) return;
  if (q + arm <= radius) {
    out.push_back({0, 1});
    return;
  }
  // The law of cosines: the distance is `radius` so far on either side of the column's own angle.
  const double cosine = (q * q + arm * arm - radius * radius) / (2 * q * arm);
  const double half = portable::acos(std::clamp(cosine, -1.0, 1.0));
  const double end_rad = begin_rad + sweep_rad;
  const double low = std::min(begin_rad, end_rad), high = std::max(begin_rad, end_rad);
  const double own = portable::atan2(qy, qx);
  double middle = own + 2 * kPi * std::ceil((low - half - own) / (2 * kPi));
  for (; middle - half <= high; middle += 2 * kPi) {
    const double a = std::max(low, middle - half), b = std::min(high, middle + half);
    const double ta = (a - begin_rad) / sweep_rad, tb = (b - begin_rad) / sweep_rad;
    out.push_back({std::min(ta, tb), std::max(ta, tb)});
  }
  if (sweep_rad < 0) std::reverse(out.begin(), out.end());
}

namespace {

/// Arcs whose radius differs so much from end to end are spirals.
constexpr double kSameRadius_mm = 0.002;

/// Nothing, if its times are told by chords only.
std::optional<PartPiece> arc_piece(const CutMove& move) {
  const CutArc& arc = *move.arc;
  if (std::abs(arc.axis.z) < 1 - 1e-12 || arc.sweep_rad == 0) return std::nullopt;
  const double begin =
      portable::hypot(move.from_mm.x - arc.center_mm.x, move.from_mm.y - arc.center_mm.y);
  const double end =
      portable::hypot(move.to_mm.x - arc.center_mm.x, move.to_mm.y - arc.center_mm.y);
  if (std::abs(begin - end) > kSameRadius_mm || begin == 0) return std::nullopt;
  PartPiece piece;
  piece.turns = true;
  piece.from = move.from_mm;
  piece.step = {0, 0, move.to_mm.z - move.from_mm.z};
  piece.center = {arc.center_mm.x, arc.center_mm.y};
  piece.arm = 0.5 * (begin + end);
  piece.begin_rad =
      portable::atan2(move.from_mm.y - arc.center_mm.y, move.from_mm.x - arc.center_mm.x);
  piece.sweep_rad = arc.axis.z < 0 ? -arc.sweep_rad : arc.sweep_rad;
  return piece;
}

}  // namespace

std::vector<PartPiece> pieces_of(const CutMove& move, double tolerance_mm) {
  if (move.arc)
    if (const std::optional<PartPiece> whole = arc_piece(move)) return {*whole};
  std::vector<Vec3> points{move.to_mm};
  if (move.arc) points = arc_chord_points(move, tolerance_mm);
  std::vector<PartPiece> pieces;
  Vec3 from = move.from_mm;
  for (const Vec3& to : points) {
    PartPiece piece;
    piece.from = from;
    piece.step = to - from;
    pieces.push_back(piece);
    from = to;
  }
  return pieces;
}

}  // namespace kerf
