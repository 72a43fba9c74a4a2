// twin/live/path_matcher.h - where on the path of its program a watched machine is, sample by
// sample.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "machine_io/position_source.h"
#include "twin/live/live_cut_options.h"
#include "twin/live/live_frame.h"
#include "twin/live/path_follower.h"
#include "twin/live/program_ahead.h"
#include "twin/live/reading.h"
#include "twin/live/real_tip.h"

namespace kerf {

/// Program time that is planned beyond what is looked at, so that the follower has where to look.
inline constexpr double kPlannedAhead_s = 6.0;
/// A machine that has so little of its program left is at its end: sensors round. s.
inline constexpr double kProgramEnd_s = 0.05;

/// From samples to places: what a sample says of the tool (LiveFrame), where that is on the path
/// (PathFollower), and what the program then tells in turn: the kinematics in force, the tool
/// length, the tool, where the tip really is. Cuts nothing and tells nothing.
///
/// One thread; beside it that of ProgramAhead. A sample costs as much as the part of the path that
/// is searched. Without a program it only reads samples.
class PathMatcher {
 public:
  /// `options` must outlive it.
  explicit PathMatcher(const LiveCutOptions& options);

  /// Takes up a program, from its beginning; again: instead of the one before. Waits for its first
  /// motions, which tell where the workpiece lies in the machine, if nobody has said it.
  void take_up(std::unique_ptr<Program> program);
  /// Ends the interpreter, if it still runs.
  void stop();

  /// Null: there is none. To be read on and forgotten by who cuts it.
  ProgramAhead* program() const { return ahead_.get(); }
  const PathFollower& follower() const { return follower_; }
  const LiveFrame& frame() const { return frame_; }
  /// Where the workpiece lies in the machine.
  const WorkpieceFrame& work() const { return frame_.options().work; }
  /// In force, as the program has it where the machine is.
  int kinematics_type() const { return kinematics_type_; }
  /// Where the machine was last on the path; -1: it has not been.
  int program_tool() const { return program_tool_; }
  /// What is known of the tip where the machine was last on the path.
  const RealTip& real_tip() const { return real_tip_; }
  /// Driven along the path by the sample that was matched last, in order.
  std::vector<PathFollower::DrivenPart>& driven() { return driven_; }
  double driven_mm() const;
  /// The machine has come to the program's end.
  bool finished() const;
  /// A machine whose kinematics the program may switch, or a robot; null: it is none.
  const MachineKinematics* switched_machine() const;

  /// Nothing if a position is missing without which there is no tip (LiveFrame::missing_axes()).
  /// `type`: of the kinematics.
  std::optional<SamplePose> pose_of(const AxisSample& sample, int type) const;
  Reading reading_of(const AxisSample& sample, const SamplePose& pose, double t_s) const;

  /// The next sample is to be matched: nothing of the path is driven yet.
  void begin();
  /// The program is planned as far as anybody looks.
  void read_ahead();
  MatchQuery query_of(const Reading& now, double elapsed_s) const;
  /// PathFollower::follow(); the path up to there is in driven().
  PathMatch follow(const MatchQuery& query);
  /// Of a tip that is not on the path: the controller may apply another length than before, as at a
  /// program's end (M2), and have been on the path until then; out of sight it may have gone on
  /// before that. `before` was on the path.
  void follow_by_length_before(const MatchQuery& query, const Reading& before, Reading& now,
                               PathMatch& point);
  /// The machine stands where it stood, in the numbers of other kinematics; so does `before`, null
  /// if there is none. `without_length`: MatchQuery's.
  void take_kinematics(int type, bool without_length, Reading& now, Reading* before);
  /// The machine is at or behind `program_s`: what lies before is passed without being driven.
  void begin_at(double program_s) { follower_.begin_at(program_s); }

  /// On the path the tip is off as the program's is, unless the machine has another tool or offset
  /// than the program; elsewhere as the tool table has it.
  static void place_real_tip(Reading& now, const PathMatch& point);
  /// What is known of the tip now holds for what comes, too. True: it is something else than
  /// before.
  bool note_real_tip(const Reading& now, const PathMatch& point);
  void note_program_tool(const PathMatch& point);
  /// Where the path is, with what the program has not turned where it really is.
  static ProgramPose place_on_path(const Reading& now, const PathMatch& point);

 private:
  std::optional<double> assumed_length_mm() const;
  PathFollower::Drive drive();

  const LiveCutOptions& options_;
  LiveFrame frame_;
  PathFollower follower_;
  std::unique_ptr<ProgramAhead> ahead_;
  RealTip real_tip_;
  int kinematics_type_ = 0;
  int program_tool_ = -1;
  std::vector<PathFollower::DrivenPart> driven_;
};

}  // namespace kerf
