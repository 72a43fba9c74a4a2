// Arcs: planes, turns, ends that meet.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/portable_math.h"
#include "base/units.h"
#include "interp_bridge/motion_fold.h"
#include "interp_bridge/motion_fold_math.h"

namespace kerf {
namespace {

/// rs274 prints four decimals of the program's unit.
constexpr double kPrintResolution = 1e-4;

/// Ends closer than this are a full turn, as in LinuxCNC's own arc code (CIRCLE_FUZZ).
constexpr double kFullTurnFuzz_rad = 1e-6;

/// Where the numbers of ARC_FEED go: x, y, z index of the first, second and normal axis. In this
/// order the three are right-handed in every plane, so that a positive rotation is
/// counter-clockwise about +normal.
struct PlaneAxes {
  int first;
  int second;
  int normal;
};

PlaneAxes axes_of(CanonicalPlane plane) {
  switch (plane) {
    case CanonicalPlane::kYz:
      return {1, 2, 0};
    case CanonicalPlane::kXz:
      return {2, 0, 1};
    case CanonicalPlane::kXy:
    case CanonicalPlane::kUnknown:
      break;
  }
  return {0, 1, 2};
}

}  // namespace

double arc_sweep_rad(const Vec2& start, const Vec2& end, int turns, double resolution,
                     bool as_printed) {
  const double direction = turns < 0 ? -1.0 : 1.0;
  const double start_radius = glm::length(start);
  const double end_radius = glm::length(end);
  const double cross = start.x * end.y - start.y * end.x;
  double sweep = direction * portable::atan2(cross, glm::dot(start, end));
  // Rounding to four decimals turns the ends about the centre by up to one digit, so a full turn
  // may show as a sliver. It is one if nothing but rounding separates the ends, or if they lie on
  // one ray at different radii (a spiral).
  const double sliver = std::abs(sweep) * std::max(start_radius, end_radius);
  const double radial = std::abs(end_radius - start_radius);
  const bool ends_meet = as_printed ? start == end : sliver + radial <= 3 * resolution;
  const bool on_one_ray = sliver <= 1.5 * resolution && radial >= 5 * resolution;
  if (ends_meet || on_one_ray || std::abs(sweep) <= kFullTurnFuzz_rad) {
    sweep = 2 * kPi;
  } else if (sweep < 0) {
    sweep += 2 * kPi;
  }
  const double full_turns = std::max(0.0, std::abs(static_cast<double>(turns)) - 1.0);
  return direction * (sweep + full_turns * 2 * kPi);
}

FoldRemark MotionFold::fold_arc(const CanonicalCommand& command, SourceRef source,
                                std::vector<Motion>& out) {
  if (!work_fixed_) fix_workpiece_frame();
  if (plane_ == CanonicalPlane::kUnknown) {
    position_known_ = false;
    return FoldRemark::kArcPlaneUnknown;
  }
  take_synchronised_outputs();
  if (only_pierces(source, out)) return FoldRemark::kNone;
  return_from_overburn(source, out);
  const PlaneAxes axes = axes_of(plane_);
  const auto number = [&](std::size_t i) {
    return without_sign_of_zero(command.number(i) * unit_mm_);
  };
  const int turns = command.integer(4);
  Vec3 end_mm{0};
  end_mm[axes.first] = number(0);
  end_mm[axes.second] = number(1);
  end_mm[axes.normal] = number(5);
  const Vec3 start_mm = position_known_ ? program_from_work(position_mm_) : end_mm;
  if (held_z_mm_ && end_mm.z == *held_z_mm_) {
    end_mm.z = start_mm.z;
  } else {
    held_z_mm_.reset();
  }
  Vec3 center_mm{0};
  center_mm[axes.first] = number(2);
  center_mm[axes.second] = number(3);
  center_mm[axes.normal] = start_mm[axes.normal];
  Vec3 normal{0};
  normal[axes.normal] = 1;

  const Vec2 start{start_mm[axes.first] - center_mm[axes.first],
                   start_mm[axes.second] - center_mm[axes.second]};
  const Vec2 end{end_mm[axes.first] - center_mm[axes.first],
                 end_mm[axes.second] - center_mm[axes.second]};
  const bool start_known = position_known_ && unknown_ == 0;
  const bool as_printed = position_as_printed_;
  // No rotation, or no radius: LinuxCNC moves straight.
  const double resolution_mm = kPrintResolution * unit_mm_;
  const bool straight = turns == 0 || (glm::length(start) < resolution_mm / 2 &&
                                       glm::length(end) < resolution_mm / 2);
  const double sweep_rad =
      straight || !start_known ? 0.0 : arc_sweep_rad(start, end, turns, resolution_mm, as_printed);
  const bool full_circle = std::abs(sweep_rad) > 2 * kPi - kFullTurnFuzz_rad &&
                           glm::length(end - start) <= 3 * resolution_mm;
  begin_arc(straight ? 0.0 : 2 * glm::length(start), full_circle);
  const std::uint8_t held_before = held_axes_;
  Motion& motion = append(straight ? MotionKind::kFeed : MotionKind::kArc, source, out);
  move_to(motion, work_from_program(end_mm), work_abc(&command.arguments[6]), work_uvw(command, 9));
  set_feed(motion);
  if (straight) {
    hold_back(motion, held_before);
    return FoldRemark::kNone;
  }
  motion.arc.center_mm = work_from_program(center_mm);
  motion.arc.axis = same_frame_ ? normal : turned(normal, turn_cos_, turn_sin_);
  motion.arc.sweep_rad = motion.start_known ? sweep_rad : 0.0;
  hold_back(motion, held_before);
  if (full_circle && hole_active_ && modes_.overburn) append_overburn(Motion(motion), out);
  return FoldRemark::kNone;
}

}  // namespace kerf
