#include "stock/sheet/triangulate.h"

#include <algorithm>
#include <cmath>

namespace kerf::sheet {
namespace {

/// One corner of the chain that is left. After bridges a point may be several corners.
struct Corner {
  Point at;
  std::uint32_t number;  // as the caller counts
  std::uint32_t previous, next;
};

class Chain {
 public:
  explicit Chain(std::span<const Ring* const> rings) {
    std::vector<std::uint32_t> holes;
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < rings.size(); ++i) {
      const std::uint32_t first = add_loop(*rings[i], number);
      number += static_cast<std::uint32_t>(rings[i]->size());
      if (i > 0) holes.push_back(rightmost(first));
    }
    std::stable_sort(holes.begin(), holes.end(), [this](std::uint32_t a, std::uint32_t b) {
      return corners_[a].at.X > corners_[b].at.X;
    });
    for (const std::uint32_t hole : holes) bridge(hole);
  }

  std::vector<Triangle> clip() {
    std::vector<Triangle> triangles;
    std::size_t left = count_and_note_reflex();
    std::uint32_t current = 0;
    std::size_t failures = 0;
    while (left > 2) {
      // Without an ear only where rounding has let rings cross; then a convex corner has to go.
      const bool stuck = failures > left;
      const bool cut = left == 3 || (stuck && (turn_at(current) > 0 || failures > 2 * left)) ||
                       is_null(current) || is_ear(current);
      const std::uint32_t next = corners_[current].next;
      if (!cut) {
        ++failures;
        current = next;
        continue;
      }
      const Corner& ear = corners_[current];
      triangles.push_back({corners_[ear.previous].number, ear.number, corners_[next].number});
      corners_[ear.previous].next = next;
      corners_[next].previous = ear.previous;
      forget_reflex(current, true);
      forget_reflex(ear.previous, turn_at(ear.previous) > 0);
      forget_reflex(next, turn_at(next) > 0);
      --left;
      failures = 0;
      // Not the neighbour: slivers that all share one corner are avoided.
      current = corners_[next].next;
    }
    return triangles;
  }

 private:
  std::uint32_t add_loop(const Ring& ring, std::uint32_t number) {
    const auto first = static_cast<std::uint32_t>(corners_.size());
    const auto count = static_cast<std::uint32_t>(ring.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      corners_.push_back(
          {ring[i], number + i, first + (i + count - 1) % count, first + (i + 1) % count});
    }
    return first;
  }

  std::uint32_t rightmost(std::uint32_t first) const {
    std::uint32_t best = first;
    for (std::uint32_t i = corners_[first].next; i != first; i = corners_[i].next) {
      if (corners_[i].at.X > corners_[best].at.X) best = i;
    }
    return best;
  }

  std::int64_t turn_at(std::uint32_t i) const {
    const Corner& corner = corners_[i];
    return turn(corners_[corner.previous].at, corner.at, corners_[corner.next].at);
  }

  /// Whether the way from corner i to p begins within the material, or along its edge.
  bool opens_to(std::uint32_t i, const Point& p) const {
    const Corner& corner = corners_[i];
    const std::int64_t from_next = turn(corner.at, corners_[corner.next].at, p);
    const std::int64_t from_previous = turn(corner.at, corners_[corner.previous].at, p);
    if (turn_at(i) > 0) return from_next >= 0 && from_previous <= 0;
    return !(from_next < 0 && from_previous > 0);
  }

  /// Joins the hole whose rightmost corner this is to the chain that contains corner 0.
  void bridge(std::uint32_t hole) {
    const Point m = corners_[hole].at;
    const std::uint32_t hit = first_edge_right_of(m);
    if (hit == kNone) return;  // not within the outer ring: only by a fault of the caller
    const std::uint32_t target = visible_corner(hole, hit);
    const Corner end = corners_[target], begin = corners_[hole];
    const auto hole_copy = static_cast<std::uint32_t>(corners_.size());
    const std::uint32_t target_copy = hole_copy + 1;
    corners_.push_back({begin.at, begin.number, begin.previous, target_copy});
    corners_.push_back({end.at, end.number, hole_copy, end.next});
    corners_[begin.previous].next = hole_copy;
    corners_[end.next].previous = target_copy;
    corners_[target].next = hole;
    corners_[hole].previous = target;
  }

  static double crossing_x(const Point& a, const Point& b, Unit y) {
    const auto wide = [](Unit value) { return static_cast<double>(value); };
    return wide(a.X) + wide(y - a.Y) * wide(b.X - a.X) / wide(b.Y - a.Y);
  }

  /// Upward edges have their material, and so the hole, on the left.
  std::uint32_t first_edge_right_of(const Point& m) const {
    std::uint32_t best = kNone;
    double best_x = 0;
    std::uint32_t i = 0;
    do {
      const Point &a = corners_[i].at, &b = corners_[corners_[i].next].at;
      if (a.Y <= m.Y && b.Y >= m.Y && a.Y != b.Y) {
        const double x = crossing_x(a, b, m.Y);
        if (x >= static_cast<double>(m.X) && (best == kNone || x < best_x)) {
          best = i;
          best_x = x;
        }
      }
      i = corners_[i].next;
    } while (i != 0);
    return best;
  }

  /// The corner of the chain that the hole's corner is joined to: an end of the edge that the ray
  /// meets, or of those corners within the triangle between ray and that end the one nearest to the
  /// ray by angle.
  std::uint32_t visible_corner(std::uint32_t hole, std::uint32_t edge) const {
    const Point m = corners_[hole].at;
    const Corner &a = corners_[edge], &b = corners_[a.next];
    const double x = crossing_x(a.at, b.at, m.Y);
    const bool lower = a.at.Y == m.Y || (b.at.Y != m.Y && a.at.X > b.at.X);
    const std::uint32_t end = lower ? edge : a.next;
    const Point p = corners_[end].at;
    std::uint32_t best = end;
    double best_slope = kSteep;
    double best_reach = 0;
    std::uint32_t i = 0;
    do {
      const Point& q = corners_[i].at;
      if (q.X >= m.X && in_bridge_triangle(m, x, p, q)) {
        const double reach = static_cast<double>(q.X - m.X);
        const double rise = std::abs(static_cast<double>(q.Y - m.Y));
        const double slope = rise == 0 ? 0 : reach == 0 ? kSteep / 2 : rise / reach;
        const bool nearer = slope < best_slope || (slope == best_slope && reach < best_reach);
        const Point& seen = q == m ? corners_[corners_[hole].next].at : m;
        if (nearer && opens_to(i, seen)) {
          best = i;
          best_slope = slope;
          best_reach = reach;
        }
      }
      i = corners_[i].next;
    } while (i != 0);
    return best;
  }

  /// Triangle m, (x, m.Y), p; all three sides count as inside.
  static bool in_bridge_triangle(const Point& m, double x, const Point& p, const Point& q) {
    if (q == p || q == m) return true;
    const auto wide = [](Unit value) { return static_cast<double>(value); };
    const double sign = p.Y >= m.Y ? 1 : -1;
    if (sign * wide(q.Y - m.Y) < 0) return false;
    if (sign * static_cast<double>(turn(m, p, q)) > 0) return false;
    const double side = (x - wide(p.X)) * wide(q.Y - p.Y) - wide(m.Y - p.Y) * wide(q.X - p.X);
    return sign * side >= 0;
  }

  std::size_t count_and_note_reflex() {
    std::size_t count = 0;
    std::uint32_t i = 0;
    do {
      ++count;
      if (turn_at(i) <= 0) reflex_.push_back(i);
      i = corners_[i].next;
    } while (i != 0);
    return count;
  }

  void forget_reflex(std::uint32_t i, bool convex) {
    const auto at = std::find(reflex_.begin(), reflex_.end(), i);
    if (!convex && at == reflex_.end()) reflex_.push_back(i);
    if (!convex || at == reflex_.end()) return;
    *at = reflex_.back();
    reflex_.pop_back();
  }

  /// Encloses nothing with its neighbours: where rings touch, chains run back into themselves.
  bool is_null(std::uint32_t i) const {
    const Corner& corner = corners_[i];
    const Point &a = corners_[corner.previous].at, &c = corners_[corner.next].at;
    return corner.at == a || corner.at == c || a == c;
  }

  bool is_ear(std::uint32_t i) const {
    const Corner& corner = corners_[i];
    const Point &a = corners_[corner.previous].at, &b = corner.at, &c = corners_[corner.next].at;
    if (turn(a, b, c) <= 0) return false;
    for (const std::uint32_t other : reflex_) {
      if (other == corner.previous || other == corner.next) continue;
      const Point& p = corners_[other].at;
      if (p == a || p == c) continue;
      if (p == b) {
        if (enters(other, a, b, c)) return false;
        continue;
      }
      if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
  }

  /// Whether an edge of corner i, which lies on b, begins strictly between those from b to c and a.
  bool enters(std::uint32_t i, const Point& a, const Point& b, const Point& c) const {
    const auto between = [&](const Point& p) { return turn(b, c, p) > 0 && turn(b, a, p) < 0; };
    return between(corners_[corners_[i].next].at) || between(corners_[corners_[i].previous].at);
  }

  static constexpr std::uint32_t kNone = 0xffff'ffff;
  static constexpr double kSteep = 1e300;
  std::vector<Corner> corners_;
  std::vector<std::uint32_t> reflex_;
};

}  // namespace

std::vector<Triangle> triangulate(std::span<const Ring* const> rings) {
  return Chain(rings).clip();
}

}  // namespace kerf::sheet
