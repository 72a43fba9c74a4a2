#include "twin/process/milling/program_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/text_scan.h"
#include "base/translate.h"
#include "interp_bridge/motion_kinds.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// Sideways by less is rounding.
constexpr double kSideways_mm = 0.01;
/// A foot of a tool that only rests on what it has cut must not count as in it.
constexpr double kInside_mm = 0.02;

bool stops(const Motion& m) {
  return m.kind == MotionKind::kToolChange || m.kind == MotionKind::kStop ||
         m.kind == MotionKind::kProgramEnd;
}

std::string extent(const Box& box) {
  // No "-0.0".
  const auto tenths = [](double mm) { return std::round(mm * 10) / 10 + 0.0; };
  return fmt::format("X{:.1f}..{:.1f} Y{:.1f}..{:.1f} Z{:.1f}..{:.1f}", tenths(box.min.x),
                     tenths(box.max.x), tenths(box.min.y), tenths(box.max.y), tenths(box.min.z),
                     tenths(box.max.z));
}

}  // namespace

void ProgramChecks::forget_events() { drill_told_ = false; }

void ProgramChecks::follow(const Motion& m) {
  if (m.kind == MotionKind::kDwell || m.kind == MotionKind::kStop) return;
  const bool turns = is_feed(m) && m.spindle != SpindleState::kStopped;
  turning_feed_at_ = turns ? m.source : SourceRef();
}

const char* ProgramChecks::words_of(const Motion& m) const {
  if (m.kind == MotionKind::kToolChange) return tr("the tool is changed");
  if (m.kind == MotionKind::kProgramEnd) return tr("the program ends");
  // Behind its feed no block but a boring cycle's stops the spindle and then the program: an M5
  // comes before the feed of its block.
  const bool bores =
      m.source.line != 0 && m.source == turning_feed_at_ && m.spindle == SpindleState::kStopped;
  return bores ? tr("G88 stops spindle and program at the bottom of its hole")
               : tr("the program stops (M0, M1, M60)");
}

bool ProgramChecks::may_stop_in_part(const Motion& m) const {
  if (!stops(m) || !m.start_known || is_empty_) return false;
  const Vec3& tip = m.to_mm;
  return tip.z < bounds_mm_.max.z - kInside_mm && tip.x > bounds_mm_.min.x &&
         tip.x < bounds_mm_.max.x && tip.y > bounds_mm_.min.y && tip.y < bounds_mm_.max.y;
}

bool ProgramChecks::touches(const Cutter& cutter, const Vec3& tip, const Vec3& to) const {
  CutMove move;
  // The foot is lifted off what it may rest on.
  move.from_mm = tip + Vec3(0, 0, kInside_mm / 2);
  move.to_mm = to + Vec3(0, 0, kInside_mm / 2);
  return stock_.first_contact(cutter, move, kContactTolerance_mm).has_value();
}

void ProgramChecks::check_stop(const Motion& m, const TimedStep& step, const Cutter& cutter,
                               int tool) {
  const Vec3& tip = m.to_mm;
  const auto between = [&](int axis) {
    Vec3 low = tip, high = tip;
    low[axis] = bounds_mm_.min[axis];
    high[axis] = bounds_mm_.max[axis];
    return touches(cutter, tip, low) && touches(cutter, tip, high);
  };
  if (!between(0) && !between(1)) return;
  Finding finding;
  finding.id = FindingId::kStopInPart;
  finding.severity = Severity::kWarning;
  finding.source = m.source;
  finding.time_s = step.start_s;
  finding.position_mm = tip;
  finding.tool = tool;
  finding.text = trf("{} while the tool is inside the part, {:.2f} mm below its top", words_of(m),
                     bounds_mm_.max.z - tip.z);
  log_.add(std::move(finding));
}

bool ProgramChecks::goes_sideways(const CheckedMove& move) {
  if (!is_feed(move.motion)) return false;
  if (move.motion.kind == MotionKind::kArc) return true;
  // Along the drill, wherever it points: what turns is divided, and each piece has its own
  // direction.
  double sideways_mm = 0;
  for (const CutMove& part : move.moves) {
    const Vec3 way = part.to_mm - part.from_mm;
    const Vec3 along = glm::normalize(part.axis_from + part.axis_to);
    sideways_mm += glm::length(way - glm::dot(way, along) * along);
  }
  return sideways_mm > kSideways_mm;
}

void ProgramChecks::check_drill(const CheckedMove& move) {
  for (const CutMove& part : move.moves) {
    const auto contact = stock_.first_contact(move.cutter, part, kContactTolerance_mm);
    if (!contact) continue;
    const double angle_deg = drill_point_deg(move.cutter);
    Finding finding;
    finding.id = FindingId::kDrillSideways;
    finding.severity = angle_deg <= kSpotting_deg + 1e-6 ? Severity::kWarning : Severity::kError;
    finding.source = move.motion.source;
    finding.time_s = move.step.start_s;
    finding.position_mm = contact->tip_mm;
    finding.tool = move.tool;
    finding.depth_mm = contact->depth_mm;
    finding.text = trf("a drill ({}) is fed sideways through material", move.cutter.spec());
    log_.add(std::move(finding));
    drill_told_ = true;
    return;
  }
}

Severity blank_severity(BlankKind blank) {
  return blank == BlankKind::kGiven ? Severity::kError : Severity::kWarning;
}

std::optional<Finding> nothing_cut(const CutFacts& facts) {
  if (facts.blank == BlankKind::kUnjudged || facts.removed_mm3 > 0) return std::nullopt;
  if (facts.probes || facts.undefined || facts.touched) return std::nullopt;
  // Where the blank is a guess, that nothing was cut says nothing of the program.
  if (facts.blank == BlankKind::kGuessed && facts.feed_moves > 0) return std::nullopt;
  Finding finding;
  finding.id = FindingId::kNothingCut;
  finding.severity = blank_severity(facts.blank);
  if (facts.moves == 0) {
    finding.severity = Severity::kError;
    finding.text = tr("the program moves nothing");
  } else if (facts.feed_moves == 0) {
    finding.severity = Severity::kWarning;
    finding.text = tr("nothing is cut: the program has no feed moves");
  } else if (!facts.came_near && !facts.feed_mm.empty() && facts.blank == BlankKind::kGuessed) {
    finding.text = trf(
        "nothing is cut, no feed move goes into the blank, which is a guess: the moves are at {}, "
        "the blank at {}; where it really is --stock SPEC says",
        extent(facts.feed_mm), extent(facts.blank_mm));
  } else if (!facts.came_near && !facts.feed_mm.empty()) {
    finding.text = trf(
        "nothing is cut, no feed move comes near the workpiece: the moves are at {}, the blank at "
        "{}; is the blank given in the coordinates that the program writes?",
        extent(facts.feed_mm), extent(facts.blank_mm));
  } else if (!facts.came_near) {
    finding.severity = Severity::kWarning;
    finding.text = tr("nothing is cut: nothing has said where the feed moves are");
  } else {
    finding.text =
        facts.blank == BlankKind::kSaved
            ? tr("nothing is cut: the feed moves come near the workpiece, and find no material "
                 "that an earlier run has left")
            : tr("nothing is cut: the feed moves come near the workpiece, and find no material");
  }
  return finding;
}

}  // namespace kerf
