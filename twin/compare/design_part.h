// twin/compare/design_part.h - the part as it was designed, to compare a workpiece with.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "base/geometry.h"
#include "base/triangle_mesh.h"
#include "mesh/surface_sides.h"
#include "twin/compare/triangle_tree.h"

namespace kerf {

/// Surface of a solid, from triangles; mm, workpiece frame. Immutable: any thread may read.
///
/// Inside and outside come from the normals around the nearest point (surface_sides.h). Where
/// these do not tell (the nearest point is at the rim of a hole, or where two parts touch), and
/// everywhere if triangles disagree on what is outside, rays in three directions are followed, and
/// the majority of them says by the number of triangles they go through: a good guess at holes,
/// right where the surface only looks open because triangles meet without sharing corners.
class DesignPart {
 public:
  /// From a mesh with at least one triangle; `name` for what is said about it: a warning with the
  /// number of open edges, or of edges whose triangles disagree, and a note if the mesh is inside
  /// out (it is turned then).
  DesignPart(const TriangleMesh& mesh, const std::string& name, Diagnostics& diagnostics);

  /// From the surface, mm: negative inside the part's material. About 1 us where a hint helps
  /// (DesignProbe), some more without.
  double distance_mm(const Vec3& p) const;

  /// The nearest point of it; `hint`: a triangle that is likely near.
  NearestPoint nearest(const Vec3& p, std::uint32_t hint = 0) const {
    return tree_.nearest(p, hint);
  }

  const Box& box_mm() const { return tree_.box_mm(); }
  const MeshFacts& facts() const { return facts_; }
  std::size_t size() const { return tree_.size(); }
  /// Of a triangle, 0 .. size() - 1, counter-clockwise from outside unless is_inside_out().
  const std::array<glm::vec3, 3>& corners(std::uint32_t triangle) const {
    return tree_.corners(triangle);
  }
  bool is_inside_out() const { return outward_ < 0; }

 private:
  friend class DesignProbe;
  double distance_mm(const Vec3& p, std::uint32_t& hint) const;
  bool is_inside_by_rays(const Vec3& p) const;

  TriangleTree tree_;
  std::vector<std::array<glm::vec3, 3>> edge_normals_;    ///< by the tree's numbers
  std::vector<std::array<glm::vec3, 3>> corner_normals_;  ///< by the tree's numbers
  MeshFacts facts_;
  double outward_ = 1;  ///< -1: the mesh is inside out
  bool trusts_normals_ = true;
};

/// Distances of points that lie near one another, one after the other: each begins with the
/// triangle that was nearest to the one before. One thread; cheap to make.
class DesignProbe {
 public:
  /// `part` must outlive it.
  explicit DesignProbe(const DesignPart& part) : part_(part) {}
  /// As DesignPart::distance_mm(), but -reach_mm or reach_mm where it is beyond these: the same
  /// whatever was asked before. What is farther off costs next to nothing, since distances grow no
  /// faster than the way from a point to the next.
  double distance_mm(const Vec3& p, double reach_mm);

 private:
  const DesignPart& part_;
  std::uint32_t hint_ = 0;
  Vec3 known_at_mm_{0.0};  ///< where the distance is known_mm_
  double known_mm_ = 0;
};

}  // namespace kerf
