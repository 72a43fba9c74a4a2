#include "twin/process/turning/stop_checks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/translate.h"
#include "interp_bridge/motion_kinds.h"
#include "twin/collision/tool_bodies.h"
#include "twin/process/contact_grounds.h"
#include "twin/process/drill_shape.h"
#include "twin/process/finding_at.h"

namespace kerf {
namespace {

/// Empty: it does not stop.
std::string stop_words(MotionKind kind) {
  switch (kind) {
    case MotionKind::kToolChange:
      return tr("the tool is changed while it is in the cut");
    case MotionKind::kProgramEnd:
      return tr("the program ends while the tool is in the cut");
    case MotionKind::kStop:
      return tr("the program stops (M0, M1, M60) while the tool is in the cut");
    default:
      return {};
  }
}

}  // namespace

bool StopChecks::is_before(const Cutter& cutter, const Vec3& tip, const Vec3& way) const {
  CutMove move;
  move.from_mm = tip;
  move.to_mm = tip + kFeel_mm * way;
  return stock_.first_turn_contact(cutter, move, kContactTolerance_mm).has_value();
}

void StopChecks::check_stop(const Motion& m, const TimedStep& step, const Cutter& cutter,
                            int tool) {
  std::string text = stop_words(m.kind);
  if (text.empty() || !m.start_known || cutter.live()) return;
  const Vec3& tip = m.to_mm;
  const auto beside = [&](const Vec3& way) { return is_before(cutter, tip, way); };
  const bool low = beside({0, 0, -1}), high = beside({0, 0, 1});
  if (!(low && high) && !((low || high) && (beside({-1, 0, 0}) || beside({1, 0, 0})))) return;
  Finding finding = finding_at(FindingId::kStopInPart, Severity::kWarning, m, step);
  finding.position_mm = tip;
  finding.tool = tool;
  finding.text = std::move(text);
  finding.hint =
      tr("away from the workpiece first: a tool that stands there marks it, and breaks "
         "when the spindle stops");
  finding.bodies = {to_string(ToolPart::kCutter), kWorkpieceBody};
  log_.add(std::move(finding));
}

void StopChecks::check_drill(const TurnedMove& move) {
  const Motion& m = move.motion;
  if (drill_told_ || !is_feed(m) || move.cutter.insert() || move.cutter.live()) return;
  const bool across =
      m.kind == MotionKind::kArc || std::abs(m.to_mm.x - m.from_mm.x) > kSideways_mm;
  if (!across) return;
  for (std::size_t i = 0; i < move.moves.size(); ++i) {
    const auto met = stock_.first_turn_contact(move.edges, move.moves[i], kContactTolerance_mm);
    if (!met) continue;
    const bool breaks =
        is_drill(move.cutter) && drill_point_deg(move.cutter) > kSpotting_deg + 1e-6;
    Finding finding =
        finding_at(FindingId::kDrillSideways, breaks ? Severity::kError : Severity::kWarning,
                   m.source, move.step.time_at(move.share_of(i, met->t)));
    finding.position_mm = Vec3(met->at_mm.y, m.from_mm.y, met->at_mm.x);
    finding.tool = move.tool;
    finding.depth_mm = met->depth_mm;
    finding.text = trf("a tool that stands on the axis ({}) is fed sideways through material",
                       move.cutter.spec());
    finding.bodies = {to_string(ToolPart::kCutter), kWorkpieceBody};
    log_.add(std::move(finding));
    drill_told_ = true;
    return;
  }
}

}  // namespace kerf
