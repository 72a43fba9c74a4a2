#include "interp_bridge/wild_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/translate.h"

namespace kerf {
namespace {

/// Not true of NaN either.
bool within(double value, double most) { return std::abs(value) <= most; }

bool within(const Vec3& v, double most) {
  return within(v.x, most) && within(v.y, most) && within(v.z, most);
}

bool within(const std::array<double, 3>& v, double most) {
  return within(v[0], most) && within(v[1], most) && within(v[2], most);
}

std::string place(char axis, double value, double most, const char* unit) {
  return trf("{} is at {:.15g} {}; {:.15g} {} are the most, either way", axis, value, unit, most,
             unit);
}

std::string place(const char* axes, const Vec3& at) {
  for (int i = 0; i < 3; ++i) {
    if (!within(at[i], kFarthest_mm)) return place(axes[i], at[i], kFarthest_mm, "mm");
  }
  return {};
}

std::string turn(const std::array<double, 3>& abc_deg) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (!within(abc_deg[i], kFarthest_deg)) {
      return place("ABC"[i], abc_deg[i], kFarthest_deg, "degrees");
    }
  }
  return {};
}

std::string arc(const Motion& m) {
  if (!within(m.arc.center_mm, kFarthestArcCenter_mm)) {
    return trf(
        "the arc's centre is at {:.15g}, {:.15g}, {:.15g} mm; {:.15g} mm are the "
        "most, either way",
        m.arc.center_mm.x, m.arc.center_mm.y, m.arc.center_mm.z, kFarthestArcCenter_mm);
  }
  const double turns = std::abs(m.arc.sweep_rad) / (2 * kPi);
  if (!within(turns, kMostArcTurns)) {
    return trf("the arc has {:.15g} turns; {:.15g} are the most", std::round(turns), kMostArcTurns);
  }
  const double radius =
      std::max(glm::length(m.from_mm - m.arc.center_mm), glm::length(m.to_mm - m.arc.center_mm));
  const double length_mm = radius * std::abs(m.arc.sweep_rad);
  if (within(length_mm, kLongestArc_mm)) return {};
  return trf("the arc is {:.6g} mm long; {:.15g} mm are the most", length_mm, kLongestArc_mm);
}

}  // namespace

std::string wild_number_of(const Motion& m) {
  const bool ends = within(m.from_mm, kFarthest_mm) && within(m.to_mm, kFarthest_mm) &&
                    within(m.from_uvw_mm, kFarthest_mm) && within(m.to_uvw_mm, kFarthest_mm) &&
                    within(m.from_abc_deg, kFarthest_deg) && within(m.to_abc_deg, kFarthest_deg);
  if (!ends) {
    std::string fault = place("XYZ", m.to_mm);
    if (fault.empty()) fault = turn(m.to_abc_deg);
    if (fault.empty()) fault = place("UVW", m.to_uvw_mm);
    if (fault.empty()) fault = place("XYZ", m.from_mm);
    if (fault.empty()) fault = turn(m.from_abc_deg);
    return fault.empty() ? place("UVW", m.from_uvw_mm) : fault;
  }
  if (m.kind == MotionKind::kArc) return arc(m);
  if (m.kind == MotionKind::kDwell && !within(m.duration_s, kLongestDwell_s)) {
    return trf("a dwell of {:.15g} s; {:.15g} s are the most", m.duration_s, kLongestDwell_s);
  }
  return {};
}

}  // namespace kerf
