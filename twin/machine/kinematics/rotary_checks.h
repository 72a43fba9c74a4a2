// twin/machine/kinematics/rotary_checks.h - what goes wrong on machines that tilt and turn, and on
// those that cannot.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "interp_bridge/ini_file.h"
#include "interp_bridge/machine_limits.h"
#include "twin/machine/kinematics/tool_path.h"

namespace kerf {

enum class RotaryFaultKind : std::uint8_t {
  kNoAxis,        ///< A, B or C of a machine that has none
  kSingularPose,  ///< an axis turns far while the spindle hardly does: the pole of the machine
  kJointTooFast,  ///< following the tip needs a joint faster than it is (LinuxCNC does not look)
  kJointLimit,    ///< following the tip sends a joint beyond its limit
  kToolTooLong,   ///< longer than the way to the pivot that the controller reckons with
};

struct RotaryFault {
  RotaryFaultKind kind = RotaryFaultKind::kNoAxis;
  SourceRef source;  ///< of the first motion that has it
  char axis = 0;     ///< 'A', or the axis that the joint moves
  std::string text;  ///< One sentence, no full stop.
  std::string hint;  ///< May be empty.
};

/// An axis that turns by this and more ..
inline constexpr double kSingularTurn_deg = 30.0;
/// .. while the spindle turns by less than this share of it, in the part, is at the pole.
inline constexpr double kSingularShare = 0.1;

/// Speeds and travels of the joints, by the letter of the axis that each moves ([JOINT_n], the
/// first of several): other than those of the axes where X Y Z follow the tip. mm, degrees.
std::array<AxisLimits, kAxisCount> joint_limits_of_ini(IniFile& ini, std::string_view joint_letters,
                                                       double unit_mm);

/// Looks at motions in program order. Each fault is told once for each axis, at the first motion
/// that has it; count() counts the others. About as fast as ToolPath::moves_of() where something
/// turns, nothing where nothing does.
class RotaryCheck {
 public:
  /// `joints`: of joint_limits_of_ini(), or those of the axes. Axes that are not present have no
  /// limits. `path` must outlive the check.
  RotaryCheck(const ToolPath& path, const std::array<AxisLimits, kAxisCount>& joints)
      : path_(path), joints_(joints) {}

  /// `duration_s`: that the motion takes; 0: not known, speeds are not looked at.
  void check(const Motion& motion, double duration_s, std::vector<RotaryFault>& out);

  /// The pole alone: of a motion that a machine has been seen to make, in parts.
  void check_pole(const Motion& motion, std::vector<RotaryFault>& out);

  /// The motion turns an axis that the machine has.
  bool turns_something(const Motion& motion) const;

  /// Motions that had the fault.
  std::uint64_t count(RotaryFaultKind kind) const {
    return counts_[static_cast<std::size_t>(kind)];
  }

 private:
  static constexpr std::size_t kKinds = 5;
  void add(RotaryFaultKind kind, std::size_t axis, const Motion& motion, std::string text,
           std::string hint, std::vector<RotaryFault>& out);
  void check_axes(const Motion& motion, std::vector<RotaryFault>& out);
  void check_joints(const Motion& motion, double duration_s, std::vector<RotaryFault>& out);
  void check_tool(const Motion& motion, std::vector<RotaryFault>& out);

  const ToolPath& path_;
  std::array<AxisLimits, kAxisCount> joints_;
  std::array<std::array<bool, kAxisCount>, kKinds> told_{};
  std::array<std::uint64_t, kKinds> counts_{};
};

}  // namespace kerf
