// stock/octree/solid_point.h - is a point of the workpiece material?
#pragma once

#include "stock/octree/brick_tree.h"
#include "stock/octree/hermite_grid.h"

namespace kerf::octree {

/// By the nodes around it; where they differ by the planes of the crossings between them, of which
/// material is a monotone combination: a point is as solid as a node that is inside of no plane
/// beyond which the point is. So edges are sharp, whether material is within them (the rim of a
/// block), around them (the foot of a wall), or both (where a slot comes out of a side), as far as
/// a cell has a node in each of the parts that planes divide it into. Where none decides, the
/// surface is one that bends: material beyond any of its planes where it is hollow (a groove), or
/// behind all of them.
///
/// What it says is good to 0.0001 cells where the surface is made of planes, and to cell^2 / 8r
/// where it has a radius r. `complement`: material is what the tree does not have.
bool solid_at(const BrickTree& tree, bool complement, const Vec3& point_mm, double within_mm);

}  // namespace kerf::octree
