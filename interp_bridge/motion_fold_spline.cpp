// The splines of MotionFold: NURBS to chords.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "interp_bridge/motion_fold.h"

namespace kerf {
namespace {

/// Splines of programs have a handful of points; more than this in a million-fold text is not one.
constexpr std::size_t kMaxPoints = 10'000;
/// A quarter of a span is halved no oftener: 2^-12 of a metre is 0.25 mm, whose sagitta is below
/// the tolerance unless the curve has a kink there.
constexpr int kMaxHalvings = 12;
/// Chords of a spline that anyone would run; a longer one is taken for damage.
constexpr std::size_t kMaxChords = 200'000;

/// Clamped uniform knots, as LinuxCNC has them: 0 .. 0, 1, 2 .., n - order + 1 .. (order times
/// each end).
double knot(std::size_t i, std::size_t points, unsigned order) {
  if (i < order) return 0;
  const std::size_t last = points - order + 1;
  return static_cast<double>(std::min(i - order + 1, last));
}

/// de Boor's algorithm in homogeneous coordinates. Source: C. de Boor, "On calculating with
/// B-splines", J. Approximation Theory 6, 1972.
class Curve {
 public:
  explicit Curve(const Spline& spline) : spline_(spline), work_(spline.order) {}

  double end() const { return static_cast<double>(spline_.points.size() - spline_.order + 1); }

  Vec2 at(double u) {
    const std::size_t n = spline_.points.size();
    const unsigned k = spline_.order;
    const auto whole = static_cast<std::size_t>(std::floor(u));
    const std::size_t span = std::min(whole, n - k) + k - 1;  // knot(span) <= u <= knot(span + 1)
    for (unsigned j = 0; j < k; ++j) {
      const Spline::Point& p = spline_.points[span + 1 - k + j];
      work_[j] = Vec3(p.x * p.weight, p.y * p.weight, p.weight);
    }
    for (unsigned r = 1; r < k; ++r) {
      for (unsigned j = k - 1; j >= r; --j) {
        const std::size_t i = span + 1 - k + j;
        const double from = knot(i, n, k);
        const double to = knot(i + k - r, n, k);
        const double t = (u - from) / (to - from);
        work_[j] = (1 - t) * work_[j - 1] + t * work_[j];
      }
    }
    const Vec3& h = work_[k - 1];
    return {h.x / h.z, h.y / h.z};
  }

 private:
  const Spline& spline_;
  std::vector<Vec3> work_;
};

/// Chords of the curve between u0 and u1, without the first point. A chord is good if the curve at
/// its quarters lies within the tolerance.
void add_chords(Curve& curve, double u0, const Vec2& p0, double u1, const Vec2& p1,
                double tolerance, int halvings, std::vector<Vec2>& out) {
  const Vec2 chord = p1 - p0;
  const double length = glm::length(chord);
  double off = 0;
  for (const double t : {0.25, 0.5, 0.75}) {
    const Vec2 d = curve.at(u0 + t * (u1 - u0)) - p0;
    off = std::max(off,
                   length > 0 ? std::abs(chord.x * d.y - chord.y * d.x) / length : glm::length(d));
  }
  if (off <= tolerance || halvings == 0 || out.size() > kMaxChords) {
    out.push_back(p1);
    return;
  }
  const double middle = 0.5 * (u0 + u1);
  const Vec2 m = curve.at(middle);
  add_chords(curve, u0, p0, middle, m, tolerance, halvings - 1, out);
  add_chords(curve, middle, m, u1, p1, tolerance, halvings - 1, out);
}

bool usable(const Spline& spline) {
  const std::size_t n = spline.points.size();
  if (spline.order < 2 || n < spline.order || n > kMaxPoints) return false;
  return std::all_of(spline.points.begin(), spline.points.end(), [](const Spline::Point& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.weight) && p.weight > 0 &&
           std::abs(p.x) < 1e12 && std::abs(p.y) < 1e12 && p.weight < 1e12;
  });
}

}  // namespace

FoldRemark MotionFold::fold_spline(const Spline& spline, SourceRef source,
                                   std::vector<Motion>& out) {
  const std::size_t first = out.size();
  const FoldRemark remark = fold_points(spline, source, out);
  place_tips(first, out);
  return remark;
}

FoldRemark MotionFold::fold_points(const Spline& spline, SourceRef source,
                                   std::vector<Motion>& out) {
  if (!usable(spline) || !position_known_) {
    position_known_ = false;
    return FoldRemark::kSplineLost;
  }
  Curve curve(spline);
  std::vector<Vec2> points;
  Vec2 from = curve.at(0);
  // Its first point is where the tip stands; where that is not known only its end is of use.
  if ((unknown_ & 3) != 0) points.push_back(curve.at(curve.end()));
  const double tolerance = kSplineChord_mm / unit_mm_;
  // From knot to knot the curve is smooth; each span begins in quarters, so that an S is not taken
  // for a line.
  constexpr int kParts = 4;
  const auto parts = static_cast<int>(curve.end()) * kParts;
  for (int i = 0; i < parts && (unknown_ & 3) == 0; ++i) {
    const double u0 = static_cast<double>(i) / kParts;
    const double u1 = static_cast<double>(i + 1) / kParts;
    const Vec2 to = curve.at(u1);
    add_chords(curve, u0, from, u1, to, tolerance, kMaxHalvings, points);
    from = to;
    if (points.size() > kMaxChords) {
      position_known_ = false;
      return FoldRemark::kSplineLost;
    }
  }
  const double z = program_from_work(position_mm_).z;
  for (const Vec2& p : points) {
    Motion& motion = append(MotionKind::kFeed, source, out);
    move_to(motion, work_from_program({p.x * unit_mm_, p.y * unit_mm_, z}), abc_deg_, uvw_mm_);
    set_feed(motion);
  }
  position_as_printed_ = false;
  return FoldRemark::kNone;
}

}  // namespace kerf
