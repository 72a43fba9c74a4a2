#include "stock/plane/outline_arcs.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/portable_math.h"
#include "stock/plane/outline_curves.h"
#include "stock/plane/polygon.h"

namespace kerf::plane {
namespace {

/// How far rounding moves a corner, in units: 0.7 each way, and that of the circle through others.
constexpr double kOnCircle = 1.5;
/// Corners of the shortest chain that counts: two more than any circle passes through.
constexpr long kLeastCorners = 5;
/// Those of the coarsest circle.
constexpr long kLeastCircle = 8;
/// How far such a chain must bend, in units: rounding is a tenth of it.
constexpr double kLeastBend = 10;
/// Flatter ones are lines in any drawing.
constexpr double kMaxRadius_mm = 1e5;
/// Corners off the circle, between others that are on it, that go with it: the bump of a lead-in.
constexpr long kMostBump = 24;
/// A chord of a circle's polygon, and less.
constexpr double kMaxStep_rad = kPi / 3;
/// Arcs are divided beyond half a turn, which rounding may pass.
constexpr double kHalfTurn_rad = kPi * (1 + 1e-6);

double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

/// Counter-clockwise from a to b: -pi .. pi.
double angle_between(const Vec2& a, const Vec2& b) {
  return portable::atan2(cross(a, b), glm::dot(a, b));
}

/// The circle nearest to points that come one by one, in the sense of I. Kasa, "A circle fitting
/// procedure and its error analysis", IEEE Trans. Instrum. Meas. 25, 1976.
class CircleFit {
 public:
  explicit CircleFit(const Vec2& origin) : origin_(origin) {}

  void add(const Vec2& point) {
    const Vec2 p = point - origin_;
    const double z = glm::dot(p, p);
    n_ += 1;
    sum_ += p;
    sum_z_ += z;
    xx_ += p.x * p.x;
    xy_ += p.x * p.y;
    yy_ += p.y * p.y;
    pz_ += z * p;
  }
  /// False if the points are on a line.
  bool solve(CurveCircle& circle) const {
    const Vec2 mean = sum_ / n_;
    const double z = sum_z_ / n_;
    const double xx = xx_ / n_ - mean.x * mean.x, yy = yy_ / n_ - mean.y * mean.y;
    const double xy = xy_ / n_ - mean.x * mean.y;
    const Vec2 right = pz_ / n_ - z * mean;
    const double det = xx * yy - xy * xy;
    if (!(det > 0)) return false;
    const Vec2 center = Vec2(yy * right.x - xy * right.y, xx * right.y - xy * right.x) / (2 * det);
    const double square = z - 2 * glm::dot(center, mean) + glm::dot(center, center);
    if (!(square > 0) || !(square < kMaxRadius_mm * kMaxRadius_mm)) return false;
    circle = {origin_ + center, std::sqrt(square)};
    return true;
  }

 private:
  Vec2 origin_, sum_{0}, pz_{0};
  double n_ = 0, sum_z_ = 0, xx_ = 0, xy_ = 0, yy_ = 0;
};

/// Corners first .. last of a ring (numbers go on beyond its end) on one circle.
struct Run {
  long first = 0, last = 0;
  CurveCircle corners;  ///< on which the corners lie
  double sense = 1;     ///< 1: counter-clockwise
  double max_step_rad = 0;
  double shrink = 1;  ///< the arc's radius, of the corners'
  bool is_closed = false;

  double radius_mm() const { return shrink * corners.radius_mm; }
  double distance(const Vec2& p) const { return glm::length(p - corners.center_mm); }
  double step_rad(const Vec2& from, const Vec2& to) const {
    return sense * angle_between(from - corners.center_mm, to - corners.center_mm);
  }
};

class ArcFinder {
 public:
  ArcFinder(const std::vector<Vec2>& ring, double tolerance_mm, double unit_mm)
      : ring_(ring),
        n_(static_cast<long>(ring.size())),
        tolerance_(tolerance_mm),
        // Two thirds of a chord's sagitta are the tolerance outward: CirclePolygon.
        sagitta_(1.5 * tolerance_mm + unit_mm),
        on_circle_(kOnCircle * unit_mm),
        least_bend_(kLeastBend * unit_mm),
        used_(ring.size(), 0) {}

  Curve find() {
    std::vector<Run> runs;
    for (long start = 0; start < n_; ++start) {
      Run run;
      if (!seed(start, run)) continue;
      grow(run, 1);
      if (!run.is_closed) grow(run, -1);
      finish(run);
      if (run.is_closed) return {CurveCircle{run.corners.center_mm, run.radius_mm()}, {}};
      for (long i = run.first; i <= run.last; ++i) used_[index(i)] = 1;
      start = std::max(start, run.last);
      runs.push_back(run);
    }
    if (const std::optional<CurveCircle> circle = whole_circle()) return {circle, {}};
    return curve_of(std::move(runs));
  }

 private:
  std::size_t index(long i) const { return static_cast<std::size_t>((i % n_ + n_) % n_); }
  const Vec2& at(long i) const { return ring_[index(i)]; }

  bool is_on(const Run& run, const Vec2& p) const {
    return std::abs(run.distance(p) - run.corners.radius_mm) <= on_circle_;
  }
  /// As far off the arc as what cuts it may be.
  bool is_near(const Run& run, const Vec2& p) const {
    return std::abs(run.distance(p) - run.radius_mm()) <= tolerance_ + on_circle_;
  }
  /// The way between two corners is not longer than a chord of the circle.
  bool is_short(const Run& run, const Vec2& from, const Vec2& to) const {
    const double step = std::abs(run.step_rad(from, to));
    return step <= kMaxStep_rad &&
           run.corners.radius_mm * (1 - portable::cos(step / 2)) <= sagitta_;
  }

  /// The shortest chain from `start` on that tells its circle.
  bool seed(long start, Run& run) const {
    for (long count = kLeastCorners; count <= n_; count = std::min(2 * count, n_)) {
      CircleFit fit(at(start));
      for (long i = start; i < start + count; ++i) {
        if (used_[index(i)]) return false;
        fit.add(at(i));
      }
      run.first = start;
      run.last = start + count - 1;
      const Vec2 chord = at(run.last) - at(start);
      const Vec2 middle = at(start + count / 2) - at(start);
      // Without a bend the circle may be any, and longer chains have to tell.
      const bool bends = std::abs(cross(chord, middle)) > least_bend_ * glm::length(chord);
      if (fit.solve(run.corners)) {
        run.sense = cross(at(start + 1) - at(start), at(run.last) - at(start)) > 0 ? 1 : -1;
        const bool fits = is_chain(run);
        if (bends && fits) finish(run);
        if (bends || !fits) return bends && fits;
      } else if (bends) {
        return false;
      }
      if (count == n_) return false;
    }
    return false;
  }

  bool is_chain(const Run& run) const {
    for (long i = run.first; i <= run.last; ++i) {
      if (!is_on(run, at(i))) return false;
      if (i == run.first) continue;
      if (!is_short(run, at(i - 1), at(i)) || run.step_rad(at(i - 1), at(i)) <= 0) return false;
    }
    return true;
  }

  /// The next corner that is on the circle, from `from` on in the direction; nothing: the run ends.
  std::optional<long> next_on(const Run& run, long from, long direction, long limit) const {
    for (long k = 1; k <= kMostBump; ++k) {
      const long i = from + direction * k;
      if (direction * (i - limit) > 0 || (used_[index(i)] && i != limit)) return std::nullopt;
      if (!is_near(run, at(i)) || !is_short(run, at(i - direction), at(i))) return std::nullopt;
      const double turned = run.step_rad(at(from), at(i));
      if (is_on(run, at(i)) && static_cast<double>(direction) * turned > 0) return i;
    }
    return std::nullopt;
  }

  void grow(Run& run, long direction) {
    CircleFit fit(at(run.first));
    for (long i = run.first; i <= run.last; ++i) fit.add(at(i));
    const long limit = direction > 0 ? run.first + n_ : run.last - n_;
    long& end = direction > 0 ? run.last : run.first;
    while (const std::optional<long> next = next_on(run, end, direction, limit)) {
      if (*next == limit) {
        run.is_closed = true;
        return;
      }
      end = *next;
      fit.add(at(end));
      fit.solve(run.corners);
    }
  }

  /// All corners are about a circle, though not on it: one that was cut as many short chords, the
  /// round ends of which leave bumps. The area tells the radius.
  std::optional<CurveCircle> whole_circle() const {
    if (n_ < kLeastCircle) return std::nullopt;
    Run all;
    CircleFit fit(at(0));
    for (long i = 0; i < n_; ++i) fit.add(at(i));
    if (!fit.solve(all.corners)) return std::nullopt;
    double angle = 0, twice_area = 0;
    for (long i = 0; i < n_; ++i) {
      const double off = std::abs(all.distance(at(i)) - all.corners.radius_mm);
      if (off > tolerance_ || !is_short(all, at(i), at(i + 1))) return std::nullopt;
      angle += all.step_rad(at(i), at(i + 1));
      twice_area += cross(at(i) - all.corners.center_mm, at(i + 1) - all.corners.center_mm);
    }
    if (std::abs(std::abs(angle) - 2 * kPi) > 1) return std::nullopt;
    return CurveCircle{all.corners.center_mm, std::sqrt(std::abs(twice_area) / (2 * kPi))};
  }

  /// The arc's radius: areas of the sectors are those of the triangles.
  void finish(Run& run) const {
    double angles = 0, sines = 0;
    const long last = run.is_closed ? run.first + n_ : run.last;
    for (long i = run.first; i < last; ++i) {
      const double step = run.step_rad(at(i), at(i + 1));
      if (!is_on(run, at(i)) || !is_on(run, at(i + 1)) || step <= 0) continue;
      angles += step;
      sines += portable::sin(step);
      run.max_step_rad = std::max(run.max_step_rad, step);
    }
    run.shrink = std::sqrt(sines / angles);
  }

  /// A corner beside the run that is on the way from its last corner to where the next would be.
  bool is_end(const Run& run, long i, const Vec2& inner) const {
    const double slack = on_circle_ / run.corners.radius_mm;
    const double step = i < run.first ? run.step_rad(at(i), inner) : run.step_rad(inner, at(i));
    const double low = run.corners.radius_mm * portable::cos(run.max_step_rad / 2) - on_circle_;
    const double distance = run.distance(at(i));
    return step > 0 && step <= run.max_step_rad + slack && distance >= low &&
           distance <= run.corners.radius_mm + on_circle_;
  }

  struct Edge {
    Vec2 from{0};
    const Run* run = nullptr;  ///< none: straight
  };

  Curve curve_of(std::vector<Run> runs) const {
    for (Run& run : runs) {
      const Vec2 first = at(run.first), last = at(run.last);
      if (is_end(run, run.last + 1, last)) ++run.last;
      if (run.last - run.first < n_ && is_end(run, run.first - 1, first)) --run.first;
      if (run.last - run.first >= n_)
        return {CurveCircle{run.corners.center_mm, run.radius_mm()}, {}};
    }
    std::sort(runs.begin(), runs.end(),
              [](const Run& a, const Run& b) { return a.first < b.first; });
    std::vector<Edge> edges;
    const long begin = runs.empty() ? 0 : runs[0].first;
    std::size_t next = 0;
    for (long i = begin; i < begin + n_;) {
      const bool is_arc = next < runs.size() && runs[next].first <= i;
      edges.push_back({at(i), is_arc ? &runs[next] : nullptr});
      i = is_arc ? std::max(i + 1, runs[next++].last) : i + 1;
    }
    return joined(edges);
  }

  Curve joined(const std::vector<Edge>& edges) const {
    std::vector<Vec2> points;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const Edge& before = edges[(i + edges.size() - 1) % edges.size()];
      const Vec2& after = edges[(i + 1) % edges.size()].from;
      points.push_back(meeting(edges[i].from, before, edges[i], after));
    }
    Curve curve;
    for (std::size_t i = 0; i < edges.size(); ++i)
      append(edges[i], points[i], points[(i + 1) % points.size()], curve.corners);
    return curve;
  }

  /// Where two edges meet, near the corner p that they share. `after`: where the second one ends.
  Vec2 meeting(const Vec2& p, const Edge& a, const Edge& b, const Vec2& after) const {
    const auto is_at = [&](const Edge& edge) {
      return !edge.run || std::abs(edge.run->distance(p) - edge.run->radius_mm()) <= on_circle_;
    };
    if (is_at(a) && is_at(b)) return p;
    Vec2 best = p;
    double nearest = 2 * tolerance_;
    const auto offer = [&](const Vec2& q) {
      const double distance = glm::length(q - p);
      if (!(distance < nearest)) return;
      best = q;
      nearest = distance;
    };
    if (a.run && b.run) {
      offer_crossings(*a.run, *b.run, offer);
    } else {
      offer_crossings(a.run ? *a.run : *b.run, p, (a.run ? after : a.from) - p, offer);
    }
    return best;
  }

  template <class Offer>
  static void offer_crossings(const Run& run, const Vec2& p, const Vec2& way, Offer&& offer) {
    const double length = glm::length(way);
    if (length == 0) return;
    const Vec2 along = way / length, arm = run.corners.center_mm - p;
    const double foot = glm::dot(arm, along), off = cross(along, arm);
    const double square = run.radius_mm() * run.radius_mm() - off * off;
    if (square < 0) return;
    offer(p + (foot + std::sqrt(square)) * along);
    offer(p + (foot - std::sqrt(square)) * along);
  }

  template <class Offer>
  static void offer_crossings(const Run& a, const Run& b, Offer&& offer) {
    const Vec2 way = b.corners.center_mm - a.corners.center_mm;
    const double distance = glm::length(way);
    if (distance == 0) return;
    const Vec2 along = way / distance, side(-along.y, along.x);
    const double foot =
        (distance * distance + a.radius_mm() * a.radius_mm() - b.radius_mm() * b.radius_mm()) /
        (2 * distance);
    const double square = a.radius_mm() * a.radius_mm() - foot * foot;
    if (square < 0) return;
    offer(a.corners.center_mm + foot * along + std::sqrt(square) * side);
    offer(a.corners.center_mm + foot * along - std::sqrt(square) * side);
  }

  static void append(const Edge& edge, const Vec2& from, const Vec2& to,
                     std::vector<CurveCorner>& corners) {
    if (!edge.run) return corners.push_back({from, 0});
    const Run& run = *edge.run;
    double sweep = run.step_rad(from, to);
    if (sweep <= 0) sweep += 2 * kPi;
    const bool halves = sweep > kHalfTurn_rad;
    const double bulge = run.sense * portable::tan((halves ? sweep / 2 : sweep) / 4);
    corners.push_back({from, bulge});
    if (!halves) return;
    const Vec2 arm = from - run.corners.center_mm;
    const double angle = portable::atan2(arm.y, arm.x) + run.sense * sweep / 2;
    corners.push_back(
        {run.corners.center_mm + run.radius_mm() * Vec2(portable::cos(angle), portable::sin(angle)),
         bulge});
  }

  const std::vector<Vec2>& ring_;
  long n_;
  double tolerance_, sagitta_, on_circle_, least_bend_;
  std::vector<char> used_;
};

Curve straight(const std::vector<Vec2>& ring) {
  Curve curve;
  for (const Vec2& p : ring) curve.corners.push_back({p, 0});
  return curve;
}

}  // namespace

double CurveCorner::radius_mm(const Vec2& to_mm) const {
  return glm::length(to_mm - point_mm) * (1 + bulge * bulge) / (4 * std::abs(bulge));
}

std::vector<Curve> curves_of(const PlaneOutline& outline, double arc_tolerance_mm, double unit_mm) {
  std::vector<Curve> curves;
  for (const std::vector<Vec2>& ring : outline.rings)
    curves.push_back(ArcFinder(ring, arc_tolerance_mm, unit_mm).find());
  if (check_outline(chords_of(curves, arc_tolerance_mm), unit_mm)) return curves;
  curves.clear();
  for (const std::vector<Vec2>& ring : outline.rings) curves.push_back(straight(ring));
  return curves;
}

PlaneOutline chords_of(const std::vector<Curve>& curves, double tolerance_mm) {
  PlaneOutline outline;
  for (const Curve& curve : curves) {
    std::vector<Vec2>& ring = outline.rings.emplace_back();
    if (curve.circle) {
      append_arc(curve.circle->center_mm, curve.circle->radius_mm, 0, 2 * kPi, tolerance_mm, ring);
      continue;
    }
    ring.push_back(curve.corners[0].point_mm);
    for (std::size_t i = 0; i < curve.corners.size(); ++i) {
      const Vec2& to = curve.corners[(i + 1) % curve.corners.size()].point_mm;
      append_bulge(to, curve.corners[i].bulge, tolerance_mm, ring);
    }
    ring.pop_back();
  }
  return outline;
}

}  // namespace kerf::plane
