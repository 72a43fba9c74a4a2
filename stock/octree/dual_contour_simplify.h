// stock/octree/dual_contour_simplify.h - fewer triangles where a surface is plane.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "base/triangle_mesh.h"

namespace kerf {

/// A mesh that is being simplified.
struct SimplifiedMesh {
  TriangleMesh mesh;
  std::vector<float> error_mm;          ///< a triangle: bound of its distance to the first mesh
  std::vector<std::uint8_t> is_locked;  ///< a vertex: stays where it is
};

/// Number of a vertex that is gone.
inline constexpr std::uint32_t kTakenOut = 0xffff'ffff;

/// Takes vertices out, as long as no triangle comes farther from the first mesh than
/// `tolerance_mm`; `error_mm` is carried on, so it may be called again on what several results
/// were put together to. Vertices and triangles that remain keep their order; returns the new
/// numbers of the vertices, kTakenOut for those that are gone.
///
/// A vertex u goes by moving it onto a neighbour v:
///
///      a---b            a---b       Only if its triangles are within a slab, whose thickness adds
///     / \ / \          /  / |       to the error, or are two such fans that meet in an edge w-u-v
///    w---u---c   ->   w--/--c       of the part; then the distance of u from the line w-v adds as
///     \ / \ /          \ \  |       well. And only if nothing turns over, u and v have exactly the
///      d---v            d---v       two neighbours of their edge in common, and neither of these
///                                   would be left with two triangles: so a closed 2-manifold stays
///                                   one, of the same genus.
///
/// A mesh with a boundary is possible if all vertices of the boundary are locked. Deterministic.
/// About 0.4 us for each vertex at the start.
std::vector<std::uint32_t> simplify(SimplifiedMesh* simplified, double tolerance_mm);

}  // namespace kerf
