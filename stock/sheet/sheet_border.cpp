#include "stock/sheet/sheet_border.h"

#include <algorithm>
#include <cmath>

#include "base/portable_math.h"

namespace kerf::sheet {
namespace {

/// How far a border corner may be off the straight line through its neighbours: rounding moves it
/// by half a unit each way.
constexpr double kStraight_units = 1;

struct DirectedEdge {
  Point from, to;
};

bool before(const Point& a, const Point& b) { return a.X != b.X ? a.X < b.X : a.Y < b.Y; }

/// Which side of `rect` the edge lies on; -1 if on none.
int side_of(const Rect& rect, const Point& a, const Point& b) {
  if (a.X == b.X && a.X == rect.min_x) return kLeft;
  if (a.X == b.X && a.X == rect.max_x) return kRight;
  if (a.Y == b.Y && a.Y == rect.min_y) return kBottom;
  if (a.Y == b.Y && a.Y == rect.max_y) return kTop;
  return -1;
}

Unit along(int side, const Point& p) { return side == kLeft || side == kRight ? p.Y : p.X; }

/// What a tile sees beyond one of its sides.
struct Neighbour {
  std::vector<Unit> corners;                // on the common border, ascending
  std::vector<std::pair<Unit, Unit>> runs;  // where its material meets the border

  bool covers(Unit low, Unit high) const {
    return std::any_of(runs.begin(), runs.end(), [&](const std::pair<Unit, Unit>& run) {
      return run.first <= low && high <= run.second;
    });
  }
};

std::array<Neighbour, 4> neighbours_of(const SheetGrid& grid, std::size_t index) {
  std::array<Neighbour, 4> neighbours;
  for (int side = 0; side < 4; ++side) {
    const std::int64_t next = grid.neighbour(index, static_cast<BorderSide>(side));
    if (next < 0) continue;
    Neighbour& neighbour = neighbours[static_cast<std::size_t>(side)];
    const Tile& tile = grid.tile(static_cast<std::size_t>(next));
    const int opposite = (side + 2) % 4;
    for (const BorderRun& run : tile.runs) {
      if (run.side != opposite) continue;
      neighbour.runs.emplace_back(run.low, run.high);
      neighbour.corners.push_back(run.low);
      neighbour.corners.push_back(run.high);
    }
    std::sort(neighbour.corners.begin(), neighbour.corners.end());
  }
  return neighbours;
}

FittedRing fit(const Ring& ring, const Rect& rect, const std::array<Neighbour, 4>& neighbours) {
  FittedRing fitted;
  fitted.points.reserve(ring.size() + 4);
  fitted.is_edge.reserve(ring.size() + 4);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point a = ring[i], b = ring[(i + 1) % ring.size()];
    const int side = side_of(rect, a, b);
    if (side < 0) {
      fitted.points.push_back(a);
      fitted.is_edge.push_back(1);
      continue;
    }
    const Neighbour& neighbour = neighbours[static_cast<std::size_t>(side)];
    const Unit from = along(side, a), to = along(side, b);
    std::vector<Unit> stops;
    for (const Unit corner : neighbour.corners) {
      const bool within = std::min(from, to) < corner && corner < std::max(from, to);
      if (within && (stops.empty() || stops.back() != corner)) stops.push_back(corner);
    }
    if (from > to) std::reverse(stops.begin(), stops.end());
    stops.push_back(to);
    Unit at = from;
    for (const Unit stop : stops) {
      Point p = a;
      (side == kLeft || side == kRight ? p.Y : p.X) = at;
      fitted.points.push_back(p);
      fitted.is_edge.push_back(!neighbour.covers(std::min(at, stop), std::max(at, stop)));
      at = stop;
    }
  }
  return fitted;
}

/// Where edges of several rings meet in one point, goes on along the material that it came along:
/// the first way out clockwise from the way back.
std::size_t way_out(const std::vector<DirectedEdge>& edges, const std::vector<char>& used,
                    std::size_t first, const Point& from, const Point& at) {
  const double back =
      portable::atan2(static_cast<double>(from.Y - at.Y), static_cast<double>(from.X - at.X));
  std::size_t best = edges.size();
  double best_turn = 0;
  for (std::size_t i = first; i < edges.size() && edges[i].from == at; ++i) {
    if (used[i]) continue;
    const Point& to = edges[i].to;
    const double out =
        portable::atan2(static_cast<double>(to.Y - at.Y), static_cast<double>(to.X - at.X));
    double clockwise = back - out;
    while (clockwise <= 0) clockwise += 2 * kPi;
    if (best == edges.size() || clockwise < best_turn) {
      best = i;
      best_turn = clockwise;
    }
  }
  return best;
}

Rings chain(std::vector<DirectedEdge> edges) {
  std::sort(edges.begin(), edges.end(), [](const DirectedEdge& e, const DirectedEdge& f) {
    return e.from != f.from ? before(e.from, f.from) : before(e.to, f.to);
  });
  const auto first_from = [&](const Point& p) {
    const auto at = std::lower_bound(
        edges.begin(), edges.end(), p,
        [](const DirectedEdge& e, const Point& point) { return before(e.from, point); });
    return static_cast<std::size_t>(at - edges.begin());
  };
  std::vector<char> used(edges.size(), 0);
  Rings rings;
  for (std::size_t start = 0; start < edges.size(); ++start) {
    if (used[start]) continue;
    Ring ring;
    for (std::size_t i = start; i < edges.size() && !used[i];) {
      used[i] = 1;
      ring.push_back(edges[i].from);
      if (edges[i].to == edges[start].from) break;
      i = way_out(edges, used, first_from(edges[i].to), edges[i].from, edges[i].to);
    }
    rings.push_back(std::move(ring));
  }
  return rings;
}

bool is_straight(const Point& a, const Point& b, const Point& c) {
  const double length =
      portable::hypot(static_cast<double>(c.X - a.X), static_cast<double>(c.Y - a.Y));
  const double ahead = static_cast<double>(b.X - a.X) * static_cast<double>(c.X - b.X) +
                       static_cast<double>(b.Y - a.Y) * static_cast<double>(c.Y - b.Y);
  return ahead > 0 && std::abs(static_cast<double>(turn(a, b, c))) <= kStraight_units * length;
}

/// Whether a line of the tiling passes through p.
class TilingLines {
 public:
  explicit TilingLines(const SheetGrid& grid) {
    for (int column = 1; column < grid.columns(); ++column)
      x_.push_back(grid.tile_rect(grid.index_of(column, 0)).min_x);
    for (int row = 1; row < grid.rows(); ++row)
      y_.push_back(grid.tile_rect(grid.index_of(0, row)).min_y);
  }
  bool pass(const Point& p) const {
    return std::binary_search(x_.begin(), x_.end(), p.X) ||
           std::binary_search(y_.begin(), y_.end(), p.Y);
  }

 private:
  std::vector<Unit> x_, y_;
};

Ring without_crossings(const Ring& ring, const TilingLines& lines) {
  Ring kept;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point& a = kept.empty() ? ring.back() : kept.back();
    if (lines.pass(ring[i]) && is_straight(a, ring[i], ring[(i + 1) % ring.size()])) continue;
    kept.push_back(ring[i]);
  }
  return kept.size() >= 3 ? kept : ring;
}

}  // namespace

std::vector<FittedRing> fit_to_neighbours(const SheetGrid& grid, std::size_t index) {
  const std::array<Neighbour, 4> neighbours = neighbours_of(grid, index);
  const Rect rect = grid.tile_rect(index);
  std::vector<FittedRing> fitted;
  for (const TileRingPointer& ring : grid.tile(index).rings)
    fitted.push_back(fit(ring->points, rect, neighbours));
  return fitted;
}

Rings outline_of(const SheetGrid& grid, std::uint32_t piece) {
  std::vector<DirectedEdge> edges;
  for (std::size_t t = 0; t < grid.tile_count(); ++t) {
    const Tile& tile = grid.tile(t);
    const bool here = std::find(tile.pieces.begin(), tile.pieces.end(), piece) != tile.pieces.end();
    if (tile.rings.empty() || (piece != kNoPiece && !here)) continue;
    const std::vector<std::uint32_t> owner = owners(tile);
    const std::vector<FittedRing> fitted = fit_to_neighbours(grid, t);
    for (std::size_t r = 0; r < fitted.size(); ++r) {
      if (piece != kNoPiece && tile.pieces[owner[r]] != piece) continue;
      const Ring& points = fitted[r].points;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (fitted[r].is_edge[i]) edges.push_back({points[i], points[(i + 1) % points.size()]});
      }
    }
  }
  const TilingLines lines(grid);
  Rings rings;
  for (const Ring& ring : chain(std::move(edges))) rings.push_back(without_crossings(ring, lines));
  return rings;
}

}  // namespace kerf::sheet
