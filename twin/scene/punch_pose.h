// twin/scene/punch_pose.h - how a punch press stands at a place of its program, beyond X, Y and Z.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "twin/machine/punch_moves.h"
#include "twin/machine/turret.h"
#include "twin/machines/machine_model.h"
#include "twin/playback/player.h"

namespace kerf {

/// The ram is drawn down while the trigger holds, in the moment after a user M-code, and on the way
/// of a feed on which the punch nibbles. Values; const calls from any thread.
class PunchPose {
 public:
  /// `through_mm`: z of the punch when it is down. O(motions).
  PunchPose(const TurretPointer& turret, const ProgramTrack& track, double through_mm);

  bool is_down(const ProgramTrack& track, const TrackPosition& place) const;
  /// The tip as it is drawn.
  Vec3 tip_mm(const ProgramTrack& track, const PlayerState& state) const;
  /// Puts the punch that works under the ram, turned as it is. `poses`: those of the machine's
  /// links.
  void place_punch(const MachineModel& machine, const ProgramTrack& track, const PlayerState& state,
                   std::vector<glm::mat4>& poses) const;
  /// By PunchJoint.
  AxisValues joints(const ProgramTrack& track, const PlayerState& state) const;

 private:
  PunchMoves moves_;
  double through_mm_;
  /// First motions with the clamps elsewhere, and where they are.
  std::vector<std::pair<std::size_t, Vec2>> grips_;
};

}  // namespace kerf
