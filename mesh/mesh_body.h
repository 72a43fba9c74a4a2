// mesh/mesh_body.h - a body that a closed mesh encloses.
#pragma once

#include <cstddef>
#include <string>

#include "base/geometry.h"
#include "base/result.h"
#include "base/triangle_mesh.h"

namespace kerf {

/// Inside is where the mesh winds about a point more often from outside than from inside: of
/// several parts that overlap or touch, their union. Immutable; any thread may read.
struct MeshBody {
  TriangleMesh mesh;  ///< closed, its triangles counter-clockwise from outside
  Box box_mm;
  /// Of the surface as it is; where parts overlap, they count twice.
  double volume_mm3 = 0;
  std::size_t parts = 1;     ///< that share no corner
  bool was_turned = false;   ///< it was inside out
  double allowance_mm = 0;   ///< by which it was grown (mesh_offset.h)
  double overhang_mm2 = 0;   ///< seen from below: what faces down above the floor
  double overhang_z_mm = 0;  ///< where the most of that begins

  /// Solid from a flat underside up to one height over each point.
  bool is_height_field() const { return overhang_mm2 == 0; }
};

/// Error: nothing is enclosed; it is open, with the number of open edges and where the first ones
/// are; triangles disagree on what is outside. `name` is the file's. A mesh that is inside out as a
/// whole is turned. Faces that lean over by less than kUpright_mm, as rounding leaves upright ones,
/// and undersides as flat as that, are no overhang. O(n log n).
Result<MeshBody> mesh_body(TriangleMesh mesh, const std::string& name);
inline constexpr double kUpright_mm = 0.001;

}  // namespace kerf
