#include "twin/process/turning/holder_checks.h"

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

/// From share a to share b of a move.
TurnMove part_of(const TurnMove& move, double a, double b) {
  TurnMove part = move;
  if (!move.arc) {
    part.from_mm = move.from_mm + a * (move.to_mm - move.from_mm);
    part.to_mm = b == 1 ? move.to_mm : move.from_mm + b * (move.to_mm - move.from_mm);
    return part;
  }
  const Vec2 from = move.from_mm - move.arc->center_mm, to = move.to_mm - move.arc->center_mm;
  const double start = std::atan2(from.y, from.x);
  const auto place = [&](double t) {
    const double angle = start + t * move.arc->sweep_rad;
    const double r = glm::length(from) + t * (glm::length(to) - glm::length(from));
    return move.arc->center_mm + r * Vec2(std::cos(angle), std::sin(angle));
  };
  if (a > 0) part.from_mm = place(a);
  if (b < 1) part.to_mm = place(b);
  part.arc->sweep_rad = (b - a) * move.arc->sweep_rad;
  return part;
}

double way_mm(const TurnMove& move) {
  if (!move.arc) return glm::distance(move.from_mm, move.to_mm);
  return std::abs(move.arc->sweep_rad) * std::max(glm::distance(move.from_mm, move.arc->center_mm),
                                                  glm::distance(move.to_mm, move.arc->center_mm));
}

}  // namespace

void HolderChecks::mount(const Cutter& cutter, int tool) {
  unmount();
  const ToolOutlines outlines = outlines_of(cutter);
  if (outlines.holder.parts.empty()) return;
  Vec2 low{0}, high{0};
  outline_box(outlines.holder, low, high);
  const TurningTool whole(outlines.holder);
  holder_ = Holder{whole.inset(kContactTolerance_mm), whole.inset(kContactRounding_mm),
                   TurningTool(outlines.cutter), high.x - low.x > high.y - low.y};
  const auto known =
      std::ranges::find_if(table_, [&](const CollisionPair& row) { return row.tool == tool; });
  holder_->row = static_cast<std::size_t>(known - table_.begin());
  if (known != table_.end()) return;
  CollisionPair& row = table_.emplace_back();
  row.tool = tool;
  row.part = ToolPart::kHolder;
}

void HolderChecks::begin_reporting() {
  unmount();
  table_.clear();
}

void HolderChecks::check(const TurnedMove& move, bool blank_guessed) {
  const std::vector<TurnMove> turns = rings_of(move);
  std::optional<Touch> touch = touch_of_traverse(turns);
  if (!is_traverse(move.motion)) {
    // Most of what is there the insert takes away first.
    if (touch) touch = touch_of_feed(turns);
  } else if (!touch) {
    event_.reset();
  }
  if (touch) tell(move, *touch, blank_guessed);
}

std::optional<HolderChecks::Touch> HolderChecks::touch_of_traverse(
    std::span<const TurnMove> turns) const {
  std::optional<Touch> first;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const auto met = stock_.part().first_contact(holder_->thin, turns[i]);
    if (!met) continue;
    const double deep = met->depth_mm + kContactTolerance_mm;
    if (!first) {
      const TurnContact begins =
          stock_.part().first_contact(holder_->bare, turns[i]).value_or(*met);
      first =
          Touch{begins, (static_cast<double>(i) + begins.t) / static_cast<double>(turns.size())};
      first->contact.depth_mm = 0;
    }
    first->contact.depth_mm = std::max(first->contact.depth_mm, deep);
  }
  return first;
}

std::optional<HolderChecks::Touch> HolderChecks::touch_of_feed(
    std::span<const TurnMove> turns) const {
  TurnedPart part = stock_.part();
  std::optional<Touch> first;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const int steps =
        std::clamp(static_cast<int>(std::ceil(way_mm(turns[i]) / kStep_mm)), 1, kMostSteps);
    bool touches = false;
    for (int k = 0; k < steps; ++k) {
      const double from = static_cast<double>(k) / steps, to = static_cast<double>(k + 1) / steps;
      const TurnMove step = part_of(turns[i], from, to);
      part.cut(holder_->insert, step);
      const auto met = part.first_contact(holder_->thin, step);
      if (!met) continue;
      touches = true;
      if (first) continue;
      const TurnContact begins = part.first_contact(holder_->bare, step).value_or(*met);
      first = Touch{begins, (static_cast<double>(i) + from + begins.t * (to - from)) /
                                static_cast<double>(turns.size())};
      first->contact.depth_mm = met->depth_mm + kContactTolerance_mm;
    }
    if (!touches) continue;
    // How deep it is by the end, not on a step.
    if (const auto whole = part.first_contact(holder_->thin, turns[i])) {
      first->contact.depth_mm =
          std::max(first->contact.depth_mm, whole->depth_mm + kContactTolerance_mm);
    }
  }
  return first;
}

void HolderChecks::tell(const TurnedMove& move, const Touch& touch, bool blank_guessed) {
  if (!event_) {
    const FindingId id = holder_->is_bar ? FindingId::kBarContact : FindingId::kHolderContact;
    const Grounds grounds{blank_guessed, move.tool_guessed};
    Finding finding = finding_at(id, severity_of(id, grounds), move.motion.source,
                                 move.step.time_at(touch.share));
    finding.text = (holder_->is_bar ? tr("the bar that holds the insert touches the workpiece")
                                    : tr("the tool's holder touches the workpiece")) +
                   doubt_of(id, grounds);
    const Vec2& at = touch.contact.at_mm;
    finding.position_mm = Vec3(at.y, move.motion.from_mm.y, at.x);
    finding.tool = move.tool;
    finding.bodies = {to_string(ToolPart::kHolder), kWorkpieceBody};
    event_ = log_.add(std::move(finding));
    CollisionPair& row = table_[holder_->row];
    if (row.contacts++ == 0) row.source = move.motion.source;
    row.least_clearance_mm = 0;
  }
  log_.deepen(*event_, touch.contact.depth_mm);
}

}  // namespace kerf
