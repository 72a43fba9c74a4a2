#include "twin/machine/kinematics/switched_motions.h"

#include <utility>

#include "interp_bridge/motion_kinds.h"

namespace kerf {

SwitchedMotions::SwitchedMotions(std::shared_ptr<const MachineKinematics> machine) {
  if (machine && machine->is_switchable()) machine_ = std::move(machine);
}

std::span<const Motion> SwitchedMotions::follow(std::span<const Motion> motions,
                                                const WorkpieceFrame& frame) {
  if (!machine_) return motions;
  if (!path_ || frame != frame_) {
    Result<ToolPath> path = ToolPath::create(*machine_, frame, {});
    if (!path) return motions;  // who made the machine has tried it
    path_ = std::move(path.value());
    frame_ = frame;
  }
  copies_.assign(motions.begin(), motions.end());
  bool changed = false;
  for (Motion& m : copies_) {
    if (!is_move(m)) continue;
    changed = changes(m) || changed;
    before_ = m;
  }
  return changed ? std::span<const Motion>(copies_) : motions;
}

bool SwitchedMotions::changes(Motion& m) {
  const bool straight = m.kind != MotionKind::kArc && m.start_known;
  if (!before_ || !straight) {
    adrift_ = {};
    return false;
  }
  Vec3 stands = before_->to_mm;
  if (machine_->type_of(*before_) != machine_->type_of(m)) {
    // Under the new numbers, from the place where the machine really is.
    Motion probe = m;
    probe.from_mm = before_->to_mm;
    path_->take_up(*before_, probe);
    for (int i = 0; i < 3; ++i) {
      if (probe.from_mm[i] != before_->to_mm[i]) adrift_[static_cast<std::size_t>(i)] = true;
    }
    stands = probe.from_mm;
  }
  bool changed = false;
  for (int i = 0; i < 3; ++i) {
    bool& adrift = adrift_[static_cast<std::size_t>(i)];
    if (!adrift) continue;
    if (m.to_mm[i] == m.from_mm[i]) {
      m.to_mm[i] = stands[i];
    } else {
      adrift = false;
    }
    m.from_mm[i] = stands[i];
    changed = true;
  }
  return changed;
}

}  // namespace kerf
