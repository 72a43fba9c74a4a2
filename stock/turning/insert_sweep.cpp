#include "stock/turning/insert_sweep.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/portable_math.h"

namespace kerf::turning {
namespace {

/// Arcs of whatever radius turn by no more between two corners.
constexpr double kMaxStep_rad = kPi / 8;
/// Points of contact nearer to an arc's end than this, in units, are that end: a step of rounding
/// would bend the chain, and over this length the smallest nose in use (0.02 mm) falls off by less
/// than a third of a unit.
constexpr double kArcEnd = 36;

double turn_of(const Vec2& from, const Vec2& to) {
  const double angle = portable::atan2(from.x * to.y - from.y * to.x, glm::dot(from, to));
  return angle > 0 ? angle : angle + 2 * kPi;
}

std::int64_t cross(const Point& a, const Point& b) {
  return static_cast<std::int64_t>(a.X * b.Y - a.Y * b.X);
}
std::int64_t dot(const Point& a, const Point& b) {
  return static_cast<std::int64_t>(a.X * b.X + a.Y * b.Y);
}

}  // namespace

ArcSteps arc_steps(double radius_mm, double sweep_rad, double bound_mm) {
  ArcSteps steps;
  if (!(radius_mm > 0) || !(sweep_rad > 0)) return steps;
  // A corner of a polygon of equal area sticks out by radius step^2 / 12.
  const double step = std::min(std::sqrt(12 * bound_mm / radius_mm), kMaxStep_rad);
  steps.count = std::max(1, static_cast<int>(std::ceil(sweep_rad / step)));
  steps.step_rad = sweep_rad / steps.count;
  // Twice the area over radius^2: two triangles at the ends, count - 1 between.
  const double ends = portable::sin(steps.step_rad / 2);
  const double between = (steps.count - 1) * portable::sin(steps.step_rad);
  steps.outward = steps.count == 1
                      ? sweep_rad / (2 * ends)
                      : (std::sqrt(ends * ends + between * sweep_rad) - ends) / between;
  return steps;
}

GridPart::GridPart(const InsertPart& part) {
  Vec2 at = part.back().end_mm;
  for (const InsertEdge& edge : part) {
    if (edge.center_mm) add_arc(at, edge);
    const Point end = to_units(edge.end_mm);
    if (corners_.empty() || !(corners_.back() == end)) {
      corners_.push_back(end);
      sides_.push_back(edge.side);
    }
    at = edge.end_mm;
    reach_mm_ = std::max(reach_mm_, glm::length(at));
    if (edge.center_mm) {
      const double radius = glm::distance(at, *edge.center_mm);
      reach_mm_ = std::max(reach_mm_, glm::length(*edge.center_mm) + radius + kArcBound_mm);
    }
  }
}

void GridPart::add_arc(const Vec2& from_mm, const InsertEdge& edge) {
  const Vec2 start = from_mm - *edge.center_mm, end = edge.end_mm - *edge.center_mm;
  Arc arc;
  const double radius_mm = glm::length(start);
  arc.center = *edge.center_mm * kUnitsPerMm;
  arc.radius = radius_mm * kUnitsPerMm;
  arc.start_rad = portable::atan2(start.y, start.x);
  arc.sweep_rad = turn_of(start, end);
  arc.steps = arc_steps(radius_mm, arc.sweep_rad, kArcBound_mm);
  arc.first = corners_.size();
  for (int i = 0; i < arc.steps.count; ++i) {
    const double angle = arc.start_rad + (i + 0.5) * arc.steps.step_rad;
    const Vec2 p = arc.center + arc.steps.outward * arc.radius *
                                    Vec2(portable::cos(angle), portable::sin(angle));
    corners_.push_back({std::llround(p.x), std::llround(p.y)});
    sides_.push_back(edge.side);
  }
  arcs_.push_back(arc);
}

/// Where a line with this normal touches an arc, its point takes the place of the corner that would
/// stick out beyond it.
void GridPart::touch(const Vec2& normal, std::vector<Point>& corners) const {
  const double angle = portable::atan2(normal.y, normal.x);
  for (const Arc& arc : arcs_) {
    double along = std::fmod(angle - arc.start_rad, 2 * kPi);
    if (along < 0) along += 2 * kPi;
    if (along * arc.radius < kArcEnd || (arc.sweep_rad - along) * arc.radius < kArcEnd) continue;
    const Vec2 p = arc.center + arc.radius * normal;
    const int corner =
        std::clamp(static_cast<int>(along / arc.steps.step_rad), 0, arc.steps.count - 1);
    corners[arc.first + static_cast<std::size_t>(corner)] = {std::llround(p.x), std::llround(p.y)};
  }
}

void GridPart::sweep(const Point& from, const Point& to, Scratch& scratch, ConvexRegion& swept,
                     Lead& lead) const {
  std::vector<Point>&touched = scratch.touched, &corners = scratch.swept;
  const std::size_t n = corners_.size();
  const Point way{to.X - from.X, to.Y - from.Y};
  const double length = portable::hypot(static_cast<double>(way.X), static_cast<double>(way.Y));
  lead.across.clear();
  lead.along.clear();
  lead.sides.clear();
  corners.clear();
  if (length == 0) {
    for (const Point& p : corners_) corners.push_back({p.X + from.X, p.Y + from.Y});
    swept.assign(corners);
    return;
  }
  const Vec2 ahead(static_cast<double>(way.X) / length, static_cast<double>(way.Y) / length);
  touched.assign(corners_.begin(), corners_.end());
  touch({-ahead.y, ahead.x}, touched);
  touch({ahead.y, -ahead.x}, touched);
  // The corners farthest to either side, of these the one that is ahead: between them leads, what
  // comes after the left one trails. Where rounding has made a small arc hollow, it may do so.
  const auto is_beyond = [&](int side, const Point& p, const Point& q) {
    const std::int64_t across = side * cross(way, {p.X - q.X, p.Y - q.Y});
    return across != 0 ? across > 0 : dot(way, {p.X - q.X, p.Y - q.Y}) > 0;
  };
  std::size_t right = 0, left = 0;
  for (std::size_t i = 1; i < n; ++i) {
    if (is_beyond(-1, touched[i], touched[right])) right = i;
    if (is_beyond(1, touched[i], touched[left])) left = i;
  }
  const auto next = [n](std::size_t k) { return k + 1 == n ? 0 : k + 1; };
  const auto add_lead = [&](const Point& p, InsertSide side) {
    corners.push_back({p.X + to.X, p.Y + to.Y});
    const auto z = static_cast<double>(p.X + from.X), r = static_cast<double>(p.Y + from.Y);
    const double across = ahead.x * r - ahead.y * z;
    if (!lead.across.empty()) {
      if (across <= lead.across.back()) return;
      lead.sides.push_back(side);
    }
    lead.across.push_back(across);
    lead.along.push_back(ahead.x * z + ahead.y * r);
  };
  // Leading edges end where the tool does, the others where it begins.
  for (std::size_t i = right; i != left; i = next(i)) add_lead(touched[i], sides_[i]);
  add_lead(touched[left], sides_[left]);
  for (std::size_t i = left; i != right; i = next(i))
    corners.push_back({touched[i].X + from.X, touched[i].Y + from.Y});
  corners.push_back({touched[right].X + from.X, touched[right].Y + from.Y});
  swept.assign(corners);
}

GridPart GridPart::inset(double width_mm) const {
  struct Corner {
    Vec2 at;
    InsertSide side;  // of the edge that ends there
  };
  const auto point = [](const Point& p) {
    return Vec2(static_cast<double>(p.X), static_cast<double>(p.Y));
  };
  std::vector<Corner> kept, rest;
  for (std::size_t i = 0; i < corners_.size(); ++i) kept.push_back({point(corners_[i]), sides_[i]});
  for (std::size_t i = 0; i < corners_.size() && !kept.empty(); ++i) {
    const Vec2 a = point(corners_[i == 0 ? corners_.size() - 1 : i - 1]), b = point(corners_[i]);
    const Vec2 inward = glm::normalize(Vec2(a.y - b.y, b.x - a.x));
    const auto depth = [&](const Vec2& p) {
      return glm::dot(p - a, inward) - width_mm * kUnitsPerMm;
    };
    rest.clear();
    for (std::size_t k = 0; k < kept.size(); ++k) {
      const Corner &from = kept[k == 0 ? kept.size() - 1 : k - 1], &to = kept[k];
      const double in = depth(from.at), out = depth(to.at);
      if (in < 0 && out < 0) continue;
      const Vec2 edge = from.at + in / (in - out) * (to.at - from.at);
      // Coming in again, it has run along the cut edge.
      if (in < 0) rest.push_back({edge, sides_[i]});
      rest.push_back(out < 0 ? Corner{edge, to.side} : to);
    }
    kept.swap(rest);
  }
  GridPart part;
  part.reach_mm_ = reach_mm_;
  for (const Corner& corner : kept) {
    part.corners_.push_back({std::llround(corner.at.x), std::llround(corner.at.y)});
    part.sides_.push_back(corner.side);
  }
  return part;
}

}  // namespace kerf::turning
