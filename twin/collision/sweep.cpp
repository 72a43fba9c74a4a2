#include "twin/collision/sweep.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/portable_math.h"

namespace kerf {
namespace {

/// Of distances, below what counts.
constexpr double kGapExact_mm = 1e-4;
/// Slack that a piece of a curved way may have: of a least distance, and where it touches first. A
/// body that grazes goes a long way while it gets a thousandth deeper.
constexpr double kSlack_mm = kWayExact_mm / 2;
constexpr double kTouchSlack_mm = 1e-4;
constexpr double kDepthExact_mm = 0.005;
/// Of distances that nobody asks to be exact.
constexpr double kCoarse_mm = 0.1;
/// Halvings of a way at most: of 100 m to a tenth of a micrometre.
constexpr int kMostHalvings = 30;

Pose upright_along(const Vec3& axis) {
  const Vec3 helper = std::abs(axis.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 side = glm::normalize(glm::cross(helper, axis));
  return {glm::dmat3(side, glm::cross(axis, side), axis), Vec3{0}};
}

/// One query over parts of a way, each halved as far as needed.
class WaySearch {
 public:
  WaySearch(const Convex& piece, const RigidWay& way, const Solid& still, Vec3& guess)
      : piece_(piece), way_(way), still_(still), guess_(guess), reach_mm_(reach_of(piece)) {}

  std::optional<LeastGap> least(double below_mm, double exact_to_mm) {
    least_ = {below_mm, -1};
    exact_to_mm_ = exact_to_mm;
    search_least(part_of(0, way_.pose(0), 1, way_.pose(1)), 0);
    if (least_.t < 0) return std::nullopt;
    return least_;
  }

  std::optional<double> first() { return search_first(0, way_.pose(0), 1, way_.pose(1), 0); }

 private:
  ConvexGap gap(const Pose& from, const Pose& to, double cutoff_mm) {
    const ConvexGap gap = still_.gap_to({piece_, from, to}, cutoff_mm, kGapExact_mm, guess_);
    guess_ = gap.direction;
    return gap;
  }

  /// Of a way from t0 to t1.
  struct Part {
    double t0, t1;
    Pose from, to;
    double slack_mm;
    double hull_mm;  ///< its hull is no nearer, if that is less than what is looked for
  };
  Part part_of(double t0, const Pose& from, double t1, const Pose& to) {
    const double slack = way_.slack_mm(t0, t1, reach_mm_);
    return {t0, t1, from, to, slack, gap(from, to, least_.mm + slack).low_mm};
  }

  void search_least(const Part& part, int depth) {
    const double slack = part.slack_mm, low_mm = part.hull_mm - slack;
    if (low_mm >= least_.mm) return;
    if (low_mm > exact_to_mm_ &&
        2 * slack + way_.turning_mm(part.t0, part.t1, reach_mm_) <= kCoarse_mm) {
      least_ = {low_mm, part.t0};
      return;
    }
    const double middle = (part.t0 + part.t1) / 2;
    const Pose there = way_.pose(middle);
    const bool is_close = slack <= kSlack_mm && is_exact(part.t0, part.t1, there, part.hull_mm);
    if (is_close || depth >= kMostHalvings) {
      const double least_mm = std::max(part.hull_mm, 0.0);
      if (least_mm < least_.mm)
        least_ = {least_mm, place_of(part.t0, part.from, part.t1, part.to, least_mm, depth)};
      return;
    }
    // The nearer half first: where a body comes nearer all the way, the other one is done then.
    const Part first = part_of(part.t0, part.from, middle, there);
    const Part last = part_of(middle, there, part.t1, part.to);
    const bool in_order = first.hull_mm - first.slack_mm <= last.hull_mm - last.slack_mm;
    search_least(in_order ? first : last, depth + 1);
    search_least(in_order ? last : first, depth + 1);
  }

  /// The hull comes no nearer than the body does.
  bool is_exact(double t0, double t1, const Pose& middle, double low_mm) {
    if (way_.turning_mm(t0, t1, reach_mm_) <= kWayExact_mm) return true;
    return gap(middle, middle, low_mm + 1).high_mm <= low_mm + kWayExact_mm;
  }

  /// Halves towards the half that is as near as the whole.
  double place_of(double t0, Pose from, double t1, Pose to, double least_mm, int depth) {
    while (depth < kMostHalvings && way_.travel_mm(t0, t1, reach_mm_) > kWayExact_mm) {
      const double middle = (t0 + t1) / 2;
      const Pose there = way_.pose(middle);
      if (gap(from, there, least_mm + kGapExact_mm).low_mm <= least_mm + kGapExact_mm) {
        t1 = middle;
        to = there;
      } else {
        t0 = middle;
        from = there;
      }
      ++depth;
    }
    return t0;
  }

  std::optional<double> search_first(double t0, const Pose& from, double t1, const Pose& to,
                                     int depth) {
    const double slack = way_.slack_mm(t0, t1, reach_mm_);
    const ConvexGap near = gap(from, to, slack);
    if (near.low_mm > slack) return std::nullopt;
    const bool straight = slack <= kTouchSlack_mm;
    if (straight && near.low_mm > 0) return std::nullopt;
    if (depth >= kMostHalvings || (straight && way_.travel_mm(t0, t1, reach_mm_) <= kWayExact_mm))
      return t0;
    const double middle = (t0 + t1) / 2;
    const Pose there = way_.pose(middle);
    if (const auto first = search_first(t0, from, middle, there, depth + 1)) return first;
    return search_first(middle, there, t1, to, depth + 1);
  }

  const Convex& piece_;
  const RigidWay& way_;
  const Solid& still_;
  Vec3& guess_;
  double reach_mm_;
  LeastGap least_;
  double exact_to_mm_ = 0;
};

/// A point of it, where it is then.
Vec3 middle_of(const Convex& piece, const Pose& pose) {
  if (piece.kind == Convex::Kind::kRevolved)
    return pose.point(piece.origin_mm + piece.discs.front().along_mm * piece.axis);
  return pose.point(piece.corners.front());
}

}  // namespace

ToolWay::ToolWay(const CutMove& move) : move_(move) {
  if (move.axis_from != move.axis_to) {
    const double along = std::clamp(glm::dot(move.axis_from, move.axis_to), -1.0, 1.0);
    const Vec3 across = move.axis_to - along * move.axis_from;
    const double sine = glm::length(across);
    tilt_rad_ = portable::atan2(sine, along);
    if (sine > 0) tilt_toward_ = across / sine;
  }
  if (!move.arc) return;
  const CutArc& arc = *move.arc;
  const Vec3 from = move.from_mm - arc.center_mm, to = move.to_mm - arc.center_mm;
  const double along_from = glm::dot(from, arc.axis);
  along_ = glm::dot(to, arc.axis) - along_from;
  foot_ = arc.center_mm + along_from * arc.axis;
  const Vec3 arm = from - along_from * arc.axis;
  radius_from_ = glm::length(arm);
  radius_to_ = glm::length(to - glm::dot(to, arc.axis) * arc.axis);
  arm_ = radius_from_ > 0 ? arm / radius_from_ : Vec3{0};
  side_ = glm::cross(arc.axis, arm_);
}

Pose ToolWay::pose(double t) const {
  Vec3 axis = t <= 0 ? move_.axis_from : move_.axis_to;
  if (tilt_rad_ > 0 && t > 0 && t < 1) {
    const double angle = t * tilt_rad_;
    axis = portable::cos(angle) * move_.axis_from + portable::sin(angle) * tilt_toward_;
  }
  Pose pose = upright_along(axis);
  if (!move_.arc) {
    pose.origin_mm = t >= 1 ? move_.to_mm : move_.from_mm + t * (move_.to_mm - move_.from_mm);
    return pose;
  }
  const double angle = t * move_.arc->sweep_rad;
  const double radius = radius_from_ + t * (radius_to_ - radius_from_);
  pose.origin_mm = foot_ + t * along_ * move_.arc->axis +
                   radius * (portable::cos(angle) * arm_ + portable::sin(angle) * side_);
  return pose;
}

double ToolWay::slack_mm(double from, double to, double reach_mm) const {
  // A point's way bends by no more than its second derivative; its chord is off by an eighth.
  double bend = tilt_rad_ * tilt_rad_ * reach_mm;
  if (move_.arc) {
    const double sweep = std::abs(move_.arc->sweep_rad);
    bend += sweep * sweep * std::max(radius_from_, radius_to_) +
            2 * sweep * std::abs(radius_to_ - radius_from_);
  }
  const double part = to - from;
  return bend * part * part / 8;
}

double ToolWay::travel_mm(double from, double to, double reach_mm) const {
  double speed = tilt_rad_ * reach_mm;
  if (move_.arc) {
    speed += std::abs(move_.arc->sweep_rad) * std::max(radius_from_, radius_to_) +
             std::abs(radius_to_ - radius_from_) + std::abs(along_);
  } else {
    speed += glm::length(move_.to_mm - move_.from_mm);
  }
  return speed * (to - from);
}

double reach_of(const Convex& piece) {
  double reach = 0;
  if (piece.kind == Convex::Kind::kRevolved) {
    for (const RoundedDisc& disc : piece.discs) {
      const Vec3 middle = piece.origin_mm + disc.along_mm * piece.axis;
      reach = std::max(reach, glm::length(middle) + disc.radius_mm + disc.round_mm);
    }
    return reach;
  }
  const Box box = piece.box_mm();
  for (int corner = 0; corner < 8; ++corner) {
    reach = std::max(reach, glm::length(Vec3{(corner & 1) != 0 ? box.max.x : box.min.x,
                                             (corner & 2) != 0 ? box.max.y : box.min.y,
                                             (corner & 4) != 0 ? box.max.z : box.min.z}));
  }
  return reach;
}

std::optional<LeastGap> least_gap(const Convex& piece, const RigidWay& way, const Solid& still,
                                  double below_mm, double exact_to_mm, Vec3& guess) {
  if (below_mm > 0 && still.encloses(middle_of(piece, way.pose(0)))) return LeastGap{0, 0};
  return WaySearch(piece, way, still, guess).least(below_mm, exact_to_mm);
}

std::optional<double> first_touch(const Convex& piece, const RigidWay& way, const Solid& still,
                                  Vec3& guess) {
  if (still.encloses(middle_of(piece, way.pose(0)))) return 0;
  return WaySearch(piece, way, still, guess).first();
}

double touch_depth_mm(const Convex& piece, const RigidWay& way, const Solid& still) {
  std::vector<RoundedDisc> discs;
  std::array<Vec3, 2> corners{};
  Vec3 guess{0};
  double touches = 0, clears = half_thickness_mm(piece);
  while (clears - touches > kDepthExact_mm) {
    const double depth = (touches + clears) / 2;
    const Convex thin = eroded(piece, depth, discs, corners);
    (first_touch(thin, way, still, guess) ? touches : clears) = depth;
  }
  return touches;
}

}  // namespace kerf
