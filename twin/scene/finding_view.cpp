#include "twin/scene/finding_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "twin/scene/contact_places.h"

namespace kerf {
namespace {

/// Shown of what lies about the place: of the tool's length, and at least.
constexpr double kAboutShare = 0.7, kLeastAbout_mm = 15;
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
  const Vec3 to_eye = direction_of(angles);
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

}  // namespace

FindingView finding_view(const FindingShot& shot, BodyWatch& watch) {
  FindingView view;
  view.tool_shape = watch.mount(shot.cutter, shot.nose_z_mm);
  const Pose pose = pose_of(shot.tool);
  view.contact = contact_of(shot.finding, watch.drawn());
  view.place_mm = view.tool_mm = view.axis_mm = shot.tool.tip_mm;
  view.axis = glm::normalize(shot.tool.axis);
  const auto piece = view.contact ? view.contact->piece : std::nullopt;
  const ToolBody* const body = piece ? watch.body_of(*piece) : nullptr;
  const bool is_spindle = body && body->part == ToolPart::kSpindle;
  view.frame_mm = box_of_tool(watch.bodies(), pose, is_spindle);
  view.frame_mm.extend(shot.tool.tip_mm);
  if (body) {
    view.tool_name = name_of(body->part);
    view.tool_radius_mm = 0.5 * body->width_mm;
    const Box own = body->solid->box_mm();
    const double half_mm = std::min(0.5 * own.size().z, 0.5 * kSpindleShown_mm);
    view.tool_mm = pose.point({0, 0, own.min.z + half_mm});
    const bool is_cutter = body->part == ToolPart::kCutter;
    std::optional<Vec3> place;
    if (view.contact->fixture) {
      place = place_between(*body, pose, (*watch.fixtures())[*view.contact->fixture]);
    } else if (view.contact->has_workpiece && !is_cutter) {
      place = place_on_workpiece(*body, pose, *shot.stock);
    }
    // Deep in the material there is no surface; of a cutter the tip is where it works.
    view.place_mm = place ? *place : is_cutter ? shot.tool.tip_mm : view.tool_mm;
    // Between two red bodies a red mark would say nothing.
    if (view.contact->has_workpiece) view.contact->point_mm = place;
    view.axis_mm =
        shot.tool.tip_mm + glm::dot(view.place_mm - shot.tool.tip_mm, view.axis) * view.axis;
  }
  const Vec3 size = view.frame_mm.size();
  const Vec3 about(std::max(kLeastAbout_mm, kAboutShare * std::max({size.x, size.y, size.z})));
  const Box near{view.place_mm - about, view.place_mm + about};
  view.frame_mm.extend(common(near, shot.stock->bounds_mm()));
  if (view.contact && view.contact->fixture) {
    const Fixture& fixture = (*watch.fixtures())[*view.contact->fixture];
    const Box whole = box_around(fixture.workpiece_from_fixture, fixture.solid->box_mm());
    const Box shown = common(near, whole);
    view.other_name = fixture.name;
    view.other_mm = middle(shown.empty() ? whole : shown);
    view.frame_mm.extend(shown);
  }
  const Vec3 frame = view.frame_mm.size();
  const Vec3 close(std::max(kLeastClose_mm, kCloseShare * view.tool_radius_mm));
  if (body && kCloserBy * close.x < 0.5 * std::max({frame.x, frame.y, frame.z}))
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

Vec3 direction_of(const ViewAngles& angles) {
  const double flat = std::cos(angles.pitch_rad);
  return {flat * std::cos(angles.yaw_rad), flat * std::sin(angles.yaw_rad),
          std::sin(angles.pitch_rad)};
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
  const double along = std::abs(glm::dot(direction_of(angles), view.axis));
  score -= kAlong * std::max(0.0, along - 0.5);
  // Else from where the operator stands.
  score -= kFront * (1 + std::sin(angles.yaw_rad));
  return score;
}

}  // namespace kerf
