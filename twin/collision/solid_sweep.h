// twin/collision/solid_sweep.h - whole bodies on their way against others: what sweep.h does of one
// convex piece, by the trees of both.
#pragma once

#include <optional>

#include "twin/collision/solid.h"
#include "twin/collision/sweep.h"

namespace kerf {

/// How far apart two bodies are, one of them at `pose` in the frame of the other: no less than this
/// and a thousandth of a mm. What is farther than `cutoff_mm` counts as just that far. Only the
/// surface of a mesh counts, not what it encloses. Some microseconds for a handful of pieces
/// against any number of triangles, up to milliseconds where two meshes of ten thousands lie close.
double gap_at(const Solid& moving, const Pose& pose, const Solid& still, double cutoff_mm);

/// The least distance of `moving` on `way` from `still`, over all t, if it is below `below_mm`: to
/// kWayExact_mm. 0: they touch.
std::optional<LeastGap> least_gap(const Solid& moving, const RigidWay& way, const Solid& still,
                                  double below_mm);

/// The first t at which they touch, with each box and each body of revolution of `moving` thinner
/// by `thinner_mm` all around (eroded()).
std::optional<double> first_touch(const Solid& moving, const RigidWay& way, const Solid& still,
                                  double thinner_mm);

/// How deep its boxes and bodies of revolution go at most, to 0.01 mm, if that is more than
/// `known_mm`; else that. Of meshes mesh_depth.h measures it.
double touch_depth_mm(const Solid& moving, const RigidWay& way, const Solid& still,
                      double known_mm);

/// `other`, at `pose` in the frame of `closed`, lies in what that encloses, or one of its pieces
/// does: boxes and bodies of revolution each by a point of theirs, of a mesh its first triangle.
bool encloses_any(const Solid& closed, const Pose& pose, const Solid& other);

/// It is made of triangles, in part at least: touch_depth_mm() does not measure these.
bool has_triangles(const Solid& solid);

}  // namespace kerf
