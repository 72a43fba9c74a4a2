// twin/live/live_cutter.h - positions of a machine in, workpiece cut: with a program along its
// path, without one along the straight line from sample to sample.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "machine_io/position_source.h"
#include "stock/zmap/zmap.h"
#include "twin/beam_settings.h"
#include "twin/cut_stage.h"
#include "twin/finding.h"
#include "twin/live/driven_run.h"
#include "twin/live/live_facts.h"
#include "twin/live/live_frame.h"
#include "twin/live/look_ahead_guard.h"
#include "twin/live/path_follower.h"
#include "twin/live/program_ahead.h"
#include "twin/live/reading_bounds.h"
#include "twin/live/sample_gate.h"
#include "twin/live/seen_strokes.h"
#include "twin/tools.h"
#include "twin/turret.h"

namespace kerf {

/// Program time that is planned beyond what is looked at, so that the follower has where to look.
inline constexpr double kPlannedAhead_s = 6.0;

/// What becomes of the way between two samples with a gap between them.
enum class GapPolicy : std::uint8_t {
  kMark,    ///< it is not cut, and is a finding
  kCut,     ///< it is cut, and is a finding
  kIgnore,  ///< it is not cut
};

/// What becomes of the program before the place where a machine that runs it already is first seen.
enum class JoinedLate : std::uint8_t {
  kCut,   ///< it is in the workpiece
  kKeep,  ///< the workpiece is as it was given
};

struct LiveCutOptions {
  LiveFrameOptions frame;
  bool work_known = false;  ///< frame.work is the user's word; else a program's, if there is one
  bool program_lengths = false;  ///< the tool lengths of the program's G43 are the machine's
  FollowOptions follow;
  GapPolicy gap = GapPolicy::kMark;
  double gap_s = 0.5;  ///< samples farther apart than this have a gap between them
  /// A machine cannot be faster: samples that say so have a gap between them. mm/s.
  double most_mm_per_s = std::numeric_limits<double>::infinity();
  PositionMost most;  ///< what no single reading can need (SampleGate)
  TimelineOptions timeline;
  double guard_s = 10;  ///< how far to look ahead; 0: not
  JoinedLate joined_late = JoinedLate::kCut;
  /// A machine that has cut for so long, and never been on the path of the program, runs another.
  double off_path_s = 2;
  /// Opens the program once more, to find out how far a machine has come that runs it already; may
  /// be empty.
  std::function<std::unique_ptr<Program>()> reopen;
  /// The machine has been watched since before the program began: what of it lies before the place
  /// where it is found has not been run, whatever joined_late says.
  bool seen_before = false;
  bool wait_for_program = false;  ///< a log waits for the interpreter, a machine does not
  /// Of a sheet; such a workpiece needs it. On the path of a program the beam is on where the
  /// program has it on. Elsewhere it is on while the spindle turns, as the source tells it: M3 of
  /// cutting tables. Where nothing tells it, it is off.
  std::optional<BeamSettings> beam;
  /// Of a sheet that is punched, instead. On the path of a program the strokes are the program's,
  /// at its places; each counts as soon as the machine goes on from there, those of a nibbled move
  /// when it is done. Elsewhere they are as the source shows them (SeenStrokes), where the machine
  /// is.
  TurretPointer turret;
  CheckOptions checks;
};

/// The machine now.
///
/// Between two samples the machine is taken to go as its controller interpolates: X Y Z straight
/// and A B C evenly, in the numbers of the kinematics in force (LivePose). Without a program these
/// are those of the module's first type; of positions of joints the tool is where it is at each
/// sample whatever the type, and only the way between two depends on it.
struct LivePlace {
  bool known = false;               ///< X, Y and Z were in the last sample
  Vec3 tip_mm{0};                   ///< workpiece frame: on the part, however that has turned
  bool turns = false;               ///< the model follows what turns, and so do these:
  Pose tool_pose;                   ///< of the tool there; its origin is tip_mm
  Vec3 spindle{0, 0, 1};            ///< there, from the tip to the nose
  Vec3 machine_mm{0};               ///< X Y Z as the machine has them
  std::array<double, 3> abc_deg{};  ///< as the program has them
  Vec3 uvw_mm{0};
  double spindle_rpm = 0;  ///< signed; NaN: not known
  int tool = -1;
  bool followed = false;     ///< there is a program, and the tip is on its path
  bool off_path = false;     ///< it should be, and is not
  double distance_mm = 0;    ///< from the path, if there is one
  SourceRef source;          ///< of the program's motion there
  double program_s = 0;      ///< program time, by the plan
  std::string missing_axes;  ///< why it is not known
};

/// One thread. Deterministic: the same samples with the same times give the same workpiece, as
/// long as the program is waited for. In a model that takes tilted tools a way is cut when it has
/// lasted for DrivenRun::kLongest_s, ends or turns off; in others at once.
class LiveCutter {
 public:
  /// `program` may be null. The references must outlive the cutter.
  LiveCutter(StockModel& stock, const ToolSources& tools, FindingLog& log, LiveCutOptions options,
             std::unique_ptr<Program> program);

  /// For a workpiece that keeps cut ids: see CutStage. Before the first sample.
  void label_by(CutLabels& labels) { stage_.label_by(labels); }
  /// The next sample, `t_s` after the first by one clock. `lost`: others are known to be missing
  /// before it. One that may be wild waits for the next.
  void take(const AxisSample& sample, double t_s, bool lost);
  /// The workpiece is up to date with the samples but for a way that is still short, and the
  /// program ahead has been looked at.
  void look();
  /// So are the workpiece's snapshots. When it or look() is called makes no difference to the
  /// workpiece in the end.
  void hand_over() { stage_.hand_over(); }
  /// All that was taken is in the workpiece, a way that is still short, too.
  void settle();
  void finish();

  /// The program that it was made with, read from another start, before the machine has been found
  /// on it.
  void read_again(std::unique_ptr<Program> program,
                  std::function<std::unique_ptr<Program>()> reopen);
  /// The workpiece was another cutter's before, which has done with it what goes before.
  void go_on_from(const LiveCutter& other) { stage_.go_on_from(other.stage_); }
  /// Where the machine was before the first sample: it is seen, and not counted.
  void begin_at(const AxisSample& sample, double t_s) {
    take(sample, t_s, false);
    facts_ = {};
  }
  /// The machine does not run the program (any more): it is on no path, and off none.
  void set_running(bool runs) { runs_ = runs; }
  /// It is not known whether it still does: a tip that is not on the path is not told of.
  void set_doubtful(bool doubtful) { doubtful_ = doubtful; }
  /// Off: nothing is told ahead, at no cost.
  void set_looks_ahead(bool looks) { looks_ahead_ = looks; }
  /// The machine has been on the program's path.
  bool found() const { return follower_.found(); }
  /// And has come to its end.
  bool finished() const;
  /// It has worked in the blank, and never on the program's path.
  bool is_foreign() const { return foreign_told_; }
  /// It says that it runs a line of the program, and is not there.
  bool is_astray() const { return off_path_event_.has_value(); }
  /// Line of the motion on which the machine was found first; 0: it has not been.
  std::uint32_t first_line() const { return first_line_; }

  const LiveFacts& facts() const { return facts_; }
  const LivePlace& place() const { return place_; }
  const CutStage& stage() const { return stage_; }
  const ProgramAhead* program() const { return ahead_.get(); }
  /// Where a program would begin that the machine starts there (LiveFrame::machine_place_of()).
  /// Nothing if the sample does not tell.
  std::optional<std::array<double, 9>> start_at(const AxisSample& sample) const;
  /// Where the workpiece lies in the machine.
  const WorkpieceFrame& work() const { return frame_.options().work; }
  /// What the look-ahead has found since the last call.
  std::vector<AheadWarning> take_warnings() { return std::exchange(warnings_, {}); }

 private:
  struct Sighting {
    ProgramPlace place;  ///< under kinematics_type_
    Pose pose;           ///< of the tool in the workpiece
    double t_s = 0;
    double tool_length_mm = 0;
    bool length_is_applied = false;  ///< LivePose's
    bool by_length_before = false;  ///< it was found on the path by the length of the sample before
    /// Of it by the tool table. While the tip is on the program's path: as the program has it,
    /// unless tool and offset of the machine are others.
    Vec3 real_shift_mm{0};
    bool length_checked = false;  ///< LivePose's
    int tool = -1;
    std::array<bool, 3> abc_known{};
    std::array<bool, 3> uvw_known{};
    AxisSample sample;
  };
  void take_sound(const AxisSample& sample, double t_s, bool lost);
  void adopt_program_frame();
  bool is_idle() const;
  double turning_speed(SpindleState state) const;
  std::optional<Sighting> see(const AxisSample& sample, double t_s);
  static Finding finding_of(FindingId id, Severity severity, double t_s, const Vec3& place,
                            int tool);
  const MachineKinematics* switched_machine() const;
  std::optional<double> assumed_length_mm() const;
  FollowedPlace place_of(const Sighting& now, double elapsed_s) const;
  FollowedPoint follow(Sighting& now, double elapsed_s);
  static void place_real_tip(Sighting& now, const FollowedPoint& point);
  static void take_real_length(const Sighting& now, Motion& motion);
  static ToolLengthState real_length_of(const Sighting& now);
  void check_passed(double until_s);
  void take_kinematics(int type, bool without_length, Sighting& now);
  static ProgramPlace place_on_path(const Sighting& now, const FollowedPoint& point);
  Pose pose_in_workpiece(const Sighting& at) const;
  double way_between(const Sighting& before, const Sighting& now) const;
  PathFollower::Drive drive();
  FollowedPoint find(const FollowedPlace& place);
  void note_late_start(const FollowedPlace& place);
  std::optional<std::uint64_t> motion_at(const FollowedPlace& place) const;
  void pass(std::uint64_t motion);
  void pass_planned(std::size_t count);
  void take_as_cut(std::span<const PathFollower::DrivenPart> parts);
  enum class Break : std::uint8_t { kNone, kGap, kJump };
  bool too_fast(const Sighting& before, const Sighting& now) const;
  Break break_between(const Sighting& before, const Sighting& now, bool lost) const;
  bool near_stock(const Vec3& from_mm, const Vec3& to_mm, double radius_mm) const;
  void note_length(int tool, double t_s);
  void note_limits(const Vec3& machine_mm, double t_s);
  bool drop_wild(const AxisSample& sample, double t_s);
  void note_wild(std::size_t count, double t_s);
  void note_gap(const Sighting& before, const Sighting& now, bool jump, bool by_program);
  void note_turn(const Sighting& now);
  void note_unseen_axes(const Sighting& now);
  void note_unseen_beam(const Sighting& now);
  void note_tool(const Sighting& now, const FollowedPoint& point, double driven_mm);
  void note_off_path(const Sighting& now, const FollowedPoint& point);
  bool is_by_hand(const FollowedPoint& point);
  void note_foreign_program(const Sighting& now, double duration_s);
  void cut_chord(const ProgramPlace& from, const Sighting& now, double duration_s, bool off_path);
  void cut_path(const Sighting& now, const FollowedPoint& point, double duration_s);
  void cut(const Motion& motion, DrivenRun::Way way, double duration_s);
  void cut_run();
  void cut_now(const Motion& motion, double duration_s, double t_s);
  SpindleState spindle() const;
  void note_spindle();
  void punch(const Sighting& now, const FollowedPoint& point, bool seen);
  void punch_program(const FollowedPoint& point, bool along);
  void punch_motion(Motion motion, double share, bool seen);
  std::uint64_t seen_from(const FollowedPoint& point) const;
  void punch_seen_part();
  void punch_rest();
  void note_unseen_trigger(const Sighting& now);

  void follow_program(std::unique_ptr<Program> program);
  void follow_by_length_before(const FollowedPlace& place, Sighting& now, FollowedPoint& point);
  bool is_long(double elapsed_s) const;

  StockModel& stock_;
  const ToolSources& tools_;
  FindingLog& log_;
  LiveCutOptions options_;
  LiveFrame frame_;
  ReadingBounds bounds_;
  SampleGate gate_;
  std::vector<SampleGate::Timed> passed_;  ///< by the gate
  bool wild_told_ = false;
  bool quick_told_ = false;
  bool runs_ = true;
  bool doubtful_ = false;
  bool looks_ahead_ = true;
  std::uint32_t first_line_ = 0;
  bool lost_wild_ = false;  ///< samples were lost before one that was dropped
  ToolBook book_;
  CutStage stage_;
  PathFollower follower_;
  std::unique_ptr<ProgramAhead> ahead_;
  std::unique_ptr<LookAheadGuard> guard_;
  bool guard_stale_ = true;
  std::vector<AheadWarning> warnings_;

  AxisSample sample_;  ///< the last one
  std::optional<Sighting> before_;
  ProgramPlace cut_to_;      ///< where the cutter has come to
  int kinematics_type_ = 0;  ///< in force, as the program has it where the machine is
  bool was_on_path_ = false;
  double period_s_ = 0;    ///< usual time between samples
  bool was_fast_ = false;  ///< between the last two samples, faster than the machine can be
  std::vector<PathFollower::DrivenPart> driven_;  ///< along the path since the sample before
  DrivenRun run_;                                 ///< not yet cut
  double t_s_ = 0;
  LiveFacts facts_;
  LivePlace place_;
  std::optional<FindingLog::Handle> off_path_event_;
  std::optional<double> beyond_since_s_;  ///< the positions lie beyond the machine's limits
  bool beyond_told_ = false;
  std::optional<std::array<double, 3>> first_abc_deg_;
  bool turn_told_ = false;
  bool unseen_told_ = false;
  bool beam_told_ = false;  ///< or that of the trigger
  std::vector<TorchMaterial> materials_;
  int length_told_ = 0;  ///< tool whose length is not known
  bool mismatch_told_ = false;
  double mismatch_mm_ = 0;  ///< driven along the path with another tool than the program's
  int program_tool_ = -1;   ///< where the machine was last on the path
  /// It has stood in no line, having gone so far along its path, and has not gone on.
  std::optional<double> stood_mm_;
  double lost_sight_s_ = 0;  ///< a program runs, and its path has not been found, for so long
  double foreign_s_ = 0;     ///< the machine has cut, and never been on the path, for so long
  bool foreign_told_ = false;
  double turning_rpm_ = 0;                 ///< signed: when the spindle was last told to turn ..
  std::optional<double> turning_until_s_;  ///< .. which was then
  double watched_s_ = 0;  ///< since the first sample, while the path has not been found
  std::optional<SeenStrokes> strokes_;
  std::uint64_t punched_ = 0;   ///< motions of the program that have been; the next is under way
  bool struck_before_ = false;  ///< what the program strikes before this sample has been struck
  double seen_share_ = 0;       ///< of that one, since strokes of it were last cut
  int real_tool_ = -1;          ///< in the spindle, when the machine was last between two places ..
  int real_program_tool_ = -1;  ///< .. where the program has this one
  double join_after_s_;         ///< lost_sight_s_ at which the whole program is searched
};

}  // namespace kerf
