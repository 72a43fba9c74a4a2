#include "twin/live/path_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/translate.h"
#include "twin/live/source_watch.h"

namespace kerf {
namespace {

/// A machine that says it runs the program for so long without being seen on its path is off it.
constexpr double kNeverSeen_s = 1.0;
/// A machine that has gone so far along its path goes on in its program. mm.
constexpr double kGoesOn_mm = 2.0;
/// A machine that rounds a corner is through by then; one that still is beside its path is off it.
constexpr double kMostInCorner_s = 1.0;

}  // namespace

PathWatch::PathWatch(const LiveCutOptions& options, const PathMatcher& matcher, FindingLog& log,
                     LiveFacts& facts)
    : options_(options), matcher_(matcher), log_(log), facts_(facts) {}

void PathWatch::note_out_of_sight() {
  if (!stood_mm_) stood_mm_ = facts_.path_mm;
}

bool PathWatch::note_tool(const Reading& now, const PathMatch& point, double driven_mm) {
  if (!point.on_path || now.sample.tool < 0) return false;
  if (now.sample.tool == point.tool) {
    mismatch_told_ = false;
    mismatch_mm_ = 0;
    return false;
  }
  // A machine that stands may have its new tool already, while its length is still the old one's.
  mismatch_mm_ += driven_mm;
  if (mismatch_mm_ < kMismatch_mm) return false;
  if (std::exchange(mismatch_told_, true)) return false;
  Finding finding = live_finding(FindingId::kToolMismatch, Severity::kError, now.t_s,
                                 now.pose.origin_mm, now.tool);
  finding.source = point.source;
  finding.text = trf("the machine has tool {} in the spindle where the program has tool {}",
                     now.tool, point.tool);
  log_.add(std::move(finding));
  return true;
}

/// Moved by hand, or by a single block: no line of the program is to blame. A block by hand has a
/// line in LinuxCNC, that of the last one that was read, and begins where the machine has stood.
bool PathWatch::is_by_hand(const AxisSample& sample, const PathMatch& point) {
  if (sample.line == 0) {
    stood_mm_ = facts_.path_mm;
    return true;
  }
  if (!stood_mm_ || sample.line < 0) return false;
  const bool named = matcher_.follower().comes_to(sample.line);
  const bool there = point.on_path && static_cast<std::uint32_t>(sample.line) == point.source.line;
  if (there || (named && facts_.path_mm > *stood_mm_ + kGoesOn_mm)) stood_mm_.reset();
  return stood_mm_ && !named;
}

void PathWatch::note_off_path(const Reading& now, const PathMatch& point, double elapsed_s,
                              bool doubtful) {
  const bool searched = std::isfinite(point.distance_mm);
  const bool by_hand = is_by_hand(now.sample, point);
  const PathFollower& follower = matcher_.follower();
  in_corner_s_ = point.corner == RoundedCorner::kRight ? in_corner_s_ + elapsed_s : 0;
  if (in_corner_s_ > 0 && in_corner_s_ <= kMostInCorner_s && !off_path_event_) return;
  if (point.on_path || !searched || by_hand || follower.passed_all() || matcher_.finished()) {
    off_path_event_.reset();
    lost_sight_s_ = 0;
    return;
  }
  if (!follower.found()) {
    // Before the program begins a machine may be anywhere; while it says that it runs, it may not.
    const int line = now.sample.line;
    const bool runs = line > 0 && line != matcher_.program()->approach_line();
    lost_sight_s_ = runs ? lost_sight_s_ + elapsed_s : 0;
    if (lost_sight_s_ < kNeverSeen_s) return;
  }
  if (doubtful) return;
  ++facts_.off_path;
  facts_.off_path_max_mm = std::max(facts_.off_path_max_mm, point.distance_mm);
  if (!off_path_event_) {
    Finding finding = live_finding(FindingId::kOffPath, Severity::kWarning, now.t_s,
                                   now.pose.origin_mm, now.tool);
    finding.source = point.source;
    const Vec3 by = now.place.tip_mm - point.place.tip_mm;
    finding.text =
        trf("the tip is not on the path of the program, it is beside it by X{:.3f} Y{:.3f} Z{:.3f}",
            by.x, by.y, by.z);
    if (point.corner == RoundedCorner::kByFeeds) {
      finding.hint =
          tr("G64 without P rounds corners as far as the machine's accelerations want: with --ini "
             "they are in the path, and G64 P says how far");
    }
    off_path_event_ = log_.add(std::move(finding));
  }
  log_.deepen(*off_path_event_, point.distance_mm);
}

void PathWatch::note_foreign_program(const Reading& now, double duration_s) {
  if (!matcher_.program() || matcher_.follower().found() || foreign_told_) return;
  foreign_s_ += duration_s;
  if (foreign_s_ < options_.off_path_s) return;
  foreign_told_ = true;
  Finding finding = live_finding(FindingId::kNotThisProgram, Severity::kError, now.t_s,
                                 now.pose.origin_mm, now.tool);
  finding.text = trf(
      "the machine has worked in the blank for {:.1f} s and has not once been on the path of this "
      "program: nothing can be told ahead",
      foreign_s_);
  finding.hint = tr(
      "another program, another work offset (--ini, machine.work_offset), or positions in another "
      "frame or unit");
  log_.add(std::move(finding));
}

void PathWatch::note_late_start(const MatchQuery& place, double t_s) {
  Finding finding =
      live_finding(FindingId::kLateStart, Severity::kNote, t_s, place.here.tip_mm, place.tool);
  finding.source = {0, static_cast<std::uint32_t>(std::max(0, place.line))};
  if (options_.joined_late == JoinedLate::kCut) {
    finding.text =
        tr("the machine was here already when it was first seen; what the program cuts before is "
           "taken as cut");
    finding.hint = tr("--joined-late keep leaves the workpiece as it was given");
  } else {
    finding.text = tr(
        "the machine was here already when it was first seen; what the program cuts before is not "
        "cut");
    finding.hint = tr("--joined-late cut takes it as cut");
  }
  log_.add(std::move(finding));
}

}  // namespace kerf
