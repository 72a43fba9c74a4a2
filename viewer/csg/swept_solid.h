// viewer/csg/swept_solid.h - the region that a move of a cutter with a vertical axis empties, as
// convex polyhedra.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "base/geometry.h"
#include "viewer/csg/convex_profile.h"

namespace kerf {

/// A straight move of the tip, mm in the workpiece frame; the axis of the tool is +Z.
struct SweptMove {
  Vec3 from_mm{0.0};
  Vec3 to_mm{0.0};
  std::uint32_t tool = 0;  ///< Into the list of tools.
};

/// An arc or helix; the radius may change on the way (spiral).
struct SweptArc {
  Vec3 from_mm{0.0};
  Vec3 to_mm{0.0};
  Vec3 center_mm{0.0};
  Vec3 axis{0.0, 0.0, 1.0};  ///< Unit length; the tip turns counter-clockwise around it.
  int whole_turns = 0;       ///< Besides the way to to_mm, which is in (0, 1] turns.
  std::uint32_t tool = 0;
};

/// Chords of the arc that leave it by no more than tolerance_mm (> 0). Begins and ends exactly at
/// the ends of the arc.
std::vector<SweptMove> chords(const SweptArc& arc, double tolerance_mm);

struct SolidVertex {
  glm::vec3 position_mm;
  std::uint32_t normal;  ///< as pack_normal(); counts at the first corner of a triangle
  std::uint32_t color;   ///< 0xAABBGGRR; likewise
};
static_assert(sizeof(SolidVertex) == 20);

/// Closed convex polyhedron, triangles counter-clockwise seen from outside of it. Normals of its
/// faces point into it: out of the material that it leaves.
struct SolidMesh {
  std::vector<SolidVertex> vertices;
  std::vector<std::uint16_t> indices;
  Box bounds_mm;
};

/// Makes the solids. With K = {z >= f(r)} the region above a convex profile, a move from p to q
/// empties the Minkowski sum of K and the segment pq, which is convex: faces of K that look along
/// the move stand at q, the others at p, and every edge between the two kinds is drawn out to a
/// parallelogram. That holds for level moves, ramps and plunges alike.
///
///        p ----------> q
///      _____         _____
///     |     |       |     |        from above: two halves of the outline, two walls
///    (   o  ========== o   )
///     |_____|       |_____|
///
/// K is a prism of N sides around each ring; N keeps the sides within tolerance_mm of the circle
/// and never outside of it, so that no more is removed than by the true cutter. Corners of the
/// prism stand across the move: the walls of a slot are exact.
class SweepBuilder {
 public:
  /// tolerance_mm > 0. Material above material_top_mm does not exist: what a move does up there is
  /// left out, and solids end at solid_top_mm (above it); those of steep ramps of pointed cutters
  /// may end higher.
  SweepBuilder(double tolerance_mm, double material_top_mm, double solid_top_mm);

  /// Empty if the move stays above the material. About 10 us.
  SolidMesh build(const ConvexProfile& piece, Vec3 from_mm, Vec3 to_mm, std::uint32_t color);

 private:
  struct Corner {  // of the prism: which end of the move, ring from below, side
    int end, ring, side;
  };

  void choose_sides(double radius_mm, const Vec3& move);
  void add_faces(SolidMesh* mesh);
  void add_cap(SolidMesh* mesh);
  void add_walls(SolidMesh* mesh);
  void add_wall(const Corner& p, const Corner& q, int end_a, int end_b, SolidMesh* mesh);
  void add_face(const std::vector<Corner>& corners, const Vec3& outward, SolidMesh* mesh);
  Vec3 outward(int ring, int side) const;
  Vec3 position(const Corner& corner) const;
  int end_of(int ring, int side) const;
  std::uint16_t vertex(const Corner& corner, SolidMesh* mesh);
  int rings() const { return static_cast<int>(profile_.size()); }
  bool is_pointed() const;

  double tolerance_mm_;
  double material_top_mm_;
  double solid_top_mm_;

  // Of the solid under construction.
  double top_mm_ = 0.0;
  ConvexProfile profile_;
  Vec3 from_mm_{0.0};
  Vec3 to_mm_{0.0};
  std::uint32_t color_ = 0;
  std::vector<Vec2> directions_;  // of the corners around the axis
  std::vector<std::int32_t> vertex_of_corner_;
  std::vector<std::int8_t> end_of_face_;
  std::vector<bool> is_first_corner_;  // by vertex: a face has its normal there
  std::vector<Corner> corners_;
};

}  // namespace kerf
