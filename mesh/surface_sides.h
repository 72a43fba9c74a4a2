// mesh/surface_sides.h - which side of a mesh is outside, at its faces, edges and
// corners.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/geometry.h"
#include "base/triangle_mesh.h"

namespace kerf {

/// One triangle's share of an edge; number / 3 is the triangle, number % 3 the corner it begins at.
struct HalfEdge {
  std::uint64_t ends;  ///< both positions, the lower number first: equal for all at one edge
  std::uint32_t number;
  bool is_rising;  ///< runs from the lower number to the higher
};

/// Of all triangles; those of one edge follow one another, in the order of their numbers.
std::vector<HalfEdge> sorted_half_edges(const TriangleMesh& mesh);

/// Of what is wrong with a mesh so many places are told.
inline constexpr std::size_t kFewPlaces = 3;

/// How the triangles of a mesh hang together.
struct MeshFacts {
  std::size_t edges = 0;
  std::size_t open_edges = 0;           ///< of one triangle only: a hole, or a gap between parts
  std::size_t turned_edges = 0;         ///< whose triangles disagree on what is outside
  std::vector<Vec3> first_open_mm{};    ///< middles of such, at most kFewPlaces
  std::vector<Vec3> first_turned_mm{};  ///< the same
  double volume_mm3 = 0;                ///< negative: turned inside out
  bool is_closed() const { return open_edges == 0; }
};

/// Normals such that the sign of dot(p - nearest point, its normal) tells the side of p: those of
/// faces, for edges the sum of both faces', for corners the sum weighted by the angles there.
/// Source: J. A. Baerentzen, H. Aanaes, "Signed distance computation using the angle weighted
/// pseudonormal", IEEE Trans. Visualization and Computer Graphics 11(3), 2005.
///
/// Holds where the surface is closed and two triangles meet at each edge. Edges and corners where
/// that is not so (holes; two parts that touch) have the normal 0: the side has to be found in
/// another way there.
struct SurfaceSides {
  std::vector<std::array<glm::vec3, 3>> edge_normals;  ///< of each triangle's three edges
  std::vector<glm::vec3> corner_normals;               ///< of each position
  MeshFacts facts;
};

/// O(n log n).
SurfaceSides surface_sides(const TriangleMesh& mesh);

}  // namespace kerf
