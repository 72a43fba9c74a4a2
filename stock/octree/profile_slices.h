// stock/octree/profile_slices.h - a body that turns about Z, seen from the nodes of a lattice.
//
//   layer k+1 o-----o--x--o-----o     x hits: where a layer of nodes crosses the profile
//             |     | /   |     |     / sides: edges of the profile that pass between two layers
//   layer k   o-----x-----o-----o
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/geometry.h"
#include "base/portable_math.h"
#include "stock/octree/brick_tree.h"
#include "stock/octree/revolved_cut.h"

namespace kerf::octree {

/// Where an edge leaves the body: how far from its solid end, and the body's normal there.
struct BodyExit {
  double way_mm = 0;
  Vec3 normal{0};
};

/// Made once for a cut; read by any number of threads.
class ProfileSlices {
 public:
  /// Layers of nodes in first .. last, and what lies between them.
  ProfileSlices(const RevolvedBody& body, const Lattice& lattice, int first_layer, int last_layer);

  /// Is the node of this layer at (x, y) in the body?
  bool holds(int layer, const Vec2& at) const {
    return is_within_flats(at) && is_inside(layer, portable::hypot(at.x, at.y));
  }
  /// Along x (axis 0) or y from a node that is in the body, `sign` the way, up to `length_mm`.
  std::optional<BodyExit> exit_level(int layer, const Vec2& at, int axis, double sign,
                                     double length_mm) const;
  /// Along z, to the next layer above (sign 1) or below.
  std::optional<BodyExit> exit_upright(int layer, const Vec2& at, double sign) const;

  /// What a box sees of the body whose nodes lie in `first_layer` .. +`layers` and that reaches so
  /// far across.
  enum class Sight { kInside, kOutside, kMixed };
  Sight sight_of(int first_layer, int layers, const Vec2& low, const Vec2& high) const;

 private:
  struct Hit {
    double r;
    double nr, nz;  ///< normal, nr > 0
  };
  struct Side {
    Vec2 from, to;  ///< (z, r)
    double nz, nr;  ///< normal, nz > 0
  };
  struct Span {
    double low, high;
  };
  bool is_within_flats(const Vec2& at) const;
  bool is_inside(int layer, double r) const { return hits_below(layer, r) % 2 == 1; }
  std::size_t hits_below(int layer, double r) const;
  void add_edge(const Vec2& a, const Vec2& b);
  const std::vector<Hit>& hits(int layer) const {
    return hits_[static_cast<std::size_t>(layer - first_)];
  }

  const Lattice& lattice_;
  int first_, last_;
  std::vector<std::vector<Hit>> hits_;    ///< by layer, rising
  std::vector<std::vector<Side>> sides_;  ///< by the lower layer
  std::vector<std::vector<Span>> spans_;  ///< by the lower layer: radii between it and the next
  std::vector<Vec2> flats_;               ///< their normals
  double inner_radius_mm_ = 0;
};

}  // namespace kerf::octree
