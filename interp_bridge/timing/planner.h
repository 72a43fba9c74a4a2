// interp_bridge/timing/planner.h - how long a program really takes, and which path the machine
// really runs: a model of LinuxCNC 2.9's trajectory planner.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/translate.h"
#include "interp_bridge/machine_limits.h"
#include "interp_bridge/motion.h"
#include "interp_bridge/timing/spindle_speed.h"
#include "interp_bridge/timing/way_in_time.h"

namespace kerf {

/// Times that no NC program and no INI tells. The defaults are those measured on LinuxCNC's own
/// simulated machine, whose spindle is at speed at once; a real machine is slower.
struct PlannerOptions {
  /// What the limits are, for time_model(): "mill.ini", or "a small mill (no INI given)".
  std::string limits_origin = tr_noop("a small mill (no INI given)");
  /// A tool change, beyond the handshake of task and I/O: kToolChangeLooks periods of
  /// [EMCIO]CYCLE_TIME, 0.2 to 0.3 s with the usual 0.1 s.
  double tool_change_s = 0;
  /// The spindle's way to its speed when it starts, turns round or changes its speed.
  double spindle_start_s = 0;
  /// How fast it gets there, if that is known: feeds, arcs and threads then wait until LinuxCNC
  /// calls the spindle at speed, after it has been started or sent to another speed, and under G96
  /// after each traverse.
  SpindleDrive spindle;
  /// Where the program makes the machine wait until it stands (Motion::halts, a dwell): from
  /// standstill to the next move, besides half of [TASK]CYCLE_TIME. Measured: 1 ms where the task
  /// keeps the command to itself (messages, work offsets), 2 to 3 ms where it is sent on, 3 ms for
  /// M66, as the program is then read on.
  double halt_s = 0.0015;
  /// Report the planned path to MotionPlanSink::path().
  bool with_path = false;
};

/// I/O periods that a tool change waits for: to begin, to change and to be acknowledged. Two for
/// the T word, while the moves that were sent before it go on; M61 takes one in the same way.
inline constexpr int kToolChangeLooks = 3;
inline constexpr int kToolPrepareLooks = 2;
inline constexpr int kToolNumberLooks = 1;
/// From when M6 or M61 is done to the next move: LinuxCNC reads the program on only then, after it
/// has written its variables and read the tool table. Measured: 3 to 6 ms.
inline constexpr double kReadOn_s = 0.004;

/// One motion in time. Motions follow each other; a gap between one's end and the next one's start
/// is a wait for a command (spindle, coolant, offset, dwell). The time of the program is
/// TrajectoryPlanner::clock_s().
struct MotionTiming {
  std::uint64_t index = 0;  ///< of the motion: 0 for the first that was pushed
  double start_s = 0;
  double duration_s = 0;
  /// Programmed feed: mm/min (degrees/min where only A, B, C move), G95 and threads as feed per
  /// revolution times speed, under G96 the greatest along the motion. 0 for traverses, and for feed
  /// moves with no feed in force.
  double programmed_mm_per_min = 0;
  /// What the axes allow along this motion: their speeds, the speed cap of the machine, and on
  /// arcs the centripetal acceleration. 0 for steps that do not move. "Feed above what the machine
  /// can do" is programmed_mm_per_min > allowed_mm_per_min.
  double allowed_mm_per_min = 0;
  /// The greatest speed of the planned motion: less than both where the motion is too short to
  /// reach them.
  double peak_mm_per_min = 0;
  /// How the way goes in that time. Of what does not move even.
  WayInTime way;
};

/// A piece of the planned path: a straight line, or an arc about arc.center_mm from from_mm by
/// arc.sweep_rad. Tool tip in the workpiece frame, as Motion.
struct PathPiece {
  bool curved = false;
  Vec3 from_mm{0};
  Vec3 to_mm{0};
  ArcGeometry arc;
};

/// Receives the plan. Called from within push() and finish().
class MotionPlanSink {
 public:
  virtual ~MotionPlanSink() = default;
  /// One per pushed motion, in the order of pushing.
  virtual void timed(const MotionTiming& timing) = 0;
  /// With PlannerOptions::with_path: the pieces of the motion whose timed() comes next, in order.
  /// The pieces of all motions join without gaps where the motions themselves do.
  virtual void path(const PathPiece& piece) = 0;
};

/// Plans a stream of motions as LinuxCNC 2.9 does: consecutive short feeds merged within the G64 Q
/// (P) tolerance, corners cut by arcs within P and run through as fast as the axes' accelerations
/// allow, G61 and G61.1 stops, arcs no faster than their centripetal acceleration, no segment
/// shorter than one servo period, a look-ahead of arc_blend_depth segments, half deceleration
/// before a stop under G64, stops between traverses and feeds and wherever the program makes the
/// machine wait (Motion::halts). Under G95 corners are rounded as for the fastest feed, and run
/// through at that of the spindle; from a feed per minute the machine brakes before one that
/// follows the spindle. Under G96 a feed per revolution changes along a motion with the distance
/// from the axis. Dwells last exactly as long as written. M0, M1, M60 take no time: stops()
/// counts them.
///
/// Results come late, as a motion's end speed depends on what follows: by the look-ahead, times up
/// to 101 motions merged into one segment; at once where the machine stops for a command. They come
/// in order, one per motion, so a caller who cuts before the results are there keeps what it needs
/// in a queue, one entry per pushed motion, and takes the front entry at each timed(). After
/// finish() none is missing.
///
/// Of merged motions each gets the time of its share of the way. The time of a blend arc goes half
/// to the motion before, half to the one after; so does the time in which two motions pass a corner
/// at once.
///
/// Axis limits apply along the axes of the workpiece frame: exact unless that is rotated against
/// the machine (G10 L2 R). A feed is that of X Y Z; where these stand that of U V W, and last that
/// of A B C (degrees); the other axes are only seen to it that they keep up. Of the limits,
/// max_linear_acceleration, arc_blend_fallback and arc_blend_ramp_hz are not used: what was
/// measured depends on none of them. Corners that no arc fits LinuxCNC passes while both moves run:
/// their path is chords, within half of a servo period's way of the machine's (measured: 0.016 mm
/// at 30 mm/s). Corners of moves of A to W, which it passes so too, are drawn sharp; the real tool
/// passes inside. Steps that take no time have no path. Overrides, pauses and jerk limits (2.10)
/// are not modelled; nor the feed that is lost before M61 (Motion::by_number). Moves behind a T
/// word are sent when the I/O task has prepared the tool: the machine stops if those before it end
/// sooner.
///
/// Threads (G33, G76, and the way in of a rigid tap, G33.1) run at pitch times speed and wait for
/// the spindle's index: half a revolution on average, and where the spindle has turned on since the
/// thread before, whole revolutions after that one's. A rigid tap's spindle turns round at once;
/// that the tap overshoots meanwhile, by two servo periods at both ends, is in its time and not in
/// the path; so is what a spindle whose acceleration is known needs to turn round, and the way back
/// from where it has come to meanwhile. Nothing is known of moves without a start
/// (Motion::start_known) or with no feed in force: they take no time.
///
/// Cost: under 1 us a motion, about 0.3 us on average on CAM paths. Memory does not grow with the
/// program; nothing is allocated once the queues have reached their size.
class TrajectoryPlanner {
 public:
  TrajectoryPlanner(const MachineLimits& limits, const PlannerOptions& options,
                    MotionPlanSink& sink);
  ~TrajectoryPlanner();
  TrajectoryPlanner(const TrajectoryPlanner&) = delete;
  TrajectoryPlanner& operator=(const TrajectoryPlanner&) = delete;

  void push(const Motion& motion);
  /// The machine comes to a stop, all that was pushed is reported, and it stands for so long: what
  /// neither program nor INI tells, as the stroke of a punch. It is in no motion's time.
  void hold(double seconds);
  /// Brings the machine to a stop and reports what is left. More may be pushed afterwards.
  void finish();

  double clock_s() const;  ///< end of the last motion that was reported, or of the hold() after
  std::uint64_t stops() const;  ///< M0, M1, M60: their waiting is not counted
  /// One sentence for the report: what was modelled, with which limits, and where they are from.
  std::string time_model() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kerf
