// stock/zmap/height_mesh_compact.h - from triangles by node to an indexed mesh.
#pragma once

#include "stock/zmap/height_mesh_rim.h"

namespace kerf {

/// Numbers the used nodes in the order of their keys. Where the mesh touches itself at a point of a
/// hole's edge, that point becomes several vertices at the same place, so that the triangles around
/// each vertex form one closed fan.
/// `steps` may be null.
TriangleMesh compact(const Relief& relief, const StepSquares* steps, NodeMesh&& nodes, int threads);

}  // namespace kerf
