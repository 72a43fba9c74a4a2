// twin/live/seen_strokes.h - strokes of a punch as the samples of its machine show them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "machine_io/position_source.h"
#include "twin/live/path_follower.h"
#include "twin/machine/punch_moves.h"
#include "twin/machine/turret.h"

namespace kerf {

/// For a machine without a program, or beside its path. The trigger is what the source says of it
/// (AxisSample::trigger), whatever the turret's file names; else that file's conditions as far as
/// samples have them: m3, m4 and s by the spindle's speed, z<LEVEL and g81 by Z. Others, and
/// nibbling by a condition of its own, no sample tells.
///
///     comes on            a stroke where the machine is then
///     on, and it moves    with a pitch one every pitch of the way, and one where it goes off;
///                         `hit: ends` one wherever it comes to a stand; else the punch is dragged
///     g81                 Z comes down and up again, X and Y stand: a stroke at the bottom
///
/// A stroke is as late as its sample, and one between two samples is not seen. One thread.
class SeenStrokes {
 public:
  explicit SeenStrokes(TurretPointer turret) : moves_(turret), turret_(std::move(turret)) {}

  /// The next sample; the strokes since the one before, until the next call. `gap`: between the two
  /// positions are missing. share of a hit means nothing.
  std::span<const PunchHit> take(const AxisSample& sample, const ProgramPose& place, int tool,
                                 bool gap);
  /// The trigger can be told from the last sample.
  bool is_told() const { return told_; }
  /// Between the last two samples the sheet moved while the punch was down.
  bool drags() const { return drags_; }
  /// "no trigger": what the source does not say; for messages.
  std::string missing() const;

 private:
  std::optional<bool> is_on(const AxisSample& sample, const Vec3& place_mm) const;
  void take_state(bool on, const ProgramPose& place, int tool);
  void take_plunge(const ProgramPose& place, int tool);
  void nibble(const ProgramPose& place, int tool, double pitch_mm);
  void strike(const ProgramPose& place, int tool);

  PunchMoves moves_;
  TurretPointer turret_;
  std::vector<PunchHit> hits_;
  std::optional<ProgramPose> before_;  ///< where the sheet last moved to
  bool told_ = false;
  bool drags_ = false;
  std::optional<bool> on_;
  double since_mm_ = 0;  ///< way since the last stroke, with the trigger on
  // g81
  double top_mm_ = 0;                  ///< Z has come down from there ..
  std::optional<ProgramPose> bottom_;  ///< .. to there, X and Y standing
};

}  // namespace kerf
