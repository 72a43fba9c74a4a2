#include "twin/process/fixture_checks.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/translate.h"
#include "interp_bridge/motion_kinds.h"
#include "twin/process/contact_grounds.h"
#include "twin/process/holding_texts.h"

namespace kerf {
namespace {

/// Distances are kept to this: a least one that is less by no more is no new one.
constexpr double kObstacleGrain_mm = 0.005;
/// Nearer than this may be a contact.
constexpr double kContactGap_mm = 1e-3;
/// How far beyond the least distance it is looked, so that moves that follow need no look.
constexpr double kObstacleAhead_mm = 2;

std::optional<double> first_of(const CarriedPieces& body, const RigidWay& way, const Solid& still,
                               Vec3& guess) {
  std::optional<double> first;
  for (const Convex& piece : body.pieces) {
    const auto t = first_touch(piece, way, still, guess);
    if (t && (!first || *t < *first)) first = t;
  }
  return first;
}

std::string contact_text(const std::string& part, double width_mm, double from_z_mm, ToolPart which,
                         const std::string& fixture) {
  if (which == ToolPart::kCutter || width_mm == 0)
    return trf("{} touches fixture '{}'", part, fixture);
  return trf("{} ({:.4g} mm wide, {:.4g} mm above the tip) touches fixture '{}'", part, width_mm,
             from_z_mm, fixture);
}

}  // namespace

std::vector<Obstacle> obstacles_of(const FixtureList& fixtures) {
  std::vector<Obstacle> out;
  if (!fixtures) return out;
  for (const Fixture& fixture : *fixtures) {
    if (!fixture.on.empty()) continue;
    out.push_back({fixture.name, fixture.solid, fixture.fixture_from_workpiece,
                   fixture.clearance_mm, std::nullopt});
  }
  return out;
}

std::vector<Obstacle> obstacles_of(std::span<const HoldingBody> bodies) {
  std::vector<Obstacle> out;
  for (const HoldingBody& body : bodies) {
    // Tubes, and the centre's cone with its quill, which is the hull of its corners' discs.
    const std::vector<Vec2> corners = body.ring.profile().front();
    const auto [low, high] = std::ranges::minmax(corners, {}, &Vec2::x);
    const auto [inner, outer] = std::ranges::minmax(corners, {}, &Vec2::y);
    Obstacle obstacle;
    obstacle.name = to_string(body.kind);
    obstacle.kind = body.kind;
    if (body.kind == HoldingBody::Kind::kTailstock || inner.y <= 0) {
      std::vector<RoundedDisc> discs;
      for (const Vec2& corner : corners) discs.push_back({corner.y, corner.x, 0});
      obstacle.solid = Solid::of_hulls(std::span(&discs, 1));
    } else {
      BlankBody tube;
      tube.kind = BlankBody::Kind::kTube;
      tube.diameter_mm = 2 * outer.y;
      tube.inner_diameter_mm = 2 * inner.y;
      tube.bounds_mm = {{-outer.y, -outer.y, low.x}, {outer.y, outer.y, high.x}};
      obstacle.solid = Solid::of_bodies(std::span(&tube, 1));
    }
    out.push_back(std::move(obstacle));
  }
  return out;
}

/// A move as a way in an obstacle's frame.
struct FixtureChecks::Way final : RigidWay {
  Way(const ToolWay& tool, const Obstacle& obstacle, bool tool_stands)
      : tool_way(tool),
        obstacle_from_workpiece(obstacle.obstacle_from_workpiece),
        stands(tool_stands) {}
  Pose pose(double t) const override {
    Pose tool = tool_way.pose(t);
    if (stands) tool.rotation = glm::dmat3(1);
    return obstacle_from_workpiece * tool;
  }
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
  const Pose& obstacle_from_workpiece;
  bool stands;
};

void FixtureChecks::set_obstacles(std::vector<Obstacle> obstacles, const CollisionWishes& wishes) {
  obstacles_ = std::move(obstacles);
  rules_ = wishes.rules;
  clearance_mm_ = wishes.clearance_mm;
  boxes_.clear();
  for (const Obstacle& obstacle : obstacles_) boxes_.emplace_back(*obstacle.solid);
}

std::size_t FixtureChecks::pair_of(int tool, const CarriedBody& body, std::size_t obstacle) {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const Pair& pair = pairs_[i];
    if (pair.row.tool == tool && pair.row.part == body.part && pair.obstacle == obstacle) return i;
  }
  const Obstacle& other = obstacles_[obstacle];
  Pair pair;
  pair.row.tool = tool;
  pair.row.part = body.part;
  pair.row.other = other.name;
  pair.obstacle = obstacle;
  pair.width_mm = body.width_mm;
  pair.from_z_mm = body.from_z_mm;
  pair.set_rules(rules_, other.clearance_mm.value_or(clearance_mm_));
  pairs_.push_back(std::move(pair));
  return pairs_.size() - 1;
}

void FixtureChecks::mount(std::vector<CarriedBody> bodies, int tool, bool guessed) {
  mounted_.clear();
  if (!active()) return;
  tool_ = tool;
  guessed_ = guessed;
  for (Pair& pair : pairs_) pair.event.reset();
  const std::size_t count = obstacles_.size();
  for (CarriedBody& body : bodies) {
    Mounted part;
    for (const Convex& piece : body.whole.pieces)
      part.reach_mm = std::max(part.reach_mm, reach_of(piece));
    for (std::size_t i = 0; i < count; ++i) part.pairs.push_back(pair_of(tool, body, i));
    part.spare_mm.assign(count, -1);
    part.guess.assign(count, Vec3{0});
    part.body = std::move(body);
    mounted_.push_back(std::move(part));
  }
}

double FixtureChecks::reach_mm() const {
  double reach = 0;
  for (const Mounted& part : mounted_) reach = std::max(reach, part.reach_mm);
  return reach;
}

void FixtureChecks::check(const CheckedMove& move) {
  const std::size_t count = obstacles_.size();
  for (std::size_t which = 0; which < move.moves.size(); ++which) {
    const CutMove& now = move.moves[which];
    const bool goes_on = last_ && last_->to_mm == now.from_mm && last_->axis_to == now.axis_from;
    if (!goes_on)
      for (Mounted& part : mounted_) std::ranges::fill(part.spare_mm, -1);
    last_ = now;
    const ToolWay tool_way(now);
    for (std::size_t i = 0; i < count; ++i) {
      const Pose& from_workpiece = obstacles_[i].obstacle_from_workpiece;
      const std::optional<Box> tip = upright_tip_box(now, from_workpiece);
      const bool turned = from_workpiece.rotation != glm::dmat3(1);
      for (Mounted& part : mounted_) {
        bool touched = false;
        const bool stands = part.body.stands;
        // What does not turn about its own axis has another box in a frame that is turned.
        check_pair(part, i, move, which, Way(tool_way, obstacles_[i], stands),
                   stands && turned ? std::nullopt : tip, touched);
        Pair& pair = pairs_[part.pairs[i]];
        if (pair.event && !touched && is_traverse(move.motion)) pair.event.reset();
      }
    }
  }
}

void FixtureChecks::check_pair(Mounted& part, std::size_t obstacle, const CheckedMove& move,
                               std::size_t which, const Way& way, const std::optional<Box>& tip,
                               bool& touched) {
  Pair& pair = pairs_[part.pairs[obstacle]];
  if (pair.ignored) return;
  const Solid& still = *obstacles_[obstacle].solid;
  double& spare = part.spare_mm[obstacle];
  Vec3& guess = part.guess[obstacle];
  const double travel = way.travel_mm(0, 1, part.reach_mm);
  // What would be a new least distance; 0: a contact.
  const double counts = std::max(pair.least_mm - kObstacleGrain_mm, 0.0);
  spare -= travel;
  if (spare > 0 && spare >= counts) return;
  if (tip) {
    const Box& own = part.body.whole.box_mm;
    const double apart = boxes_[obstacle].gap_mm({tip->min + own.min, tip->max + own.max});
    if (apart > kContactGap_mm && apart >= counts) {
      spare = apart;
      return;
    }
  }
  if (pair.least_mm > kObstacleGrain_mm) {
    std::optional<LeastGap> least;
    // A little more is looked for than counts, so that what comes next need not be looked at.
    double below = counts + kObstacleAhead_mm;
    for (const Convex& piece : part.body.whole.pieces) {
      const auto gap = least_gap(piece, way, still, below, counts, guess);
      if (!gap) continue;
      least = gap;
      below = gap->mm;
    }
    spare = below;
    if (least && least->mm < counts)
      pair.note(least->mm, move.motion.source, move.time_s(which, least->t),
                way.tool_way.pose(least->t).origin_mm);
    if (spare > kContactGap_mm) return;
  }
  spare = -1;
  std::optional<double> first = first_of(part.body.thin, way, still, guess);
  if (!first) return;
  touched = true;
  // What grazes has gone a long way before it is as deep as a contact must be.
  if (!pair.event) first = first_of(part.body.bare, way, still, guess).value_or(*first);
  meet(part, pair, move, which, way, *first);
}

void FixtureChecks::meet(Mounted& part, Pair& pair, const CheckedMove& move, std::size_t which,
                         const Way& way, double t) {
  if (!pair.event) {
    Finding finding = contact_of(pair);
    finding.source = move.motion.source;
    finding.time_s = move.time_s(which, t);
    finding.position_mm = way.tool_way.pose(t).origin_mm;
    pair.event = log_.add(std::move(finding));
    pair.depth_mm = 0;
    pair.count_contact(move.motion.source);
  }
  pair.least_mm = 0;
  // Only what is deeper than known is measured.
  pair.depth_mm = part.body.depth_mm(way, *obstacles_[pair.obstacle].solid, pair.depth_mm);
  log_.deepen(*pair.event, pair.depth_mm);
}

/// Without line, time and place.
Finding FixtureChecks::contact_of(const Pair& pair) const {
  const std::optional<HoldingBody::Kind> kind = obstacles_[pair.obstacle].kind;
  const ToolPart part = pair.row.part;
  const Grounds grounds{false, guessed_};
  Finding finding;
  finding.id = kind ? holding_contact_id(*kind) : FindingId::kFixtureContact;
  finding.severity = severity_of(finding.id, grounds);
  finding.text =
      (kind ? holding_contact_text(part, *kind)
            : contact_text(name_of(part), pair.width_mm, pair.from_z_mm, part, pair.row.other)) +
      doubt_of(finding.id, grounds);
  finding.tool = tool_;
  finding.bodies = {to_string(part), pair.row.other};
  return finding;
}

void FixtureChecks::begin_reporting() {
  unmount();
  pairs_.clear();
}

void FixtureChecks::finish() {
  for (const Pair& pair : pairs_) {
    std::optional<Finding> near = pair.near_miss();
    if (!near) continue;
    const std::optional<HoldingBody::Kind> kind = obstacles_[pair.obstacle].kind;
    near->text = kind ? holding_near_text(pair.row.part, *kind, pair.least_mm)
                      : trf("{} comes as near as {:.2f} mm to fixture '{}'", name_of(pair.row.part),
                            pair.least_mm, pair.row.other);
    log_.add(std::move(*near));
  }
}

std::vector<CollisionPair> FixtureChecks::table() const { return rows_of(pairs_); }

}  // namespace kerf
