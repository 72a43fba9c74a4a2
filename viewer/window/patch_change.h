// viewer/window/patch_change.h - where two patches of a tile differ.
#pragma once

#include "base/geometry.h"
#include "base/mesh_patch.h"

namespace kerf {

/// Box of all triangles that only one of the patches has, whatever their order and the numbers of
/// their vertices; a triangle whose normals, moves or deviations differ is another one. Exact up to
/// collisions of a 64-bit hash. `before` may be null. About 20 ns a triangle.
Box changed_box(const MeshPatch* before, const MeshPatch& after, bool with_skirts);

}  // namespace kerf
