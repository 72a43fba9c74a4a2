// twin/scene/fixture_bodies.h - fixtures as the viewer draws them.
#pragma once

#include <glm/mat4x4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "base/triangle_mesh.h"
#include "twin/collision/solid.h"
#include "twin/job/fixtures.h"
#include "twin/machine/kinematics/pose.h"
#include "viewer/picture.h"
#include "viewer/scene.h"

namespace kerf {

/// The surfaces of its pieces, which may lie in each other. What is round comes in facets of some
/// degrees; corners at one place are shared. About 0.3 us a triangle.
TriangleMesh drawn_mesh(const Solid& solid);

/// A link each, in the fixture's own frame; seen through.
SceneMachine scene_fixtures(const std::vector<Fixture>& fixtures);

/// From each to the workpiece frame. `link_poses`: of the links of `machine`, as
/// Moment::link_poses; what stands on a link that has none is nowhere.
std::vector<std::optional<Pose>> fixture_places(const std::vector<Fixture>& fixtures,
                                                const SceneMachine& machine,
                                                std::span<const glm::mat4> link_poses);

/// For pictures of a part, in which there is no machine: without what stands on its links.
std::vector<PictureBody> picture_bodies(const std::vector<Fixture>& fixtures);

/// For Moment::fixture_poses.
std::vector<glm::mat4> fixture_poses(const std::vector<std::optional<Pose>>& places);

}  // namespace kerf
