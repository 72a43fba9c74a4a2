#include "twin/live/live_cutter.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "interp_bridge/motion_kinds.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// Only milling cuts are worked out.
CuttingWish cutting_wish(const StockModel& stock, const LiveCutOptions& options) {
  CuttingWish wish = options.checks.cutting;
  if (stock.sheet()) wish.material.reset();
  return wish;
}

}  // namespace

LiveCutter::LiveCutter(StockModel& stock, const ToolSources& tools, FindingLog& log,
                       LiveCutOptions options, std::unique_ptr<Program> program)
    : stock_(stock),
      options_(std::move(options)),
      matcher_(options_),
      cutter_(stock, tools, log, options_, facts_),
      spindle_(options_.process->traits().is_beam),
      source_watch_(stock, options_, log, facts_),
      machine_watch_(stock, options_, log),
      path_watch_(options_, matcher_, log, facts_),
      loads_(cutting_wish(stock, options_), log),
      look_ahead_(tools, options_),
      late_join_(options_, matcher_, cutter_, punch_) {
  if (program) follow_program(std::move(program));
  if (options_.process->turret()) {
    punch_.emplace(options_, matcher_, cutter_.stage(), machine_watch_, log);
  }
  cutter_.stage().set_frame(work());
  cutter_.stage().hear_loads(loads_);
}

void LiveCutter::follow_program(std::unique_ptr<Program> program) {
  matcher_.take_up(std::move(program));
  cutter_.set_program(matcher_.program());
  look_ahead_.begin();
}

void LiveCutter::read_again(std::unique_ptr<Program> program,
                            std::function<std::unique_ptr<Program>()> reopen) {
  look_ahead_.end();
  options_.reopen = std::move(reopen);
  follow_program(std::move(program));
}

std::optional<std::array<double, 9>> LiveCutter::start_at(const AxisSample& sample) const {
  if (source_watch_.is_beyond(sample)) return std::nullopt;
  // Of the first kinematics: a program begins under them.
  const auto pose = matcher_.pose_of(sample, 0);
  return pose ? std::optional(matcher_.frame().machine_place_of(*pose)) : std::nullopt;
}

void LiveCutter::take(const AxisSample& sample, double t_s, bool lost) {
  ++facts_.samples;
  lost |= std::exchange(lost_wild_, false);
  if (source_watch_.drops(sample, t_s)) {
    t_s_ = t_s;
    restarted_ |= sample.restarted;
    lost_wild_ = lost;
    return;
  }
  for (const SampleGate::Timed& one : source_watch_.sift(sample, t_s, lost)) {
    take_sound(one.sample, one.t_s, one.lost);
  }
}

void LiveCutter::take_sound(const AxisSample& sample, double t_s, bool lost) {
  sample_ = sample;
  t_s_ = t_s;
  restarted_ |= sample.restarted;
  spindle_.take(sample, t_s);
  loads_.take(sample, t_s);
  cutter_.cut_long_run(t_s);
  std::optional<Reading> seen = see(sample, t_s);
  if (!seen) return;
  Reading& now = *seen;
  now.restarted = std::exchange(restarted_, false);
  const double elapsed_s = before_ ? now.t_s - before_->t_s : 0;
  const PathMatch point = match(now, elapsed_s);
  place_tool(now, point);
  show(now, point);
  watch(now, point, elapsed_s);
  const bool way_seen = before_ && way_is_seen(now, point, lost);
  if (punch_) {
    punch_way(now, point, way_seen);
  } else if (way_seen) {
    cut_way(now, point);
  }
  cutter_.stand_at(point.on_path ? PathMatcher::place_on_path(now, point) : now.place);
  was_on_path_ = point.on_path;
  if (!way_seen) look_ahead_.outdate();
  before_ = now;
}

/// The machine as the sample shows it.
std::optional<Reading> LiveCutter::see(const AxisSample& sample, double t_s) {
  const LiveFrame& frame = matcher_.frame();
  const auto pose = matcher_.pose_of(sample, matcher_.kinematics_type());
  if (!pose) {
    ++facts_.incomplete;
    place_.known = false;
    place_.missing_axes = frame.missing_axes(sample);
    return std::nullopt;
  }
  // A punch has no length that could matter.
  if (!pose->length_known && !punch_) machine_watch_.note_length(frame.tool_of(sample), t_s);
  if (!options_.frame.workpiece_frame) {
    machine_watch_.note_limits(pose->machine_mm, sample.line, t_s);
  }
  place_.machine_mm = pose->machine_mm;
  place_.spindle_rpm = sample.spindle_rpm;
  return matcher_.reading_of(sample, *pose, t_s);
}

/// Where on the path it is, with what the program then tells of it.
PathMatch LiveCutter::match(Reading& now, double elapsed_s) {
  matcher_.begin();
  PathMatch point;
  point.distance_mm = std::numeric_limits<double>::infinity();
  if (!matcher_.program() || !runs_) return point;
  matcher_.read_ahead();
  const MatchQuery query = matcher_.query_of(now, elapsed_s);
  point = found() ? matcher_.follow(query) : join(query);
  if (!point.on_path && before_ && was_on_path_) {
    matcher_.follow_by_length_before(query, *before_, now, point);
  }
  if (point.on_path && point.kinematics_type != matcher_.kinematics_type()) {
    // What waits to be cut is in the numbers of the kinematics before.
    cutter_.cut_run();
    Reading* const before = before_ ? &*before_ : nullptr;
    matcher_.take_kinematics(point.kinematics_type, query.without_length, now, before);
    if (before) cutter_.stand_at(before->place);
  }
  if (query.without_length) {
    now.tool_length_mm = point.tool_length_mm;
    now.place.tip_mm -= point.tool_length_mm * now.place.along_tool;
  }
  check_passed(matcher_.follower().program_s());
  // Strokes hang on motions that do not move, too: PunchFollower forgets them.
  if (!punch_) matcher_.program()->forget_before(matcher_.follower().program_s());
  return point;
}

PathMatch LiveCutter::join(const MatchQuery& query) {
  const LateJoin::Found found = late_join_.find(query, path_watch_.lost_sight_s(), t_s_);
  if (!found.late) return found.point;
  if (!options_.seen_before) path_watch_.note_late_start(query, t_s_);
  look_ahead_.outdate();
  return found.point;
}

/// What the machine has behind it.
void LiveCutter::check_passed(double until_s) {
  if (!found()) return;
  const double program_s = matcher_.follower().program_s();
  for (const PlannedMotion& planned : matcher_.program()->motions()) {
    if (planned.start_s >= program_s || planned.end_s >= until_s) break;
    TimedStep step;
    step.start_s = t_s_;
    cutter_.stage().check_whole(planned.motion, step);
  }
}

/// Its real tip, and the tool in the workpiece.
void LiveCutter::place_tool(Reading& now, const PathMatch& point) {
  PathMatcher::place_real_tip(now, point);
  if (matcher_.note_real_tip(now, point)) look_ahead_.outdate();
  const MachineKinematics* const machine = matcher_.switched_machine();
  const int type = matcher_.kinematics_type();
  if (before_ && machine && machine->type(type).mode == KinematicsMode::kArm) {
    now.place.abc_deg = nearest_turns(now.place.abc_deg, before_->place.abc_deg);
  }
  now.pose = cutter_.pose_in_workpiece(now, type);
}

void LiveCutter::show(const Reading& now, const PathMatch& point) {
  place_.known = true;
  place_.tool_pose = now.pose;
  place_.tip_mm = now.pose.origin_mm;
  const ToolPath* const path = stage().machine_path();
  place_.turns = path && stock_.takes_tilted_tools();
  if (place_.turns) place_.spindle = now.pose.direction(path->machine().nose_from_tip);
  place_.abc_deg = now.place.abc_deg;
  place_.uvw_mm = now.place.uvw_mm;
  place_.tool_length_mm = now.tool_length_mm;
  place_.tool = now.tool >= 0 ? now.tool : point.on_path ? point.tool : matcher_.program_tool();
  place_.followed = point.on_path;
  place_.distance_mm = point.distance_mm;
  place_.in_corner = point.corner == RoundedCorner::kRight;
  if (!place_.has_program_place()) return;
  place_.source = point.source;
  place_.program_s = point.program_s;
  if (!point.on_path) return;
  if (first_line_ == 0) first_line_ = point.source.line;
  matcher_.note_program_tool(point);
  ++facts_.on_path;
  facts_.following_max_mm = std::max(facts_.following_max_mm, point.distance_mm);
  facts_.following_sum_mm += point.distance_mm;
}

void LiveCutter::watch(const Reading& now, const PathMatch& point, double elapsed_s) {
  if (!punch_) machine_watch_.note_turn(now, place_.source);  // what turns there is the punch
  machine_watch_.note_unseen_axes(now, stage().machine_path());
  if (path_watch_.note_tool(now, point, matcher_.driven_mm())) look_ahead_.outdate();
  if (source_watch_.is_long(elapsed_s)) path_watch_.note_out_of_sight();
  path_watch_.note_off_path(now, point, elapsed_s, doubtful_);
  place_.off_path = path_watch_.is_off_path();
}

/// The machine has gone from the sample before to this one, as far as anybody knows.
bool LiveCutter::way_is_seen(const Reading& now, const PathMatch& point, bool lost) {
  Reading& before = *before_;
  // A machine that stands while its tool length changes: the new tip is elsewhere, and has moved
  // through nothing.
  const double change_mm = before.tool_length_mm - now.tool_length_mm;
  const Vec3 by_mm = change_mm * before.place.along_tool;
  before.place.tip_mm += by_mm;
  cutter_.move_tip(by_mm);
  if (before.tool != now.tool && before.tool >= 0) ++facts_.tool_changes;
  using Break = SourceWatch::Break;
  const Break gap = source_watch_.break_between(before, now, lost);
  if (gap == Break::kNone) return true;
  if (gap == Break::kRestart) {
    source_watch_.note_restart(before, now, runs_, place_.source);
    return false;
  }
  // Along its program, it was found again where it can have come to meanwhile.
  const bool by_program =
      gap == Break::kGap && point.on_path && point.in_reach && was_on_path_ && !punch_;
  source_watch_.note_gap(before, now, gap == Break::kJump, by_program, place_.source);
  return by_program || options_.gap == GapPolicy::kCut;
}

void LiveCutter::cut_way(const Reading& now, const PathMatch& point) {
  const SpindleNow spindle = spindle_now();
  if (!point.on_path || !was_on_path_) return cut_chord(now, point, spindle);
  cutter_.cut_path(matcher_.driven(), *before_, now, point, now.t_s - before_->t_s, spindle);
}

/// Beside the path, to it or from it.
void LiveCutter::cut_chord(const Reading& now, const PathMatch& point, const SpindleNow& spindle) {
  const double duration_s = now.t_s - before_->t_s;
  Reading to = now;
  if (point.on_path) to.place = PathMatcher::place_on_path(now, point);
  const WayState state{spindle, matcher_.kinematics_type(), matcher_.program_tool()};
  const std::optional<Motion> chord = cutter_.chord_to(to, duration_s, state);
  if (!chord) return;
  if (!matcher_.program()) machine_watch_.note_unseen_beam(to);
  if (runs_) path_watch_.note_foreign_program(to, duration_s);
  cutter_.cut(*chord, DrivenRun::Way::kStraight, duration_s, t_s_);
  // The workpiece is no longer what the program makes of it.
  look_ahead_.outdate();
}

void LiveCutter::punch_way(const Reading& now, const PathMatch& point, bool seen) {
  const bool along = seen && point.on_path && was_on_path_;
  using Way = PunchFollower::Way;
  Way way = before_ ? Way::kUnseen : Way::kFirst;
  if (seen) {
    way = along ? Way::kAlongPath : Way::kStraight;
    const double way_mm = glm::length(now.place.tip_mm - before_->place.tip_mm);
    (along ? facts_.path_mm : facts_.chord_mm) += way_mm;
  }
  if (punch_->take(now, point, way)) look_ahead_.outdate();
}

/// On the way to the last sample.
SpindleNow LiveCutter::spindle_now() const {
  const bool idle =
      sample_.program == ProgramState::kIdle ||
      (sample_.program == ProgramState::kUnknown && program() && path_watch_.has_stood());
  return spindle_.now(sample_, t_s_, before_ ? t_s_ - before_->t_s : 0, idle);
}

bool LiveCutter::has_cut_all() const {
  if (finished()) return true;
  const ProgramAhead* const ahead = program();
  if (!ahead || !ahead->complete() || !found() || punch_) return false;
  const double from_s = matcher_.follower().program_s() + kProgramEnd_s;
  return std::none_of(
      ahead->motions().begin(), ahead->motions().end(),
      [&](const PlannedMotion& left) { return left.end_s > from_s && is_feed(left.motion); });
}

void LiveCutter::settle() {
  cutter_.cut_run();
  cutter_.stage().complete();
}

/// Between programs a machine may have any tool, or, that has just been switched on, none that it
/// knows.
bool LiveCutter::is_idle() const {
  if (!runs_ || sample_.program == ProgramState::kIdle) return true;
  const bool other_tool = place_.tool >= 0 && place_.tool != matcher_.program_tool();
  if (sample_.program != ProgramState::kUnknown || !other_tool) return false;
  // One that tells no lines stands at a program's beginning as well as it may be on it.
  const bool drives = path_watch_.mismatch_mm() >= PathWatch::kMismatch_mm;
  return sample_.line == 0 || (sample_.line < 0 && !drives);
}

void LiveCutter::look() {
  cutter_.stage().complete();
  loads_.judge(t_s_ - LoadWatch::kDelay_s);
  if (!is_idle()) look_ahead_.look(stock_, cutter_, matcher_, place_.tool, t_s_);
}

void LiveCutter::finish() {
  for (const SampleGate::Timed& one : source_watch_.finish()) {
    take_sound(one.sample, one.t_s, one.lost);
  }
  cutter_.cut_run();
  if (program()) check_passed(std::numeric_limits<double>::infinity());
  if (punch_) punch_->finish(was_on_path_, t_s_);
  cutter_.stage().complete();
  loads_.judge(t_s_);
  cutter_.stage().finish(false);
  matcher_.stop();
}

}  // namespace kerf
