#include "stock/turning/contour_arcs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/portable_math.h"

namespace kerf::turning {
namespace {

/// A corner nearer to its circle than this stays where it is: what rounding does.
constexpr double kOnArc_mm = 3e-5;
/// So far a corner may slide along a line to where this meets the circle: they part by less than
/// the band on the way.
constexpr double kSlide_mm = 0.02;
/// Flatter ones are lines in any drawing.
constexpr double kMaxArcRadius_mm = 1e5;
/// One edge of an arc turns by no more: outlines have at least eight for half a turn.
constexpr double kMaxEdge_rad = kPi / 6;
/// Edges that do not bend are followed no farther, in the hope that they will.
constexpr std::size_t kMostStraight = 512;
/// Gauss, three points of an edge: places and weights.
constexpr std::array<double, 3> kGaussAt{0.1127016653792583, 0.5, 0.8872983346207417};
constexpr std::array<double, 3> kGaussWeight{5.0 / 18, 8.0 / 18, 5.0 / 18};

double cross_of(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

struct ArcCircle {
  Vec2 center{0};
  double radius = 0;
  double off(const Vec2& p) const { return glm::distance(p, center) - radius; }
  double step_rad(const Vec2& from, const Vec2& to) const {
    const Vec2 a = from - center, b = to - center;
    return portable::atan2(cross_of(a, b), glm::dot(a, b));
  }
};

/// The solution of a symmetric system of three, lower triangle given row by row; false: there is
/// none.
bool solve3(std::array<double, 6> m, std::array<double, 3>& x) {
  // By L D L'.
  const double d0 = m[0];
  if (!(d0 > 0)) return false;
  const double l10 = m[1] / d0, l20 = m[3] / d0;
  const double d1 = m[2] - l10 * l10 * d0;
  if (!(d1 > 0)) return false;
  const double l21 = (m[4] - l20 * l10 * d0) / d1;
  const double d2 = m[5] - l20 * l20 * d0 - l21 * l21 * d1;
  if (!(d2 > 0)) return false;
  const double y0 = x[0], y1 = x[1] - l10 * y0, y2 = x[2] - l20 * y0 - l21 * y1;
  x[2] = y2 / d2;
  x[1] = y1 / d1 - l21 * x[2];
  x[0] = y0 / d0 - l10 * x[1] - l20 * x[2];
  return true;
}

class ContourArcs {
 public:
  explicit ContourArcs(const Contour& contour) {
    std::size_t longest = 0;
    double length = -1;
    for (const Point& p : contour.ring()) points_.push_back(to_mm(p));
    n_ = points_.size();
    for (std::size_t i = 0; i < n_; ++i) {
      const double edge = glm::distance(points_[i], points_[(i + 1) % n_]);
      if (edge <= length) continue;
      length = edge;
      longest = i;
    }
    // The longest edge is the surest not to be one of an arc.
    std::rotate(points_.begin(), points_.begin() + static_cast<long>(longest), points_.end());
    points_.push_back(points_.front());
  }

  CurvedContour find() {
    if (const std::optional<ArcCircle> whole = fitting(0, n_)) return {circle_piece(*whole)};
    for (std::size_t i = 0; i < n_;) {
      const std::size_t end = longest_arc(i);
      if (end == i) {
        runs_.push_back({i, i + 1, std::nullopt});
        ++i;
      } else {
        runs_.push_back({i, end, fitting(i, end)});
        i = end;
      }
    }
    settle_borders();
    return pieces();
  }

 private:
  struct Run {
    std::size_t first = 0, last = 0;  ///< corners
    std::optional<ArcCircle> arc;
  };

  /// The circle nearest to edges first .. last.
  std::optional<ArcCircle> circle_of(std::size_t first, std::size_t last) const {
    const Vec2 &a = points_[first], &b = points_[(first + last) / 2], &c = points_[last];
    ArcCircle circle = through(a, b, c);
    if (first == 0 && last == n_) circle = through(a, points_[n_ / 3], points_[2 * n_ / 3]);
    // Gauss-Newton on the distances of the edges, by centre and radius.
    for (int pass = 0; pass < 3; ++pass) {
      if (!(circle.radius < kMaxArcRadius_mm)) return std::nullopt;
      std::array<double, 6> m{};
      std::array<double, 3> x{};
      for (std::size_t i = first; i < last; ++i) {
        const Vec2 way = points_[i + 1] - points_[i];
        const double length = glm::length(way);
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec2 arm = points_[i] + kGaussAt[k] * way - circle.center;
          const double distance = glm::length(arm), w = kGaussWeight[k] * length;
          if (!(distance > 0)) return std::nullopt;
          const double dx = arm.x / distance, dy = arm.y / distance;
          const double off = distance - circle.radius;
          m[0] += w * dx * dx, m[1] += w * dx * dy, m[2] += w * dy * dy;
          m[3] += w * dx, m[4] += w * dy, m[5] += w;
          x[0] += w * off * dx, x[1] += w * off * dy, x[2] += w * off;
        }
      }
      if (!solve3(m, x)) return std::nullopt;
      circle.center += Vec2(x[0], x[1]);
      circle.radius += x[2];
      if (!(circle.radius > 0)) return std::nullopt;
    }
    return circle;
  }

  static ArcCircle through(const Vec2& a, const Vec2& b, const Vec2& c) {
    const Vec2 u = b - a, v = c - a;
    const double twice = 2 * cross_of(u, v);
    if (twice == 0) return {a, kMaxArcRadius_mm};
    const double uu = glm::dot(u, u), vv = glm::dot(v, v);
    const Vec2 arm = Vec2(v.y * uu - u.y * vv, u.x * vv - v.x * uu) / twice;
    return {a + arm, glm::length(arm)};
  }

  /// The circle of edges that keep to it; none: they do not.
  std::optional<ArcCircle> fitting(std::size_t first, std::size_t last) const {
    if (last - first < kLeastArcEdges) return std::nullopt;
    std::optional<ArcCircle> circle = circle_of(first, last);
    if (!circle || !(circle->radius > kArcBand_mm)) return std::nullopt;
    const double sense = circle->step_rad(points_[first], points_[first + 1]) > 0 ? 1 : -1;
    double turned = 0;
    for (std::size_t i = first; i < last; ++i) {
      const Vec2 &p = points_[i], &q = points_[i + 1];
      const double step = sense * circle->step_rad(p, q);
      turned += step;
      if (!(step > 0) || step > kMaxEdge_rad || std::abs(circle->off(p)) > kArcBand_mm ||
          std::abs(circle->off((p + q) / 2.0)) > kArcBand_mm)
        return std::nullopt;
    }
    if (std::abs(circle->off(points_[last])) > kArcBand_mm || turned > 2 * kPi + 1e-6)
      return std::nullopt;
    if (turned < kPi && circle->radius * (1 - portable::cos(turned / 2)) < kLeastBend_mm)
      return std::nullopt;
    return circle;
  }
  /// Too short to bend counts as fitting while a run grows.
  bool may_fit(std::size_t first, std::size_t last) const {
    const Vec2 chord = points_[last] - points_[first];
    const double length = glm::length(chord);
    double bend = 0;
    for (std::size_t i = first; i <= last && length > 0; ++i)
      bend = std::max(bend, std::abs(cross_of(chord, points_[i] - points_[first])) / length);
    const bool is_straight = bend < kLeastBend_mm && last - first <= kMostStraight;
    return is_straight || fitting(first, last).has_value();
  }

  /// Where the longest arc from this corner on ends; the corner itself: none begins there.
  std::size_t longest_arc(std::size_t first) const {
    std::size_t good = first, step = kLeastArcEdges;
    while (first + step <= n_ && may_fit(first, first + step)) {
      good = first + step;
      step *= 2;
    }
    std::size_t bad = std::min(first + step, n_ + 1);
    while (bad - good > 1) {
      const std::size_t middle = (good + bad) / 2;
      (middle - first < kLeastArcEdges || may_fit(first, middle) ? good : bad) = middle;
    }
    if (good - first < kLeastArcEdges) return first;
    return fitting(first, good) ? good : first;
  }

  /// Arcs that go over into each other: the first has run on into the second as far as the band
  /// lets it. Circles are those of the inner edges, and each corner goes to the nearer one.
  void settle_borders() {
    for (std::size_t k = 0; k + 1 < runs_.size(); ++k) {
      Run &a = runs_[k], &b = runs_[k + 1];
      if (!a.arc) continue;
      const auto core = [this](const Run& run) {
        const std::size_t quarter = (run.last - run.first) / 4;
        return circle_of(run.first + quarter, run.last - quarter);
      };
      if (a.last - a.first < 2 * kLeastArcEdges) continue;
      const std::optional<ArcCircle> of_a = core(a);
      if (!of_a) continue;
      std::size_t border = a.last;
      if (b.arc && b.last - b.first >= 2 * kLeastArcEdges) {
        const std::optional<ArcCircle> of_b = core(b);
        if (!of_b) continue;
        while (border > a.first + kLeastArcEdges &&
               std::abs(of_b->off(points_[border - 1])) < std::abs(of_a->off(points_[border - 1])))
          --border;
        if (border == a.last) continue;
        const auto new_a = fitting(a.first, border), new_b = fitting(border, b.last);
        if (!new_a || !new_b) continue;
        a.last = b.first = border;
        a.arc = new_a;
        b.arc = new_b;
      }
    }
  }

  ContourPiece circle_piece(const ArcCircle& circle) const {
    const double sense = circle.step_rad(points_[0], points_[1]) > 0 ? 1 : -1;
    const Vec2 at = circle.center + Vec2(circle.radius, 0);
    return {at, at, PieceArc{circle.center, circle.radius, sense * 2 * kPi}};
  }

  /// Where the line goes into the circle nearest to its end p.
  static std::optional<Vec2> meeting(const ArcCircle& circle, const Vec2& p, const Vec2& other) {
    const double length = glm::distance(p, other);
    const Vec2 along = (other - p) / length, arm = circle.center - p;
    const double foot = glm::dot(arm, along), beside = cross_of(along, arm);
    const double square = circle.radius * circle.radius - beside * beside;
    if (!(square >= 0)) return std::nullopt;
    const double half = std::sqrt(square);
    const double slide = std::abs(foot - half) < std::abs(foot + half) ? foot - half : foot + half;
    if (std::abs(slide) > std::min(kSlide_mm, length / 2)) return std::nullopt;
    return p + slide * along;
  }

  /// Lines stay where they are: an end off the circle by less than the band only makes the radius
  /// differ by half of that.
  Vec2 border_of(const Run& before, const Run& after) const {
    const Vec2& p = points_[after.first];
    const auto is_on = [&](const Run& run) {
      return !run.arc || std::abs(run.arc->off(p)) <= kOnArc_mm;
    };
    if (is_on(before) && is_on(after)) return p;
    if (before.arc && after.arc) {
      const auto on = [&](const ArcCircle& circle) {
        return circle.center + circle.radius * glm::normalize(p - circle.center);
      };
      return (on(*before.arc) + on(*after.arc)) / 2.0;
    }
    const Vec2& other = before.arc ? points_[after.last] : points_[before.first];
    return meeting(before.arc ? *before.arc : *after.arc, p, other).value_or(p);
  }

  CurvedContour pieces() const {
    std::vector<Vec2> borders;
    for (std::size_t k = 0; k < runs_.size(); ++k) {
      const Run& before = runs_[k == 0 ? runs_.size() - 1 : k - 1];
      borders.push_back(border_of(before, runs_[k]));
    }
    CurvedContour contour;
    for (std::size_t k = 0; k < runs_.size(); ++k) {
      const Run& run = runs_[k];
      ContourPiece piece{borders[k], borders[k + 1 == runs_.size() ? 0 : k + 1], std::nullopt};
      if (run.arc) {
        const double sense = run.arc->step_rad(points_[run.first], points_[run.first + 1]);
        double sweep = run.arc->step_rad(piece.from_mm, piece.to_mm);
        if (sense * sweep < 0) sweep += sense > 0 ? 2 * kPi : -2 * kPi;
        piece.arc = PieceArc{run.arc->center, run.arc->radius, sweep};
      }
      contour.push_back(piece);
    }
    return contour;
  }

  std::vector<Vec2> points_;  // the first once more at the end
  std::size_t n_ = 0;
  std::vector<Run> runs_;
};

}  // namespace

CurvedContour with_arcs(const Contour& contour) { return ContourArcs(contour).find(); }

}  // namespace kerf::turning
