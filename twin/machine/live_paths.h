// twin/machine/live_paths.h - ways of a lathe's driven tools, as the workpiece sees them.
#pragma once

#include <memory>

#include "stock/cutter/cutter.h"
#include "twin/machine/kinematics/tool_path.h"

namespace kerf {

/// A driven tool mills while the workpiece stands or is an axis. Where nobody says more than axes
/// (no kinematics, trivkins and what is like it), X, Y and Z carry the tool, and the workpiece
/// turns about X0 Y0 of the workpiece frame by C, or by A where the spindle is called so
/// (lathe_chain()). A machine of links, or of kinematics with a geometry, moves as it is described.
/// Immutable; any number of threads.
class LivePaths {
 public:
  /// Null: kinematics that are switched, and robots: of those nobody says how they turn, mill and
  /// hold a workpiece. `cell_mm`: of what is milled.
  static std::shared_ptr<const LivePaths> create(
      const std::shared_ptr<const MachineKinematics>& machine, const WorkpieceFrame& frame,
      double cell_mm);
  /// It moves as it is described.
  static bool is_described(const MachineKinematics& machine);
  const ToolPath& path(LiveAxis axis) const { return axis == LiveAxis::kX ? x_ : z_; }

 private:
  LivePaths(ToolPath x, ToolPath z) : x_(std::move(x)), z_(std::move(z)) {}
  ToolPath x_, z_;
};

}  // namespace kerf
