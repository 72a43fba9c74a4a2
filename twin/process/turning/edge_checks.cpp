#include "twin/process/turning/edge_checks.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/translate.h"
#include "interp_bridge/motion_kinds.h"
#include "twin/process/contact_grounds.h"
#include "twin/process/finding_at.h"
#include "twin/process/turning/tool_outlines.h"

namespace kerf {
namespace {

/// Sine of the least angle between an edge that cuts and its way.
constexpr double kLeastLean = 0.4;

}  // namespace

void EdgeChecks::mount(const Cutter& cutter) {
  unmount();
  if (!cutter.insert()) return;
  for (const InsertPart& part : cutter.insert()->parts) {
    for (std::size_t i = 0; i < part.size(); ++i) {
      const InsertEdge& edge = part[i];
      const InsertEdge& before = part[i == 0 ? part.size() - 1 : i - 1];
      const InsertEdge& after = part[i + 1 == part.size() ? 0 : i + 1];
      const bool flank = edge.side == InsertSide::kFront || edge.side == InsertSide::kBack;
      if (!flank || edge.center_mm || (is_cutting(before.side) && is_cutting(after.side))) continue;
      edges_.push_back({edge.end_mm - before.end_mm, edge.side});
    }
  }
}

void EdgeChecks::check(const TurnedMove& move, const TurnCut& cut, bool blank_guessed) {
  const Motion& m = move.motion;
  if (edges_.empty() || m.kind == MotionKind::kArc || cut.removed_mm3 <= 0) return;
  Vec2 way(m.to_mm.z - m.from_mm.z, m.to_mm.x - m.from_mm.x);
  if (glm::length(way) == 0) return;
  way = glm::normalize(way);
  double reach_mm = 0, met_mm = 0;
  for (const Edge& edge : edges_) {
    // It leads where its outer side looks along the way; what lies along it trails, or slides.
    const double across = edge.along_mm.x * way.y - edge.along_mm.y * way.x;
    if (-across < std::max(kShortest_mm, kLeastLean * glm::length(edge.along_mm))) continue;
    const double met = cut.side_mm[static_cast<std::size_t>(edge.side)];
    if (met < -across - kSlack_mm) continue;
    reach_mm = -across;
    met_mm = met;
  }
  if (reach_mm == 0) {
    event_.reset();
    return;
  }
  if (!event_) {
    const Grounds grounds{blank_guessed, move.tool_guessed};
    Finding finding =
        finding_at(FindingId::kOverDepth, Severity::kWarning, m.source, move.step.start_s);
    finding.text =
        trf("material stands before the whole cutting edge of the insert, which reaches {:.2f} mm "
            "across this way: the cut is as deep or deeper",
            reach_mm) +
        doubt_of(FindingId::kOverDepth, grounds);
    finding.position_mm = m.from_mm;
    finding.tool = move.tool;
    finding.hint = tr("less depth of cut, or edge=L of the tool's SHAPE if its edge is longer");
    event_ = log_.add(std::move(finding));
  }
  log_.deepen(*event_, std::max(met_mm, cut.depth_mm));
}

}  // namespace kerf
