// twin/process/punch/punch_holds.h - where a punch press stands: strokes, turret, re-gripping.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "interp_bridge/motion.h"
#include "twin/machine/program_holds.h"
#include "twin/machine/punch_moves.h"
#include "twin/machine/turret.h"

namespace kerf {

/// Strokes are where PunchMoves have them. Without times in the turret's file nothing is held.
class PunchHolds final : public ProgramHolds {
 public:
  explicit PunchHolds(TurretPointer turret);

  MotionHold of(const Motion& motion) override;
  double stroke_s(double pitch_mm, double move_s) const override;
  std::string text() const override;

 private:
  void add_strokes(const Motion& motion, MotionHold& hold);

  TurretPointer turret_;
  PunchMoves moves_;
  ClampPlace clamps_;
  /// The last motions, for PunchMoves::hits(): motion n at n % size.
  std::array<Motion, 2 * PunchMoves::kLookBack> recent_;
  std::size_t taken_ = 0;
  std::vector<PunchHit> hits_;  ///< of the present motion
  std::vector<double> row_;
  int station_ = 0;  ///< under the punch; 0: not known
};

}  // namespace kerf
