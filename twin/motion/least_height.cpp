#include "twin/motion/least_height.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "base/golden_section.h"
#include "twin/motion/motion_geometry.h"
#include "twin/motion/motion_nearest.h"

namespace kerf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Slopes of profile pieces that differ by less go on in one direction.
constexpr double kSameSlope = 1e-9;
/// Steps of a search along curved ways, in radii of the cutter.
constexpr double kSearchStep = 0.02;
constexpr int kMostSteps = 20'000;
/// Shrinks the interval by 1e-12.
constexpr int kGoldenSteps = 58;

double slope_at(const ProfilePiece& piece, double r, double z) {
  if (piece.kind == ProfilePiece::Kind::kLine) {
    const double run = piece.r1 - piece.r0;
    return run > 0 ? (piece.z1 - piece.z0) / run : kInfinity;
  }
  const double fall = piece.center_z - z;
  return fall > 0 ? (r - piece.center_r) / fall : kInfinity;
}

/// Least value of a function with one minimum on [a, b].
template <class F>
double least_between(const F& f, double a, double b) {
  const double least = golden_section(f, a, b, kGoldenSteps, std::less<>{}).least;
  return std::min({f(a), f(b), least});
}

/// The part of a straight way over which the cutter is, in fractions. False: none.
bool under_cutter(const Motion& m, const Vec2& point, double reach_mm, double& from, double& to) {
  const Vec2 way = Vec2(m.to_mm) - Vec2(m.from_mm);
  const Vec2 start = Vec2(m.from_mm) - point;
  const double square = glm::dot(way, way);
  const double inner = glm::dot(start, start) - reach_mm * reach_mm;
  from = 0;
  to = 1;
  if (square == 0) return inner <= 0;
  const double middle = -glm::dot(start, way) / square;
  const double root = middle * middle - inner / square;
  if (root < 0) return false;
  from = std::max(0.0, middle - std::sqrt(root));
  to = std::min(1.0, middle + std::sqrt(root));
  return from <= to;
}

/// Samples, and a search around those that are lower than their neighbours.
template <class F>
double searched_minimum(const F& f, int steps) {
  const auto t = [steps](int i) { return static_cast<double>(i) / steps; };
  double least = kInfinity;
  double before = kInfinity;
  double here = f(0.0);
  for (int i = 0; i <= steps; ++i) {
    const double next = i < steps ? f(t(i + 1)) : kInfinity;
    if (here < kInfinity && here <= before && here <= next) {
      least = std::min(least, least_between(f, t(std::max(0, i - 1)), t(std::min(steps, i + 1))));
    }
    before = here;
    here = next;
  }
  return least;
}

bool is_level(const Motion& m) {
  if (m.from_mm.z != m.to_mm.z) return false;
  return m.kind != MotionKind::kArc || (m.arc.axis.x == 0 && m.arc.axis.y == 0);
}

}  // namespace

double LeftHeight::at(const Vec3& tip) const {
  const double beside = glm::length(point_mm - Vec2(tip)) - tolerance_mm;
  const double r = std::max(0.0, beside);
  const double radius = cutter.radius_mm();
  if (r > radius + kCutterRim_mm) return kInfinity;
  return tip.z + cutter.height_mm(std::min(r, radius));
}

bool is_convex(const Cutter& cutter) {
  double slope = -kInfinity;
  for (const ProfilePiece& piece : cutter.profile()) {
    if (piece.kind == ProfilePiece::Kind::kArc && !piece.convex) return false;
    if (slope_at(piece, piece.r0, piece.z0) < slope - kSameSlope) return false;
    slope = slope_at(piece, piece.r1, piece.z1);
  }
  return true;
}

double least_height(const Motion& m, const LeftHeight& left, bool convex) {
  const double radius = left.cutter.radius_mm();
  if (is_level(m)) {
    const Vec3 beside(left.point_mm, m.from_mm.z);
    return left.at(point_at(m, nearest_on(m, beside, 0).t));
  }
  const auto height = [&](double t) { return left.at(point_at(m, t)); };
  if (m.kind != MotionKind::kArc) {
    double from = 0, to = 1;
    if (!under_cutter(m, left.point_mm, radius + left.tolerance_mm, from, to)) return kInfinity;
    if (convex) return least_between(height, from, to);
  }
  const double steps = path_length_mm(m) / (kSearchStep * radius);
  return searched_minimum(height, static_cast<int>(std::clamp<double>(steps, 8, kMostSteps)));
}

}  // namespace kerf
