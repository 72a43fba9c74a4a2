#include "twin/machine/live_paths.h"

#include <cassert>
#include <utility>

#include "twin/machine/kinematics/kinematics_setup.h"
#include "twin/machine/kinematics/known_kinematics.h"

namespace kerf {

bool LivePaths::is_described(const MachineKinematics& machine) {
  return machine.module == "links" || !takes_rotary_placement(machine.module);
}

std::shared_ptr<const LivePaths> LivePaths::create(
    const std::shared_ptr<const MachineKinematics>& machine, const WorkpieceFrame& frame,
    double cell_mm) {
  if (machine && (machine->is_switchable() || machine->is_arm())) return nullptr;
  const bool described = machine && is_described(*machine);
  MachineKinematics lathe;
  if (described) {
    lathe = *machine;
  } else {
    lathe.module = "lathe";
    lathe.chain = lathe_chain();
    lathe.joint_letters = "XYZAC";
    lathe.types.emplace_back();
  }
  // The axis of a lathe is that of its program's Z, wherever the work offset is.
  const WorkpieceFrame place = described ? frame : WorkpieceFrame{};
  const ToolPathTolerance tolerance = ToolPathTolerance::of_cell(cell_mm);
  Result<ToolPath> along_z = ToolPath::create(lathe, place, tolerance);
  lathe.nose_from_tip = {1.0, 0.0, 0.0};
  Result<ToolPath> along_x = ToolPath::create(lathe, place, tolerance);
  if (!along_z || !along_x) return nullptr;
  return std::shared_ptr<const LivePaths>(
      new LivePaths(std::move(along_x.value()), std::move(along_z.value())));
}

}  // namespace kerf
