// interp_bridge/timing/corner.h - what LinuxCNC's planner makes of the corner between two segments.
#pragma once

#include "interp_bridge/timing/segment.h"

namespace kerf {

enum class CornerKind : std::uint8_t {
  kPlain,     ///< the segments meet; how is in previous.end
  kBlend,     ///< an arc goes between them; both are trimmed
  kSwallowed  ///< the same, and the arc takes the place of the previous segment too
};

/// Joins `next` to `previous`: finds out whether the corner is run through, stopped at, or cut by
/// an arc, and trims. `blend` is filled for the last two kinds.
///
///      previous            theta: half the angle between the arms
///   ---------.  d          d:     trim of both arms = R / tan(theta)
///             \ |          R:     radius, so that the arc stays within the tolerance P of the
///              \|                 corner: R (1 / sin(theta) - 1) <= P, and d within half an arm
///               \  next
///
/// Behaviour of LinuxCNC 2.9's planner ("circular arc blending", Ellenberg 2013), measured on it.
CornerKind join_corner(const AxisRates& rates, Segment& previous, Segment& next, Segment& blend);

/// Speeds below which a parabolic blend begins: of `previous` slowing down, and that `next` has
/// reached when previous stands.
struct ParabolicSpeeds {
  double leaving = 0;
  double entering = 0;
  double along = 0;  ///< speed through the corner that this amounts to
};
ParabolicSpeeds parabolic_speeds(const Segment& previous, const Segment& next, double target_before,
                                 double target_after);

}  // namespace kerf
