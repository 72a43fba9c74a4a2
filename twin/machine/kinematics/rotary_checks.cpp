#include "twin/machine/kinematics/rotary_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/portable_math.h"
#include "base/translate.h"
#include "base/units.h"

namespace kerf {
namespace {

/// Programs have four decimals, offsets six: what lies beyond by less is at the limit.
constexpr double kTolerance = 1e-3;
/// A joint may be faster than its limit by this share: what the planner rounds.
constexpr double kSpeedSlack = 1.001;
/// Positions looked at along a motion: joints bend slowly between them.
constexpr int kLooks = 16;
/// For the way of the spindle, which may go round many times.
constexpr int kSpindleLooks = 96;

bool is_cut(const Motion& m) {
  return m.kind == MotionKind::kFeed || m.kind == MotionKind::kArc || m.kind == MotionKind::kThread;
}

bool has_axis(const MachineKinematics& machine, std::size_t axis) {
  const KinematicsType& type = machine.type(0);
  if (type.mode == KinematicsMode::kArm) return true;
  return machine.chain.is_driven_by(axis);
}

std::string axes_of(const MachineKinematics& machine) {
  std::string out;
  for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
    if (axis >= 3 && !has_axis(machine, axis)) continue;
    if (!out.empty()) out += ' ';
    out += kAxisLetters[axis];
  }
  return out;
}

const char* unit_of(std::size_t axis) { return is_rotary_axis(axis) ? tr("degrees") : "mm"; }

double number_in(IniFile& ini, const std::string& section, const char* key, double otherwise) {
  const IniEntry* const entry = ini.find(section, key);
  if (entry == nullptr) return otherwise;
  double value = 0;
  const char* const begin = entry->value.data();
  const auto [end, error] = std::from_chars(begin, begin + entry->value.size(), value);
  return error == std::errc() && std::isfinite(value) ? value : otherwise;
}

}  // namespace

std::array<AxisLimits, kAxisCount> joint_limits_of_ini(IniFile& ini, std::string_view joint_letters,
                                                       double unit_mm) {
  std::array<AxisLimits, kAxisCount> out{};
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (std::size_t joint = joint_letters.size(); joint-- > 0;) {
    const auto at = std::find(kAxisLetters.begin(), kAxisLetters.end(), joint_letters[joint]);
    if (at == kAxisLetters.end()) continue;
    const auto axis = static_cast<std::size_t>(at - kAxisLetters.begin());
    const double unit = is_rotary_axis(axis) ? 1 : unit_mm;
    const std::string section = fmt::format("JOINT_{}", joint);
    AxisLimits& limits = out[axis];
    limits.present = true;
    limits.min = number_in(ini, section, "MIN_LIMIT", -kInfinity) * unit;
    limits.max = number_in(ini, section, "MAX_LIMIT", kInfinity) * unit;
    limits.max_velocity = number_in(ini, section, "MAX_VELOCITY", 0) * unit;
    limits.max_acceleration = number_in(ini, section, "MAX_ACCELERATION", 0) * unit;
  }
  return out;
}

void RotaryCheck::add(RotaryFaultKind kind, std::size_t axis, const Motion& motion,
                      std::string text, std::string hint, std::vector<RotaryFault>& out) {
  ++counts_[static_cast<std::size_t>(kind)];
  bool& told = told_[static_cast<std::size_t>(kind)][axis];
  if (told) return;
  told = true;
  out.push_back({kind, motion.source, kAxisLetters[axis], std::move(text), std::move(hint)});
}

bool RotaryCheck::turns_something(const Motion& motion) const {
  for (std::size_t i = 0; i < 3; ++i) {
    if (motion.to_abc_deg[i] != motion.from_abc_deg[i] && has_axis(path_.machine(), 3 + i)) {
      return true;
    }
  }
  return false;
}

void RotaryCheck::check_axes(const Motion& motion, std::vector<RotaryFault>& out) {
  const MachineKinematics& machine = path_.machine();
  for (std::size_t i = 0; i < 3; ++i) {
    if (motion.to_abc_deg[i] == motion.from_abc_deg[i] || has_axis(machine, 3 + i)) continue;
    add(RotaryFaultKind::kNoAxis, 3 + i, motion,
        trf("{}{:.4g} has nothing to turn: the axes of the machine are {}; it is cut as if "
            "{} stood still",
            kAxisLetters[3 + i], motion.to_abc_deg[i], axes_of(machine), kAxisLetters[3 + i]),
        tr("an INI (--ini) or the configuration says which axes a machine has"), out);
  }
}

void RotaryCheck::check_pole(const Motion& motion, std::vector<RotaryFault>& out) {
  const MachineKinematics& machine = path_.machine();
  if (machine.type(machine.type_of(motion)).mode == KinematicsMode::kAxes) return;
  if (!is_cut(motion) || motion.from_mm == motion.to_mm) return;
  double turned = 0;
  std::size_t axis = 3;
  for (std::size_t i = 0; i < 3; ++i) {
    const double way = std::abs(motion.to_abc_deg[i] - motion.from_abc_deg[i]);
    if (way <= turned) continue;
    turned = way;
    axis = 3 + i;
  }
  if (turned < kSingularTurn_deg) return;
  double spindle = 0;
  Vec3 before = path_.spindle_at(motion, 0);
  for (int i = 1; i <= kSpindleLooks; ++i) {
    const Vec3 now = path_.spindle_at(motion, static_cast<double>(i) / kSpindleLooks);
    spindle +=
        portable::atan2(glm::length(glm::cross(before, now)), glm::dot(before, now)) * kDegPerRad;
    before = now;
  }
  if (spindle >= kSingularShare * turned) return;
  add(RotaryFaultKind::kSingularPose, axis, motion,
      trf("singular pose: {} turns by {:.1f} degrees while the spindle turns by {:.2f} in "
          "the part: it passes the pole, where {} cannot tilt the tool",
          kAxisLetters[axis], turned, spindle, kAxisLetters[axis]),
      tr("turn the part by some degrees in the CAM program, or clamp the axis there"), out);
}

void RotaryCheck::check_joints(const Motion& motion, double duration_s,
                               std::vector<RotaryFault>& out) {
  const MachineKinematics& machine = path_.machine();
  if (machine.type(machine.type_of(motion)).mode != KinematicsMode::kTip) return;
  const int looks = motion.start_known ? kLooks : 0;
  std::optional<MachinePosition> before;
  for (int i = 0; i <= looks; ++i) {
    const auto at = path_.machine_at(motion, looks > 0 ? static_cast<double>(i) / looks : 1.0);
    if (!at) return;
    for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
      const AxisLimits& limits = joints_[axis];
      if (!limits.present) continue;
      const double value = at->axes[axis];
      const bool below = limits.min - value > kTolerance;
      if (below || value - limits.max > kTolerance) {
        const double limit = below ? limits.min : limits.max;
        add(RotaryFaultKind::kJointLimit, axis, motion,
            trf("the joint of {} is sent to {:.3f} {}, {:.3f} {} beyond its limit of "
                "{:.3f} {}, to hold a tool of {:.1f} mm there",
                kAxisLetters[axis], value, unit_of(axis), std::abs(value - limit), unit_of(axis),
                limit, unit_of(axis), motion.tool_offset_mm.z),
            tr("a tool of another length, or another place for the part, keeps it within"), out);
      }
      if (!before || duration_s <= 0 || limits.max_velocity <= 0) continue;
      const double speed = std::abs(value - before->axes[axis]) * looks / duration_s;
      if (speed <= limits.max_velocity * kSpeedSlack) continue;
      add(RotaryFaultKind::kJointTooFast, axis, motion,
          trf("the joint of {} would have to go at {:.1f} {}/s to follow the tip; its "
              "limit is {:.1f} {}/s, and LinuxCNC stops with a following error",
              kAxisLetters[axis], speed, unit_of(axis), limits.max_velocity, unit_of(axis)),
          tr("a lower feed, or a part nearer to the axis that turns"), out);
    }
    before = at;
  }
}

void RotaryCheck::check_tool(const Motion& motion, std::vector<RotaryFault>& out) {
  const MachineKinematics& machine = path_.machine();
  if (machine.pivot_length_mm <= 0 || !machine.told_tool_mm) return;
  const double length = motion.tool_offset_mm.z - *machine.told_tool_mm;
  if (length <= machine.pivot_length_mm) return;
  add(RotaryFaultKind::kToolTooLong, 2, motion,
      trf("tool {} is {:.1f} mm long, longer than the way to the pivot that {} reckons "
          "with ({:.1f} mm)",
          motion.tool, motion.tool_offset_mm.z, machine.module, machine.pivot_length_mm),
      tr("net motion.tooloffset.z into the pivot's length, as LinuxCNC's samples do"), out);
}

void RotaryCheck::check(const Motion& motion, double duration_s, std::vector<RotaryFault>& out) {
  check_axes(motion, out);
  if (path_.is_upright(motion)) return;
  check_tool(motion, out);
  check_pole(motion, out);
  check_joints(motion, duration_s, out);
}

}  // namespace kerf
