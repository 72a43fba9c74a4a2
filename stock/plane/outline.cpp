#include "stock/plane/outline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/plane/polygon.h"

namespace kerf {
namespace {

using plane::Point;
using plane::turn;

constexpr double kMaxCoordinate_mm = 1e5;
constexpr double kMaxUnits = 1 << 30;

struct Edge {
  Point a, b;
  std::size_t ring, number;  // its place in the ring
  plane::Unit min_x() const { return std::min(a.X, b.X); }
  plane::Unit max_x() const { return std::max(a.X, b.X); }
};

std::string ring_name(const PlaneOutline& outline, std::size_t ring) {
  const std::string line =
      ring < outline.lines.size() ? trf(" (line {})", outline.lines[ring]) : "";
  return trf("ring {}{}", ring + 1, line);
}

std::string place(const Vec2& p) {
  const auto rounded = [](double value) { return number_text(std::round(value * 1e4) / 1e4); };
  return fmt::format("X{} Y{}", rounded(p.x), rounded(p.y));
}

int sign(std::int64_t value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

/// On one line, with more than a point in common.
bool overlap(const Edge& e, const Edge& f) {
  if (turn(e.a, e.b, f.a) != 0 || turn(e.a, e.b, f.b) != 0) return false;
  const bool steep = std::abs(e.b.X - e.a.X) < std::abs(e.b.Y - e.a.Y);
  const auto along = [steep](const Point& p) { return steep ? p.Y : p.X; };
  return std::max(std::min(along(e.a), along(e.b)), std::min(along(f.a), along(f.b))) <
         std::min(std::max(along(e.a), along(e.b)), std::max(along(f.a), along(f.b)));
}

/// Crossing, or lying on each other. Not: touching with a corner.
bool cross(const Edge& e, const Edge& f) {
  if (std::min(e.a.Y, e.b.Y) > std::max(f.a.Y, f.b.Y)) return false;
  if (std::min(f.a.Y, f.b.Y) > std::max(e.a.Y, e.b.Y)) return false;
  const int fa = sign(turn(e.a, e.b, f.a)), fb = sign(turn(e.a, e.b, f.b));
  const int ea = sign(turn(f.a, f.b, e.a)), eb = sign(turn(f.a, f.b, e.b));
  if (fa * fb < 0 && ea * eb < 0) return true;
  return overlap(e, f);
}

Vec2 crossing_of(const Edge& e, const Edge& f, double unit_mm) {
  const auto wide = [](std::int64_t value) { return static_cast<double>(value); };
  const double at_a = wide(turn(f.a, f.b, e.a)), at_b = wide(turn(f.a, f.b, e.b));
  const double share = at_a == at_b ? 0 : at_a / (at_a - at_b);
  const auto in_mm = [unit_mm](const Point& p) {
    return unit_mm * Vec2(static_cast<double>(p.X), static_cast<double>(p.Y));
  };
  const Vec2 a = in_mm(e.a), b = in_mm(e.b);
  return a + std::clamp(share, 0.0, 1.0) * (b - a);
}

std::string crossing_text(const PlaneOutline& outline, const Edge& e, const Edge& f,
                          double unit_mm) {
  const std::string at = place(crossing_of(e, f, unit_mm));
  if (e.ring == f.ring) return trf("{} crosses itself at {}", ring_name(outline, e.ring), at);
  const auto [first, second] = std::minmax(e.ring, f.ring);
  return trf("{} and {} cross at {}", ring_name(outline, first), ring_name(outline, second), at);
}

Done check_ring(const PlaneOutline& outline, std::size_t number, double unit_mm,
                std::vector<Edge>& edges) {
  const double most_mm = std::min(kMaxCoordinate_mm, kMaxUnits * unit_mm);
  const std::vector<Vec2>& ring = outline.rings[number];
  plane::Ring points;
  for (const Vec2& p : ring) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
      return Error{trf("{}: a corner is not a number", ring_name(outline, number))};
    }
    if (std::abs(p.x) > most_mm || std::abs(p.y) > most_mm) {
      return Error{trf("{}: the corner {} is too far out; must be within {} mm",
                       ring_name(outline, number), place(p), number_text(most_mm))};
    }
    const Point point{std::llround(p.x / unit_mm), std::llround(p.y / unit_mm)};
    if (points.empty() || points.back() != point) points.push_back(point);
  }
  while (points.size() > 1 && points.front() == points.back()) points.pop_back();
  if (points.size() < 3) {
    return Error{trf("{} has {} different {}; a closed outline has at least 3",
                     ring_name(outline, number), points.size(),
                     points.size() == 1 ? tr("corner") : tr("corners"))};
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    edges.push_back({points[i], points[(i + 1) % points.size()], number, i});
  return std::monostate{};
}

}  // namespace

PlaneOutline rectangle_outline(const Vec2& low_mm, const Vec2& high_mm) {
  return {{{low_mm, {high_mm.x, low_mm.y}, high_mm, {low_mm.x, high_mm.y}}}, {}};
}

Done check_outline(const PlaneOutline& outline, double unit_mm) {
  if (outline.rings.empty()) return Error{tr("the outline is empty; it must have a closed ring")};
  std::vector<Edge> edges;
  std::vector<std::size_t> first_edge;
  for (std::size_t ring = 0; ring < outline.rings.size(); ++ring) {
    first_edge.push_back(edges.size());
    const Done done = check_ring(outline, ring, unit_mm, edges);
    if (!done) return done;
  }
  std::vector<Edge> sorted = edges;
  std::sort(sorted.begin(), sorted.end(),
            [](const Edge& e, const Edge& f) { return e.min_x() < f.min_x(); });
  std::vector<const Edge*> active;
  for (const Edge& edge : sorted) {
    std::erase_if(active, [&](const Edge* other) { return other->max_x() < edge.min_x(); });
    for (const Edge* other : active) {
      if (cross(edge, *other)) return Error{crossing_text(outline, edge, *other, unit_mm)};
    }
    active.push_back(&edge);
  }
  first_edge.push_back(edges.size());
  for (std::size_t ring = 0; ring < outline.rings.size(); ++ring) {
    plane::Ring points;
    for (std::size_t i = first_edge[ring]; i < first_edge[ring + 1]; ++i)
      points.push_back(edges[i].a);
    if (plane::twice_area(points) == 0)
      return Error{trf("{} has no area", ring_name(outline, ring))};
  }
  return std::monostate{};
}

}  // namespace kerf
