#include "twin/live/live_cutter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "twin/motion_geometry.h"
#include "twin/motion_nearest.h"
#include "twin/stock_choice.h"

namespace kerf {
namespace {

/// Sensors tremble: a machine that moved less has not moved. mm.
constexpr double kStill_mm = 1e-6;
/// What happens across a gap in which a machine moved less is nothing. mm.
constexpr double kGapMove_mm = 0.02;
/// Positions beyond the machine's limits by so much for so long are not its own.
constexpr double kBeyond_mm = 1.0;
constexpr double kBeyond_s = 2.0;
/// Lost samples leave a gap if it is longer than this, and than so many usual periods.
constexpr double kShortGap_s = 0.05;
constexpr double kShortGapPeriods = 4;
/// Share of a new interval in the usual period.
constexpr double kPeriodShare = 0.05;
/// Program time that is planned beyond what is looked at, so that the follower has where to look.
constexpr double kPlannedAhead_s = 6.0;
/// A jump is faster than the machine by this factor, and longer than this.
constexpr double kJumpFactor = 1.5;
constexpr double kJump_mm = 1.0;
/// A spindle slower than this stands. rpm.
constexpr double kStanding_rpm = 1.0;
/// Driven with the wrong tool: the program goes on without having changed it. mm.
constexpr double kMismatch_mm = 1.0;
/// A machine that says it runs, and is not seen at the program's beginning, is looked for in all of
/// it after so long.
constexpr double kJoin_s = 0.3;
/// And again, should it not be found, after so many times as long.
constexpr double kJoinAgain = 4;
/// A machine that says it runs the program for so long without being seen on its path is off it.
constexpr double kNeverSeen_s = 1.0;
/// An axis that has turned by less stands. Degrees.
constexpr double kTurned_deg = 0.01;

Finding finding_of(FindingId id, Severity severity, double t_s, const Vec3& place, int tool) {
  Finding finding;
  finding.id = id;
  finding.severity = severity;
  finding.time_s = t_s;
  finding.position_mm = place;
  if (tool >= 0) finding.tool = tool;
  return finding;
}

}  // namespace

LiveCutter::LiveCutter(StockModel& stock, const ToolSources& tools, FindingLog& log,
                       LiveCutOptions options, std::unique_ptr<Program> program)
    : stock_(stock),
      log_(log),
      options_(std::move(options)),
      frame_(options_.frame),
      book_(tools, row_of(stock).can_cut),
      stage_(stock, book_, log, options_.timeline),
      follower_(options_.follow),
      join_after_s_(kJoin_s) {
  if (program) {
    ahead_ = std::make_unique<ProgramAhead>(std::move(program), options_.timeline, follower_);
    adopt_program_frame();
    if (options_.guard_s > 0) {
      guard_ = std::make_unique<LookAheadGuard>(tools, options_.timeline, options_.guard_s);
    }
  }
  stage_.set_frame(work());
}

void LiveCutter::adopt_program_frame() {
  const std::optional<WorkpieceFrame> frame = ahead_->wait_for_frame();
  if (frame && !options_.work_known) frame_.set_work(*frame);
}

SpindleState LiveCutter::spindle() const {
  // What nobody tells cannot be found wrong.
  if (std::isnan(sample_.spindle_rpm)) return SpindleState::kClockwise;
  if (std::abs(sample_.spindle_rpm) < kStanding_rpm) return SpindleState::kStopped;
  return sample_.spindle_rpm > 0 ? SpindleState::kClockwise : SpindleState::kCounterclockwise;
}

/// The machine as the sample shows it. With the program's tool lengths the tip is that of a tool of
/// no length, until follow() has found where in the program the machine is.
std::optional<LiveCutter::Sighting> LiveCutter::see(const AxisSample& sample, double t_s) {
  const bool by_program = ahead_ && options_.program_lengths;
  const auto pose = frame_.pose_of(sample, by_program ? std::optional<double>(0.0) : std::nullopt);
  if (!pose) {
    ++facts_.incomplete;
    place_.known = false;
    place_.missing_axes = frame_.missing_axes(sample);
    return std::nullopt;
  }
  if (!pose->length_known) note_length(frame_.tool_of(sample), t_s);
  if (!options_.frame.workpiece_frame) note_limits(pose->machine_mm, t_s);
  place_.machine_mm = pose->machine_mm;
  place_.abc_deg = pose->abc_deg;
  place_.spindle_rpm = sample.spindle_rpm;
  Sighting now;
  now.tip_mm = pose->tip_mm;
  now.t_s = t_s;
  now.tool_length_mm = pose->tool_length_mm;
  // A program that is followed knows better than a configuration that says one tool for all.
  const bool by_configuration = !ahead_ || program_tool_ < 0;
  now.tool = by_configuration ? frame_.tool_of(sample) : sample.tool;
  now.abc_deg = pose->abc_deg;
  return now;
}

FollowedPlace LiveCutter::place_of(const Sighting& now, const AxisSample& sample,
                                   double elapsed_s) const {
  FollowedPlace place;
  place.tip_mm = now.tip_mm;
  const ToolLengthFrom from = options_.frame.tool_length;
  place.without_length = options_.program_lengths && !options_.frame.workpiece_frame &&
                         (from == ToolLengthFrom::kProgram ||
                          (from == ToolLengthFrom::kAuto && std::isnan(sample.tool_offset_z_mm)));
  place.elapsed_s = elapsed_s;
  place.line = sample.line;
  place.tool = sample.tool;
  return place;
}

FollowedPoint LiveCutter::follow(Sighting& now, const AxisSample& sample, double elapsed_s) {
  driven_.clear();
  FollowedPoint point;
  point.distance_mm = std::numeric_limits<double>::infinity();
  if (!ahead_) return point;
  ahead_->read_until(follower_.program_s() + options_.guard_s + kPlannedAhead_s,
                     options_.wait_for_program);
  const FollowedPlace place = place_of(now, sample, elapsed_s);
  const PathFollower::Drive drive = [this](const Motion& motion, double duration_s) {
    driven_.emplace_back(motion, duration_s);
  };
  point = follower_.follow(place, drive);
  if (!point.on_path && !follower_.found() && lost_sight_s_ >= join_after_s_ && join(place)) {
    point = follower_.follow(place, drive);
    driven_.clear();  // the way to where it was first seen has not been seen
  }
  if (place.without_length) {
    now.tool_length_mm = point.tool_length_mm;
    now.tip_mm.z -= point.tool_length_mm;
  }
  ahead_->forget_before(follower_.program_s());
  return point;
}

/// A machine that was running when we came: finds where in the program it is, and takes what lies
/// before as cut. False if it cannot be told.
bool LiveCutter::join(const FollowedPlace& place) {
  join_after_s_ *= kJoinAgain;
  const std::optional<std::uint64_t> motion = motion_at(place);
  if (!motion) return false;
  cut_before(*motion);
  Finding finding =
      finding_of(FindingId::kLateStart, Severity::kNote, t_s_, place.tip_mm, place.tool);
  finding.source = {0, static_cast<std::uint32_t>(place.line)};
  finding.text =
      "the machine was here already when it was first seen; what the program cuts before is taken "
      "as cut";
  log_.add(std::move(finding));
  guard_stale_ = true;
  return true;
}

/// Number of the first motion of the machine's line that its tip is on.
std::optional<std::uint64_t> LiveCutter::motion_at(const FollowedPlace& place) const {
  if (!options_.reopen || place.line <= 0) return std::nullopt;
  const std::unique_ptr<Program> program = options_.reopen();
  if (!program) return std::nullopt;
  std::optional<std::uint64_t> found;
  std::uint64_t number = 0;
  Diagnostics ignored;
  program->run(
      [&](std::span<const Motion> motions) {
        for (const Motion& m : motions) {
          const bool here = m.source.file == 0 && m.start_known &&
                            m.source.line == static_cast<std::uint32_t>(place.line) &&
                            (m.kind == MotionKind::kTraverse || is_feed(m));
          if (here &&
              nearest_on(m, tip_on(m, place), 0).distance_mm <= options_.follow.tolerance_mm) {
            found = number;
            return false;
          }
          ++number;
        }
        return true;
      },
      {}, ignored);
  return found;
}

/// Without a word.
void LiveCutter::cut_before(std::uint64_t motion) {
  stage_.hold_reports();
  double begin_s = 0;
  while (ahead_->forgotten() + ahead_->motions().size() <= motion) {
    for (const PlannedMotion& planned : ahead_->motions()) begin_s = planned.end_s;
    cut_planned(ahead_->motions().size());
    follower_.begin_at(begin_s);
    const std::uint64_t before = ahead_->forgotten();
    ahead_->read_until(begin_s + kPlannedAhead_s, true);
    if (ahead_->motions().empty() && ahead_->forgotten() == before && ahead_->complete()) break;
  }
  const auto left = static_cast<std::size_t>(motion - ahead_->forgotten());
  if (left < ahead_->motions().size()) begin_s = ahead_->motions()[left].start_s;
  cut_planned(std::min(left, ahead_->motions().size()));
  follower_.begin_at(begin_s);
  stage_.release_reports();
}

/// The first `count` motions that have been planned, as the program has them.
void LiveCutter::cut_planned(std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) cut(ahead_->motions()[i].motion, 0);
  ahead_->forget(count);
}

bool LiveCutter::too_fast(const Sighting& before, const Sighting& now) const {
  const double way_mm = glm::length(now.tip_mm - before.tip_mm);
  return way_mm > kJump_mm &&
         way_mm > kJumpFactor * options_.most_mm_per_s * (now.t_s - before.t_s);
}

LiveCutter::Break LiveCutter::break_between(const Sighting& before, const Sighting& now,
                                            bool lost) const {
  const double way_mm = glm::length(now.tip_mm - before.tip_mm);
  if (way_mm < kGapMove_mm) return Break::kNone;
  const double elapsed_s = now.t_s - before.t_s;
  // A sample that is missing in a quick row is no gap: the way is as short as between slow ones.
  const bool felt = lost && elapsed_s > std::max(kShortGap_s, kShortGapPeriods * period_s_);
  if (felt || elapsed_s > options_.gap_s) return Break::kGap;
  // One jump is none of a machine; one after the other is a machine that is faster than is known.
  return too_fast(before, now) && !was_fast_ ? Break::kJump : Break::kNone;
}

/// Within boxes.
bool LiveCutter::near_stock(const Vec3& from_mm, const Vec3& to_mm, double radius_mm) const {
  const Box blank = stock_.bounds_mm();
  Box way;
  way.extend(from_mm);
  way.extend(to_mm);
  return way.min.z < blank.max.z && way.min.x - radius_mm < blank.max.x &&
         way.max.x + radius_mm > blank.min.x && way.min.y - radius_mm < blank.max.y &&
         way.max.y + radius_mm > blank.min.y;
}

/// Once a tool. With no tool in the spindle, or none that is known of, nothing is taken for
/// granted.
void LiveCutter::note_length(int tool, double t_s) {
  if (tool <= 0 || tool == length_told_) return;
  length_told_ = tool;
  Finding finding;
  finding.id = FindingId::kLengthUnknown;
  finding.severity = Severity::kWarning;
  finding.time_s = t_s;
  finding.tool = tool;
  finding.text = fmt::format(
      "nothing tells the length of tool {} (the source does not, and no tool table has it): its "
      "tip "
      "is taken to be where the machine's position is (machine.tool_length: none says so, too)",
      tool);
  log_.add(std::move(finding));
}

/// Positions of another machine, or in another unit. One that is not homed may be anywhere for a
/// while; while it says that it runs no program, for as long as it likes.
void LiveCutter::note_limits(const Vec3& machine_mm, double t_s) {
  if (beyond_told_) return;
  int beyond = -1;
  for (int i = 0; i < 3; ++i) {
    const AxisLimits& axis = options_.timeline.limits.axes[static_cast<std::size_t>(i)];
    const bool outside =
        machine_mm[i] < axis.min - kBeyond_mm || machine_mm[i] > axis.max + kBeyond_mm;
    if (axis.present && outside) beyond = i;
  }
  if (beyond < 0 || sample_.line == 0) {
    beyond_since_s_.reset();
    return;
  }
  if (!beyond_since_s_) beyond_since_s_ = t_s;
  if (t_s - *beyond_since_s_ < kBeyond_s) return;
  beyond_told_ = true;
  const AxisLimits& axis = options_.timeline.limits.axes[static_cast<std::size_t>(beyond)];
  Finding finding;
  finding.id = FindingId::kAxisLimit;
  finding.severity = Severity::kWarning;
  finding.time_s = t_s;
  finding.text = fmt::format(
      "{} stands at {:.2f}, beyond the limits of the machine ({:g} to {:g}): are these positions "
      "of "
      "another machine, or in another unit?",
      "XYZ"[beyond], machine_mm[beyond], axis.min, axis.max);
  log_.add(std::move(finding));
}

void LiveCutter::note_gap(const Sighting& before, const Sighting& now, bool jump) {
  const double way_mm = glm::length(now.tip_mm - before.tip_mm);
  const double elapsed_s = now.t_s - before.t_s;
  // A machine that is homed says that it is elsewhere, and has not moved.
  const bool harmless = jump && !near_stock(before.tip_mm, before.tip_mm, 0) &&
                        !near_stock(now.tip_mm, now.tip_mm, 0);
  ++(harmless ? facts_.jumps : facts_.gaps);
  if (!harmless) {
    facts_.gap_s += elapsed_s;
    facts_.gap_max_mm = std::max(facts_.gap_max_mm, way_mm);
  }
  if (options_.gap == GapPolicy::kIgnore) return;
  Finding finding =
      finding_of(FindingId::kSourceGap, harmless ? Severity::kNote : Severity::kWarning, now.t_s,
                 now.tip_mm, now.tool);
  finding.source = place_.source;
  const char* const what_then = options_.gap == GapPolicy::kCut
                                    ? "the way between is cut all the same"
                                    : "the way between is not cut (gap: cut would)";
  if (jump) {
    finding.text = fmt::format(
        "positions jump by {:.2f} mm within {:.3f} s, faster than the machine can be (homing? a "
        "wrong reading?); {}",
        way_mm, elapsed_s, what_then);
  } else {
    finding.text = fmt::format("no positions for {:.3f} s, the machine is {:.2f} mm further on; {}",
                               elapsed_s, way_mm, what_then);
  }
  if (before.tool != now.tool) {
    finding.text +=
        fmt::format("; the tool was changed meanwhile, from {} to {}", before.tool, now.tool);
  }
  log_.add(std::move(finding));
}

/// Once: A, B or C stand elsewhere than where they were first seen, and the model knows upright
/// tools over a workpiece that lies still.
void LiveCutter::note_turn(const Sighting& now) {
  if (!first_abc_deg_) first_abc_deg_ = now.abc_deg;
  if (turn_told_ || stock_.takes_tilted_tools()) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const double turned_deg = now.abc_deg[i] - (*first_abc_deg_)[i];
    if (!(std::abs(turned_deg) > kTurned_deg)) continue;
    turn_told_ = true;
    Finding finding =
        finding_of(FindingId::kRotaryIgnored, Severity::kError, now.t_s, now.tip_mm, now.tool);
    finding.source = place_.source;
    finding.text = fmt::format(
        "{} has turned by {:.2f} degrees, and the model {} is for upright tools over a workpiece "
        "that lies still: it is cut as if A, B and C stood (--model octree follows them)",
        "ABC"[i], turned_deg, stock_.name());
    log_.add(std::move(finding));
    return;
  }
}

/// The machine has another tool than the program has where the machine is.
void LiveCutter::note_tool(const Sighting& now, const FollowedPoint& point, double driven_mm) {
  if (!point.on_path || sample_.tool < 0) return;
  if (sample_.tool == point.tool) {
    mismatch_told_ = false;
    mismatch_mm_ = 0;
    return;
  }
  // A machine that stands may have its new tool already, while its length is still the old one's.
  mismatch_mm_ += driven_mm;
  if (mismatch_mm_ < kMismatch_mm) return;
  if (std::exchange(mismatch_told_, true)) return;
  guard_stale_ = true;
  Finding finding =
      finding_of(FindingId::kToolMismatch, Severity::kError, now.t_s, now.tip_mm, now.tool);
  finding.source = point.source;
  finding.text = fmt::format("the machine has tool {} in the spindle where the program has tool {}",
                             now.tool, point.tool);
  log_.add(std::move(finding));
}

void LiveCutter::note_off_path(const Sighting& now, const FollowedPoint& point) {
  const bool searched = std::isfinite(point.distance_mm);
  if (point.on_path || !searched || follower_.passed_all()) {
    off_path_event_.reset();
    lost_sight_s_ = 0;
    return;
  }
  if (!follower_.found()) {
    // Before the program begins a machine may be anywhere; while it says that it runs, it may not.
    const double elapsed_s = before_ ? now.t_s - before_->t_s : 0;
    const bool runs = sample_.line > 0 && sample_.line != ahead_->approach_line();
    lost_sight_s_ = runs ? lost_sight_s_ + elapsed_s : 0;
    if (lost_sight_s_ < kNeverSeen_s) return;
  }
  ++facts_.off_path;
  facts_.off_path_max_mm = std::max(facts_.off_path_max_mm, point.distance_mm);
  if (!off_path_event_) {
    Finding finding =
        finding_of(FindingId::kOffPath, Severity::kWarning, now.t_s, now.tip_mm, now.tool);
    finding.source = point.source;
    const Vec3 by = now.tip_mm - point.place_mm;
    finding.text = fmt::format(
        "the tip is not on the path of the program, it is beside it by X{:.3f} Y{:.3f} Z{:.3f}",
        by.x, by.y, by.z);
    off_path_event_ = log_.add(std::move(finding));
  }
  log_.deepen(*off_path_event_, point.distance_mm);
}

void LiveCutter::cut(const Motion& motion, double duration_s) {
  TimedStep step;
  step.start_s = t_s_;
  step.duration_s = duration_s;
  step.length_mm = path_length_mm(motion);
  step.programmed_mm_per_min = duration_s > 0 ? 60 * step.length_mm / duration_s : 0;
  step.allowed_mm_per_min = step.programmed_mm_per_min;
  stage_.take_timed(motion, step);
}

/// The straight line from where the cutter is to where the tip is.
void LiveCutter::cut_chord(const Vec3& from_mm, const Sighting& now, double duration_s,
                           bool off_path) {
  const double length_mm = glm::length(now.tip_mm - from_mm);
  const std::array<double, 3>& from_abc_deg = before_ ? before_->abc_deg : now.abc_deg;
  const bool turns = stock_.takes_tilted_tools() && from_abc_deg != now.abc_deg;
  if (length_mm < kStill_mm && !turns) return;
  Motion motion;
  motion.kind = MotionKind::kFeed;
  motion.spindle = spindle();
  motion.spindle_rpm = std::isnan(sample_.spindle_rpm) ? 0 : std::abs(sample_.spindle_rpm);
  motion.tool = std::max(0, now.tool >= 0 ? now.tool : program_tool_);
  motion.source = {0, sample_.line > 0 ? static_cast<std::uint32_t>(sample_.line) : 0};
  motion.from_mm = from_mm;
  motion.to_mm = now.tip_mm;
  // A model of upright tools is not asked about turns: note_turn() has told.
  motion.from_abc_deg = turns ? from_abc_deg : now.abc_deg;
  motion.to_abc_deg = now.abc_deg;
  motion.tool_offset_mm = {0, 0, now.tool_length_mm};
  motion.feed_mm_per_min = duration_s > 0 ? 60 * length_mm / duration_s : 0;
  facts_.chord_mm += length_mm;
  double radius_mm = 0;
  if (motion.tool > 0 || book_.has_arguments()) {
    const ResolvedTool& tool = book_.mount(motion.tool, 0);
    if (tool.cutter) radius_mm = tool.cutter->radius_mm();
  }
  // Jogging in the air needs no tool that is known.
  if (!stock_.takes_tilted_tools() && !near_stock(from_mm, now.tip_mm, radius_mm)) return;
  cut(motion, duration_s);
  // The workpiece is no longer what the program makes of it.
  guard_stale_ |= off_path;
}

/// What the follower has driven, with the tool and the spindle that the machine really has.
void LiveCutter::cut_path(double duration_s) {
  double planned_s = 0;
  for (const auto& [motion, share_s] : driven_) planned_s += share_s;
  const bool spindle_told = !std::isnan(sample_.spindle_rpm);
  for (auto& [motion, share_s] : driven_) {
    if (sample_.tool >= 0) motion.tool = sample_.tool;
    if (spindle_told) motion.spindle = spindle();
    facts_.path_mm += path_length_mm(motion);
    cut(motion, planned_s > 0 ? duration_s * share_s / planned_s : 0);
  }
}

void LiveCutter::take(const AxisSample& sample, double t_s, bool lost) {
  ++facts_.samples;
  sample_ = sample;
  t_s_ = t_s;
  std::optional<Sighting> seen = see(sample, t_s);
  if (!seen) return;
  Sighting& now = *seen;
  const double elapsed_s = before_ ? now.t_s - before_->t_s : 0;
  const FollowedPoint point = follow(now, sample, elapsed_s);
  place_.known = true;
  place_.tip_mm = now.tip_mm;
  place_.tool = now.tool >= 0 ? now.tool : point.on_path ? point.tool : program_tool_;
  place_.followed = point.on_path;
  place_.distance_mm = point.distance_mm;
  if (point.on_path) {
    place_.source = point.source;
    place_.program_s = point.program_s;
    program_tool_ = point.tool;
    ++facts_.on_path;
    facts_.following_max_mm = std::max(facts_.following_max_mm, point.distance_mm);
    facts_.following_sum_mm += point.distance_mm;
  }
  double driven_mm = 0;
  for (const auto& [motion, share_s] : driven_) driven_mm += path_length_mm(motion);
  note_turn(now);
  note_tool(now, point, driven_mm);
  note_off_path(now, point);
  place_.off_path = off_path_event_.has_value();
  const bool first = !before_;
  if (before_) {
    // A machine that stands while its tool length changes: the new tip is elsewhere, and has moved
    // through nothing.
    const double change_mm = before_->tool_length_mm - now.tool_length_mm;
    before_->tip_mm.z += change_mm;
    cut_to_mm_.z += change_mm;
    if (before_->tool != now.tool && before_->tool >= 0) ++facts_.tool_changes;
    const Break gap = break_between(*before_, now, lost);
    was_fast_ = too_fast(*before_, now);
    period_s_ += kPeriodShare * (std::min(elapsed_s, options_.gap_s) - period_s_);
    if (gap != Break::kNone) note_gap(*before_, now, gap == Break::kJump);
    if (gap != Break::kNone && options_.gap != GapPolicy::kCut) {
      guard_stale_ = true;
    } else if (point.on_path && was_on_path_) {
      cut_path(elapsed_s);
    } else {
      Sighting to = now;
      if (point.on_path) to.tip_mm = point.place_mm;
      cut_chord(cut_to_mm_, to, elapsed_s, true);
    }
  }
  cut_to_mm_ = point.on_path ? point.place_mm : now.tip_mm;
  was_on_path_ = point.on_path;
  before_ = now;
  if (first) guard_stale_ = true;
}

void LiveCutter::look() {
  stage_.complete();
  if (!guard_ || !follower_.found() || follower_.passed_all()) return;
  if (std::exchange(guard_stale_, false)) guard_->restart(stock_, work());
  guard_->look(*ahead_, follower_.program_s(), program_tool_, place_.tool, warnings_);
}

void LiveCutter::finish() {
  stage_.finish(false);
  if (ahead_) ahead_->stop();
}

}  // namespace kerf
