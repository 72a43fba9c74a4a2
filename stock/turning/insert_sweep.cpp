#include "stock/turning/insert_sweep.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace kerf::turning {
namespace {

/// Arcs of whatever radius turn by no more between two corners.
constexpr double kMaxStep_rad = kPi / 8;
/// Points of contact nearer to an arc's end than this, in units, are that end: a step of rounding
/// would bend the chain, and over this length the smallest nose in use (0.02 mm) falls off by less
/// than a third of a unit.
constexpr double kArcEnd = 36;

double turn_of(const Vec2& from, const Vec2& to) {
  const double angle = std::atan2(from.x * to.y - from.y * to.x, glm::dot(from, to));
  return angle > 0 ? angle : angle + 2 * kPi;
}

/// Sign of d x e.
int side_of(const Point& d, const Point& e) {
  const std::int64_t cross = static_cast<std::int64_t>(d.X * e.Y - d.Y * e.X);
  return cross > 0 ? 1 : cross < 0 ? -1 : 0;
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
  const double ends = std::sin(steps.step_rad / 2);
  const double between = (steps.count - 1) * std::sin(steps.step_rad);
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
  arc.start_rad = std::atan2(start.y, start.x);
  arc.sweep_rad = turn_of(start, end);
  arc.steps = arc_steps(radius_mm, arc.sweep_rad, kArcBound_mm);
  arc.first = corners_.size();
  for (int i = 0; i < arc.steps.count; ++i) {
    const double angle = arc.start_rad + (i + 0.5) * arc.steps.step_rad;
    const Vec2 p =
        arc.center + arc.steps.outward * arc.radius * Vec2(std::cos(angle), std::sin(angle));
    corners_.push_back({std::llround(p.x), std::llround(p.y)});
    sides_.push_back(edge.side);
  }
  arcs_.push_back(arc);
}

/// Where a line with this normal touches an arc, its point takes the place of the corner that would
/// stick out beyond it.
void GridPart::touch(const Vec2& normal, std::vector<Point>& corners) const {
  const double angle = std::atan2(normal.y, normal.x);
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
  std::vector<int>& leads = scratch.leads;
  const std::size_t n = corners_.size();
  const Point way{to.X - from.X, to.Y - from.Y};
  const double length = std::hypot(static_cast<double>(way.X), static_cast<double>(way.Y));
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
  // 1: the edge from this corner leads, -1: it trails.
  leads.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Point &p = touched[i], &q = touched[i + 1 == n ? 0 : i + 1];
    leads[i] = side_of(way, {q.X - p.X, q.Y - p.Y});
  }
  std::size_t first = 0;  // of the edges that lead
  while (first < n && !(leads[first] > 0 && leads[first == 0 ? n - 1 : first - 1] <= 0)) ++first;
  if (first == n) first = 0;
  // Leading edges end where the tool does, the others where it begins.
  std::size_t i = first;
  const auto next = [n](std::size_t k) { return k + 1 == n ? 0 : k + 1; };
  const auto across = [&](const Point& p) {
    return ahead.x * static_cast<double>(p.Y + from.Y) -
           ahead.y * static_cast<double>(p.X + from.X);
  };
  const auto along = [&](const Point& p) {
    return ahead.x * static_cast<double>(p.X + from.X) +
           ahead.y * static_cast<double>(p.Y + from.Y);
  };
  const auto add_lead = [&](const Point& p) {
    corners.push_back({p.X + to.X, p.Y + to.Y});
    lead.across.push_back(across(p));
    lead.along.push_back(along(p));
  };
  add_lead(touched[i]);
  for (; leads[i] > 0; i = next(i)) {
    add_lead(touched[next(i)]);
    lead.sides.push_back(sides_[next(i)]);
  }
  for (; i != first; i = next(i)) corners.push_back({touched[i].X + from.X, touched[i].Y + from.Y});
  corners.push_back({touched[first].X + from.X, touched[first].Y + from.Y});
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
