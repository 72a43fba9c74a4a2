// mesh/smooth_skin.h - where a mesh is so smooth that its triangles grow by moving their corners.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/geometry.h"
#include "base/triangle_mesh.h"
#include "mesh/surface_sides.h"

namespace kerf {

/// Between a triangle and the same one with its corners moved out by the allowance, each along one
/// direction for all triangles about it, is a prism. Prisms of neighbours share their walls, so
/// that of a smooth surface nothing is left but the triangles outside: as many as there were.
///
///     out  o-----o-----o          No point of a prism is farther from its triangle than the
///          |     |     |          allowance: directions are of unit length, and means of them no
///          o-----o-----o          longer. All directions between the normals at a corner are
///          within
///                                 an angle of its own whose cosine takes no more than the rounding
///                                 off: by so much at most the prisms fall short.
///
/// A triangle whose prism would be folded (a hollow narrower than the allowance) is none of them:
/// of prisms that are not folded, each point in one of them is within what they enclose, however
/// they overlap.
struct SmoothSkin {
  enum class Face : std::uint8_t {
    kPieces,  ///< it, its edges and corners grow by pieces of their own
    kBoth,    ///< by its prism; and by pieces, since one of its corners belongs to one of those
    kSkin,    ///< by its prism alone
  };
  std::vector<Face> faces;
  std::vector<glm::vec3> outer_mm;  ///< of each position; of faces that have a prism

  bool has_prism(std::size_t face) const { return faces[face] != Face::kPieces; }
};

/// `normals`: of its triangles, of unit length or 0. `halves`: sorted_half_edges(). O(n).
SmoothSkin smooth_skin(const TriangleMesh& mesh, std::span<const Vec3> normals,
                       std::span<const HalfEdge> halves, double allowance_mm, double rounding_mm);

}  // namespace kerf
