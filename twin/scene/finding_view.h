// twin/scene/finding_view.h - what of a finding is to be seen, and from where. No drawing.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "twin/machines/machine_bodies.h"
#include "twin/scene/body_watch.h"
#include "twin/scene/finding_picture.h"
#include "viewer/scene.h"
#include "viewer/standing.h"

namespace kerf {

struct FindingView {
  std::shared_ptr<const ToolShape> tool_shape;  ///< null: as that of the shot before
  std::optional<SceneContact> contact;          ///< none: the finding tells of no two bodies
  Vec3 place_mm{0};                             ///< where they touch; of others the tip
  Vec3 axis_mm{0};                              ///< the nearest point of the tool's axis
  Vec3 axis{0, 0, 1};                           ///< of the tool
  /// The middle of the part of the tool; where no part of it touches, a place on the first of the
  /// links and fixtures that do, which then is "the tool" below and in what follows.
  Vec3 tool_mm{0};
  double tool_radius_mm = 0;  ///< of that part
  std::string tool_name;
  std::optional<Vec3> other_mm;  ///< a place on the fixture or link; none: it is the workpiece
  std::string other_name;
  Box frame_mm;  ///< that the picture shows
  Box close_mm;  ///< that is shown once more, larger; empty: there is nothing more to be seen
  Standing standing = Standing::kOnTable;  ///< which way up it is looked at
  /// Seen straight from the front, without perspective: what touches lies in one plane.
  bool is_flat = false;
  bool is_inside = false;  ///< the workpiece is cut open in that plane
};

/// `watch`: it is given the shot's tool and poses of links. `links`: shapes of those of the machine
/// that it draws; null: they are not known. On a lathe as turned_finding_view() has it. Costs what
/// place_between() and place_on_workpiece() do.
FindingView finding_view(const FindingShot& shot, BodyWatch& watch,
                         const MachineBodies* links = nullptr);

/// Of the eye: about +Z from +X, and above the plane.
struct ViewAngles {
  double yaw_rad = 0, pitch_rad = 0;
};
/// From all around, at some heights; the usual one first.
std::vector<ViewAngles> candidate_views();
/// Unit vector to the eye, in the workpiece frame.
Vec3 direction_of(const ViewAngles& angles, Standing standing = Standing::kOnTable);

/// It stands before the place where it touches.
bool tool_hides_place(const FindingView& view, const ViewAngles& angles);

/// More is better: where they touch is seen first of all, then both bodies; then from beside, where
/// neither stands before the other.
double score_of(const FindingView& view, const ViewAngles& angles, bool shows_place,
                bool shows_tool, bool shows_other);

}  // namespace kerf
