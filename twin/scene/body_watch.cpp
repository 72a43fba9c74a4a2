#include "twin/scene/body_watch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "twin/machine/kinematics/kinematic_chain.h"
#include "twin/machines/machine_bodies.h"
#include "twin/scene/contact_places.h"
#include "twin/scene/fixture_bodies.h"
#include "twin/scene/tool_shape.h"

namespace kerf {
namespace {

/// Distances are shown in hundredths.
constexpr double kExact_mm = 0.002;
/// What goes less deep is no contact (fixture-contact).
constexpr double kTouchDepth_mm = 0.01;
/// Times that differ by less are the same.
constexpr double kSameTime_s = 1e-6;
/// Of the mark on the workpiece: of the width of what touches it there, and in all.
constexpr double kMarkShare = 0.06, kLeastMark_mm = 0.4, kMostMark_mm = 4;

constexpr std::array kParts{ToolPart::kCutter, ToolPart::kShank, ToolPart::kHolder,
                            ToolPart::kSpindle};

ToolPiece piece_of(ToolPart part) {
  switch (part) {
    case ToolPart::kShank:
      return ToolPiece::kShank;
    case ToolPart::kHolder:
      return ToolPiece::kHolder;
    case ToolPart::kSpindle:
      return ToolPiece::kSpindle;
    case ToolPart::kCutter:
      break;
  }
  return ToolPiece::kCutter;
}

bool is_same_pair(const SceneContact& a, const SceneContact& b) {
  return a.piece == b.piece && a.fixture == b.fixture && a.links == b.links &&
         a.has_workpiece == b.has_workpiece;
}

/// By the name that reports have for it: of the tool, of a fixture, of a link, the workpiece.
void add_body(const std::string& name, const DrawnBodies& drawn, SceneContact& contact) {
  for (const ToolPart part : kParts) {
    if (name != to_string(part) || contact.piece) continue;
    contact.piece = piece_of(part);
    return;
  }
  for (std::size_t i = 0; drawn.fixtures && i < drawn.fixtures->size(); ++i) {
    if ((*drawn.fixtures)[i].name != name) continue;
    contact.fixture = i;
    return;
  }
  const std::size_t fixtures = drawn.fixtures ? drawn.fixtures->size() : 0;
  for (std::size_t i = 0; drawn.held_by && i < drawn.held_by->size(); ++i) {
    if (name != to_string((*drawn.held_by)[i].kind)) continue;
    contact.fixture = fixtures + i;
    return;
  }
  for (std::size_t i = 0; drawn.machine && i < drawn.machine->links.size(); ++i) {
    if (drawn.machine->links[i].name != name) continue;
    contact.links.push_back(i);
    return;
  }
  contact.has_workpiece = contact.has_workpiece || name == kWorkpieceBody;
}

double distance_mm(const ToolBody& body, const Pose& fixture_from_tool, const Solid& solid,
                   double cutoff_mm) {
  double least = cutoff_mm;
  for (const Convex& piece : body.solid->pieces()) {
    const MovingConvex still{piece, fixture_from_tool, fixture_from_tool};
    least = std::min(least, solid.gap_to(still, least, kExact_mm).high_mm);
    if (least <= 0) return 0;
  }
  return solid.encloses(fixture_from_tool.origin_mm) ? 0 : least;
}

bool touches(const ToolBody& body, const Pose& fixture_from_tool, const Solid& solid) {
  if (solid.encloses(fixture_from_tool.origin_mm)) return true;
  std::vector<RoundedDisc> discs;
  std::array<Vec3, 2> corners{};
  return std::ranges::any_of(body.solid->pieces(), [&](const Convex& piece) {
    const Convex thin = eroded(piece, kTouchDepth_mm, discs, corners);
    const MovingConvex still{thin, fixture_from_tool, fixture_from_tool};
    return solid.gap_to(still, 0, kExact_mm).high_mm <= 0;
  });
}

}  // namespace

Pose pose_of(const ToolPose& tool) {
  const Vec3 z = glm::normalize(tool.axis);
  const Vec3 across = std::abs(z.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 y = glm::normalize(glm::cross(z, across));
  return {glm::dmat3(glm::cross(y, z), y, z), tool.tip_mm};
}

std::optional<SceneContact> contact_of(const Finding& finding, const DrawnBodies& drawn) {
  if (!finding.has_bodies()) return std::nullopt;
  SceneContact contact;
  contact.is_near = finding.id == FindingId::kNearMiss;
  for (const std::string& name : finding.bodies) add_body(name, drawn, contact);
  const bool has_one = contact.piece || contact.fixture || !contact.links.empty();
  return has_one ? std::optional(std::move(contact)) : std::nullopt;
}

BodyWatch::BodyWatch(CollisionWishes wishes) : wishes_(std::move(wishes)), held_(wishes_.held_by) {
  SceneMachine scene;
  if (fixtures()) scene = scene_fixtures(*fixtures());
  for (MachineLink& link : held_links(wishes_.held_by)) scene.links.push_back(std::move(link));
  scene_ = std::make_shared<const SceneMachine>(std::move(scene));
  if (fixtures() && wishes_.machine) link_groups_ = rigid_groups(wishes_.machine->chain);
  set_link_poses({});
}

void BodyWatch::set_machine(std::shared_ptr<const SceneMachine> machine) {
  machine_ = std::move(machine);
  set_link_poses({});
}

void BodyWatch::set_link_poses(std::span<const glm::mat4> link_poses) {
  static const SceneMachine kNone;
  if (fixtures()) places_ = fixture_places(*fixtures(), machine_ ? *machine_ : kNone, link_poses);
  std::vector<glm::mat4> poses = fixture_poses(places_);
  poses.resize(places_.size() + held_.size(), glm::mat4(1.0f));
  if (poses == poses_) return;
  poses_ = std::move(poses);
  measured_.reset();
}

/// As the spindle does: they never come nearer to each other.
bool BodyWatch::goes_with_tool(const Fixture& fixture) const {
  if (fixture.on.empty() || link_groups_.empty()) return false;
  const KinematicChain& chain = wishes_.machine->chain;
  const std::optional<std::size_t> link = chain.find(fixture.on);
  return link && link_groups_[*link] == link_groups_[chain.tool_link()];
}

std::shared_ptr<const ToolShape> BodyWatch::mount(const std::shared_ptr<const Cutter>& cutter,
                                                  double nose_z_mm) {
  // Without a spindle it does not matter where its nose would be.
  const double nose_mm = wishes_.spindle.empty() ? 0 : nose_z_mm;
  if (std::exchange(is_mounted_, true) && cutter == cutter_ && nose_mm == nose_z_mm_)
    return nullptr;
  cutter_ = cutter;
  nose_z_mm_ = nose_mm;
  measured_.reset();
  for (Told& told : told_) told.seen_from.reset();
  bodies_.clear();
  held_.mount(cutter.get());
  if (!cutter) return std::make_shared<const ToolShape>();
  bodies_ = tool_bodies(*cutter, wishes_.spindle, nose_mm);
  return tool_shape_of(*cutter, wishes_.spindle, nose_mm);
}

void BodyWatch::set_findings(const std::vector<Finding>& findings) {
  std::vector<Told> told;
  for (const Finding& finding : findings) {
    if (!finding.time_s) continue;
    if (const auto contact = contact_of(finding, drawn()))
      told.push_back({*finding.time_s, *contact, std::nullopt});
  }
  told_ = std::move(told);
}

void BodyWatch::add_finding(const Finding& finding, double time_s) {
  std::erase_if(told_, [&](const Told& told) { return told.time_s < time_s - kRed_s; });
  if (const auto contact = contact_of(finding, drawn()))
    told_.push_back({time_s, *contact, std::nullopt});
}

const ToolBody* BodyWatch::body_of(ToolPiece piece) const {
  for (const ToolBody& body : bodies_)
    if (piece_of(body.part) == piece) return &body;
  return nullptr;
}

/// Each part of the tool against each fixture, as it stands. False: one is nowhere.
bool BodyWatch::measure_fixtures(const Pose& tool, SceneClearance& nearest) {
  bool is_known = true;
  for (std::size_t i = 0; i < fixture_count(); ++i) {
    const Fixture& fixture = (*fixtures())[i];
    if (goes_with_tool(fixture)) continue;
    if (!places_[i]) {
      is_known = false;
      continue;
    }
    const Pose fixture_from_tool = places_[i]->inverse() * tool;
    for (const ToolBody& body : bodies_) {
      const double mm = distance_mm(body, fixture_from_tool, *fixture.solid, kReach_mm);
      if (mm <= 0 && touches(body, fixture_from_tool, *fixture.solid)) {
        SceneContact contact;
        contact.piece = piece_of(body.part);
        contact.fixture = i;
        touched_.push_back(contact);
      }
      if (mm >= nearest.mm) continue;
      nearest = {mm, false, name_of(body.part), fixture.name};
    }
  }
  return is_known;
}

/// Insert and holder against chuck, jaws and tailstock, in the plane of the axis.
void BodyWatch::measure_held(const Vec3& tip_mm, SceneClearance& nearest) {
  for (std::size_t i = 0; i < held_.size(); ++i) {
    for (const ToolPart part : {ToolPart::kCutter, ToolPart::kHolder}) {
      const TurnedProfile& outline =
          part == ToolPart::kCutter ? held_.tool().cutter : held_.tool().holder;
      const auto gap = gap_between(outline, {tip_mm.z, tip_mm.x}, held_.profile(i));
      if (!gap) continue;
      if (gap->depth_mm > kTouchDepth_mm) {
        SceneContact contact;
        contact.piece = piece_of(part);
        contact.fixture = fixture_count() + i;
        touched_.push_back(contact);
      }
      if (gap->mm >= nearest.mm) continue;
      nearest = {gap->mm, false, name_of(part), name_of(held_.kind(i))};
    }
  }
}

void BodyWatch::measure(const ToolPose& tool) {
  if (measured_ == tool) return;
  measured_ = tool;
  clearance_.reset();
  touched_.clear();
  const bool has_fixtures = fixture_count() > 0 && !bodies_.empty();
  const bool is_held = held_.size() > 0 && held_.is_mounted();
  if (!has_fixtures && !is_held) return;
  SceneClearance nearest;
  nearest.mm = kReach_mm;
  nearest.is_beyond = true;
  // What is nowhere may be nearer.
  const bool is_known = !has_fixtures || measure_fixtures(pose_of(tool), nearest);
  if (is_held) measure_held(tool.tip_mm, nearest);
  if (is_known) clearance_ = std::move(nearest);
}

void BodyWatch::add_told(const ToolPose& tool, double time_s, double speed, const StockModel* stock,
                         std::vector<SceneContact>& contacts) {
  for (Told& told : told_) {
    const double since_s = time_s - told.time_s;
    if (since_s < -kSameTime_s || since_s > kRed_s * speed + kSameTime_s) continue;
    const bool is_known = std::ranges::any_of(
        contacts, [&](const SceneContact& c) { return is_same_pair(c, told.contact); });
    if (is_known) continue;
    const ToolBody* const body = told.contact.piece ? body_of(*told.contact.piece) : nullptr;
    // Where the event began it is looked for once, not for each picture after it.
    if (!told.seen_from && told.contact.has_workpiece && body && stock) {
      told.seen_from = tool;
      told.contact.mark_mm = std::clamp(kMarkShare * body->width_mm, kLeastMark_mm, kMostMark_mm);
      told.contact.point_mm = body->part == ToolPart::kCutter
                                  ? tool.tip_mm
                                  : place_on_workpiece(*body, pose_of(tool), *stock);
    }
    contacts.push_back(told.contact);
  }
}

void BodyWatch::look(const ToolPose& tool, double time_s, double speed, const StockModel* stock,
                     Moment* moment) {
  measure(tool);
  moment->clearance = clearance_;
  moment->contacts = touched_;
  add_told(tool, time_s, std::isfinite(speed) ? speed : 1.0, stock, moment->contacts);
}

}  // namespace kerf
