#include "twin/diff/path_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "twin/motion/motion_geometry.h"
#include "twin/motion/motion_nearest.h"

namespace kerf {
namespace {

constexpr double kArcStep_rad = 5 * kPi / 180;
constexpr int kMostArcPoints = 7200;
constexpr int kLinePoints = 4;
/// Looked at ahead of the place that has been reached, at least.
constexpr std::size_t kLeastAhead = 8;
/// And where the ways are far apart at most, beyond what has been gone.
constexpr std::size_t kMostAhead = 64;

int points_of(const DiffStep& step) {
  if (step.kind != MotionKind::kArc) return kLinePoints;
  const double wanted = std::ceil(std::abs(step.arc.sweep_rad) / kArcStep_rad);
  return static_cast<int>(std::clamp(wanted, double{kLinePoints}, double{kMostArcPoints}));
}

/// Angles and slides of a step at a fraction of its way.
TurnedAxes turned_at(const Motion& m, double t) {
  TurnedAxes out;
  out.lever_mm = kTurnLever_mm;
  for (std::size_t i = 0; i < 3; ++i) {
    out.abc_deg[i] = m.from_abc_deg[i] + t * (m.to_abc_deg[i] - m.from_abc_deg[i]);
    out.counts[i] = true;
    out.uvw_counts[i] = true;
  }
  out.uvw_mm = m.from_uvw_mm + t * (m.to_uvw_mm - m.from_uvw_mm);
  return out;
}

bool is_plain(const DiffStep& step) {
  constexpr std::array<double, 3> kNone{};
  return step.from_abc_deg == kNone && step.to_abc_deg == kNone && step.from_uvw_mm == Vec3(0) &&
         step.to_uvw_mm == Vec3(0);
}

/// Walks along one way while the points of another one come by.
class Follower {
 public:
  Follower(std::span<const DiffStep> way, double enough_mm) : enough_mm_(enough_mm) {
    for (const DiffStep& step : way) {
      motions_.push_back(motion_of(step));
      lengths_mm_.push_back(path_length_mm(motions_.back()));
      plain_ = plain_ && is_plain(step);
    }
  }

  /// The distance of the next point, which lies so much farther on its own way.
  double distance_mm(const Motion& of, double t, double gone_mm) {
    const Vec3 place = point_at(of, t);
    double best_mm = std::numeric_limits<double>::infinity();
    std::size_t best = at_;
    double best_t = t_;
    double looked_mm = 0;
    for (std::size_t i = at_; i < motions_.size(); ++i) {
      const double from_t = i == at_ ? t_ : 0;
      const PointOnWay near = plain_ ? nearest_on(motions_[i], place, from_t)
                                     : nearest_on(motions_[i], place, turned_at(of, t), from_t);
      const bool nearer = near.distance_mm < best_mm - kRounding_mm;
      // The first that is near enough, and what is nearer right behind it: a way that comes by
      // later is another pass.
      if (best_mm <= enough_mm_ && !nearer) break;
      if (nearer) {
        best_mm = near.distance_mm;
        best = i;
        best_t = near.t;
      }
      looked_mm += lengths_mm_[i] * (1 - from_t);
      const std::size_t ahead = i - at_;
      if (ahead < kLeastAhead || looked_mm <= 2 * gone_mm) continue;
      if (ahead >= kMostAhead || looked_mm > 2 * gone_mm + best_mm) break;
    }
    at_ = best;
    t_ = best_t;
    return best_mm;
  }
  std::size_t at() const { return at_; }

 private:
  static constexpr double kRounding_mm = 1e-9;

  double enough_mm_;
  std::vector<Motion> motions_;
  std::vector<double> lengths_mm_;
  bool plain_ = true;
  std::size_t at_ = 0;
  double t_ = 0;
};

/// Of the points of `a` from the way `b`.
PathDistance one_way(std::span<const DiffStep> a, std::span<const DiffStep> b, double enough_mm) {
  PathDistance out;
  Follower follower(b, enough_mm);
  for (const DiffStep& step : a) {
    const Motion m = motion_of(step);
    const int points = points_of(step);
    const double gone_mm = path_length_mm(m) / points;
    for (int i = 0; i <= points; ++i) {
      const double t = static_cast<double>(i) / points;
      const double mm = follower.distance_mm(m, t, gone_mm);
      if (mm <= out.mm) continue;
      out = {mm, point_at(m, t), step.source, b[follower.at()].source};
    }
  }
  return out;
}

}  // namespace

PathDistance path_distance(std::span<const DiffStep> a, std::span<const DiffStep> b,
                           double enough_mm) {
  if (a.empty() || b.empty()) return {};
  const PathDistance there = one_way(a, b, enough_mm);
  PathDistance back = one_way(b, a, enough_mm);
  if (there.mm >= back.mm) return there;
  std::swap(back.a, back.b);
  return back;
}

}  // namespace kerf
