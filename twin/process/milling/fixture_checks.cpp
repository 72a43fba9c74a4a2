#include "twin/process/milling/fixture_checks.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/translate.h"
#include "interp_bridge/motion_kinds.h"

namespace kerf {
namespace {

/// Distances are kept to this: a least one that is less by no more is no new one.
constexpr double kGrain_mm = 0.005;
/// Nearer than this may be a contact.
constexpr double kContactGap_mm = 1e-3;
/// How far beyond the least distance it is looked, so that moves that follow need no look.
constexpr double kAhead_mm = 2;

SolidPointer thinner(const Solid& solid, double by_mm) {
  std::vector<std::vector<RoundedDisc>> hulls;
  std::array<Vec3, 2> corners{};
  for (const Convex& piece : solid.pieces()) {
    hulls.emplace_back();
    eroded(piece, by_mm, hulls.back(), corners);
  }
  return Solid::of_hulls(hulls);
}

std::optional<double> first_of(const Solid& body, const RigidWay& way, const Solid& still,
                               Vec3& guess) {
  std::optional<double> first;
  for (const Convex& piece : body.pieces()) {
    const auto t = first_touch(piece, way, still, guess);
    if (t && (!first || *t < *first)) first = t;
  }
  return first;
}

std::string contact_text(const std::string& part, double width_mm, double from_z_mm, ToolPart which,
                         const std::string& fixture) {
  if (which == ToolPart::kCutter) return trf("{} touches fixture '{}'", part, fixture);
  return trf("{} ({:.4g} mm wide, {:.4g} mm above the tip) touches fixture '{}'", part, width_mm,
             from_z_mm, fixture);
}

}  // namespace

/// A move as a way in a fixture's frame.
struct FixtureChecks::Way final : RigidWay {
  Way(const ToolWay& tool, const Fixture& fixture)
      : tool_way(tool), fixture_from_workpiece(fixture.fixture_from_workpiece) {}
  Pose pose(double t) const override { return fixture_from_workpiece * tool_way.pose(t); }
  double slack_mm(double from, double to, double reach_mm) const override {
    return tool_way.slack_mm(from, to, reach_mm);
  }
  double turning_mm(double from, double to, double reach_mm) const override {
    return tool_way.turning_mm(from, to, reach_mm);
  }
  double travel_mm(double from, double to, double reach_mm) const override {
    return tool_way.travel_mm(from, to, reach_mm);
  }
  const ToolWay& tool_way;
  const Pose& fixture_from_workpiece;
};

void FixtureChecks::set_wishes(const CollisionWishes& wishes) {
  wishes_ = wishes;
  boxes_.clear();
  if (!wishes_.fixtures) return;
  auto here = std::make_shared<std::vector<Fixture>>(*wishes.fixtures);
  std::erase_if(*here, [](const Fixture& fixture) { return !fixture.on.empty(); });
  wishes_.fixtures = std::move(here);
  for (const Fixture& fixture : *wishes_.fixtures) boxes_.emplace_back(*fixture.solid);
}

bool FixtureChecks::checks_spindle() const {
  return std::ranges::any_of(
      mounted_, [](const Mounted& part) { return part.body.part == ToolPart::kSpindle; });
}

std::size_t FixtureChecks::pair_of(int tool, const ToolBody& body, std::size_t fixture) {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const Pair& pair = pairs_[i];
    if (pair.row.tool == tool && pair.row.part == body.part && pair.fixture == fixture) return i;
  }
  const Fixture& other = (*wishes_.fixtures)[fixture];
  Pair pair;
  pair.row.tool = tool;
  pair.row.part = body.part;
  pair.row.other = other.name;
  pair.fixture = fixture;
  pair.width_mm = body.width_mm;
  pair.from_z_mm = body.from_z_mm;
  pair.ignored = wishes_.rules.ignores(to_string(body.part), other.name);
  pair.near_mm = wishes_.rules.clearance_mm(to_string(body.part), other.name)
                     .value_or(other.clearance_mm.value_or(wishes_.clearance_mm));
  pairs_.push_back(std::move(pair));
  return pairs_.size() - 1;
}

void FixtureChecks::mount(const Cutter& cutter, int tool, bool guessed, double nose_mm) {
  mounted_.clear();
  if (!active()) return;
  tool_ = tool;
  guessed_ = guessed;
  for (Pair& pair : pairs_) pair.event.reset();
  const std::size_t count = wishes_.fixtures->size();
  for (ToolBody& body : tool_bodies(cutter, wishes_.spindle, nose_mm)) {
    Mounted part;
    part.thin = thinner(*body.solid, kContactTolerance_mm);
    part.bare = thinner(*body.solid, kContactRounding_mm);
    for (const Convex& piece : body.solid->pieces())
      part.reach_mm = std::max(part.reach_mm, reach_of(piece));
    for (std::size_t i = 0; i < count; ++i) part.pairs.push_back(pair_of(tool, body, i));
    part.spare_mm.assign(count, -1);
    part.guess.assign(count, Vec3{0});
    part.body = std::move(body);
    mounted_.push_back(std::move(part));
  }
}

void FixtureChecks::check(const CheckedMove& move) {
  const std::size_t count = wishes_.fixtures->size();
  for (std::size_t which = 0; which < move.moves.size(); ++which) {
    const CutMove& now = move.moves[which];
    const bool goes_on = last_ && last_->to_mm == now.from_mm && last_->axis_to == now.axis_from;
    if (!goes_on)
      for (Mounted& part : mounted_) std::ranges::fill(part.spare_mm, -1);
    last_ = now;
    const ToolWay tool_way(now);
    for (std::size_t fixture = 0; fixture < count; ++fixture) {
      const Way way(tool_way, (*wishes_.fixtures)[fixture]);
      const std::optional<Box> tip = upright_tip_box(now, way.fixture_from_workpiece);
      for (Mounted& part : mounted_) {
        bool touched = false;
        check_pair(part, fixture, move, which, way, tip, touched);
        Pair& pair = pairs_[part.pairs[fixture]];
        if (pair.event && !touched && is_traverse(move.motion)) pair.event.reset();
      }
    }
  }
}

void FixtureChecks::check_pair(Mounted& part, std::size_t fixture, const CheckedMove& move,
                               std::size_t which, const Way& way, const std::optional<Box>& tip,
                               bool& touched) {
  Pair& pair = pairs_[part.pairs[fixture]];
  if (pair.ignored) return;
  const Solid& still = *(*wishes_.fixtures)[fixture].solid;
  double& spare = part.spare_mm[fixture];
  Vec3& guess = part.guess[fixture];
  const double travel = way.travel_mm(0, 1, part.reach_mm);
  // What would be a new least distance; 0: a contact.
  const double counts = std::max(pair.least_mm - kGrain_mm, 0.0);
  spare -= travel;
  if (spare > 0 && spare >= counts) return;
  if (tip) {
    const Box& own = part.body.solid->box_mm();
    const double apart = boxes_[fixture].gap_mm({tip->min + own.min, tip->max + own.max});
    if (apart > kContactGap_mm && apart >= counts) {
      spare = apart;
      return;
    }
  }
  const auto pieces = part.body.solid->pieces();
  if (pair.least_mm > kGrain_mm) {
    std::optional<LeastGap> least;
    // A little more is looked for than counts, so that what comes next need not be looked at.
    double below = counts + kAhead_mm;
    for (const Convex& piece : pieces) {
      const auto gap = least_gap(piece, way, still, below, guess);
      if (!gap) continue;
      least = gap;
      below = gap->mm;
    }
    spare = below;
    if (least && least->mm < counts) note_least(pair, move, which, way, *least);
    if (spare > kContactGap_mm) return;
  }
  spare = -1;
  std::optional<double> first = first_of(*part.thin, way, still, guess);
  if (!first) return;
  touched = true;
  // What grazes has gone a long way before it is as deep as a contact must be.
  if (!pair.event) first = first_of(*part.bare, way, still, guess).value_or(*first);
  meet(part, pair, move, which, way, *first);
}

void FixtureChecks::note_least(Pair& pair, const CheckedMove& move, std::size_t which,
                               const Way& way, const LeastGap& gap) {
  pair.least_mm = gap.mm;
  pair.row.source = move.motion.source;
  if (gap.mm >= pair.near_mm) return;
  Finding& near = pair.nearest;
  near.source = move.motion.source;
  near.time_s = move.time_s(which, gap.t);
  near.position_mm = way.tool_way.pose(gap.t).origin_mm;
  near.tool = tool_;
}

void FixtureChecks::meet(Mounted& part, Pair& pair, const CheckedMove& move, std::size_t which,
                         const Way& way, double t) {
  const std::string& name = pair.row.other;
  if (!pair.event) {
    const Grounds grounds{false, guessed_};
    Finding finding;
    finding.id = FindingId::kFixtureContact;
    finding.severity = severity_of(finding.id, grounds);
    finding.text =
        contact_text(name_of(part.body.part), pair.width_mm, pair.from_z_mm, part.body.part, name) +
        doubt_of(finding.id, grounds);
    finding.source = move.motion.source;
    finding.time_s = move.time_s(which, t);
    finding.position_mm = way.tool_way.pose(t).origin_mm;
    finding.tool = tool_;
    finding.bodies = {to_string(part.body.part), name};
    pair.event = log_.add(std::move(finding));
    pair.depth_mm = 0;
    if (pair.row.contacts++ == 0) pair.row.source = move.motion.source;
  }
  pair.least_mm = 0;
  // Only what is deeper than known is measured.
  const Solid& still = *(*wishes_.fixtures)[pair.fixture].solid;
  std::vector<RoundedDisc> discs;
  std::array<Vec3, 2> corners{};
  Vec3 guess{0};
  for (const Convex& piece : part.body.solid->pieces()) {
    const double known = pair.depth_mm + kContactTolerance_mm;
    if (known >= half_thickness_mm(piece)) continue;
    if (!first_touch(eroded(piece, known, discs, corners), way, still, guess)) continue;
    pair.depth_mm = std::max(pair.depth_mm, touch_depth_mm(piece, way, still));
  }
  log_.deepen(*pair.event, pair.depth_mm);
}

void FixtureChecks::begin_reporting() {
  unmount();
  pairs_.clear();
}

void FixtureChecks::finish() {
  for (Pair& pair : pairs_) {
    if (pair.row.contacts > 0 || pair.least_mm >= pair.near_mm) continue;
    Finding near = pair.nearest;
    near.id = FindingId::kNearMiss;
    near.severity = Severity::kNote;
    near.bodies = {to_string(pair.row.part), pair.row.other};
    near.text = trf("{} comes as near as {:.2f} mm to fixture '{}'", name_of(pair.row.part),
                    pair.least_mm, pair.row.other);
    log_.add(std::move(near));
  }
}

std::vector<CollisionPair> FixtureChecks::table() const {
  std::vector<CollisionPair> out;
  for (const Pair& pair : pairs_) {
    if (pair.ignored) continue;
    out.push_back(pair.row);
    if (std::isfinite(pair.least_mm))
      out.back().least_clearance_mm = pair.row.contacts > 0 ? 0 : pair.least_mm;
  }
  return out;
}

}  // namespace kerf
