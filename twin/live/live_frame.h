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
#include "twin/kinematics/machine_kinematics.h"

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
  /// Of a machine whose joints are not its axes under other names (corexykins): position i is that
  /// of joint i then, and `axis` does not matter. Null: `axis` says it all.
  std::shared_ptr<const MachineKinematics> kinematics;
  bool workpiece_frame = false;  ///< positions are the tip's, in the workpiece frame
  WorkpieceFrame work;           ///< where the workpiece lies in the machine
  ToolLengthFrom tool_length = ToolLengthFrom::kAuto;
  std::map<int, double> table_length_mm;  ///< Z offsets of the tool table by tool number
  /// In the spindle, where neither the source nor a program that is followed says.
  int tool = -1;
};

/// The machine at one moment.
struct LivePose {
  Vec3 tip_mm{0};  ///< workpiece frame
  Vec3 machine_mm{
      0};  ///< X Y Z as the machine has them; of positions in the workpiece frame: tip_mm
  std::array<double, 3> abc_deg{};
  double tool_length_mm = 0;
  bool length_known = true;  ///< false: taken as 0 because nothing tells it
};

/// Turns samples into poses. One thread.
class LiveFrame {
 public:
  explicit LiveFrame(LiveFrameOptions options) : options_(std::move(options)) { turn(); }

  /// Nothing if X, Y or Z of the sample is not known (missing_axes() then says which).
  /// `program_length_mm`: the G43 in force in the program, if it is followed.
  std::optional<LivePose> pose_of(const AxisSample& sample,
                                  std::optional<double> program_length_mm) const;
  /// "Z", "X and Y": those without which there is no tip.
  std::string missing_axes(const AxisSample& sample) const;

  int tool_of(const AxisSample& sample) const {
    return sample.tool >= 0 ? sample.tool : options_.tool;
  }
  void set_work(const WorkpieceFrame& work) {
    options_.work = work;
    turn();
  }
  const LiveFrameOptions& options() const { return options_; }

 private:
  void turn();
  double length_of(const AxisSample& sample, std::optional<double> program_length_mm,
                   bool& known) const;

  LiveFrameOptions options_;
  double cos_ = 1;
  double sin_ = 0;
};

}  // namespace kerf
