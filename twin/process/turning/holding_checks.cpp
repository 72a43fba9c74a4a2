#include "twin/process/turning/holding_checks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/portable_math.h"
#include "interp_bridge/motion_kinds.h"
#include "stock/turning/turned_gap.h"
#include "stock/turning/turning_stock.h"
#include "twin/motion/motion_geometry.h"
#include "twin/process/contact_grounds.h"
#include "twin/process/holding_texts.h"
#include "twin/process/turning/tool_outlines.h"

namespace kerf {
namespace {

/// Distances are kept to this: a least one that is less by no more is no new one.
constexpr double kHoldGrain_mm = 0.005;

/// No part of the tool is nearer to the body than that on the whole motion.
double boxes_apart_mm(const Box& way, const Vec2& low, const Vec2& high, const Box& body) {
  // Of |x|, whichever side of the axis.
  const double x0 = way.min.x + low.y, x1 = way.max.x + high.y;
  const double near_r = x0 <= 0 && x1 >= 0 ? 0 : std::min(std::abs(x0), std::abs(x1));
  const double along =
      std::max({0.0, way.min.z + low.x - body.max.z, body.min.z - (way.max.z + high.x)});
  return portable::hypot(along, std::max(0.0, near_r - body.max.x));
}

}  // namespace

void HoldingChecks::set_wishes(const CollisionWishes& wishes) {
  bodies_ = *wishes.held_by;
  wishes_ = wishes;
}

std::size_t HoldingChecks::pair_of(int tool, ToolPart part, std::size_t body) {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const Pair& pair = pairs_[i];
    if (pair.row.tool == tool && pair.row.part == part && pair.body == body) return i;
  }
  const char* const other = to_string(bodies_[body].kind);
  Pair pair;
  pair.row.tool = tool;
  pair.row.part = part;
  pair.row.other = other;
  pair.body = body;
  pair.set_rules(wishes_.rules, wishes_.clearance_mm);
  pairs_.push_back(std::move(pair));
  return pairs_.size() - 1;
}

void HoldingChecks::mount(const Cutter& cutter, int tool, bool guessed) {
  mounted_.clear();
  if (!active()) return;
  tool_ = tool;
  guessed_ = guessed;
  for (Pair& pair : pairs_) pair.event.reset();
  const ToolOutlines outlines = outlines_of(cutter);
  for (const ToolPart part : {ToolPart::kCutter, ToolPart::kHolder}) {
    const InsertOutline& outline = part == ToolPart::kCutter ? outlines.cutter : outlines.holder;
    if (outline.parts.empty()) continue;
    const TurningTool whole(outline);
    Mounted mounted{part, whole, whole.inset(kContactTolerance_mm),
                    whole.inset(kContactRounding_mm)};
    outline_box(outline, mounted.low_mm, mounted.high_mm);
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      mounted.pairs.push_back(pair_of(tool, part, i));
    mounted_.push_back(std::move(mounted));
  }
}

void HoldingChecks::check(const TurnedMove& move) {
  const Box way = bounds_of(move.motion);
  std::vector<TurnMove> turns;
  for (const Mounted& part : mounted_) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      Pair& pair = pairs_[part.pairs[i]];
      if (pair.ignored) continue;
      const double apart =
          boxes_apart_mm(way, part.low_mm, part.high_mm, bodies_[i].ring.bounds_mm());
      const bool is_new = apart < std::max(pair.least_mm - kHoldGrain_mm, 0.0);
      if (apart > 0 && !is_new) {
        if (is_traverse(move.motion)) pair.event.reset();
        continue;
      }
      if (turns.empty()) turns = rings_of(move);
      check_pair(part, pair, move, turns, apart);
    }
  }
}

void HoldingChecks::check_pair(const Mounted& part, Pair& pair, const TurnedMove& move,
                               std::span<const TurnMove> turns, double apart_mm) {
  const TurnedPart& body = bodies_[pair.body].ring;
  const auto count = static_cast<double>(turns.size());
  // 0: it is known that they have touched.
  if (pair.least_mm > kHoldGrain_mm) {
    for (std::size_t i = 0; i < turns.size(); ++i) {
      const double below = std::max(pair.least_mm - kHoldGrain_mm, 0.0);
      const auto gap = least_gap(body, part.whole, turns[i], below);
      if (!gap) continue;
      pair.note(gap->mm, move.motion.source,
                move.step.time_at((static_cast<double>(i) + gap->t) / count),
                Vec3(gap->at_mm.y, move.motion.from_mm.y, gap->at_mm.x));
    }
    if (pair.least_mm > kHoldGrain_mm) {
      if (is_traverse(move.motion)) pair.event.reset();
      return;
    }
  }
  if (apart_mm == 0) meet(part, pair, move, turns);
}

void HoldingChecks::meet(const Mounted& part, Pair& pair, const TurnedMove& move,
                         std::span<const TurnMove> turns) {
  const TurnedPart& body = bodies_[pair.body].ring;
  double depth_mm = 0;
  std::optional<TurnContact> first;
  double share = 0;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const auto met = body.first_contact(part.thin, turns[i]);
    if (!met) continue;
    depth_mm = std::max(depth_mm, met->depth_mm + kContactTolerance_mm);
    if (first) continue;
    // What grazes has gone a long way before it is as deep as a contact must be.
    first = body.first_contact(part.bare, turns[i]).value_or(*met);
    share = (static_cast<double>(i) + first->t) / static_cast<double>(turns.size());
  }
  if (!first) {
    if (is_traverse(move.motion)) pair.event.reset();
    return;
  }
  pair.least_mm = 0;
  if (!pair.event) {
    const HoldingBody::Kind kind = bodies_[pair.body].kind;
    const Grounds grounds{false, guessed_};
    Finding finding;
    finding.id = holding_contact_id(kind);
    finding.severity = severity_of(finding.id, grounds);
    finding.text = holding_contact_text(part.part, kind) + doubt_of(finding.id, grounds);
    finding.source = move.motion.source;
    finding.time_s = move.step.time_at(share);
    finding.position_mm = Vec3(first->at_mm.y, move.motion.from_mm.y, first->at_mm.x);
    finding.tool = tool_;
    finding.bodies = {to_string(part.part), pair.row.other};
    pair.event = log_.add(std::move(finding));
    pair.count_contact(move.motion.source);
  }
  log_.deepen(*pair.event, depth_mm);
}

void HoldingChecks::begin_reporting() {
  unmount();
  pairs_.clear();
}

void HoldingChecks::finish() {
  for (const Pair& pair : pairs_) {
    std::optional<Finding> near = pair.near_miss();
    if (!near) continue;
    near->text = holding_near_text(pair.row.part, bodies_[pair.body].kind, pair.least_mm);
    log_.add(std::move(*near));
  }
}

std::vector<CollisionPair> HoldingChecks::table() const { return rows_of(pairs_); }

}  // namespace kerf
