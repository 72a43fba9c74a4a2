#include "stock/sheet/tile.h"

#include <algorithm>
#include <atomic>

namespace kerf::sheet {
namespace {

/// Material lies to the left of an outer ring's edge, so along each side of the tile edges that
/// bound material run one way only.
void add_runs(const Rect& rect, const Ring& ring, std::uint32_t number,
              std::vector<BorderRun>& runs) {
  Point a = ring.back();
  for (const Point& b : ring) {
    if (a.X == b.X) {
      if (a.X == rect.min_x && b.Y < a.Y) runs.push_back({b.Y, a.Y, number, kLeft});
      if (a.X == rect.max_x && b.Y > a.Y) runs.push_back({a.Y, b.Y, number, kRight});
    } else if (a.Y == b.Y) {
      if (a.Y == rect.min_y && b.X > a.X) runs.push_back({a.X, b.X, number, kBottom});
      if (a.Y == rect.max_y && b.X < a.X) runs.push_back({b.X, a.X, number, kTop});
    }
    a = b;
  }
}

bool touches_border(const Rect& rect, const Rect& box) {
  return box.min_x <= rect.min_x || box.min_y <= rect.min_y || box.max_x >= rect.max_x ||
         box.max_y >= rect.max_y;
}

/// The smallest of the outer rings that p is in or on; kNoPiece if there is none. `certain`: it is
/// strictly inside of it, or in no other at all.
std::uint32_t innermost(const Point& p, const Tile& tile, std::span<const std::uint32_t> outer,
                        bool& certain) {
  std::uint32_t best = kNoPiece;
  int found = 0;
  bool inside = false;
  for (const std::uint32_t i : outer) {
    const TileRing& ring = *tile.rings[i];
    if (!ring.box.holds(p)) continue;
    const Side side = locate(p, ring.points);
    if (side == Side::kOutside) continue;
    ++found;
    if (best == kNoPiece || ring.area2 < tile.rings[best]->area2) {
      best = i;
      inside = side == Side::kInside;
    }
  }
  certain = found == 1 || (found > 1 && inside);
  return best;
}

}  // namespace

std::uint64_t next_version() {
  static std::atomic<std::uint64_t> last{0};
  return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

TileRingPointer make_tile_ring(Ring points) {
  auto ring = std::make_shared<TileRing>();
  ring->points = std::move(points);
  ring->box = bounds_of(ring->points);
  ring->area2 = twice_area(ring->points);
  return ring;
}

Tile make_tile(const Rect& rect, std::vector<TileRingPointer> rings) {
  Tile tile;
  tile.rings = std::move(rings);
  tile.pieces.assign(tile.rings.size(), kNoPiece);
  for (std::uint32_t i = 0; i < tile.rings.size(); ++i) {
    const TileRing& ring = *tile.rings[i];
    tile.area2 += ring.area2;
    if (ring.is_outer() && touches_border(rect, ring.box))
      add_runs(rect, ring.points, i, tile.runs);
  }
  std::sort(tile.runs.begin(), tile.runs.end(), [](const BorderRun& a, const BorderRun& b) {
    return a.side != b.side ? a.side < b.side : a.low < b.low;
  });
  for (const BorderRun& run : tile.runs) ++tile.first_run[run.side + 1u];
  for (std::size_t side = 0; side < 4; ++side) tile.first_run[side + 1] += tile.first_run[side];
  tile.version = next_version();
  return tile;
}

std::vector<std::uint32_t> owners(const Tile& tile) {
  std::vector<std::uint32_t> owner(tile.rings.size()), outer;
  for (std::uint32_t i = 0; i < owner.size(); ++i) {
    owner[i] = i;
    if (tile.rings[i]->is_outer()) outer.push_back(i);
  }
  for (std::uint32_t i = 0; i < owner.size(); ++i) {
    if (!tile.rings[i]->is_outer()) owner[i] = origin_of(tile.rings[i]->points, tile, outer);
  }
  return owner;
}

std::uint32_t origin_of(const Ring& ring, const Tile& tile,
                        std::span<const std::uint32_t> candidates) {
  std::vector<std::uint32_t> outer;
  for (const std::uint32_t i : candidates) {
    if (tile.rings[i]->is_outer()) outer.push_back(i);
  }
  if (outer.size() == 1) return outer[0];
  std::uint32_t fallback = kNoPiece;
  for (const Point& p : ring) {
    bool certain = false;
    const std::uint32_t found = innermost(p, tile, outer, certain);
    if (found != kNoPiece && certain) return found;
    if (fallback == kNoPiece) fallback = found;
  }
  if (fallback != kNoPiece) return fallback;
  // Every corner was rounded outward: a speck beside its ring.
  const Rect box = bounds_of(ring);
  fallback = outer[0];
  for (const std::uint32_t i : outer) {
    if (tile.rings[i]->box.meets(box)) fallback = i;
  }
  return fallback;
}

}  // namespace kerf::sheet
