// twin/collision/mesh_depth.h - how deep two closed meshes go into each other.
#pragma once

#include "twin/collision/solid.h"
#include "twin/collision/sweep.h"

namespace kerf {

/// The greatest depth of the surface of `a` in `b`, and of that of `b` in `a`; of the two the
/// lesser, since it is enough that one body is smaller by so much all around; of bodies of which
/// one has nothing of the other's surface in it, the greatest in that other one. `b_from_a` is a's
/// pose in the frame of b. Never more than it is; places are looked at until none can be deeper by
/// 0.05 mm, a thousand at most. What one body swallows of the other's thickest inside counts as
/// deep as its own surface goes. 0 of meshes that are not closed. Some milliseconds.
double mesh_depth_at_mm(const Solid& a, const Pose& b_from_a, const Solid& b);

/// The greatest of these on the way of `moving`, if it is more than `known_mm`; else that. Poses
/// are looked at until none can be deeper by more than 0.1 mm, 32 at most.
double mesh_depth_mm(const Solid& moving, const RigidWay& way, const Solid& still, double known_mm);

}  // namespace kerf
