// twin/live/live_frame.h - from what a machine's sensors say to where the tool tip is in the
// workpiece.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "interp_bridge/motion.h"
#include "machine_io/position_source.h"
#include "twin/machine/kinematics/machine_kinematics.h"

namespace kerf {

/// Where the length of the tool in the spindle comes from.
enum class ToolLengthFrom : std::uint8_t {
  kAuto,     ///< the source if it gives one, else the program, else the tool table, else none
  kSource,   ///< AxisSample::tool_offset_z_mm
  kProgram,  ///< the G43 in force where the machine is in the program
  kTable,    ///< the tool table's row of the tool number
  kNone,     ///< 0: positions are those of the tip already
};

/// How positions are to be read. The defaults: axes X Y Z A B C U V W of a mm machine, machine
/// coordinates.
struct LiveFrameOptions {
  /// axis[i]: which axis (0 = X .. 8 = W) position i of the samples is; -1: none. With trivial
  /// kinematics a joint is an axis, and this is all there is to it.
  std::array<int, kMaxPositions> axis = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  /// Of a machine whose joints are not its axes under other names (corexykins, kinematics that
  /// follow the tip, robots): position i is that of joint i then, and `axis` does not matter. Null:
  /// `axis` says it all.
  std::shared_ptr<const MachineKinematics> kinematics;
  /// A lathe: where no position of Y comes, tools stand in the plane of the axis.
  bool y_stands = false;
  bool workpiece_frame = false;  ///< positions are the tip's, in the workpiece frame
  WorkpieceFrame work;           ///< where the workpiece lies in the machine
  ToolLengthFrom tool_length = ToolLengthFrom::kAuto;
  std::map<int, double> table_length_mm;  ///< Z offsets of the tool table by tool number
  /// In the spindle, where neither the source nor a program that is followed says.
  int tool = -1;
};

/// The machine at one moment, in the numbers that a program would have there: Motion::to_mm and
/// to_abc_deg. What these mean depends on the kinematics (KinematicsMode):
///
///     kAxes       X Y Z are the slides', less offsets. Where a table turns this is not the
///                 workpiece frame, which turns with it
///     kTip, kArm  X Y Z are the tip in the workpiece frame, whatever has turned
///
/// ToolPath says where the tool is in the workpiece for either.
struct SamplePose {
  Vec3 tip_mm{0};
  std::array<double, 3> abc_deg{};  ///< of kArm roll, pitch and yaw, in -180 .. 180
  std::array<bool, 3> abc_known{};  ///< false: no position of that axis has come, 0 is assumed
  Vec3 uvw_mm{0};                   ///< Motion::to_uvw_mm; a tool's offset in them is not known
  std::array<bool, 3> uvw_known{};  ///< false: none has come, 0 is assumed
  /// tip_mm of a tool that is 1 mm longer is tip_mm less this: (0, 0, 1), but where the controller
  /// follows the tip of a tool whose length it is told.
  Vec3 along_tool{0, 0, 1};
  Vec3 machine_mm{
      0};  ///< X Y Z as the machine has them; of positions in the workpiece frame: tip_mm
  double tool_length_mm = 0;
  bool length_known = true;  ///< false: taken as 0 because nothing tells it
  /// The length is the offset that the controller applies (the source says it). Where the tool in
  /// the spindle has another one in the tool table the tip is real_shift_mm from tip_mm. Up to 1 mm
  /// are wear, or a tool that was measured.
  bool length_is_applied = false;
  Vec3 real_shift_mm{0};
  bool length_checked = false;  ///< real_shift_mm is by the tool table; else 0 for want of a row
};

/// Turns samples into poses. One thread.
class LiveFrame {
 public:
  explicit LiveFrame(LiveFrameOptions options) : options_(std::move(options)) { turn(); }

  /// Nothing if a position is not known without which there is no tip (missing_axes() then says
  /// which): X, Y, Z, and where the kinematics need them to tell these, the axes that turn.
  /// `program_length_mm`: the G43 in force in the program, if it is followed. `type`: of the
  /// kinematics in force (MachineKinematics::types); of positions by axes it does not matter.
  std::optional<SamplePose> pose_of(const AxisSample& sample,
                                    std::optional<double> program_length_mm, int type = 0) const;
  /// "Z", "X and Y", "joint 3": those without which there is no tip.
  std::string missing_axes(const AxisSample& sample) const;

  /// Machine coordinates of the pose, whatever tool length is in force: X Y Z A B C U V W. mm,
  /// degrees.
  std::array<double, 9> machine_place_of(const SamplePose& pose) const;

  int tool_of(const AxisSample& sample) const {
    return sample.tool >= 0 ? sample.tool : options_.tool;
  }
  void set_work(const WorkpieceFrame& work) {
    options_.work = work;
    turn();
  }
  const LiveFrameOptions& options() const { return options_; }

 private:
  struct Axes;
  void turn();
  Axes axes_of(const AxisSample& sample, int type, double tool_mm) const;
  Vec3 tip_of(const Axes& axes, double tool_mm) const;
  double length_of(const AxisSample& sample, std::optional<double> program_length_mm,
                   SamplePose& pose) const;
  std::optional<Vec3> real_shift_of(const AxisSample& sample, double applied_mm) const;

  LiveFrameOptions options_;
  double cos_ = 1;
  double sin_ = 0;
};

}  // namespace kerf
