// What MillingStage asks of a program beyond its single moves: its order, its whole.
#include <algorithm>
#include <utility>

#include "base/translate.h"
#include "twin/motion/motion_geometry.h"
#include "twin/process/finding_at.h"
#include "twin/process/milling/milling_stage.h"

namespace kerf {

/// Told to stop, or to turn at no speed. What nobody tells of a machine that is watched cannot be
/// found wrong.
bool MillingStage::stands(const Motion& m) const {
  if (m.spindle == SpindleState::kStopped) return true;
  return m.spindle_rpm == 0 && (m.speed_said || !site_.watched);
}

/// Before anything is made of the motion. Of a machine that is watched nobody asks why it stops,
/// and which tool it has it tells itself.
void MillingStage::watch_program(const Motion& m, const TimedStep& step) {
  if (speed_unsaid_ && m.speed_said) {
    log_.raise(*std::exchange(speed_unsaid_, FindingLog::kMaxKept), Severity::kError);
  }
  if (site_.watched) return;
  const bool probes = m.kind == MotionKind::kProbe;
  probes_ = probes_ || probes;
  const bool feeds = probes || is_feed(m);
  if (feeds) ++feed_moves_made_;
  if (feeds || is_traverse(m)) ++moves_made_;
  if (m.kind == MotionKind::kToolChange) {
    changes_.feeds(m, step, m.tool);  // its T word may be another than the one that waited
    changes_.end_tool();
    program_.end_tool();
  }
  program_.follow(m);
  if (checks_.options().is_drawn) return;
  if (!cutter() || !program_.may_stop_in_part(m) || !site_.moves.is_upright(m)) return;
  complete();
  program_.check_stop(m, step, *mounted_->cutter, mounted_->number);
}

/// A spindle that is told to turn at no speed stands. Where the program has no S word at all its
/// speed may be set by hand, at the spindle: that is told once, as a warning, unless the machine's
/// INI is there or an S word comes after all.
void MillingStage::check_standing(const Motion& m, const TimedStep& step, const CheckedMove& move) {
  const bool unsaid = m.spindle != SpindleState::kStopped && !m.speed_said;
  if (unsaid && speed_unsaid_) return;
  if (checks_.options().is_drawn) {
    if (!std::exchange(drawn_told_, true)) report_drawn(m, step);
    return;
  }
  complete();
  if (m.spindle == SpindleState::kStopped) {
    checks_.check_standing_spindle(
        move, tr("feed move touches the workpiece while the spindle stands"), Severity::kError);
  } else if (!unsaid) {
    checks_.check_standing_spindle(
        move, tr("feed move touches the workpiece while the spindle is told to turn at S0 (0 rpm)"),
        Severity::kError);
  } else {
    speed_unsaid_ =
        checks_.check_standing_spindle(move,
                                       tr("feed move touches the workpiece at 0 rpm: the spindle "
                                          "is told to turn, and no S word says "
                                          "how fast; is its speed set by hand?"),
                                       site_.limits_known ? Severity::kError : Severity::kWarning);
  }
}

/// Once, instead of warnings: with the spindle that a pen has not.
void MillingStage::report_drawn(const Motion& m, const TimedStep& step) {
  Finding finding = finding_at(FindingId::kSpindleOffContact, Severity::kNote, m, step);
  finding.tool = mounted_->number;
  finding.text =
      tr("no spindle is ever started, and the blank is a guess, a skin over the only level that is "
         "fed: it is taken for a pen or a knife, and what stands in the skin is not told (--stock "
         "SPEC gives the blank, and then it is)");
  log_.add(std::move(finding));
}

/// In cells that are too coarse for it a groove may remove nothing: the geometry says whether a
/// move has met material. The first move that cuts is the last that is looked at.
void MillingStage::note_contact(const CheckedMove& move) {
  constexpr int kMostLooks = 100;
  if (touched_ || contact_looks_ == kMostLooks || !comes_near(move.motion)) return;
  complete();
  for (const ToolUse& use : uses_) touched_ = touched_ || use.removed_mm3 > 0;
  if (touched_) return;
  ++contact_looks_;
  touched_ = checks_.touches(move);
}

/// Of a whole program over a blank that is known to be one; else only what lies outside.
void MillingStage::report_nothing_cut() {
  if (site_.blank == BlankKind::kUnjudged) {
    report_outside_stock();
    return;
  }
  CutFacts facts;
  facts.blank = site_.blank;
  facts.moves = moves_made_;
  facts.feed_moves = feed_moves_made_;
  facts.probes = probes_;
  facts.came_near = reached_stock_;
  facts.touched = touched_;
  facts.feed_mm = feed_bounds_mm_;
  facts.blank_mm = stock_.bounds_mm();
  for (const ToolUse& use : uses_) {
    facts.undefined = facts.undefined || use.shape.empty();
    facts.removed_mm3 += use.removed_mm3;
  }
  if (std::optional<Finding> finding = nothing_cut(facts)) log_.add(std::move(*finding));
}

}  // namespace kerf
