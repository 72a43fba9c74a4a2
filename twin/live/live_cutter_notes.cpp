// What a machine that is watched is told of: LiveCutter's findings.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/live/live_cutter.h"

namespace kerf {
namespace {

/// Positions beyond the machine's limits by so much for so long are not its own.
constexpr double kBeyond_mm = 1.0;
constexpr double kBeyond_s = 2.0;
/// Driven with the wrong tool: the program goes on without having changed it. mm.
constexpr double kMismatch_mm = 1.0;
/// A machine that says it runs the program for so long without being seen on its path is off it.
constexpr double kNeverSeen_s = 1.0;
/// A machine that has gone so far along its path goes on in its program. mm.
constexpr double kGoesOn_mm = 2.0;
/// An axis that has turned by less stands. Degrees.
constexpr double kTurned_deg = 0.01;

}  // namespace

Finding LiveCutter::finding_of(FindingId id, Severity severity, double t_s, const Vec3& place,
                               int tool) {
  Finding finding;
  finding.id = id;
  finding.severity = severity;
  finding.time_s = t_s;
  finding.position_mm = place;
  if (tool >= 0) finding.tool = tool;
  return finding;
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
      "{} stands at {:.2f} mm, beyond the limits of the machine ({:g} to {:g} mm): are these "
      "positions "
      "of "
      "another machine, or in another unit?",
      "XYZ"[beyond], machine_mm[beyond], axis.min, axis.max);
  log_.add(std::move(finding));
}

/// A reading that no machine has moves nothing. True: it is one.
bool LiveCutter::drop_wild(const AxisSample& sample, double t_s) {
  const std::optional<std::string> fault = bounds_.fault_of(sample);
  if (!fault) return false;
  ++facts_.wild;
  t_s_ = t_s;
  if (wild_told_) return true;
  wild_told_ = true;
  Finding finding;
  finding.id = FindingId::kSourceGap;
  finding.severity = Severity::kWarning;
  finding.time_s = t_s;
  finding.text = *fault +
                 " (a damaged number? another type or unit than the device's?); such readings are "
                 "dropped and counted";
  log_.add(std::move(finding));
  return true;
}

/// Single readings that the gate has dropped.
void LiveCutter::note_wild(std::size_t count, double t_s) {
  facts_.wild += count;
  if (std::exchange(quick_told_, true)) return;
  Finding finding;
  finding.id = FindingId::kSourceGap;
  finding.severity = Severity::kWarning;
  finding.time_s = t_s;
  finding.text = gate_.fault() + " (a damaged number?); such readings are dropped and counted";
  log_.add(std::move(finding));
}

void LiveCutter::note_gap(const Sighting& before, const Sighting& now, bool jump, bool by_program) {
  const double way_mm = way_between(before, now);
  const double elapsed_s = now.t_s - before.t_s;
  // A machine that is homed says that it is elsewhere, and has not moved.
  const bool harmless = jump && !near_stock(before.pose.origin_mm, before.pose.origin_mm, 0) &&
                        !near_stock(now.pose.origin_mm, now.pose.origin_mm, 0);
  ++(harmless ? facts_.jumps : facts_.gaps);
  if (!harmless) {
    facts_.gap_s += elapsed_s;
    facts_.gap_max_mm = std::max(facts_.gap_max_mm, way_mm);
  }
  if (options_.gap == GapPolicy::kIgnore) return;
  Finding finding =
      finding_of(FindingId::kSourceGap, harmless ? Severity::kNote : Severity::kWarning, now.t_s,
                 now.pose.origin_mm, now.tool);
  finding.source = place_.source;
  const char* what_then = "the way between is not cut (gap: cut would)";
  if (options_.gap == GapPolicy::kCut) what_then = "the way between is cut all the same";
  if (by_program) what_then = "the way between is cut as the program has it";
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
  if (!first_abc_deg_) first_abc_deg_ = now.place.abc_deg;
  if (turn_told_ || stock_.takes_tilted_tools()) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const double turned_deg = now.place.abc_deg[i] - (*first_abc_deg_)[i];
    if (!(std::abs(turned_deg) > kTurned_deg)) continue;
    turn_told_ = true;
    Finding finding = finding_of(FindingId::kRotaryIgnored, Severity::kError, now.t_s,
                                 now.pose.origin_mm, now.tool);
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
      finding_of(FindingId::kToolMismatch, Severity::kError, now.t_s, now.pose.origin_mm, now.tool);
  finding.source = point.source;
  finding.text = fmt::format("the machine has tool {} in the spindle where the program has tool {}",
                             now.tool, point.tool);
  log_.add(std::move(finding));
}

/// Moved by hand, or by a single block: no line of the program is to blame. A block by hand has a
/// line in LinuxCNC, that of the last one that was read, and begins where the machine has stood.
bool LiveCutter::is_by_hand(const FollowedPoint& point) {
  if (sample_.line == 0) {
    stood_mm_ = facts_.path_mm;
    return true;
  }
  if (!stood_mm_ || sample_.line < 0) return false;
  const bool named = follower_.comes_to(sample_.line);
  const bool there = point.on_path && static_cast<std::uint32_t>(sample_.line) == point.source.line;
  if (there || (named && facts_.path_mm > *stood_mm_ + kGoesOn_mm)) stood_mm_.reset();
  return stood_mm_ && !named;
}

void LiveCutter::note_off_path(const Sighting& now, const FollowedPoint& point) {
  const bool searched = std::isfinite(point.distance_mm);
  const bool by_hand = is_by_hand(point);
  if (point.on_path || !searched || by_hand || follower_.passed_all() || finished()) {
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
  if (doubtful_) return;
  ++facts_.off_path;
  facts_.off_path_max_mm = std::max(facts_.off_path_max_mm, point.distance_mm);
  if (!off_path_event_) {
    Finding finding =
        finding_of(FindingId::kOffPath, Severity::kWarning, now.t_s, now.pose.origin_mm, now.tool);
    finding.source = point.source;
    const Vec3 by = now.place.tip_mm - point.place.tip_mm;
    finding.text = fmt::format(
        "the tip is not on the path of the program, it is beside it by X{:.3f} Y{:.3f} Z{:.3f}",
        by.x, by.y, by.z);
    off_path_event_ = log_.add(std::move(finding));
  }
  log_.deepen(*off_path_event_, point.distance_mm);
}

/// Once: the machine has worked in the blank for `duration_s` more, and not by this program.
void LiveCutter::note_foreign_program(const Sighting& now, double duration_s) {
  if (!ahead_ || !runs_ || follower_.found() || foreign_told_) return;
  foreign_s_ += duration_s;
  if (foreign_s_ < options_.off_path_s) return;
  foreign_told_ = true;
  Finding finding = finding_of(FindingId::kNotThisProgram, Severity::kError, now.t_s,
                               now.pose.origin_mm, now.tool);
  finding.text = fmt::format(
      "the machine has worked in the blank for {:.1f} s and has not once been on the path of this "
      "program: nothing can be told ahead",
      foreign_s_);
  finding.hint =
      "another program, another work offset (--ini, machine.work_offset), or positions in another "
      "frame or unit";
  log_.add(std::move(finding));
}

/// Once: a sheet is cut by whoever knows when the beam is on.
void LiveCutter::note_unseen_beam(const Sighting& now) {
  if (!options_.beam || ahead_ || beam_told_ || !std::isnan(sample_.spindle_rpm)) return;
  beam_told_ = true;
  Finding finding =
      finding_of(FindingId::kNoBeam, Severity::kWarning, now.t_s, now.place.tip_mm, now.tool);
  finding.text =
      "nothing tells when the beam is on: the source has no spindle speed, and no program is "
      "followed (--program); nothing is cut until it does";
  log_.add(std::move(finding));
}

/// Once: an axis that the machine turns, and whose positions do not come.
void LiveCutter::note_unseen_axes(const Sighting& now) {
  const ToolPath* const path = stage_.machine_path();
  if (unseen_told_ || !path || !options_.timeline.kinematics_known) return;
  if (options_.frame.workpiece_frame || !stock_.takes_tilted_tools()) return;
  unseen_told_ = true;
  std::string unseen;
  for (std::size_t i = 0; i < 3; ++i) {
    if (now.abc_known[i] || !path->machine().chain.is_driven_by(3 + i)) continue;
    unseen.append(unseen.empty() ? "" : " and ").append(1, kAxisLetters[3 + i]);
  }
  if (unseen.empty()) return;
  Finding finding = finding_of(FindingId::kRotaryIgnored, Severity::kWarning, now.t_s,
                               now.pose.origin_mm, now.tool);
  finding.text = fmt::format(
      "the machine turns about {}, and no position of it comes: it is taken to stand at 0", unseen);
  log_.add(std::move(finding));
}

}  // namespace kerf
