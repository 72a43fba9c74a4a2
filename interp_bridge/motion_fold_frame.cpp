// Units and frames: program coordinates into those of the workpiece frame.
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/portable_math.h"
#include "base/units.h"
#include "interp_bridge/motion_fold.h"
#include "interp_bridge/motion_fold_math.h"

namespace kerf {
namespace {

/// Degrees to (cos, sin), exact for multiples of 90 so that a part turned by R90 keeps its digits.
std::pair<double, double> cos_sin(double degrees) {
  const double quarter = degrees / 90.0;
  if (quarter == std::floor(quarter) && std::abs(quarter) < 1e9) {
    constexpr std::array<std::pair<double, double>, 4> kQuarters = {
        {{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    return kQuarters[static_cast<std::size_t>(static_cast<std::int64_t>(quarter) & 3)];
  }
  const double radians = degrees * kRadPerDeg;
  return {portable::cos(radians), portable::sin(radians)};
}

}  // namespace

Vec3 MotionFold::work_from_program(const Vec3& p_mm) const {
  if (same_frame_) return p_mm;
  return turned(p_mm, turn_cos_, turn_sin_) + shift_mm_;
}

Vec3 MotionFold::program_from_work(const Vec3& w_mm) const {
  if (same_frame_) return w_mm;
  return turned(w_mm - shift_mm_, turn_cos_, -turn_sin_);
}

std::array<double, 3> MotionFold::work_abc(const double* program_abc_deg) const {
  std::array<double, 3> abc{};
  for (std::size_t i = 0; i < 3; ++i) {
    abc[i] = without_sign_of_zero(program_abc_deg[i]);
    if (same_frame_) continue;
    abc[i] += frame_.g5x_abc_deg[i] + frame_.g92_abc_deg[i];
    abc[i] -= work_.g5x_abc_deg[i] + work_.g92_abc_deg[i];
  }
  return abc;
}

Vec3 MotionFold::work_uvw(const CanonicalCommand& command, std::size_t first) const {
  const Vec3 uvw_mm = scaled_if_there(command, first);
  if (same_frame_) return uvw_mm;
  return uvw_mm + frame_.g5x_uvw_mm + frame_.g92_uvw_mm - work_.g5x_uvw_mm - work_.g92_uvw_mm;
}

/// U, V, W follow the other numbers, where the interpreter gives them.
Vec3 MotionFold::scaled_if_there(const CanonicalCommand& command, std::size_t first) const {
  return command.argument_count < first + 3 ? Vec3{0} : scaled(command, first);
}

Vec3 MotionFold::scaled(const CanonicalCommand& command, std::size_t first) const {
  return {without_sign_of_zero(command.number(first) * unit_mm_),
          without_sign_of_zero(command.number(first + 1) * unit_mm_),
          without_sign_of_zero(command.number(first + 2) * unit_mm_)};
}

void MotionFold::frame_changed() {
  if (!work_fixed_) return;
  if (follows_places_) adopt_frame();
  const bool same = frame_ == work_;
  if (same && same_frame_) return;
  position_as_printed_ = false;
  same_frame_ = same;
  if (same) return;
  std::tie(turn_cos_, turn_sin_) = cos_sin(frame_.rotation_deg - work_.rotation_deg);
  const auto [work_cos, work_sin] = cos_sin(work_.rotation_deg);
  shift_mm_ = turned(frame_.g92_mm, turn_cos_, turn_sin_) +
              turned(frame_.g5x_mm - work_.g5x_mm, work_cos, -work_sin) - work_.g92_mm;
}

void MotionFold::fix_workpiece_frame() {
  work_ = frame_;
  work_fixed_ = true;
  same_frame_ = true;
  if (stated_work_ && workpiece_frame() != *stated_work_) {
    work_ = Frame{};
    work_.g5x_mm = stated_work_->g5x_mm;
    work_.g92_mm = stated_work_->g92_mm;
    work_.g5x_abc_deg = stated_work_->offset_abc_deg;
    work_.g5x_uvw_mm = stated_work_->offset_uvw_mm;
    work_.rotation_deg = stated_work_->rotation_deg;
  }
  if (stated_work_) {
    placed_ = 0b111;  // X Y Z, by what came before
    frame_changed();
  }
  if (!stands_at_) return;
  height_said_ = true;
  const std::array<double, 9>& at = *stands_at_;
  const auto [work_cos, work_sin] = cos_sin(work_.rotation_deg);
  const Vec3 tip_mm = Vec3{at[0], at[1], at[2]} - tool_offset_mm_ - work_.g5x_mm;
  position_mm_ = turned(tip_mm, work_cos, -work_sin) - work_.g92_mm;
  for (std::size_t i = 0; i < 3; ++i) {
    abc_deg_[i] = at[3 + i] - tool_offset_abc_deg_[i] - work_.g5x_abc_deg[i] - work_.g92_abc_deg[i];
  }
  if (!follows_places_) has_rotary_motion_ |= abc_deg_ != std::array<double, 3>{};
  uvw_mm_ = Vec3{at[6], at[7], at[8]} - tool_offset_uvw_mm_ - work_.g5x_uvw_mm - work_.g92_uvw_mm;
  position_known_ = true;
  position_as_printed_ = false;
}

WorkpieceFrame MotionFold::workpiece_frame() const {
  WorkpieceFrame frame;
  frame.g5x_mm = work_.g5x_mm;
  frame.g92_mm = work_.g92_mm;
  frame.rotation_deg = work_.rotation_deg;
  for (std::size_t i = 0; i < 3; ++i) {
    frame.offset_abc_deg[i] = work_.g5x_abc_deg[i] + work_.g92_abc_deg[i];
  }
  frame.offset_uvw_mm = work_.g5x_uvw_mm + work_.g92_uvw_mm;
  return frame;
}

void MotionFold::change_tool_length(const CanonicalCommand& command) {
  const Vec3 offset_mm = scaled(command, 0);
  const std::array<double, 3> abc_deg = {command.number(3), command.number(4), command.number(5)};
  const Vec3 uvw_mm = coded_lengths_ ? Vec3{0} : scaled_if_there(command, 6);
  if (offset_mm == tool_offset_mm_ && abc_deg == tool_offset_abc_deg_ &&
      uvw_mm == tool_offset_uvw_mm_) {
    return;
  }
  if (position_known_) {
    const auto [work_cos, work_sin] = cos_sin(work_.rotation_deg);
    position_mm_ += turned(tool_offset_mm_ - offset_mm, work_cos, -work_sin);
    for (std::size_t i = 0; i < 3; ++i) abc_deg_[i] += tool_offset_abc_deg_[i] - abc_deg[i];
    uvw_mm_ += tool_offset_uvw_mm_ - uvw_mm;
    position_as_printed_ = false;
  }
  tool_offset_mm_ = offset_mm;
  tool_offset_abc_deg_ = abc_deg;
  tool_offset_uvw_mm_ = uvw_mm;
}

bool MotionFold::fold_frame(const CanonicalCommand& command) {
  switch (command.name) {
    case CanonicalName::kUseLengthUnits: {
      constexpr std::array<double, 3> kUnits_mm = {kMmPerInch, 1.0, 10.0};
      const double unit_mm = kUnits_mm[static_cast<std::size_t>(command.integer(0))];
      if (unit_mm != unit_mm_) position_as_printed_ = false;
      unit_mm_ = unit_mm;
      return true;
    }
    case CanonicalName::kSetG5xOffset:
      frame_.g5x_mm = scaled(command, 1);
      for (std::size_t i = 0; i < 3; ++i) frame_.g5x_abc_deg[i] = command.number(4 + i);
      frame_.g5x_uvw_mm = scaled_if_there(command, 7);
      follow_offset(command.name, command.integer(0));
      frame_changed();
      return true;
    case CanonicalName::kSetG92Offset:
      frame_.g92_mm = scaled(command, 0);
      for (std::size_t i = 0; i < 3; ++i) frame_.g92_abc_deg[i] = command.number(3 + i);
      frame_.g92_uvw_mm = scaled_if_there(command, 6);
      follow_offset(command.name, 0);
      frame_changed();
      return true;
    case CanonicalName::kSetXyRotation:
      frame_.rotation_deg = without_sign_of_zero(command.number(0));
      frame_changed();
      return true;
    case CanonicalName::kSelectPlane:
      plane_ = static_cast<CanonicalPlane>(command.integer(0));
      return true;
    case CanonicalName::kUseToolLengthOffset:
      for (std::size_t i = 0; i < length_call_.size(); ++i) {
        length_call_[i] = i < command.argument_count ? command.number(i) : 0;
      }
      change_tool_length(command);
      // By how much only the probe knows.
      lose_place(probed_);
      return true;
    default:
      return false;
  }
}

}  // namespace kerf
