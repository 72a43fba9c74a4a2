// What CutStage tells beyond what its checks tell: places, axes.
#include <string>
#include <utility>

#include "base/translate.h"
#include "twin/motion/motion_geometry.h"
#include "twin/process/cut_stage.h"
#include "twin/process/finding_at.h"

namespace kerf {
/// That rapids come from an unknown place until every axis has been placed is how programs begin.
/// Once each: a feed move that is not cut, and a place of the machine.
void CutStage::report_unknown_place(const Motion& m, const TimedStep& step) {
  const bool to_machine = m.to_machine_place && !machine_place_told_;
  const bool feed = is_feed(m) && !unknown_feed_told_;
  if (!to_machine && !feed) return;
  (to_machine ? machine_place_told_ : unknown_feed_told_) = true;
  const unsigned axes = to_machine ? m.unknown_to : m.unknown_from | m.unknown_to;
  std::string letters;
  for (std::size_t i = 0; i < 3; ++i) {
    if ((axes >> i & 1) == 0) continue;
    letters += letters.empty() ? "" : ", ";
    letters += kAxisLetters[i];
  }
  const bool one = letters.size() == 1;
  Finding finding = finding_at(FindingId::kPositionUnknown, Severity::kNote, m, step);
  if (to_machine) {
    finding.text = trf(
        "goes to a place of the machine (G53, G28, G30), and where the work lies in the machine is "
        "not known (--work-offset X,Y,Z or --ini says it): such moves are not checked, and {} {} "
        "unknown until a block places {}",
        letters, one ? tr("is") : tr("are"), one ? tr("it") : tr("them"));
  } else {
    finding.text = trf(
        "a feed move while nothing has said where {} {} (--ini does, or a G0 before it that names "
        "the {}): such moves are not cut",
        letters, one ? tr("stands") : tr("stand"), one ? tr("axis") : tr("axes"));
  }
  site_.log.add(std::move(finding));
}

/// U, V or W move. Once for each that moves nothing that is known.
void CutStage::check_slides(const Motion& m, const TimedStep& step) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<int>(i);
    const bool known = kinematics_ && kinematics_->slides_uvw() &&
                       kinematics_->chain.is_driven_by(6 + i) && traits_.slides;
    if (known || slide_reported_[i] || m.from_uvw_mm[axis] == m.to_uvw_mm[axis]) continue;
    slide_reported_[i] = true;
    const char letter = kAxisLetters[6 + i];
    Finding finding = finding_at(FindingId::kSecondaryIgnored, Severity::kError, m, step);
    finding.tool = m.tool;
    finding.text = trf(
        "{} moves, and nothing says what it slides: it is cut as if {} stood still (a second "
        "carriage, the slide of a facing head, and the wire between XY and UV of a foam cutter are "
        "not modelled)",
        letter, letter);
    finding.hint = tr(
        "with W among the axes (--ini, machine.joints) it is a quill along Z; machine.kinematics: "
        "links says what U, V and W slide on another machine");
    site_.log.add(std::move(finding));
  }
}

/// Once: what the machine is taken to be, where nothing says it.
void CutStage::report_assumptions(const Motion& m) {
  assumptions_told_ = true;
  for (const std::string& note : kinematics_->notes) {
    Finding finding;
    finding.id = FindingId::kKinematics;
    finding.severity = Severity::kNote;
    finding.source = m.source;
    finding.text = note;
    site_.log.add(std::move(finding));
  }
}

namespace {

FindingId id_of(RotaryFaultKind kind) {
  switch (kind) {
    case RotaryFaultKind::kNoAxis:
      return FindingId::kNoRotaryAxis;
    case RotaryFaultKind::kSingularPose:
      return FindingId::kSingularPose;
    case RotaryFaultKind::kJointTooFast:
      return FindingId::kOverFeed;
    case RotaryFaultKind::kJointLimit:
      return FindingId::kAxisLimit;
    case RotaryFaultKind::kToolTooLong:
      return FindingId::kToolTooLong;
  }
  return FindingId::kAxisLimit;
}

}  // namespace

void CutStage::report_rotary_faults(const TimedStep& step) {
  for (RotaryFault& fault : rotary_faults_) {
    const bool too_fast = fault.kind == RotaryFaultKind::kJointTooFast;
    if (too_fast && !site_.limits_known && std::exchange(invented_limits_told_, true)) continue;
    Finding finding = finding_at(id_of(fault.kind), Severity::kError, fault.source, step.start_s);
    if (fault.kind == RotaryFaultKind::kSingularPose) finding.severity = Severity::kWarning;
    if (too_fast) finding.severity = site_.limits_known ? Severity::kWarning : Severity::kNote;
    finding.text = std::move(fault.text);
    finding.hint = std::move(fault.hint);
    site_.log.add(std::move(finding));
  }
  rotary_faults_.clear();
}

/// Once: a model for upright tools was asked for, and the program is not for one.
void CutStage::report_ignored_turn(const Motion& m, const TimedStep& step) {
  turn_reported_ = true;
  Finding finding = finding_at(FindingId::kRotaryIgnored, Severity::kError, m, step);
  finding.tool = m.tool;
  finding.text = trf(
      "A, B or C move, and the model {} is for upright tools over a workpiece that lies still: it "
      "is cut as if they stood{}",
      site_.stock.name(), site_.stock.sheet() ? "" : tr(" (--model octree follows them)"));
  site_.log.add(std::move(finding));
}

}  // namespace kerf
