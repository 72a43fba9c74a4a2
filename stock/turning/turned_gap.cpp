#include "stock/turning/turned_gap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "base/portable_math.h"
#include "stock/turning/contour.h"
#include "stock/turning/convex_region.h"
#include "stock/turning/insert_sweep.h"

namespace kerf {
namespace {

using turning::Contour;
using turning::ConvexRegion;
using turning::GridPart;
using turning::Point;
using turning::Rect;

Vec2 real(const Point& p) { return {static_cast<double>(p.X), static_cast<double>(p.Y)}; }

double box_gap(const Rect& a, const Rect& b) {
  const auto apart = [](auto low, auto high) {
    return std::max(0.0, static_cast<double>(low - high));
  };
  const double along = std::max(apart(a.min_x, b.max_x), apart(b.min_x, a.max_x));
  const double across = std::max(apart(a.min_y, b.max_y), apart(b.min_y, a.max_y));
  return portable::hypot(along, across);
}

struct Nearest {
  double units = 0;
  Vec2 on_tool{0};
};

/// Of p from the edge a b.
Vec2 nearest_on(const Vec2& a, const Vec2& b, const Vec2& p) {
  const Vec2 along = b - a;
  const double length2 = glm::dot(along, along);
  const double share = length2 > 0 ? std::clamp(glm::dot(p - a, along) / length2, 0.0, 1.0) : 0;
  return a + share * along;
}

/// Where the two edges cross, as a share of the first.
std::optional<double> crossing(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const auto cross = [](const Vec2& u, const Vec2& v) { return u.x * v.y - u.y * v.x; };
  const double whole = cross(b - a, d - c);
  if (whole == 0) return std::nullopt;
  const double s = cross(c - a, d - c) / whole, t = cross(c - a, b - a) / whole;
  if (s < 0 || s > 1 || t < 0 || t > 1) return std::nullopt;
  return s;
}

/// a b is the tool's.
void look_between(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d, Nearest& nearest) {
  const auto note = [&](const Vec2& on_tool, const Vec2& other) {
    const double units = glm::distance(on_tool, other);
    if (units < nearest.units) nearest = {units, on_tool};
  };
  if (const auto share = crossing(a, b, c, d)) {
    const Vec2 at = a + *share * (b - a);
    note(at, at);
    return;
  }
  note(a, nearest_on(c, d, a));
  note(b, nearest_on(c, d, b));
  note(nearest_on(a, b, c), c);
  note(nearest_on(a, b, d), d);
}

/// Of one contour from what is swept, and what of that it lies in.
void look_at(const Contour& contour, const ConvexRegion& swept, Nearest& nearest) {
  Point before = contour.runs().back()->points.back();
  for (const turning::RunPointer& run : contour.runs()) {
    Rect whole = run->box;
    whole.extend(before);
    if (box_gap(whole, swept.box()) >= nearest.units) {
      before = run->points.back();
      continue;
    }
    for (const Point& p : run->points) {
      Rect edge;
      edge.extend(before);
      edge.extend(p);
      if (box_gap(edge, swept.box()) < nearest.units) {
        for (std::size_t i = 0; i < swept.corners().size(); ++i)
          look_between(real(swept.corner(i)), real(swept.after(i)), real(before), real(p), nearest);
      }
      before = p;
    }
  }
}

/// Even-odd over all contours.
bool is_in(const std::vector<Contour>& contours, const Point& p) {
  bool inside = false;
  for (const Contour& contour : contours) {
    Point a = contour.runs().back()->points.back();
    for (const turning::RunPointer& run : contour.runs()) {
      for (const Point& b : run->points) {
        if ((a.Y > p.Y) != (b.Y > p.Y)) {
          const double at = static_cast<double>(a.X) + static_cast<double>(p.Y - a.Y) /
                                                           static_cast<double>(b.Y - a.Y) *
                                                           static_cast<double>(b.X - a.X);
          if (static_cast<double>(p.X) < at) inside = !inside;
        }
        a = b;
      }
    }
  }
  return inside;
}

/// The share of the way after which the place is first in the tool, which stands at the way's
/// beginning as `standing`. The place is in it somewhere on the way, or as good as.
double share_until(const ConvexRegion& standing, const Vec2& way, const Vec2& place) {
  double from = 0, to = 1;
  for (std::size_t i = 0; i < standing.corners().size(); ++i) {
    const Vec2 a = real(standing.corner(i)), edge = real(standing.after(i)) - a;
    const double length = glm::length(edge);
    if (length == 0) continue;
    // Inward of the edge by so much now, and so much less over the way. Corners are rounded.
    constexpr double kRounded = 2;
    const double inward = (edge.x * (place - a).y - edge.y * (place - a).x) / length + kRounded;
    const double less = (edge.x * way.y - edge.y * way.x) / length;
    if (less > 0) to = std::min(to, inward / less);
    if (less < 0) from = std::max(from, inward / less);
  }
  return std::clamp(std::min(from, to), 0.0, 1.0);
}

Point mirrored_point(const Point& p) { return {p.X, -p.Y}; }

}  // namespace

std::optional<TurnGap> least_gap(const TurnedPart& part, const TurningTool& tool,
                                 const TurnMove& move, double below_mm) {
  std::optional<TurnGap> least;
  double below = below_mm * turning::kUnitsPerMm;
  std::vector<turning::WayChord> chords;
  turning::append_way(move, TurnedPart::kWayReach_mm, chords);
  ConvexRegion swept, standing;
  GridPart::Scratch scratch;
  GridPart::Lead lead;
  for (const turning::WayChord& chord : chords) {
    const Point from = turning::to_units(chord.from.at_mm), to = turning::to_units(chord.to.at_mm);
    for (const bool is_below : {false, true}) {
      const Point a = is_below ? mirrored_point(from) : from,
                  b = is_below ? mirrored_point(to) : to;
      for (const GridPart& one : tool.parts(is_below)) {
        if (std::max(a.Y, b.Y) + turning::to_units(one.reach_mm()) <= 0) continue;
        one.sweep(a, b, scratch, swept, lead);
        if (swept.empty() || swept.box().max_y <= 0) continue;
        const bool is_far = std::ranges::all_of(part.contours(), [&](const Contour& contour) {
          return box_gap(contour.box(), swept.box()) >= below;
        });
        if (is_far) continue;
        Nearest nearest{below, Vec2{0}};
        for (const Contour& contour : part.contours()) {
          if (box_gap(contour.box(), swept.box()) >= nearest.units) continue;
          look_at(contour, swept, nearest);
          const Point& corner = contour.runs().front()->points.front();
          if (nearest.units > 0 && contour.is_outer() && swept.holds(corner))
            nearest = {0, real(corner)};
        }
        if (nearest.units > 0 && is_in(part.contours(), swept.corner(0)))
          nearest = {0, real(swept.corner(0))};
        if (nearest.units >= below) continue;
        below = nearest.units;
        one.sweep(a, a, scratch, standing, lead);
        const double share = share_until(standing, real(b) - real(a), nearest.on_tool);
        least = TurnGap{below / turning::kUnitsPerMm,
                        chord.from.t + share * (chord.to.t - chord.from.t),
                        chord.from.at_mm + share * (chord.to.at_mm - chord.from.at_mm)};
      }
    }
  }
  return least;
}

}  // namespace kerf
