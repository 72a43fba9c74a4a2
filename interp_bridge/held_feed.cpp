#include "interp_bridge/held_feed.h"

#include <cmath>

#include "base/portable_math.h"
#include "base/triple.h"

namespace kerf {

bool is_held_back(const Motion& m) {
  if (!is_equal(m.from_abc_deg, m.to_abc_deg) || !is_equal(m.from_uvw_mm, m.to_uvw_mm))
    return false;
  if (m.kind == MotionKind::kFeed) return m.start_known && m.from_mm != m.to_mm;
  if (m.kind != MotionKind::kArc || m.path_mode != PathMode::kContinuous) return false;
  if (std::abs(m.arc.axis.z) < 0.9999) return false;
  const double radius =
      portable::hypot(m.from_mm.x - m.arc.center_mm.x, m.from_mm.y - m.arc.center_mm.y);
  const double sagitta = radius * (1 - portable::cos(m.arc.sweep_rad / 2));
  return std::abs(m.arc.sweep_rad) < 2 * kPi && sagitta < double{m.merge_tolerance_mm};
}

}  // namespace kerf
