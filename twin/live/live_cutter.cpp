#include "twin/live/live_cutter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "interp_bridge/tool_lengths.h"
#include "twin/motion_geometry.h"
#include "twin/motion_nearest.h"
#include "twin/stock_choice.h"

namespace kerf {
namespace {

/// Sensors tremble: a machine that moved less has not moved. mm.
constexpr double kStill_mm = 1e-6;
/// What happens across a gap in which a machine moved less is nothing. mm.
constexpr double kGapMove_mm = 0.02;
/// Lost samples leave a gap if it is longer than this, and than so many usual periods: sources of
/// ten readings a second are believed.
constexpr double kShortGap_s = 0.1;
constexpr double kShortGapPeriods = 4;
/// Share of a new interval in the usual period.
constexpr double kPeriodShare = 0.05;
/// A jump is faster than the machine by this factor, and longer than this.
constexpr double kJumpFactor = 1.5;
constexpr double kJump_mm = 1.0;
/// Times are not exacter than this. What was held up on a busy computer follows in a burst: cycles
/// of a LinuxCNC without a real-time kernel, answers of a network, readings of a process that had
/// to wait between its stamp and its positions.
constexpr double kBurst_s = 0.05;
/// A spindle slower than this stands. rpm.
constexpr double kStanding_rpm = 1.0;
/// One that was told to stop still turns for so long, s; and where no program runs any more.
constexpr double kCoasts_s = 0.15;
constexpr double kCoastsIdle_s = 1.0;
/// A machine that says it runs, and is not seen at the program's beginning, is looked for in all of
/// it after so long.
constexpr double kJoin_s = 0.3;
/// An axis that has turned by less stands. Degrees.
constexpr double kTurned_deg = 0.01;
/// A machine that has so little of its program left is at its end: sensors round. s.
constexpr double kEnd_s = 0.05;

/// The motion is under this type of the machine's kinematics.
void set_type(const MachineKinematics& machine, int type, Motion& motion) {
  if (!machine.is_switchable() || machine.switch_output >= TorchState::kAnalogs) return;
  motion.torch.analog[machine.switch_output] = static_cast<float>(type);
}

}  // namespace

LiveCutter::LiveCutter(StockModel& stock, const ToolSources& tools, FindingLog& log,
                       LiveCutOptions options, std::unique_ptr<Program> program)
    : stock_(stock),
      tools_(tools),
      log_(log),
      options_(std::move(options)),
      frame_(options_.frame),
      bounds_(options_.frame, options_.timeline),
      gate_(motion_bounds(options_.frame, options_.timeline, options_.most), options_.gap_s),
      book_(tools, row_of(stock).can_cut),
      stage_(stock, book_, log, options_.timeline),
      follower_(options_.follow),
      run_(ToolPathTolerance::of_cell(stock.cell_mm()).tip_mm, options_.follow.lever_mm),
      join_after_s_(kJoin_s) {
  stage_.watch_machine();
  stage_.check_by(options_.checks);
  if (program) follow_program(std::move(program));
  if (options_.turret) {
    stage_.punch(options_.turret);
    strokes_.emplace(options_.turret);
  } else if (options_.beam) {
    stage_.burn(*options_.beam);
  }
  stage_.set_frame(work());
}

void LiveCutter::follow_program(std::unique_ptr<Program> program) {
  ahead_ = std::make_unique<ProgramAhead>(std::move(program), options_.timeline, follower_);
  adopt_program_frame();
  if (!(options_.guard_s > 0)) return;
  guard_ = std::make_unique<LookAheadGuard>(
      tools_,
      LookAheadGuard::Options{options_.timeline, options_.guard_s, options_.beam, options_.turret,
                              options_.checks, !options_.wait_for_program});
}

void LiveCutter::read_again(std::unique_ptr<Program> program,
                            std::function<std::unique_ptr<Program>()> reopen) {
  guard_.reset();
  ahead_->stop();
  follower_ = PathFollower(options_.follow);
  options_.reopen = std::move(reopen);
  follow_program(std::move(program));
  guard_stale_ = true;
}

void LiveCutter::adopt_program_frame() {
  const std::optional<WorkpieceFrame> frame = ahead_->wait_for_frame();
  if (frame && !options_.work_known) frame_.set_work(*frame);
}

SpindleState LiveCutter::spindle() const {
  // What nobody tells cannot be found wrong; a beam that nobody tells of is off.
  if (std::isnan(sample_.spindle_rpm)) {
    return options_.beam ? SpindleState::kStopped : SpindleState::kClockwise;
  }
  double rpm = sample_.spindle_rpm;
  if (std::abs(rpm) < kStanding_rpm) {
    // An abort stops spindle and axes together, and takes the axes some way. When it was nobody
    // knows of a spindle that turned before the time out of sight.
    const double unseen_s = before_ ? t_s_ - before_->t_s : 0;
    const bool idle = sample_.program == ProgramState::kIdle ||
                      (sample_.program == ProgramState::kUnknown && ahead_ && stood_mm_);
    const double coasts_s = unseen_s + (idle ? kCoastsIdle_s : kCoasts_s);
    const bool coasts = !options_.beam && turning_until_s_ && t_s_ - *turning_until_s_ <= coasts_s;
    if (!coasts) return SpindleState::kStopped;
    rpm = turning_rpm_;
  }
  return rpm > 0 ? SpindleState::kClockwise : SpindleState::kCounterclockwise;
}

void LiveCutter::note_spindle() {
  if (!(std::abs(sample_.spindle_rpm) >= kStanding_rpm)) return;
  turning_rpm_ = sample_.spindle_rpm;
  turning_until_s_ = t_s_;
}

/// With the program's tool lengths the tip is that of a tool of no length, until follow() has found
/// where in the program the machine is.
std::optional<double> LiveCutter::assumed_length_mm() const {
  return ahead_ && options_.program_lengths ? std::optional<double>(0.0) : std::nullopt;
}

/// A machine whose kinematics the program may switch, or a robot; null: it is none.
const MachineKinematics* LiveCutter::switched_machine() const {
  const MachineKinematics* const machine = options_.timeline.kinematics.get();
  return machine && (machine->is_switchable() || machine->is_arm()) ? machine : nullptr;
}

std::optional<std::array<double, 9>> LiveCutter::start_at(const AxisSample& sample) const {
  if (bounds_.fault_of(sample)) return std::nullopt;
  const auto pose = frame_.pose_of(sample, assumed_length_mm(), 0);
  return pose ? std::optional(frame_.machine_place_of(*pose)) : std::nullopt;
}

/// The machine as the sample shows it.
std::optional<LiveCutter::Sighting> LiveCutter::see(const AxisSample& sample, double t_s) {
  const auto pose = frame_.pose_of(sample, assumed_length_mm(), kinematics_type_);
  if (!pose) {
    ++facts_.incomplete;
    place_.known = false;
    place_.missing_axes = frame_.missing_axes(sample);
    return std::nullopt;
  }
  // A punch has no length that could matter.
  if (!pose->length_known && !options_.turret) note_length(frame_.tool_of(sample), t_s);
  if (!options_.frame.workpiece_frame) note_limits(pose->machine_mm, t_s);
  place_.machine_mm = pose->machine_mm;
  place_.spindle_rpm = sample.spindle_rpm;
  Sighting now;
  now.place = {pose->tip_mm, pose->abc_deg, pose->along_tool, pose->uvw_mm};
  now.abc_known = pose->abc_known;
  now.uvw_known = pose->uvw_known;
  now.t_s = t_s;
  now.tool_length_mm = pose->tool_length_mm;
  now.length_is_applied = pose->length_is_applied;
  now.real_shift_mm = pose->real_shift_mm;
  now.length_checked = pose->length_checked;
  now.sample = sample;
  // A program that is followed knows better than a configuration that says one tool for all.
  const bool by_configuration = !ahead_ || program_tool_ < 0;
  now.tool = by_configuration ? frame_.tool_of(sample) : sample.tool;
  return now;
}

FollowedPlace LiveCutter::place_of(const Sighting& now, double elapsed_s) const {
  FollowedPlace place;
  place.here = now.place;
  place.abc_known = now.abc_known;
  place.uvw_known = now.uvw_known;
  const AxisSample& sample = now.sample;
  place.machine = switched_machine();
  if (place.machine) {
    for (std::size_t i = 0; i < place.machine->types.size(); ++i) {
      const auto pose = frame_.pose_of(sample, assumed_length_mm(), static_cast<int>(i));
      place.by_type[i] = {pose->tip_mm, pose->abc_deg, pose->along_tool, pose->uvw_mm};
    }
  }
  const ToolLengthFrom from = options_.frame.tool_length;
  place.without_length = options_.program_lengths && !options_.frame.workpiece_frame &&
                         (from == ToolLengthFrom::kProgram ||
                          (from == ToolLengthFrom::kAuto && std::isnan(sample.tool_offset_z_mm)));
  place.applied_length = now.length_is_applied;
  place.elapsed_s = elapsed_s;
  place.line = sample.line;
  place.tool = sample.tool;
  return place;
}

FollowedPoint LiveCutter::follow(Sighting& now, double elapsed_s) {
  driven_.clear();
  FollowedPoint point;
  point.distance_mm = std::numeric_limits<double>::infinity();
  if (!ahead_ || !runs_) return point;
  ahead_->read_until(follower_.program_s() + options_.guard_s + kPlannedAhead_s,
                     options_.wait_for_program);
  const FollowedPlace place = place_of(now, elapsed_s);
  point = follower_.found() ? follower_.follow(place, drive()) : find(place);
  if (!point.on_path) follow_by_length_before(place, now, point);
  if (point.on_path && point.kinematics_type != kinematics_type_) {
    take_kinematics(point.kinematics_type, place.without_length, now);
  }
  if (place.without_length) {
    now.tool_length_mm = point.tool_length_mm;
    now.place.tip_mm -= point.tool_length_mm * now.place.along_tool;
  }
  check_passed(follower_.program_s());
  // Strokes hang on motions that do not move, too: punch() forgets them.
  if (!options_.turret) ahead_->forget_before(follower_.program_s());
  return point;
}

/// The controller applies another length than before, as at a program's end (M2), and has been on
/// the path until then: out of sight it may have gone on before that.
void LiveCutter::follow_by_length_before(const FollowedPlace& place, Sighting& now,
                                         FollowedPoint& point) {
  if (!before_ || !was_on_path_ || !now.length_is_applied || !before_->length_is_applied) return;
  const double before_mm = before_->tool_length_mm + before_->real_shift_mm.z;
  if (before_mm == now.tool_length_mm) return;
  FollowedPlace as_before = place;
  as_before.elapsed_s = 0;
  const double change_mm = now.tool_length_mm - before_mm;
  as_before.here.tip_mm += change_mm * place.here.along_tool;
  for (ProgramPlace& one : as_before.by_type) one.tip_mm += change_mm * one.along_tool;
  const FollowedPoint then = follower_.follow(as_before, drive());
  if (!then.on_path) return;
  point = then;
  now.by_length_before = true;
}

/// On the path the tip is off as the program's is, unless the machine has another tool or offset
/// than the program; elsewhere as the tool table has it.
void LiveCutter::place_real_tip(Sighting& now, const FollowedPoint& point) {
  if (!now.length_is_applied) return;
  const bool stated = point.stated_length_mm &&
                      std::abs(*point.stated_length_mm - now.tool_length_mm) <= kMostWear_mm;
  const bool checked = now.length_checked && now.sample.tool >= 0 && !stated;
  const double off_mm = now.real_shift_mm.z - point.tip_shift_mm.z;
  const bool other = now.by_length_before || (checked && std::abs(off_mm) > kMostWear_mm);
  if (point.on_path && !other) {
    now.real_shift_mm = point.tip_shift_mm;
  }
  now.place.tip_mm += now.real_shift_mm;
  now.tool_length_mm -= now.real_shift_mm.z;
}

ToolLengthState LiveCutter::real_length_of(const Sighting& now) {
  ToolLengthState length;
  length.verdict = ToolLengthState::Verdict::kWrong;
  length.real_mm = {0, 0, now.tool_length_mm};
  length.applied_mm = length.real_mm + now.real_shift_mm;
  length.tip_shift_mm = now.real_shift_mm;
  length.displaces = true;
  return length;
}

/// A motion of the program, by the tool and the offset that the machine really has.
void LiveCutter::take_real_length(const Sighting& now, Motion& motion) {
  const Vec3 more_mm = now.real_shift_mm - motion.length.tip_shift_mm;
  if (!now.length_is_applied || now.by_length_before || more_mm == Vec3{0}) return;
  motion.from_mm += more_mm;
  motion.to_mm += more_mm;
  if (motion.kind == MotionKind::kArc) motion.arc.center_mm += more_mm;
  motion.tool_offset_mm = {0, 0, now.tool_length_mm};
  motion.length = now.real_shift_mm == Vec3{0} ? ToolLengthState{} : real_length_of(now);
}

/// What the machine has behind it.
void LiveCutter::check_passed(double until_s) {
  if (!follower_.found()) return;
  for (const PlannedMotion& planned : ahead_->motions()) {
    if (planned.start_s >= follower_.program_s() || planned.end_s >= until_s) break;
    TimedStep step;
    step.start_s = t_s_;
    stage_.check_whole(planned.motion, step);
  }
}

/// The machine stands where it stood, in other numbers. `without_length`: FollowedPlace's.
void LiveCutter::take_kinematics(int type, bool without_length, Sighting& now) {
  cut_run();
  kinematics_type_ = type;
  const auto again = [&](Sighting& at) {
    const auto pose = frame_.pose_of(at.sample, assumed_length_mm(), type);
    at.place = {pose->tip_mm, pose->abc_deg, pose->along_tool, pose->uvw_mm};
  };
  again(now);
  if (!before_) return;
  again(*before_);
  if (without_length) {
    before_->place.tip_mm -= before_->tool_length_mm * before_->place.along_tool;
  }
  cut_to_ = before_->place;
}

/// Where the tool is, with all that has turned.
Pose LiveCutter::pose_in_workpiece(const Sighting& at) const {
  const ToolPath* const path = stage_.model_path();
  if (!path) return shift(at.place.tip_mm);
  Motion here;
  here.start_known = false;
  here.to_mm = at.place.tip_mm;
  here.to_abc_deg = here.from_abc_deg = at.place.abc_deg;
  here.to_uvw_mm = here.from_uvw_mm = at.place.uvw_mm;
  here.tool_offset_mm = {0, 0, at.tool_length_mm};
  set_type(path->machine(), kinematics_type_, here);
  return path->pose_at(here, 1);
}

/// As far as the tip has gone on the part, or what the axes have turned at the lever.
double LiveCutter::way_between(const Sighting& before, const Sighting& now) const {
  double turned_deg = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    turned_deg = std::max(turned_deg, std::abs(now.place.abc_deg[i] - before.place.abc_deg[i]));
  }
  double way_mm = std::max(glm::length(now.place.tip_mm - before.place.tip_mm),
                           glm::length(now.pose.origin_mm - before.pose.origin_mm));
  if (stock_.takes_tilted_tools()) {
    way_mm = std::max(way_mm, turned_deg * kPi / 180 * options_.follow.lever_mm);
  }
  return way_mm;
}

bool LiveCutter::too_fast(const Sighting& before, const Sighting& now) const {
  const double way_mm = glm::length(now.place.tip_mm - before.place.tip_mm);
  return way_mm > kJump_mm &&
         way_mm > kJumpFactor * options_.most_mm_per_s * (now.t_s - before.t_s + kBurst_s);
}

/// Time between two samples in which some are missing.
bool LiveCutter::is_long(double elapsed_s) const {
  return elapsed_s > std::max(kShortGap_s, kShortGapPeriods * period_s_);
}

LiveCutter::Break LiveCutter::break_between(const Sighting& before, const Sighting& now,
                                            bool lost) const {
  const double way_mm = way_between(before, now);
  if (way_mm < kGapMove_mm) return Break::kNone;
  const double elapsed_s = now.t_s - before.t_s;
  // A sample that is missing in a quick row is no gap: the way is as short as between slow ones.
  const bool felt = lost && is_long(elapsed_s);
  if (felt || elapsed_s > options_.gap_s) return Break::kGap;
  // One jump is none of a machine; one after the other is a machine that is faster than is known.
  return too_fast(before, now) && !was_fast_ ? Break::kJump : Break::kNone;
}

/// Within boxes. A torch is above what it cuts.
bool LiveCutter::near_stock(const Vec3& from_mm, const Vec3& to_mm, double radius_mm) const {
  const Box blank = stock_.bounds_mm();
  Box way;
  way.extend(from_mm);
  way.extend(to_mm);
  return (options_.beam || way.min.z < blank.max.z) && way.min.x - radius_mm < blank.max.x &&
         way.max.x + radius_mm > blank.min.x && way.min.y - radius_mm < blank.max.y &&
         way.max.y + radius_mm > blank.min.y;
}

/// Together with the ways before and behind it, where a move costs much however short it is. When
/// that is cut depends on the samples alone, or a workpiece would depend on who looks at it when.
void LiveCutter::cut(const Motion& motion, DrivenRun::Way way, double duration_s) {
  if (!stock_.takes_tilted_tools()) return cut_now(motion, duration_s, t_s_);
  const double begin_s = t_s_ - duration_s;
  if (!run_.add(motion, way, duration_s, begin_s)) {
    cut_run();
    run_.add(motion, way, duration_s, begin_s);
  }
  if (run_.is_long(t_s_)) cut_run();
}

void LiveCutter::cut_run() {
  if (const auto run = run_.take()) cut_now(run->motion, run->duration_s, run->t_s);
}

void LiveCutter::cut_now(const Motion& motion, double duration_s, double t_s) {
  TimedStep step;
  step.start_s = t_s;
  step.duration_s = duration_s;
  step.length_mm = path_length_mm(motion);
  // Readings in a burst may have one stamp. A machine that moves has a feed.
  step.programmed_mm_per_min =
      duration_s > 0 ? 60 * step.length_mm / duration_s : std::numeric_limits<double>::infinity();
  step.allowed_mm_per_min = step.programmed_mm_per_min;
  if (stage_.torch() && ahead_ && ahead_->take_materials(materials_)) {
    stage_.set_materials(materials_);
  }
  stage_.take_timed(motion, step);
}

/// The way from where the cutter is to where the tool is: see LivePlace.
void LiveCutter::cut_chord(const ProgramPlace& from, const Sighting& now, double duration_s,
                           bool off_path) {
  const double length_mm = std::max(glm::length(now.place.tip_mm - from.tip_mm),
                                    glm::length(now.place.uvw_mm - from.uvw_mm));
  const bool turns = stock_.takes_tilted_tools() && from.abc_deg != now.place.abc_deg;
  if (length_mm < kStill_mm && !turns) return;
  Motion motion;
  motion.spindle = spindle();
  // Without its beam a head is on its way.
  const bool travels = options_.beam && motion.spindle == SpindleState::kStopped;
  motion.kind = travels ? MotionKind::kTraverse : MotionKind::kFeed;
  motion.torch.spindles_on = motion.spindle != SpindleState::kStopped ? 1 : 0;
  motion.speed_said = !std::isnan(sample_.spindle_rpm);
  motion.spindle_rpm = motion.speed_said ? turning_speed(motion.spindle) : 0;
  motion.tool = std::max(0, now.tool >= 0 ? now.tool : program_tool_);
  motion.source = {0, sample_.line > 0 ? static_cast<std::uint32_t>(sample_.line) : 0};
  motion.from_mm = from.tip_mm;
  motion.to_mm = now.place.tip_mm;
  // A model of upright tools is not asked about turns: note_turn() has told.
  motion.from_abc_deg = turns ? from.abc_deg : now.place.abc_deg;
  motion.to_abc_deg = now.place.abc_deg;
  motion.from_uvw_mm = from.uvw_mm;
  motion.to_uvw_mm = now.place.uvw_mm;
  if (const ToolPath* const path = stage_.machine_path()) {
    set_type(path->machine(), kinematics_type_, motion);
  }
  motion.tool_offset_mm = {0, 0, now.tool_length_mm};
  if (now.real_shift_mm != Vec3{0}) motion.length = real_length_of(now);
  motion.feed_mm_per_min = duration_s > 0 ? 60 * length_mm / duration_s : 0;
  facts_.chord_mm += length_mm;
  double radius_mm = 0;
  if (motion.tool > 0 || book_.has_arguments()) {
    const ResolvedTool& tool = book_.mount(motion.tool, 0);
    if (tool.cutter) radius_mm = tool.cutter->radius_mm();
  }
  // Jogging in the air needs no tool that is known.
  if (stage_.is_upright(motion) && !near_stock(from.tip_mm, now.place.tip_mm, radius_mm)) return;
  note_unseen_beam(now);
  note_foreign_program(now, duration_s);
  cut(motion, DrivenRun::Way::kStraight, duration_s);
  // The workpiece is no longer what the program makes of it.
  guard_stale_ |= off_path;
}

/// What the follower has driven, with the tool and the spindle that the machine really has, and
/// with what the program has not turned where it really is. A beam is switched within the way
/// between two samples, at places that only the program knows.
void LiveCutter::cut_path(const Sighting& now, const FollowedPoint& point, double duration_s) {
  double planned_s = 0;
  for (const PathFollower::DrivenPart& part : driven_) planned_s += part.duration_s;
  const bool spindle_told = !std::isnan(sample_.spindle_rpm);
  for (auto& [motion, share_s, of_same_piece] : driven_) {
    if (sample_.tool >= 0) motion.tool = sample_.tool;
    if (spindle_told && !options_.beam) {
      motion.spindle = spindle();
      motion.spindle_rpm = turning_speed(motion.spindle);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const double stands_deg = now.place.abc_deg[i];
      const bool elsewhere = std::abs(stands_deg - motion.to_abc_deg[i]) > kTurned_deg;
      if (point.turned[i] || !now.abc_known[i] || !elsewhere) continue;
      motion.from_abc_deg[i] = motion.to_abc_deg[i] = stands_deg;
    }
    for (int i = 0; i < 3; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      if (point.slid[axis] || !now.uvw_known[axis]) continue;
      motion.from_uvw_mm[i] = motion.to_uvw_mm[i] = now.place.uvw_mm[i];
    }
    take_real_length(now, motion);
    facts_.path_mm += path_length_mm(motion);
    cut(motion, of_same_piece ? DrivenRun::Way::kNextPart : DrivenRun::Way::kPart,
        planned_s > 0 ? duration_s * share_s / planned_s : 0);
  }
}

/// Where the path is, with what the program has not turned where it really is.
ProgramPlace LiveCutter::place_on_path(const Sighting& now, const FollowedPoint& point) {
  ProgramPlace place = point.place;
  if (now.length_is_applied && !now.by_length_before) {
    place.tip_mm += now.real_shift_mm - point.tip_shift_mm;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (!point.turned[i] && now.abc_known[i]) place.abc_deg[i] = now.place.abc_deg[i];
    const auto axis = static_cast<int>(i);
    if (!point.slid[i] && now.uvw_known[i]) place.uvw_mm[axis] = now.place.uvw_mm[axis];
  }
  return place;
}

void LiveCutter::take(const AxisSample& sample, double t_s, bool lost) {
  ++facts_.samples;
  lost |= std::exchange(lost_wild_, false);
  if (drop_wild(sample, t_s)) {
    lost_wild_ = lost;
    return;
  }
  passed_.clear();
  if (const std::size_t wild = gate_.take({sample, t_s, lost}, passed_)) note_wild(wild, t_s);
  for (const SampleGate::Timed& one : passed_) take_sound(one.sample, one.t_s, one.lost);
}

void LiveCutter::take_sound(const AxisSample& sample, double t_s, bool lost) {
  sample_ = sample;
  t_s_ = t_s;
  note_spindle();
  if (run_.is_long(t_s_)) cut_run();
  std::optional<Sighting> seen = see(sample, t_s);
  if (!seen) return;
  Sighting& now = *seen;
  const double elapsed_s = before_ ? now.t_s - before_->t_s : 0;
  const FollowedPoint point = follow(now, elapsed_s);
  place_real_tip(now, point);
  const MachineKinematics* const machine = switched_machine();
  if (before_ && machine && machine->type(kinematics_type_).mode == KinematicsMode::kArm) {
    now.place.abc_deg = nearest_turns(now.place.abc_deg, before_->place.abc_deg);
  }
  now.pose = pose_in_workpiece(now);
  place_.known = true;
  place_.tool_pose = now.pose;
  place_.tip_mm = now.pose.origin_mm;
  const ToolPath* const path = stage_.machine_path();
  place_.turns = path && stock_.takes_tilted_tools();
  if (place_.turns) {
    place_.spindle = now.pose.direction(path->machine().nose_from_tip);
  }
  place_.abc_deg = now.place.abc_deg;
  place_.uvw_mm = now.place.uvw_mm;
  place_.tool = now.tool >= 0 ? now.tool : point.on_path ? point.tool : program_tool_;
  place_.followed = point.on_path;
  place_.distance_mm = point.distance_mm;
  if (point.on_path) {
    if (first_line_ == 0) first_line_ = point.source.line;
    place_.source = point.source;
    place_.program_s = point.program_s;
    program_tool_ = point.tool;
    ++facts_.on_path;
    facts_.following_max_mm = std::max(facts_.following_max_mm, point.distance_mm);
    facts_.following_sum_mm += point.distance_mm;
  }
  double driven_mm = 0;
  for (const PathFollower::DrivenPart& part : driven_) driven_mm += path_length_mm(part.motion);
  if (!options_.turret) note_turn(now);  // what turns there is the punch
  note_unseen_axes(now);
  note_tool(now, point, driven_mm);
  // Out of sight it may have stood, and may be moved by hand.
  if (is_long(elapsed_s) && !stood_mm_) stood_mm_ = facts_.path_mm;
  note_off_path(now, point);
  place_.off_path = off_path_event_.has_value();
  const bool first = !before_;
  bool way_seen = false;  ///< from the sample before
  if (before_) {
    // A machine that stands while its tool length changes: the new tip is elsewhere, and has moved
    // through nothing.
    const double change_mm = before_->tool_length_mm - now.tool_length_mm;
    before_->place.tip_mm += change_mm * before_->place.along_tool;
    cut_to_.tip_mm += change_mm * before_->place.along_tool;
    if (before_->tool != now.tool && before_->tool >= 0) ++facts_.tool_changes;
    const Break gap = break_between(*before_, now, lost);
    was_fast_ = too_fast(*before_, now);
    period_s_ += kPeriodShare * (std::min(elapsed_s, options_.gap_s) - period_s_);
    // Along its program, it was found again where it can have come to meanwhile.
    const bool by_program =
        gap == Break::kGap && point.on_path && point.in_reach && was_on_path_ && !options_.turret;
    if (gap != Break::kNone) note_gap(*before_, now, gap == Break::kJump, by_program);
    way_seen = gap == Break::kNone || options_.gap == GapPolicy::kCut || by_program;
    if (!way_seen) {
      guard_stale_ = true;
    } else if (options_.turret) {
      (point.on_path && was_on_path_ ? facts_.path_mm : facts_.chord_mm) +=
          glm::length(now.place.tip_mm - before_->place.tip_mm);
    } else if (point.on_path && was_on_path_) {
      cut_path(now, point, elapsed_s);
    } else {
      Sighting to = now;
      if (point.on_path) to.place = place_on_path(now, point);
      cut_chord(cut_to_, to, elapsed_s, true);
    }
  }
  if (options_.turret) punch(now, point, way_seen);
  cut_to_ = point.on_path ? place_on_path(now, point) : now.place;
  was_on_path_ = point.on_path;
  before_ = now;
  if (first) guard_stale_ = true;
}

bool LiveCutter::finished() const {
  return ahead_ && ahead_->complete() && follower_.found() && follower_.left_s() <= kEnd_s;
}

void LiveCutter::settle() {
  cut_run();
  stage_.complete();
}

/// What the machine says, or while it says next to nothing what it was told last.
double LiveCutter::turning_speed(SpindleState state) const {
  const double rpm = std::abs(sample_.spindle_rpm);
  return state != SpindleState::kStopped && rpm < kStanding_rpm ? std::abs(turning_rpm_) : rpm;
}

/// Between programs a machine may have any tool, or, that has just been switched on, none that it
/// knows.
bool LiveCutter::is_idle() const {
  if (!runs_ || sample_.program == ProgramState::kIdle) return true;
  const bool other_tool = place_.tool >= 0 && place_.tool != program_tool_;
  return sample_.program == ProgramState::kUnknown && sample_.line == 0 && other_tool;
}

void LiveCutter::look() {
  stage_.complete();
  if (!looks_ahead_ || is_idle() || !guard_ || !follower_.found() || follower_.passed_all()) return;
  if (std::exchange(guard_stale_, false)) guard_->restart(stock_, stage_, work());
  if (stage_.torch()) {
    if (ahead_->take_materials(materials_)) stage_.set_materials(materials_);
    guard_->set_materials(materials_);
  }
  const std::size_t before = warnings_.size();
  guard_->look(*ahead_, follower_.program_s(), program_tool_, place_.tool, warnings_);
  for (std::size_t i = before; i < warnings_.size(); ++i) warnings_[i].t_s = t_s_;
}

void LiveCutter::finish() {
  passed_.clear();
  gate_.finish(passed_);
  for (const SampleGate::Timed& one : passed_) take_sound(one.sample, one.t_s, one.lost);
  cut_run();
  if (ahead_) check_passed(std::numeric_limits<double>::infinity());
  if (ahead_ && options_.turret) punch_rest();
  stage_.finish(false);
  if (ahead_) ahead_->stop();
}

}  // namespace kerf
