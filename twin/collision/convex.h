// twin/collision/convex.h - convex solids and how far apart two of them are.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/geometry.h"
#include "twin/machine/kinematics/pose.h"

namespace kerf {

/// A disc across an axis, and all that is no farther from it than `round_mm`. mm along the axis.
struct RoundedDisc {
  double radius_mm = 0;
  double along_mm = 0;
  double round_mm = 0;
};

/// A convex solid in the frame of its body. A small value: it points at what its owner keeps.
struct Convex {
  enum class Kind : std::uint8_t {
    kRevolved,  ///< hull of discs about one axis: cylinders, cones, balls, bull noses
    kBox,       ///< corners[0] the lowest, corners[1] the highest
    kHull,      ///< of its corners: a triangle
  };
  Kind kind = Kind::kHull;
  std::span<const RoundedDisc> discs{};
  std::span<const Vec3> corners{};
  Vec3 origin_mm{0};   ///< kRevolved: a point of the axis
  Vec3 axis{0, 0, 1};  ///< kRevolved: unit vector

  /// About it, in the body's frame.
  Box box_mm() const;
  /// A point that is farthest in a direction, of any length.
  Vec3 support(const Vec3& direction) const;
};

/// The same solid, thinner by `depth_mm` all around: discs and boxes lose it at every face (a cone
/// a little more), triangles nothing. As thin as a micrometre at most. `discs` and `corners` hold
/// what it points at.
Convex eroded(const Convex& solid, double depth_mm, std::vector<RoundedDisc>& discs,
              std::array<Vec3, 2>& corners);
/// How much can be taken off at all: half of its least thickness.
double half_thickness_mm(const Convex& solid);

/// A convex solid that goes straight, without turning between the two, from one pose to another in
/// the frame of what stands still; of poses that differ in rotation: the hull of both.
struct MovingConvex {
  Convex solid;
  Pose from;
  Pose to;
};

/// Support points of a solid on its way: what is farthest in a direction, of any length, in the
/// frame of what stands still. `moving` outlives it.
class ConvexSweep {
 public:
  explicit ConvexSweep(const MovingConvex& moving);
  Vec3 support(const Vec3& direction) const;

 private:
  struct Axis {
    Vec3 origin_mm{0};
    Vec3 along{0};
  };
  Vec3 support_at(const Pose& pose, const Axis& axis, const Vec3& direction) const;

  const MovingConvex& moving_;
  Axis from_, to_;  ///< of what is revolved
  bool slides_;     ///< without turning
};

/// What is known of the distance of two solids.
struct ConvexGap {
  double low_mm = 0;   ///< it is no less ..
  double high_mm = 0;  ///< .. and no more; both 0: they overlap
  Vec3 direction{0};   ///< from the second towards the first, of no length in particular
};

/// The distance of `moving`, over all of its way, from `still`: by Gilbert, Johnson and Keerthi,
/// with the bound that each of its steps gives. Ends when the bounds are within `exact_mm` of each
/// other, or `low_mm` is above `cutoff_mm`. `guess`: a direction to begin with, that of a query
/// nearby; 0,0,0: none. Allocates nothing.
ConvexGap gap_of(const ConvexSweep& moving, const Convex& still, double cutoff_mm, double exact_mm,
                 const Vec3& guess = Vec3{0});
inline ConvexGap gap_of(const MovingConvex& moving, const Convex& still, double cutoff_mm,
                        double exact_mm, const Vec3& guess = Vec3{0}) {
  return gap_of(ConvexSweep(moving), still, cutoff_mm, exact_mm, guess);
}

}  // namespace kerf
