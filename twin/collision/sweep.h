// twin/collision/sweep.h - rigid bodies on their way: how near they come to what stands still, and
// where they first touch it.
#pragma once

#include <optional>

#include "stock/stock_model.h"
#include "twin/collision/solid.h"

namespace kerf {

/// A body's way in the frame of what stands still, over t in [0, 1].
class RigidWay {
 public:
  virtual ~RigidWay() = default;
  virtual Pose pose(double t) const = 0;
  /// While t goes from one to the other, no point of the body that is within `reach_mm` of its
  /// origin is farther than this from the hull of the body's places at both ends.
  virtual double slack_mm(double from, double to, double reach_mm) const = 0;
  /// By how much that hull is larger than what the body covers on the way, at most: the body turns.
  virtual double turning_mm(double from, double to, double reach_mm) const = 0;
  /// And none goes farther than this.
  virtual double travel_mm(double from, double to, double reach_mm) const = 0;
};

/// A tool on a move: its tip is the origin, its axis Z. Which way round it stands is left open.
class ToolWay final : public RigidWay {
 public:
  /// `move` outlives it.
  explicit ToolWay(const CutMove& move);
  Pose pose(double t) const override;
  double slack_mm(double from, double to, double reach_mm) const override;
  double turning_mm(double from, double to, double reach_mm) const override {
    return tilt_rad_ * (to - from) * reach_mm;
  }
  double travel_mm(double from, double to, double reach_mm) const override;

 private:
  const CutMove& move_;
  double tilt_rad_ = 0;    ///< by which the spindle turns
  Vec3 tilt_toward_{0};    ///< across axis_from, in the plane in which it turns
  Vec3 arm_{0}, side_{0};  ///< of an arc: from its axis to the start, unit; and a quarter turn on
  Vec3 foot_{0};           ///< of the start on the axis
  double radius_from_ = 0, radius_to_ = 0, along_ = 0;
};

/// Lengths to which contacts are exact.
inline constexpr double kWayExact_mm = 0.002;

/// How near a body comes.
struct LeastGap {
  double mm = 0;
  double t = 0;
};
/// The least distance of `piece` on `way` from `still`, over all t, if it is below `below_mm`:
/// to kWayExact_mm. 0: they touch. `guess`: of the query before, is kept up to date.
/// What is more than `exact_to_mm` may be told up to 0.1 mm less than it is.
std::optional<LeastGap> least_gap(const Convex& piece, const RigidWay& way, const Solid& still,
                                  double below_mm, double exact_to_mm, Vec3& guess);

/// The first t at which `piece` touches `still`, to kWayExact_mm of its way. What a closed mesh
/// encloses touches it.
std::optional<double> first_touch(const Convex& piece, const RigidWay& way, const Solid& still,
                                  Vec3& guess);

/// Whether it would touch still if it were thinner by `depth_mm` all around, at some t: the
/// greatest such depth, to 0.01 mm, at most half of its least thickness.
double touch_depth_mm(const Convex& piece, const RigidWay& way, const Solid& still);

/// From the body's origin to its farthest point.
double reach_of(const Convex& piece);

}  // namespace kerf
