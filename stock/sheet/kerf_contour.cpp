#include "stock/sheet/kerf_contour.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/portable_math.h"

namespace kerf::sheet {
namespace {

/// Beyond it, units do not fit into 64 bits.
constexpr double kMaxKerfCoordinate_mm = 1e13;
/// Shorter ways leave a disc: half a unit.
constexpr double kNoWay_mm = 0.5 / kUnitsPerMm;
/// An arc's own end and a corner of its circle closer than this part of the corners' distance make
/// one corner.
constexpr double kSameCorner = 1e-3;
/// Chords of a spiral keep within this share of the tolerance; their round ends have the rest.
constexpr double kChordShare = 0.25;
constexpr int kMaxChords = 100'000;
/// Circles as polygons keep the order of their radii, and round ends their side of the way, if the
/// tolerance is less than this part of the kerf's radius.
constexpr double kPlainTolerance = 0.2;
/// Ends of an arc that are so far apart, seen from its centre, do not meet.
constexpr double kPlainGap_rad = 0.1;

Vec2 direction(double angle) { return {portable::cos(angle), portable::sin(angle)}; }

class Builder {
 public:
  Builder(double radius_mm, double tolerance_mm, CircleTables& tables)
      : radius_(radius_mm), tolerance_(tolerance_mm), tables_(tables) {}

  void disc(const Vec2& center) {
    circle(center, radius_, false);
    is_plain_ = kerf_.rings.size() == 1 && resolves(radius_);
  }

  void capsule(const Vec2& from, const Vec2& to) {
    const Vec2 way = to - from;
    if (portable::hypot(way.x, way.y) < kNoWay_mm) return disc(from);
    const double heading = portable::atan2(way.y, way.x);
    begin();
    arc(to, radius_, heading - kPi / 2, heading + kPi / 2);
    arc(from, radius_, heading + kPi / 2, heading + 3 * kPi / 2);
    end();
    is_plain_ = kerf_.rings.size() == 1 && resolves(radius_);
  }

  /// From angle a0 counter-clockwise to a1 > a0.
  void sector(const Vec2& center, double arc_radius, double a0, double a1) {
    if (arc_radius < kNoWay_mm) return disc(center);
    const double sweep = a1 - a0;
    if (sweep >= 2 * kPi * (1 - 1e-12)) {
      circle(center, arc_radius + radius_, false);
      const double inner = arc_radius - radius_;
      if (inner > kNoWay_mm) circle(center, inner, true);
      is_plain_ = resolves(radius_) && (inner <= kNoWay_mm || resolves(inner));
      return;
    }
    const Vec2 first = center + arc_radius * direction(a0);
    const Vec2 last = center + arc_radius * direction(a1);
    if (sweep * arc_radius < kNoWay_mm) return disc(first);
    begin();
    arc(center, arc_radius + radius_, a0, a1);
    if (radius_ < arc_radius) {
      arc(last, radius_, a1, a1 + kPi);
      arc(center, arc_radius - radius_, a1, a0);
      arc(first, radius_, a0 - kPi, a0);
      const double ends = 2 * portable::asin(radius_ / arc_radius);
      is_plain_ = sweep + ends < 2 * kPi - kPlainGap_rad && resolves(radius_) &&
                  resolves(arc_radius - radius_);
    } else {
      // Where the circles of both ends meet: on the bisector, opposite to the arc's middle.
      const double half = sweep / 2;
      const double sideways = arc_radius * portable::sin(half);
      const double root = radius_ * radius_ - sideways * sideways;
      const double reach = std::sqrt(std::max(root, 0.0)) - arc_radius * portable::cos(half);
      const Vec2 meeting = center - reach * direction(a0 + half);
      const auto angle_from = [&](const Vec2& middle) {
        return portable::atan2(meeting.y - middle.y, meeting.x - middle.x);
      };
      arc(last, radius_, a1, a1 + turn_to(a1, angle_from(last)));
      arc(first, radius_, a0 - turn_to(angle_from(first), a0), a0);
    }
    end();
  }

  Kerf take() {
    for (const Ring& ring : kerf_.rings) kerf_.box.extend(bounds_of(ring));
    kerf_.plain = is_plain_;
    return std::move(kerf_);
  }

 private:
  /// By how much `angle` has to turn counter-clockwise to reach `target`: 0 .. pi, between two
  /// ends.
  static double turn_to(double angle, double target) {
    const double turn = target - angle;
    const double positive = turn - 2 * kPi * std::floor(turn / (2 * kPi));
    return positive > 1.5 * kPi ? 0 : positive;  // just below a full turn: none, rounded
  }

  bool resolves(double radius_mm) const { return tolerance_ < kPlainTolerance * radius_mm; }
  void begin() { ring_.clear(); }
  void end() {
    while (ring_.size() > 1 && ring_.front() == ring_.back()) ring_.pop_back();
    if (ring_.size() >= 3) kerf_.rings.push_back(ring_);
  }
  void corner(const Vec2& p) {
    const Point point = to_units(p);
    if (ring_.empty() || ring_.back() != point) ring_.push_back(point);
  }

  void circle(const Vec2& center, double radius, bool hole) {
    const CirclePolygon polygon = CirclePolygon::within(radius, tolerance_);
    begin();
    for (int i = 0; i < polygon.count; ++i)
      corner(center + polygon.corner_mm * unit_point(polygon.count, hole ? -i : i));
    end();
  }

  /// Both ends, and the circle's corners between them, from a0 to a1 in whichever sense.
  void arc(const Vec2& center, double radius, double a0, double a1) {
    const CirclePolygon polygon = CirclePolygon::within(radius, tolerance_);
    const double step = 2 * kPi / polygon.count;
    corner(center + radius * direction(a0));
    if (a0 < a1) {
      const auto first = static_cast<std::int64_t>(std::floor(a0 / step + kSameCorner)) + 1;
      const auto last = static_cast<std::int64_t>(std::ceil(a1 / step - kSameCorner)) - 1;
      for (std::int64_t i = first; i <= last; ++i)
        corner(center + polygon.corner_mm * unit_point(polygon.count, i));
    } else {
      const auto first = static_cast<std::int64_t>(std::ceil(a0 / step - kSameCorner)) - 1;
      const auto last = static_cast<std::int64_t>(std::floor(a1 / step + kSameCorner)) + 1;
      for (std::int64_t i = first; i >= last; --i)
        corner(center + polygon.corner_mm * unit_point(polygon.count, i));
    }
    corner(center + radius * direction(a1));
  }

  Vec2 unit_point(int count, std::int64_t i) {
    const std::int64_t turned = (i % count + count) % count;
    if (count > CircleTables::kMaxCount)
      return direction(2 * kPi * static_cast<double>(turned) / count);
    return tables_.points(count)[static_cast<std::size_t>(turned)];
  }

  double radius_, tolerance_;
  CircleTables& tables_;
  Ring ring_;
  Kerf kerf_;
  bool is_plain_ = false;  // of the ring that was added last, if it is the only one
};

bool usable(const Vec3& p) {
  return std::abs(p.x) < kMaxKerfCoordinate_mm && std::abs(p.y) < kMaxKerfCoordinate_mm;
}

/// After `share` of its sweep.
Vec2 point_of_arc(const CutMove& move, double share) {
  const CutArc& arc = *move.arc;
  const auto radial = [&](const Vec3& p) {
    const Vec3 arm = p - arc.center_mm;
    return arm - glm::dot(arm, arc.axis) * arc.axis;
  };
  const Vec3 start = radial(move.from_mm);
  const double r0 = glm::length(start);
  if (r0 == 0) return Vec2(move.from_mm) + share * (Vec2(move.to_mm) - Vec2(move.from_mm));
  const double r1 = glm::length(radial(move.to_mm));
  const double angle = share * arc.sweep_rad;
  const Vec3 side = glm::cross(arc.axis, start);
  const Vec3 arm = (portable::cos(angle) * start + portable::sin(angle) * side) *
                   ((r0 + share * (r1 - r0)) / r0);
  const double h0 = glm::dot(move.from_mm - arc.center_mm, arc.axis);
  const double h1 = glm::dot(move.to_mm - arc.center_mm, arc.axis);
  return Vec2(arc.center_mm + arm + (h0 + share * (h1 - h0)) * arc.axis);
}

void chain_of_chords(const CutMove& move, double tolerance_mm, Builder& builder) {
  const std::vector<Vec2> way = chords_of_move(move, kChordShare * tolerance_mm);
  for (std::size_t i = 1; i < way.size(); ++i) builder.capsule(way[i - 1], way[i]);
}

}  // namespace

const std::vector<Vec2>& CircleTables::points(int count) {
  const auto index = static_cast<std::size_t>(count / 4);
  if (tables_.size() <= index) tables_.resize(index + 1);
  std::vector<Vec2>& table = tables_[index];
  if (table.empty()) {
    // A quarter, mirrored: turned by right angles the polygon is the same.
    const int quarter = count / 4;
    table.resize(static_cast<std::size_t>(count));
    for (int i = 0; i < quarter; ++i) {
      const Vec2 p = i == 0 ? Vec2(1, 0) : direction(2 * kPi * i / count);
      const auto at = [&](int turn) -> Vec2& {
        return table[static_cast<std::size_t>(i + turn * quarter)];
      };
      at(0) = p;
      at(1) = {-p.y, p.x};
      at(2) = {-p.x, -p.y};
      at(3) = {p.y, -p.x};
    }
  }
  return table;
}

CirclePolygon CirclePolygon::within(double radius_mm, double tolerance_mm) {
  const double sagitta = 1.5 * tolerance_mm;  // two thirds of it outward
  const double step = sagitta < radius_mm ? 2 * portable::acos(1 - sagitta / radius_mm) : kPi / 2;
  const auto quarter = static_cast<std::int64_t>(std::max(std::ceil(kPi / 2 / step), 2.0));
  // Few different counts, an eighth apart at most: arcs of like radii share a table.
  std::int64_t grain = 1;
  while (quarter > 16 * grain) grain *= 2;
  CirclePolygon polygon;
  polygon.count = static_cast<int>(4 * ((quarter + grain - 1) / grain * grain));
  const double angle = 2 * kPi / polygon.count;
  polygon.corner_mm = radius_mm * std::sqrt(angle / portable::sin(angle));
  return polygon;
}

Kerf kerf_of_move(const CutMove& move, double radius_mm, double tolerance_mm,
                  CircleTables& tables) {
  if (!usable(move.from_mm) || !usable(move.to_mm)) return {};
  Builder builder(radius_mm, tolerance_mm, tables);
  const Vec2 from(move.from_mm), to(move.to_mm);
  if (!move.arc) {
    builder.capsule(from, to);
    return builder.take();
  }
  const CutArc& arc = *move.arc;
  if (!usable(arc.center_mm) || !std::isfinite(arc.sweep_rad) || !usable(arc.axis)) return {};
  const Vec2 center(arc.center_mm);
  const double r0 = glm::length(from - center), r1 = glm::length(to - center);
  const bool upright = std::abs(std::abs(arc.axis.z) - 1) < 1e-9;
  if (!upright || std::abs(r1 - r0) > tolerance_mm / 8) {
    chain_of_chords(move, tolerance_mm, builder);
    return builder.take();
  }
  const double a0 = portable::atan2(from.y - center.y, from.x - center.x);
  const double sweep = arc.axis.z > 0 ? arc.sweep_rad : -arc.sweep_rad;
  builder.sector(center, (r0 + r1) / 2, std::min(a0, a0 + sweep), std::max(a0, a0 + sweep));
  return builder.take();
}

std::vector<Vec2> chords_of_move(const CutMove& move, double tolerance_mm) {
  if (!move.arc) return {Vec2(move.from_mm), Vec2(move.to_mm)};
  const double r0 = glm::length(move.from_mm - move.arc->center_mm);
  const double r1 = glm::length(move.to_mm - move.arc->center_mm);
  const double radius = std::max({r0, r1, tolerance_mm});
  // Half of it: a spiral bends more sharply than a circle of its largest radius.
  const double step = 2 * portable::acos(std::max(1 - tolerance_mm / 2 / radius, 0.5));
  const double wanted = std::ceil(std::abs(move.arc->sweep_rad) / step);
  const int chords = static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(kMaxChords)));
  std::vector<Vec2> way;
  for (int i = 0; i <= chords; ++i)
    way.push_back(point_of_arc(move, static_cast<double>(i) / chords));
  return way;
}

}  // namespace kerf::sheet
