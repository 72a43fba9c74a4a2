#include "twin/machine/motion_moves.h"

#include <cassert>
#include <utility>

#include "twin/motion/motion_geometry.h"

namespace kerf {

Result<bool> MotionMoves::follow(std::shared_ptr<const MachineKinematics> machine,
                                 const WorkpieceFrame& frame, double cell_mm) {
  if (path_ && machine == machine_ && frame == frame_) return false;
  Result<ToolPath> path = ToolPath::create(*machine, frame, ToolPathTolerance::of_cell(cell_mm));
  if (!path) return Error{path.error()};
  machine_ = std::move(machine);
  frame_ = frame;
  path_ = std::move(path.value());
  tilts_ = true;
  return true;
}

MotionMoves MotionMoves::of(const StockModel& stock,
                            std::shared_ptr<const MachineKinematics> machine,
                            const WorkpieceFrame& frame) {
  MotionMoves moves;
  const bool tilts = stock.takes_tilted_tools();
  if (stock.milling_cell_mm() > 0)
    moves.live_ = LivePaths::create(machine, frame, stock.milling_cell_mm());
  if (!machine || !(tilts || machine->slides_uvw())) return moves;
  if (!tilts) machine = std::make_shared<const MachineKinematics>(machine->standing());
  const Result<bool> follows = moves.follow(std::move(machine), frame, stock.cell_mm());
  assert(follows);
  static_cast<void>(follows);
  moves.tilts_ = tilts;
  return moves;
}

bool MotionMoves::append(const Motion& motion, const Cutter& cutter, std::uint64_t id,
                         std::vector<CutMove>& out, std::vector<double>* ends) const {
  if (const ToolPath* const live = live_path(cutter))
    return live->moves_of(motion, reach_mm(cutter), id, out, ends);
  return append_reaching(motion, reach_mm(cutter), id, out, ends);
}

bool MotionMoves::append_reaching(const Motion& motion, double reach_mm, std::uint64_t id,
                                  std::vector<CutMove>& out, std::vector<double>* ends) const {
  if (is_upright(motion)) {
    out.push_back(cut_move_from(motion, id));
    return true;
  }
  return path_->moves_of(motion, reach_mm, id, out, ends);
}

double MotionMoves::reach_mm(const Cutter& cutter) {
  return cutter.flute_length_mm().value_or(8 * cutter.radius_mm());
}

}  // namespace kerf
