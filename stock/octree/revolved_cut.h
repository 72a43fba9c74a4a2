// stock/octree/revolved_cut.h - takes away what lies beyond a body that turns about Z.
#pragma once

#include <cstdint>
#include <vector>

#include "base/geometry.h"
#include "base/worker_pool.h"
#include "stock/octree/brick_tree.h"

namespace kerf::octree {

/// What closed chains of (z, r >= 0) sweep about the z axis of the workpiece frame: even-odd, mm.
/// Of a bar of flats what lies within these as well.
struct RevolvedBody {
  std::vector<std::vector<Vec2>> chains_mm;
  int flats = 0;               ///< 0: none. The first one faces +X
  double inner_radius_mm = 0;  ///< from the axis to a flat
};

/// Where it is to be done: a part of the z axis.
struct ZRange {
  double low_mm = 0, high_mm = 0;
};

/// Leaves of the tree what is in the body, as far as its nodes lie in the range (or one cell beyond
/// it); gives what is gone, in kNodeVolume. Crossings and normals are those of the cones and planes
/// that the chains' edges and the flats are, in closed form: nothing is searched. A crossing that
/// lies as deep already, to a part of 1 / kEdgeParts, stays: a second time changes nothing. Bits
/// depend neither on threads nor on the range, as long as all that differs lies in it.
///
/// Cost: O(chains' edges) once, then what the body's surface touches; bricks that lie on one side
/// of it are taken or left as a whole.
std::int64_t cut_to_revolved(BrickTree& tree, const RevolvedBody& body, const ZRange& range,
                             WorkerPool& pool);

}  // namespace kerf::octree
