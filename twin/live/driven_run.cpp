#include "twin/live/driven_run.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "twin/motion/motion_nearest.h"

namespace kerf {
namespace {

/// Coordinates that ways share differ by rounding at most. mm and degrees.
constexpr double kSame = 1e-9;
/// An axis that the program has not turned stands where it was last seen, give or take this much.
/// Degrees.
constexpr double kStands_deg = 0.01;

bool is_near(const std::array<double, 3>& a, const std::array<double, 3>& b, double by) {
  return std::abs(a[0] - b[0]) <= by && std::abs(a[1] - b[1]) <= by && std::abs(a[2] - b[2]) <= by;
}

}  // namespace

/// With the same tool, for the same line, from where the run has come to.
bool DrivenRun::goes_on(const Motion& motion, Way way) const {
  const Motion& run = run_->motion;
  return way == (straight_ ? Way::kStraight : Way::kNextPart) && motion.kind == run.kind &&
         motion.tool == run.tool && motion.spindle == run.spindle && motion.source == run.source &&
         motion.tool_offset_mm == run.tool_offset_mm && motion.torch.analog == run.torch.analog &&
         motion.from_uvw_mm == run.to_uvw_mm && glm::length(motion.from_mm - run.to_mm) <= kSame;
}

/// All that was met lies on the way, in the order in which it was met.
bool DrivenRun::is_straight(const Motion& whole) const {
  double t = 0;
  for (const ProgramPose& place : met_) {
    const TurnedAxes turned{
        place.abc_deg, {true, true, true}, lever_mm_, place.uvw_mm, {true, true, true}};
    const PointOnWay point = nearest_on(whole, place.tip_mm, turned, t);
    if (point.distance_mm > bound_mm_) return false;
    t = point.t;
  }
  return true;
}

bool DrivenRun::add_part(const Motion& part) {
  Motion& whole = run_->motion;
  if (!is_near(part.from_abc_deg, whole.to_abc_deg, kStands_deg)) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (part.to_abc_deg[i] != part.from_abc_deg[i]) whole.to_abc_deg[i] = part.to_abc_deg[i];
  }
  whole.to_mm = part.to_mm;
  whole.to_uvw_mm = part.to_uvw_mm;
  whole.arc.sweep_rad += part.arc.sweep_rad;
  return true;
}

bool DrivenRun::add_straight(const Motion& motion) {
  Motion whole = run_->motion;
  if (!is_near(motion.from_abc_deg, whole.to_abc_deg, kSame)) return false;
  whole.to_mm = motion.to_mm;
  whole.to_abc_deg = motion.to_abc_deg;
  whole.to_uvw_mm = motion.to_uvw_mm;
  met_.push_back({motion.from_mm, motion.from_abc_deg, {0, 0, 1}, motion.from_uvw_mm});
  if (!is_straight(whole)) {
    met_.pop_back();
    return false;
  }
  run_->motion = whole;
  return true;
}

bool DrivenRun::add(const Motion& motion, Way way, double duration_s, double t_s) {
  if (!run_) {
    run_ = Run{motion, duration_s, t_s};
    straight_ = way == Way::kStraight;
    return true;
  }
  if (!goes_on(motion, way)) return false;
  if (!(straight_ ? add_straight(motion) : add_part(motion))) return false;
  run_->duration_s += duration_s;
  return true;
}

std::optional<DrivenRun::Run> DrivenRun::take() {
  met_.clear();
  return std::exchange(run_, std::nullopt);
}

}  // namespace kerf
