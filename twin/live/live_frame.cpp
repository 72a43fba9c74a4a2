#include "twin/live/live_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/translate.h"
#include "interp_bridge/tool_lengths.h"

namespace kerf {
namespace {

constexpr unsigned kTipAxes = 0b111;

unsigned bit(std::size_t index) { return 1U << index; }

std::size_t axis_of(char letter) {
  return static_cast<std::size_t>(std::find(kAxisLetters.begin(), kAxisLetters.end(), letter) -
                                  kAxisLetters.begin());
}

/// Joints whose positions are known.
unsigned known_joints(const AxisSample& sample, const MachineKinematics& machine) {
  unsigned known = 0;
  for (std::size_t i = 0; i < std::min(machine.joint_letters.size(), kMaxPositions); ++i) {
    if (sample.has(i)) known |= bit(i);
  }
  return known;
}

/// Joints without which the forward kinematics tell nothing of X, Y and Z.
unsigned needed_joints(const MachineKinematics& machine) {
  unsigned needed = 0;
  const bool follows =
      std::any_of(machine.types.begin(), machine.types.end(),
                  [](const KinematicsType& type) { return type.mode != KinematicsMode::kAxes; });
  for (std::size_t i = 0; i < std::min(machine.joint_letters.size(), kMaxPositions); ++i) {
    const char letter = machine.joint_letters[i];
    const std::size_t axis = axis_of(letter);
    if (machine.is_arm()) {
      if (machine.chain.is_driven_by_joint(i)) needed |= bit(i);
      continue;
    }
    // Of several joints on one axis the first counts.
    if (machine.joint_letters.find(letter) != i) continue;
    const bool slides = (bit(axis) & kTipAxes) != 0;
    // A machine whose U, V, W have no motors may have no joints for them either.
    const bool in_mind = machine.uvw_by_xyz && axis >= 6;
    if (slides || (follows && !in_mind && machine.chain.is_driven_by(axis))) needed |= bit(i);
  }
  return needed;
}

/// "X", or of a robot "joint 3".
std::string name_of_joint(const MachineKinematics& machine, std::size_t joint) {
  if (machine.is_arm()) return trf("joint {}", joint);
  return std::string(1, machine.joint_letters[joint]);
}

}  // namespace

/// X Y Z .. W of the controller.
struct LiveFrame::Axes {
  AxisValues value{};
  unsigned known = 0;  ///< bits
};

LiveFrame::Axes LiveFrame::axes_of(const AxisSample& sample, int type, double tool_mm) const {
  Axes out;
  if (const MachineKinematics* const machine = options_.kinematics.get()) {
    AxisValues joints{};
    for (std::size_t i = 0; i < std::min(joints.size(), kMaxPositions); ++i) {
      if (sample.has(i)) joints[i] = sample.position[i];
    }
    out.value = machine->axes_of(joints, type, tool_mm);
    const unsigned known = known_joints(sample, *machine);
    const unsigned needed = needed_joints(*machine);
    if ((known & needed) == needed) out.known = kTipAxes;
    for (std::size_t i = 0; i < machine->joint_letters.size(); ++i) {
      const std::size_t axis = axis_of(machine->joint_letters[i]);
      if (axis < kAxisCount && (bit(axis) & kTipAxes) == 0 && (known & bit(i)) != 0) {
        out.known |= bit(axis);
      }
    }
    return out;
  }
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    const int axis = options_.axis[i];
    if (axis < 0 || !sample.has(i)) continue;
    out.value[static_cast<std::size_t>(axis)] = sample.position[i];
    out.known |= 1U << axis;
  }
  if (options_.y_stands && (out.known & bit(1)) == 0) {
    if (!options_.workpiece_frame) out.value[1] = options_.work.g5x_mm.y + options_.work.g92_mm.y;
    out.known |= bit(1);
  }
  return out;
}

void LiveFrame::turn() {
  const double angle = options_.work.rotation_deg * kPi / 180.0;
  cos_ = options_.work.rotation_deg == 0 ? 1.0 : std::cos(angle);
  sin_ = options_.work.rotation_deg == 0 ? 0.0 : std::sin(angle);
}

std::string LiveFrame::missing_axes(const AxisSample& sample) const {
  std::string text;
  const auto add = [&](const std::string& name) {
    text.append(text.empty() ? "" : tr(" and ")).append(name);
  };
  if (const MachineKinematics* const machine = options_.kinematics.get()) {
    unsigned missing = needed_joints(*machine) & ~known_joints(sample, *machine);
    // Neither is known by one belt.
    if (machine->belts && (missing & 0b11) != 0) missing |= 0b11;
    for (std::size_t i = 0; i < machine->joint_letters.size(); ++i) {
      if ((missing & bit(i)) != 0) add(name_of_joint(*machine, i));
    }
    return text;
  }
  const Axes axes = axes_of(sample, 0, 0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if ((axes.known & bit(axis)) == 0) add(std::string(1, kAxisLetters[axis]));
  }
  return text;
}

double LiveFrame::length_of(const AxisSample& sample, std::optional<double> program_length_mm,
                            SamplePose& pose) const {
  const ToolLengthFrom from = options_.tool_length;
  const auto allowed = [from](ToolLengthFrom one) {
    return from == one || from == ToolLengthFrom::kAuto;
  };
  if (from == ToolLengthFrom::kNone) return 0;
  if (allowed(ToolLengthFrom::kSource) && !std::isnan(sample.tool_offset_z_mm)) {
    pose.length_is_applied = true;
    return sample.tool_offset_z_mm;
  }
  if (allowed(ToolLengthFrom::kProgram) && program_length_mm) return *program_length_mm;
  if (allowed(ToolLengthFrom::kTable)) {
    const int tool = tool_of(sample);
    if (tool == 0) return 0;
    const auto row = options_.table_length_mm.find(tool);
    if (row != options_.table_length_mm.end()) return row->second;
  }
  pose.length_known = false;
  return 0;
}

/// Only of straight axes; of others the controller turns the tool with the length that it is told.
std::optional<Vec3> LiveFrame::real_shift_of(const AxisSample& sample, double applied_mm) const {
  const auto& lengths = options_.table_length_mm;
  const auto row = lengths.find(tool_of(sample));
  if (row == lengths.end() || row->first <= 0) return std::nullopt;
  const bool any =
      std::any_of(lengths.begin(), lengths.end(), [](const auto& one) { return one.second != 0; });
  const bool turned =
      options_.kinematics &&
      std::any_of(options_.kinematics->types.begin(), options_.kinematics->types.end(),
                  [](const KinematicsType& type) { return type.mode != KinematicsMode::kAxes; });
  const double off_mm = applied_mm - row->second;
  if (!any || turned) return std::nullopt;
  return std::abs(off_mm) <= kMostWear_mm ? Vec3{0} : Vec3{0, 0, off_mm};
}

/// Machine coordinates without the tool's length and the work offset.
Vec3 LiveFrame::tip_of(const Axes& axes, double tool_mm) const {
  const WorkpieceFrame& work = options_.work;
  const Vec3 there{axes.value[0], axes.value[1], axes.value[2]};
  const Vec3 tip = there - Vec3{0, 0, tool_mm} - work.g5x_mm;
  return Vec3{cos_ * tip.x + sin_ * tip.y, cos_ * tip.y - sin_ * tip.x, tip.z} - work.g92_mm;
}

std::array<double, 9> LiveFrame::machine_place_of(const SamplePose& pose) const {
  const WorkpieceFrame& work = options_.work;
  const Vec3 turned = pose.tip_mm + work.g92_mm;
  const Vec3 there =
      Vec3{cos_ * turned.x - sin_ * turned.y, sin_ * turned.x + cos_ * turned.y, turned.z} +
      work.g5x_mm + Vec3{0, 0, pose.tool_length_mm};
  std::array<double, 9> place{there.x, there.y, there.z};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<int>(i);
    if (pose.abc_known[i]) place[3 + i] = pose.abc_deg[i] + work.offset_abc_deg[i];
    if (pose.uvw_known[i]) place[6 + i] = pose.uvw_mm[axis] + work.offset_uvw_mm[axis];
  }
  return place;
}

std::optional<SamplePose> LiveFrame::pose_of(const AxisSample& sample,
                                             std::optional<double> program_length_mm,
                                             int type) const {
  SamplePose pose;
  if (!options_.workpiece_frame) {
    pose.tool_length_mm = length_of(sample, program_length_mm, pose);
    if (pose.length_is_applied) {
      const std::optional<Vec3> shift_mm = real_shift_of(sample, pose.tool_length_mm);
      pose.length_checked = shift_mm.has_value();
      pose.real_shift_mm = shift_mm.value_or(Vec3{0});
    }
  }
  const Axes axes = axes_of(sample, type, pose.tool_length_mm);
  if ((axes.known & kTipAxes) != kTipAxes) return std::nullopt;
  pose.machine_mm = {axes.value[0], axes.value[1], axes.value[2]};
  for (std::size_t i = 0; i < 3; ++i) {
    pose.abc_deg[i] = axes.value[3 + i];
    pose.abc_known[i] = (axes.known & bit(3 + i)) != 0;
    pose.uvw_mm[static_cast<int>(i)] = axes.value[6 + i];
    pose.uvw_known[i] = (axes.known & bit(6 + i)) != 0;
  }
  if (options_.workpiece_frame) {
    pose.tip_mm = pose.machine_mm;
    return pose;
  }
  pose.tip_mm = tip_of(axes, pose.tool_length_mm);
  const auto& machine = options_.kinematics;
  if (machine && machine->type(type).mode == KinematicsMode::kTip) {
    const double longer_mm = pose.tool_length_mm + 1;
    pose.along_tool = pose.tip_mm - tip_of(axes_of(sample, type, longer_mm), longer_mm);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    pose.abc_deg[i] -= options_.work.offset_abc_deg[i];
    const auto axis = static_cast<int>(i);
    if (pose.uvw_known[i]) pose.uvw_mm[axis] -= options_.work.offset_uvw_mm[axis];
  }
  return pose;
}

}  // namespace kerf
