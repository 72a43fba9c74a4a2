#include "twin/scene/finding_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <limits>
#include <utility>

#include "twin/collision/solid_sweep.h"
#include "twin/scene/contact_places.h"
#include "twin/scene/turned_finding_view.h"

namespace kerf {
namespace {

/// Shown of what lies about the place: of the tool's length, and at least.
constexpr double kAboutShare = 0.7, kLeastAbout_mm = 15;
/// Of what a machine carries, about the place: of the smaller of the two, from end to end.
constexpr double kMachineAboutShare = 0.7;
/// Of that: where a link has its name. Boxes of links are large, and empty in the middle.
constexpr double kNamedShare = 0.4;
/// Of a spindle that touches: the rest of it is a column through the picture.
constexpr double kSpindleShown_mm = 60;

/// Shown larger: of the radius of what touches, and at least.
constexpr double kCloseShare = 1.2, kLeastClose_mm = 2.5;
/// What would hardly be larger is not shown twice.
constexpr double kCloserBy = 2.5;

Box common(const Box& a, const Box& b) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = std::max(a.min[axis], b.min[axis]);
    box.max[axis] = std::min(a.max[axis], b.max[axis]);
  }
  return box;
}

/// Cosine between the way from the tool's axis to the place and that to the eye, across the axis;
/// none: the place is on the axis.
std::optional<double> facing_of(const FindingView& view, const ViewAngles& angles) {
  constexpr double kOnAxis_mm = 0.05;
  const Vec3 outward = view.place_mm - view.axis_mm;
  const Vec3 to_eye = direction_of(angles, view.standing);
  const Vec3 across = to_eye - glm::dot(to_eye, view.axis) * view.axis;
  const double lengths = glm::length(outward) * glm::length(across);
  if (glm::length(outward) < kOnAxis_mm || lengths <= 0) return std::nullopt;
  return glm::dot(outward, across) / lengths;
}

Vec3 middle(const Box& box) { return 0.5 * (box.min + box.max); }

/// Of the tool: with its holder, and the beginning of a spindle that touches.
Box box_of_tool(const std::vector<ToolBody>& bodies, const Pose& pose, bool with_spindle) {
  Box box;
  for (const ToolBody& body : bodies) {
    Box own = body.solid->box_mm();
    if (body.part == ToolPart::kSpindle) {
      if (!with_spindle) continue;
      own.max.z = std::min(own.max.z, own.min.z + kSpindleShown_mm);
    }
    box.extend(box_around(pose, own));
  }
  return box;
}

/// Whatever touches, but the workpiece.
struct StandingBody {
  std::string name;
  std::vector<SolidPointer> solids;
  Pose pose;

  Box box_mm() const {
    Box box;
    for (const SolidPointer& solid : solids) box.extend(box_around(pose, solid->box_mm()));
    return box;
  }
};

/// Those whose place is known: a part of the tool, then links, then a fixture.
std::vector<StandingBody> touching_bodies(const FindingShot& shot, const SceneContact& contact,
                                          const BodyWatch& watch, const MachineBodies* links) {
  std::vector<StandingBody> bodies;
  if (const ToolBody* const part = contact.piece ? watch.body_of(*contact.piece) : nullptr)
    bodies.push_back({name_of(part->part), {part->solid}, pose_of(shot.tool)});
  for (const std::size_t link : contact.links) {
    const std::string& name = watch.drawn_machine()->links[link].name;
    if (!links || link >= shot.link_poses.size()) continue;
    const auto body = std::ranges::find(links->bodies, name, &LinkBody::name);
    if (body == links->bodies.end()) continue;
    const glm::dmat4 m(shot.link_poses[link]);
    bodies.push_back({name, body->solids, Pose{glm::dmat3(m), Vec3(m[3])}});
  }
  const std::size_t fixtures = watch.fixtures() ? watch.fixtures()->size() : 0;
  if (contact.fixture && *contact.fixture < fixtures && watch.place_of(*contact.fixture)) {
    const Fixture& fixture = (*watch.fixtures())[*contact.fixture];
    bodies.push_back({fixture.name, {fixture.solid}, *watch.place_of(*contact.fixture)});
  }
  return bodies;
}

/// Between those of their solids that are nearest to each other.
std::optional<Vec3> place_between(const StandingBody& a, const StandingBody& b) {
  const Pose b_from_a = b.pose.inverse() * a.pose;
  double least_mm = std::numeric_limits<double>::infinity();
  std::pair<const Solid*, const Solid*> nearest{};
  for (const SolidPointer& one : a.solids) {
    for (const SolidPointer& other : b.solids) {
      const double mm = gap_at(*one, b_from_a, *other, least_mm);
      if (nearest.first && mm >= least_mm) continue;
      least_mm = mm;
      nearest = {one.get(), other.get()};
    }
  }
  if (!nearest.first) return std::nullopt;
  return place_between(*nearest.first, a.pose, *nearest.second, b.pose);
}

std::optional<Vec3> place_of_contact(const FindingShot& shot, const SceneContact& contact,
                                     const BodyWatch& watch,
                                     const std::vector<StandingBody>& bodies) {
  if (bodies.size() > 1) return place_between(bodies[0], bodies[1]);
  if (!contact.has_workpiece || !shot.stock) return std::nullopt;
  const ToolBody* const part = contact.piece ? watch.body_of(*contact.piece) : nullptr;
  if (part && part->part == ToolPart::kCutter) return std::nullopt;
  if (part) return place_on_workpiece(*part, bodies[0].pose, *shot.stock);
  std::optional<Vec3> place;
  for (const SolidPointer& solid : bodies[0].solids)
    if (!place) place = place_on_workpiece(*solid, bodies[0].pose, *shot.stock);
  return place;
}

/// So far about the place bodies are shown: the tool counts, and the smaller of what touches.
double shown_about_mm(const Box& tool, const std::vector<StandingBody>& bodies, bool of_machine) {
  const auto longest = [](const Vec3& size) { return std::max({size.x, size.y, size.z}); };
  double about = std::max(kLeastAbout_mm, kAboutShare * longest(tool.size()));
  if (!of_machine) return about;
  double smaller = std::numeric_limits<double>::infinity();
  for (const StandingBody& body : bodies)
    smaller = std::min(smaller, longest(body.box_mm().size()));
  return std::isfinite(smaller) ? std::max(about, kMachineAboutShare * smaller) : about;
}

/// A part of the tool that touches, as pictures show it.
void show_part(const ToolBody& part, const Pose& pose, FindingView& view) {
  view.tool_radius_mm = 0.5 * part.width_mm;
  const Box own = part.solid->box_mm();
  const double half_mm = std::min(0.5 * own.size().z, 0.5 * kSpindleShown_mm);
  view.tool_mm = pose.point({0, 0, own.min.z + half_mm});
}

/// A link or a fixture in its place, of which the box is shown.
void show_standing(const Box& shown, FindingView& view) {
  view.tool_mm = middle(shown);
  view.tool_radius_mm = 0.5 * std::min(shown.size().x, shown.size().y);
  view.axis = {0, 0, 1};
}

}  // namespace

FindingView finding_view(const FindingShot& shot, BodyWatch& watch, const MachineBodies* links) {
  if (is_turned_shot(shot)) return turned_finding_view(shot, watch);
  FindingView view;
  if (shot.stock->turned()) view.standing = Standing::kInLathe;
  view.tool_shape = watch.mount(shot.cutter, shot.nose_z_mm);
  watch.set_link_poses(shot.link_poses);
  const Pose pose = pose_of(shot.tool);
  view.contact = contact_of(shot.finding, watch.drawn());
  view.place_mm = view.tool_mm = view.axis_mm = shot.tool.tip_mm;
  view.axis = glm::normalize(shot.tool.axis);
  const auto piece = view.contact ? view.contact->piece : std::nullopt;
  const ToolBody* const part = piece ? watch.body_of(*piece) : nullptr;
  view.frame_mm = box_of_tool(watch.bodies(), pose, part && part->part == ToolPart::kSpindle);
  view.frame_mm.extend(shot.tool.tip_mm);
  std::vector<StandingBody> bodies;
  if (view.contact) bodies = touching_bodies(shot, *view.contact, watch, links);
  if (part) show_part(*part, pose, view);
  std::optional<Vec3> place;
  if (!bodies.empty()) {
    place = place_of_contact(shot, *view.contact, watch, bodies);
    view.tool_name = bodies[0].name;
    // Deep in the material there is no surface; of a cutter the tip is where it works.
    const bool at_tip = !part || part->part == ToolPart::kCutter;
    view.place_mm = place ? *place : at_tip ? shot.tool.tip_mm : view.tool_mm;
    // Between two red bodies a red mark would say nothing.
    if (view.contact->has_workpiece) view.contact->point_mm = place;
  }
  const bool of_machine = view.contact && !view.contact->links.empty();
  const Vec3 about(shown_about_mm(view.frame_mm, bodies, of_machine));
  const Box near{view.place_mm - about, view.place_mm + about};
  view.frame_mm.extend(common(near, shot.stock->bounds_mm()));
  for (std::size_t i = part ? 1 : 0; i < bodies.size(); ++i) {
    const Box whole = bodies[i].box_mm();
    const Box shown = common(near, whole).empty() ? whole : common(near, whole);
    view.frame_mm.extend(common(near, whole));
    if (i == 0) {
      const Vec3 by_place = kNamedShare * about;
      const Box named = common({view.place_mm - by_place, view.place_mm + by_place}, whole);
      show_standing(named.empty() ? shown : named, view);
    } else {
      view.other_name = bodies[i].name;
      view.other_mm = middle(shown);
    }
  }
  if (!bodies.empty()) {
    const Vec3 from = part ? shot.tool.tip_mm : view.tool_mm;
    view.axis_mm = from + glm::dot(view.place_mm - from, view.axis) * view.axis;
  }
  const Vec3 frame = view.frame_mm.size();
  const Vec3 close(std::max(kLeastClose_mm, kCloseShare * view.tool_radius_mm));
  if (!bodies.empty() && kCloserBy * close.x < 0.5 * std::max({frame.x, frame.y, frame.z}))
    view.close_mm = {view.place_mm - close, view.place_mm + close};
  return view;
}

std::vector<ViewAngles> candidate_views() {
  constexpr int kAround = 8;
  constexpr std::array kHeights_deg{28.0, 12.0, 58.0};
  std::vector<ViewAngles> views;
  for (const double height_deg : kHeights_deg) {
    for (int i = 0; i < kAround; ++i) {
      const double yaw_deg = -60.0 + 360.0 * i / kAround;
      views.push_back({yaw_deg * kPi / 180, height_deg * kPi / 180});
    }
  }
  return views;
}

Vec3 direction_of(const ViewAngles& angles, Standing standing) {
  const double flat = std::cos(angles.pitch_rad);
  return in_workpiece({flat * std::cos(angles.yaw_rad), flat * std::sin(angles.yaw_rad),
                       std::sin(angles.pitch_rad)},
                      standing);
}

bool tool_hides_place(const FindingView& view, const ViewAngles& angles) {
  constexpr double kBehind = -0.15;
  const auto facing = facing_of(view, angles);
  return facing && *facing < kBehind;
}

double score_of(const FindingView& view, const ViewAngles& angles, bool shows_place,
                bool shows_tool, bool shows_other) {
  constexpr double kPlace = 4, kBody = 1, kBeside = 1, kAlong = 1.2, kFront = 0.1;
  double score = kPlace * shows_place + kBody * shows_tool + kBody * shows_other;
  // What the tool touches hides it on the near side.
  constexpr double kALittleBefore = 0.3;
  if (const auto facing = facing_of(view, angles))
    score -= kBeside * std::abs(*facing - kALittleBefore);
  // Along its axis a tool is short.
  const double along = std::abs(glm::dot(direction_of(angles, view.standing), view.axis));
  score -= kAlong * std::max(0.0, along - 0.5);
  // Else from where the operator stands.
  score -= kFront * (1 + std::sin(angles.yaw_rad));
  return score;
}

}  // namespace kerf
