#include "twin/process/turning/holder_checks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/translate.h"
#include "interp_bridge/motion_kinds.h"
#include "stock/turning/turned_gap.h"
#include "twin/process/contact_grounds.h"
#include "twin/process/finding_at.h"
#include "twin/process/turning/tool_outlines.h"
#include "twin/process/turning/turn_steps.h"

namespace kerf {

void HolderChecks::mount(const Cutter& cutter, int tool) {
  unmount();
  const ToolOutlines outlines = outlines_of(cutter);
  if (outlines.holder.parts.empty()) return;
  Vec2 low{0}, high{0};
  outline_box(outlines.holder, low, high);
  const TurningTool whole(outlines.holder);
  holder_ = Holder{whole, whole.inset(kContactTolerance_mm), whole.inset(kContactRounding_mm),
                   TurningTool(outlines.cutter), high.x - low.x > high.y - low.y};
  const auto known =
      std::ranges::find_if(table_, [&](const CollisionPair& row) { return row.tool == tool; });
  holder_->row = static_cast<std::size_t>(known - table_.begin());
  if (known != table_.end()) return;
  CollisionPair& row = table_.emplace_back();
  row.tool = tool;
  row.part = ToolPart::kHolder;
  nearest_.emplace_back();
}

void HolderChecks::begin_reporting() {
  unmount();
  table_.clear();
  nearest_.clear();
}

void HolderChecks::check(const TurnedMove& move, bool blank_guessed) {
  const std::vector<TurnMove> turns = rings_of(move);
  std::optional<Touch> touch = touch_of_traverse(turns);
  if (!is_traverse(move.motion)) {
    // Most of what is there the insert takes away first.
    if (touch) touch = touch_of_feed(turns);
  } else if (!touch) {
    event_.reset();
    measure_to(move, turns);
  }
  touched_ = touch.has_value();
  if (touch) tell(move, *touch, blank_guessed);
}

void HolderChecks::measure(const TurnedMove& move) {
  if (!touched_) measure_to(move, rings_of(move));
}

/// The move does not touch.
void HolderChecks::measure_to(const TurnedMove& move, std::span<const TurnMove> turns) {
  CollisionPair& row = table_[holder_->row];
  const double most = std::max(kMeasured_mm, 2 * clearance_mm_);
  row.clearance_above_mm = most;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const double below = row.least_clearance_mm ? *row.least_clearance_mm - kGrain_mm : most;
    if (below <= 0) return;
    const auto gap = least_gap(stock_.part(), holder_->whole, turns[i], below);
    if (!gap) continue;
    const double share = (static_cast<double>(i) + gap->t) / static_cast<double>(turns.size());
    row.least_clearance_mm = gap->mm;
    row.source = move.motion.source;
    Finding& near = nearest_[holder_->row];
    near = finding_at(FindingId::kNearMiss, Severity::kNote, move.motion.source,
                      move.step.time_at(share));
    near.position_mm = Vec3(gap->at_mm.y, move.motion.from_mm.y, gap->at_mm.x);
    near.tool = move.tool;
    near.bodies = {to_string(ToolPart::kHolder), kWorkpieceBody};
    near.text = holder_->is_bar
                    ? trf("the bar that holds the insert comes as near as {:.2f} mm to the "
                          "workpiece",
                          gap->mm)
                    : trf("the tool's holder comes as near as {:.2f} mm to the workpiece", gap->mm);
  }
}

void HolderChecks::finish() {
  for (std::size_t i = 0; i < table_.size(); ++i) {
    const CollisionPair& row = table_[i];
    if (row.contacts == 0 && row.least_clearance_mm && *row.least_clearance_mm < clearance_mm_)
      log_.add(nearest_[i]);
  }
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
        std::clamp(static_cast<int>(std::ceil(turn_way_mm(turns[i]) / kStep_mm)), 1, kMostSteps);
    bool touches = false;
    for (int k = 0; k < steps; ++k) {
      const double from = static_cast<double>(k) / steps, to = static_cast<double>(k + 1) / steps;
      const TurnMove step = turn_part(turns[i], from, to);
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
