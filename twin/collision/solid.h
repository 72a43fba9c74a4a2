// twin/collision/solid.h - a rigid body as convex pieces in a tree of boxes: fixtures, links of a
// machine, tools.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/result.h"
#include "base/triangle_mesh.h"
#include "stock/blank.h"
#include "stock/cutter/cutter.h"
#include "twin/collision/convex.h"

namespace kerf {

/// Immutable; any number of threads. mm, in its own frame.
class Solid {
 public:
  /// Boxes and cylinders exactly; a tube by flat facets that are nowhere farther than half a
  /// micrometre from it, closed if it is the only body.
  static std::shared_ptr<const Solid> of_bodies(std::span<const BlankBody> bodies);
  /// The surface; and what it encloses, if it is closed().
  static std::shared_ptr<const Solid> of_mesh(const TriangleMesh& mesh);
  /// Solids of revolution about Z, each the hull of a row of discs.
  static std::shared_ptr<const Solid> of_hulls(std::span<const std::vector<RoundedDisc>> hulls);

  Solid(const Solid&) = delete;
  Solid& operator=(const Solid&) = delete;

  std::span<const Convex> pieces() const { return pieces_; }
  const Box& box_mm() const { return box_mm_; }
  /// Of a mesh, or a tube: each edge has two triangles, which run along it in opposite directions.
  bool is_closed() const { return is_closed_; }
  /// A point of a closed mesh's inside; else false. Inside out counts as the right way round.
  bool encloses(const Vec3& point) const;

  /// The pieces that are `moving`'s nearest, over all of its way: bounds as gap_of() has them.
  /// What is farther than `cutoff_mm` is not looked at closely: `low_mm` is above that then.
  ConvexGap gap_to(const MovingConvex& moving, double cutoff_mm, double exact_mm,
                   const Vec3& guess = Vec3{0}) const;

  struct Node {
    Box box_mm;
    std::uint32_t first = 0;  ///< of its pieces; of an inner node: its right child
    std::uint32_t count = 0;  ///< 0: an inner node, whose left child comes next
  };
  std::span<const Node> nodes() const { return nodes_; }

 private:
  Solid() = default;
  void add_box(const Box& box);
  void add_revolved(std::span<const RoundedDisc> discs, const Vec3& origin, const Vec3& axis);
  void add_mesh(const TriangleMesh& mesh);
  void finish();
  std::uint32_t build(std::uint32_t begin, std::uint32_t end, std::span<const Box> boxes);

  std::vector<Convex> pieces_;
  std::vector<std::unique_ptr<std::vector<RoundedDisc>>> discs_;
  std::vector<std::unique_ptr<std::array<Vec3, 2>>> boxes_;
  std::vector<Vec3> corners_;  ///< of triangles, three each
  std::vector<Node> nodes_;
  Box box_mm_;
  bool is_closed_ = false;
};
using SolidPointer = std::shared_ptr<const Solid>;

/// Distance of two boxes; 0: they overlap or touch.
double box_gap_mm(const Box& a, const Box& b);
/// Around the moving solid, over all of its way, in the frame of what stands still.
Box box_of(const MovingConvex& moving);

}  // namespace kerf
