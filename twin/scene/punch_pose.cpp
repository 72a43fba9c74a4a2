#include "twin/scene/punch_pose.h"

#include <algorithm>
#include <iterator>

#include "base/units.h"
#include "twin/machines/builtin_models.h"

namespace kerf {

PunchPose::PunchPose(const TurretPointer& turret, const ProgramTrack& track, double through_mm)
    : moves_(turret), through_mm_(through_mm) {
  if (turret->regrips.empty()) return;
  ClampPlace clamps(turret);
  for (std::size_t i = 0; i < track.size(); ++i) {
    if (clamps.follow(track.motion(i))) grips_.emplace_back(i, clamps.shift_mm());
  }
}

bool PunchPose::is_down(const ProgramTrack& track, const TrackPosition& place) const {
  if (place.motion < track.size() && place.fraction > 0) {
    const Motion m = track.motion(place.motion);
    return moves_.nibbles(m) || moves_.holds(m, place.fraction);
  }
  if (place.motion == 0) return false;
  const Motion last = track.motion(place.motion - 1);
  return moves_.nibbles(last) || moves_.holds(last, 1);
}

Vec3 PunchPose::tip_mm(const ProgramTrack& track, const PlayerState& state) const {
  Vec3 tip = state.tip_mm;
  if (is_down(track, state.place)) tip.z = std::min(tip.z, through_mm_);
  return tip;
}

void PunchPose::place_punch(const MachineModel& machine, const ProgramTrack& track,
                            const PlayerState& state, std::vector<glm::mat4>& poses) const {
  const auto link = machine.chain.find(punch_link(state.motion.tool));
  if (!link || *link >= poses.size()) return;
  const double share = state.place.motion >= track.size() ? 1 : state.place.fraction;
  const double turned_deg = moves_.turn_rad(state.motion, share) * kDegPerRad;
  poses[*link] = to_mat4(shift(tip_mm(track, state)) * turn({0, 0, 1}, turned_deg));
}

AxisValues PunchPose::joints(const ProgramTrack& track, const PlayerState& state) const {
  AxisValues joints{};
  const auto& stations = moves_.turret().stations;
  const auto station = stations.find(state.motion.tool);
  if (station != stations.end()) {
    const auto index = static_cast<double>(std::distance(stations.begin(), station));
    joints[kTurret] = 360 * index / static_cast<double>(stations.size());
  }
  joints[kStroke] = tip_mm(track, state).z - state.tip_mm.z;
  const auto after =
      std::upper_bound(grips_.begin(), grips_.end(), state.place.motion,
                       [](std::size_t motion, const auto& grip) { return motion <= grip.first; });
  if (after != grips_.begin()) {
    joints[kGripX] = std::prev(after)->second.x;
    joints[kGripY] = std::prev(after)->second.y;
  }
  return joints;
}

}  // namespace kerf
