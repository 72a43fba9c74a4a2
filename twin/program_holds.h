// twin/program_holds.h - where a machine stands for what its program has no words for, and how
// long: the strokes of a punch, its turret, re-gripping; a torch that pierces.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interp_bridge/beam_trigger.h"
#include "interp_bridge/motion.h"
#include "interp_bridge/torch_materials.h"
#include "twin/beam_settings.h"
#include "twin/punch_moves.h"
#include "twin/turret.h"

namespace kerf {

/// By cause, s.
struct HeldTime {
  double strokes_s = 0;  ///< of a punch
  double turret_s = 0;   ///< changes of station, beyond what LinuxCNC takes for a tool change
  double regrip_s = 0;
  double pierces_s = 0;  ///< of QtPlasmaC, from the arc to the first move
  double pauses_s = 0;   ///< of QtPlasmaC, at the ends of cuts with the arc on

  double sum_s() const { return strokes_s + turret_s + regrip_s + pierces_s + pauses_s; }
  HeldTime& operator+=(const HeldTime& other);
};

/// What the machine is; at most one of them.
struct HoldOptions {
  TurretPointer turret;              ///< a punch press; null: none
  std::optional<BeamTrigger> torch;  ///< a QtPlasmaC machine, and what turns its arc on

  bool any() const { return turret != nullptr || torch; }
};

/// Of a sheet under a punch, or under a beam; of neither there is nothing to hold.
HoldOptions holds_of(const TurretPointer& turret, const std::optional<BeamSettings>& beam);

/// How the machine stands about one motion.
struct MotionHold {
  HeldTime before;     ///< it stands, then the motion begins
  HeldTime after;      ///< the motion has ended; of one that does not move, within its time
  bool moves = false;  ///< the motion does
  /// Of a nibbled motion: where its strokes are, as shares of the way, the last at 1. The machine
  /// stands at each. Until the next call.
  std::span<const double> row;
};

/// Follows a program: strokes and piercing are where PunchMoves and TorchMoves have them. Without
/// times in the turret's file nothing is held for it, and of a torch whose materials have none
/// neither. QtPlasmaC's probing, the start of its arc and its moves between heights are not
/// counted: nothing says how long they take. One thread.
class ProgramHolds {
 public:
  explicit ProgramHolds(HoldOptions options);

  /// All that the motions name from here on.
  void set_materials(std::span<const TorchMaterial> materials);
  /// In program order, every motion.
  MotionHold of(const Motion& motion);
  /// At a stroke of a row, behind a way of `pitch_mm` (0: none) that took `move_s`.
  double stroke_s(double pitch_mm, double move_s) const;

  /// What is counted, for people, behind what the planner says of itself.
  std::string text() const;

 private:
  MotionHold of_punch(const Motion& motion);
  MotionHold of_torch(const Motion& motion);
  void add_strokes(const Motion& motion, MotionHold& hold);

  HoldOptions options_;
  std::optional<PunchMoves> punch_;
  std::optional<ClampPlace> clamps_;
  /// The last motions, for PunchMoves::hits(): motion n at n % size.
  std::array<Motion, 2 * PunchMoves::kLookBack> recent_;
  std::size_t taken_ = 0;
  std::vector<PunchHit> hits_;  ///< of the present motion
  std::vector<double> row_;
  int station_ = 0;  ///< under the punch; 0: not known
  std::vector<TorchMaterial> materials_;
  bool pierced_ = false;  ///< since the arc came on
  double dwelt_s_ = 0;    ///< with the arc on, before the first move
  double pause_s_ = 0;    ///< at the end of the present cut
};

}  // namespace kerf
