#include "twin/process/turning/edge_checks.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/translate.h"
#include "interp_bridge/motion_kinds.h"
#include "stock/cutter/turning_shape.h"
#include "twin/motion/motion_geometry.h"
#include "twin/process/contact_grounds.h"
#include "twin/process/finding_at.h"
#include "twin/process/turning/tool_outlines.h"
#include "twin/process/turning/turn_steps.h"

namespace kerf {
namespace {

/// Sine of the least angle between an edge that cuts and its way.
constexpr double kLeastLean = 0.4;

}  // namespace

void EdgeChecks::mount(const Cutter& cutter) {
  unmount();
  if (!cutter.insert()) return;
  most_mm_ = insert_use_of(cutter).max_depth_mm;
  tool_.emplace(*cutter.insert());
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

void EdgeChecks::note(const TurnedMove& move) {
  before_.reset();
  if (!edges_.empty() && move.motion.kind == MotionKind::kArc) before_ = stock_.part();
}

void EdgeChecks::check(const TurnedMove& move, const TurnCut& cut, bool blank_guessed) {
  const Motion& m = move.motion;
  if (cut.removed_mm3 <= 0) return;
  check_most(move, cut, blank_guessed);
  if (edges_.empty()) return;
  Full full;
  if (m.kind == MotionKind::kArc) {
    // Most arcs are cut with a part of an edge that is too short for any direction.
    const bool may_be_full = std::ranges::any_of(edges_, [&](const Edge& edge) {
      const double least = std::max(kShortest_mm, kLeastLean * glm::length(edge.along_mm));
      return cut.side_mm[static_cast<std::size_t>(edge.side)] >= least - kSlack_mm;
    });
    if (may_be_full) full = look_along(move);
  } else {
    const Vec2 way(m.to_mm.z - m.from_mm.z, m.to_mm.x - m.from_mm.x);
    if (glm::length(way) == 0) return;
    look_straight(glm::normalize(way), cut, 0, full);
  }
  if (full.reach_mm == 0) {
    event_.reset();
  } else {
    tell_full(move, cut, full, blank_guessed);
  }
}

void EdgeChecks::look_straight(const Vec2& way, const TurnCut& cut, double share,
                               Full& full) const {
  for (const Edge& edge : edges_) {
    // It leads where its outer side looks along the way; what lies along it trails, or slides.
    const double across = edge.along_mm.x * way.y - edge.along_mm.y * way.x;
    if (-across < std::max(kShortest_mm, kLeastLean * glm::length(edge.along_mm))) continue;
    const double met = cut.side_mm[static_cast<std::size_t>(edge.side)];
    if (met < -across - kSlack_mm) continue;
    if (full.reach_mm == 0) full.share = share;
    full.reach_mm = std::max(full.reach_mm, -across);
    full.met_mm = std::max(full.met_mm, met);
  }
}

/// Of an arc, cut once more step by step.
EdgeChecks::Full EdgeChecks::look_along(const TurnedMove& move) {
  Full full;
  if (!before_) return full;
  const std::vector<TurnMove> turns = rings_of(move);
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const TurnMove& turn = turns[i];
    const double sweep_rad = turn.arc ? std::abs(turn.arc->sweep_rad) : 0;
    const int steps = std::clamp(static_cast<int>(std::ceil(sweep_rad / kStep_rad)), 1, kMostSteps);
    for (int k = 0; k < steps; ++k) {
      const TurnMove step =
          turn_part(turn, static_cast<double>(k) / steps, static_cast<double>(k + 1) / steps);
      const TurnCut cut = before_->cut(*tool_, step);
      const Vec2 way = step.to_mm - step.from_mm;
      if (cut.removed_mm3 <= 0 || glm::length(way) == 0) continue;
      look_straight(glm::normalize(way), cut,
                    (static_cast<double>(i) + static_cast<double>(k) / steps) /
                        static_cast<double>(turns.size()),
                    full);
    }
  }
  before_.reset();
  return full;
}

void EdgeChecks::tell_full(const TurnedMove& move, const TurnCut& cut, const Full& full,
                           bool blank_guessed) {
  if (!event_) {
    const Grounds grounds{blank_guessed, move.tool_guessed};
    Finding finding = finding_at(FindingId::kOverDepth, Severity::kWarning, move.motion.source,
                                 move.step.time_at(full.share));
    finding.text =
        trf("material stands before the whole cutting edge of the insert, which reaches {:.2f} mm "
            "across this way: the cut is as deep or deeper",
            full.reach_mm) +
        doubt_of(FindingId::kOverDepth, grounds);
    finding.position_mm = point_at(move.motion, full.share);
    finding.tool = move.tool;
    finding.hint = tr("less depth of cut, or edge=L of the tool's SHAPE if its edge is longer");
    event_ = log_.add(std::move(finding));
  }
  log_.deepen(*event_, move.motion.kind == MotionKind::kArc ? full.met_mm
                                                            : std::max(full.met_mm, cut.depth_mm));
}

void EdgeChecks::check_most(const TurnedMove& move, const TurnCut& cut, bool blank_guessed) {
  if (!most_mm_ || move.motion.kind == MotionKind::kThread) return;
  if (cut.depth_mm <= *most_mm_ + kSlack_mm) {
    deep_.reset();
    return;
  }
  if (!deep_) {
    const Grounds grounds{blank_guessed, move.tool_guessed};
    Finding finding = finding_at(FindingId::kOverDepth, Severity::kWarning, move.motion, move.step);
    finding.text =
        trf("the depth of cut is more than the {:g} mm that this tool takes (max_ap)", *most_mm_) +
        doubt_of(FindingId::kOverDepth, grounds);
    finding.position_mm = move.motion.from_mm;
    finding.tool = move.tool;
    deep_ = log_.add(std::move(finding));
  }
  log_.deepen(*deep_, cut.depth_mm);
}

}  // namespace kerf
