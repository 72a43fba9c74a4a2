// twin/live/spindle_memory.h - whether the spindle of a watched machine turns, from what is told of
// it.
#pragma once

#include <optional>

#include "interp_bridge/motion.h"
#include "machine_io/position_source.h"

namespace kerf {

/// The spindle on the way to a sample.
struct SpindleNow {
  SpindleState state = SpindleState::kClockwise;
  bool said = false;  ///< the source tells its speed
  double rpm = 0;     ///< not signed; 0 where it is not said
};

/// A spindle that was told to stop still turns for a while, and what nobody tells cannot be found
/// wrong. Values.
class SpindleMemory {
 public:
  /// `has_beam`: it is that of a torch, which is on or off at once, and off where nobody tells.
  explicit SpindleMemory(bool has_beam) : has_beam_(has_beam) {}

  /// The next sample, `t_s` after the first.
  void take(const AxisSample& sample, double t_s);
  /// At the sample that was taken last. `unseen_s`: since the one before; `idle`: no program runs.
  SpindleNow now(const AxisSample& sample, double t_s, double unseen_s, bool idle) const;

 private:
  SpindleState state(const AxisSample& sample, double t_s, double unseen_s, bool idle) const;

  bool has_beam_;
  double turning_rpm_ = 0;                 ///< signed: when the spindle was last told to turn ..
  std::optional<double> turning_until_s_;  ///< .. which was then
};

}  // namespace kerf
