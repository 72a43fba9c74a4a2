#include "twin/live/live_frame.h"

#include <algorithm>
#include <cmath>

namespace kerf {
namespace {

constexpr unsigned kTipAxes = 0b111;

/// Positions by axis, and which of them are known.
struct ByAxis {
  std::array<double, kMaxPositions> position{};
  unsigned known = 0;
};

/// Of belts neither X nor Y is known unless both are.
ByAxis by_kinematics(const AxisSample& sample, const MachineKinematics& machine) {
  ByAxis out;
  AxisValues joints{};
  for (std::size_t i = 0; i < machine.joint_letters.size(); ++i) {
    if (!sample.has(i)) continue;
    joints[i] = sample.position[i];
    const auto axis = std::find(kAxisLetters.begin(), kAxisLetters.end(), machine.joint_letters[i]);
    out.known |= 1U << (axis - kAxisLetters.begin());
  }
  constexpr unsigned kBelts = 0b11;
  if (machine.belts && (out.known & kBelts) != kBelts) out.known &= ~kBelts;
  const AxisValues axes = machine.axes_of(joints, 0);
  std::copy(axes.begin(), axes.end(), out.position.begin());
  return out;
}

ByAxis by_axis(const AxisSample& sample, const LiveFrameOptions& options) {
  if (options.kinematics) return by_kinematics(sample, *options.kinematics);
  const std::array<int, kMaxPositions>& axis = options.axis;
  ByAxis out;
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if (axis[i] < 0 || !sample.has(i)) continue;
    out.position[static_cast<std::size_t>(axis[i])] = sample.position[i];
    out.known |= 1U << axis[i];
  }
  return out;
}

}  // namespace

void LiveFrame::turn() {
  const double angle = options_.work.rotation_deg * kPi / 180.0;
  cos_ = options_.work.rotation_deg == 0 ? 1.0 : std::cos(angle);
  sin_ = options_.work.rotation_deg == 0 ? 0.0 : std::sin(angle);
}

std::string LiveFrame::missing_axes(const AxisSample& sample) const {
  const ByAxis axes = by_axis(sample, options_);
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    if (axes.known >> axis & 1U) continue;
    if (!text.empty()) text += " and ";
    text += kAxisLetters[static_cast<std::size_t>(axis)];
  }
  return text;
}

double LiveFrame::length_of(const AxisSample& sample, std::optional<double> program_length_mm,
                            bool& known) const {
  const ToolLengthFrom from = options_.tool_length;
  const auto allowed = [from](ToolLengthFrom one) {
    return from == one || from == ToolLengthFrom::kAuto;
  };
  if (from == ToolLengthFrom::kNone) return 0;
  if (allowed(ToolLengthFrom::kSource) && !std::isnan(sample.tool_offset_z_mm)) {
    return sample.tool_offset_z_mm;
  }
  if (allowed(ToolLengthFrom::kProgram) && program_length_mm) return *program_length_mm;
  if (allowed(ToolLengthFrom::kTable)) {
    const int tool = tool_of(sample);
    if (tool == 0) return 0;
    const auto row = options_.table_length_mm.find(tool);
    if (row != options_.table_length_mm.end()) return row->second;
  }
  known = false;
  return 0;
}

std::optional<LivePose> LiveFrame::pose_of(const AxisSample& sample,
                                           std::optional<double> program_length_mm) const {
  const ByAxis axes = by_axis(sample, options_);
  if ((axes.known & kTipAxes) != kTipAxes) return std::nullopt;
  LivePose pose;
  const Vec3 there{axes.position[0], axes.position[1], axes.position[2]};
  for (std::size_t i = 0; i < 3; ++i) pose.abc_deg[i] = axes.position[3 + i];
  pose.machine_mm = there;
  if (options_.workpiece_frame) {
    pose.tip_mm = there;
    return pose;
  }
  pose.tool_length_mm = length_of(sample, program_length_mm, pose.length_known);
  const WorkpieceFrame& work = options_.work;
  const Vec3 tip = there - Vec3{0, 0, pose.tool_length_mm} - work.g5x_mm;
  pose.tip_mm = Vec3{cos_ * tip.x + sin_ * tip.y, cos_ * tip.y - sin_ * tip.x, tip.z} - work.g92_mm;
  for (std::size_t i = 0; i < 3; ++i) pose.abc_deg[i] -= work.offset_abc_deg[i];
  return pose;
}

}  // namespace kerf
