// twin/machine/program_holds.h - where a machine stands for what its program has no words for, and
// how long: the seam behind which processes say it.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "interp_bridge/motion.h"
#include "interp_bridge/torch_materials.h"

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

/// How the machine stands about one motion.
struct MotionHold {
  HeldTime before;     ///< it stands, then the motion begins
  HeldTime after;      ///< the motion has ended; of one that does not move, within its time
  bool moves = false;  ///< the motion does
  /// Of a nibbled motion: where its strokes are, as shares of the way, the last at 1. The machine
  /// stands at each. Until the next call.
  std::span<const double> row;
};

/// Follows a program of one process, which says where its machine stands. One thread.
class ProgramHolds {
 public:
  virtual ~ProgramHolds() = default;
  /// Of a torch program, all that the motions name from here on.
  virtual void set_materials(std::span<const TorchMaterial> /*materials*/) {}
  /// In program order, every motion.
  virtual MotionHold of(const Motion& motion) = 0;
  /// At a stroke of a row, behind a way of `pitch_mm` (0: none) that took `move_s`.
  virtual double stroke_s(double /*pitch_mm*/, double /*move_s*/) const { return 0; }
  /// What is counted, for people, behind what the planner says of itself.
  virtual std::string text() const = 0;
};

/// Makes those of one reading of a program; empty: there is nothing to hold.
using MakeHolds = std::function<std::unique_ptr<ProgramHolds>()>;

/// The motion moves the tip, and not to where it is.
bool goes_somewhere(const Motion& motion);

}  // namespace kerf
