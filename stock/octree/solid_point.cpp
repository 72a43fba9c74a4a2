#include "stock/octree/solid_point.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

#include "stock/octree/hermite_gather.h"

namespace kerf::octree {
namespace {

constexpr int kCorners = 8;
constexpr int kMostPlanes = 12;  ///< a cell's edges
/// A crossing's place and normal are good to this part of a cell, over a cell.
constexpr double kPlaneSlack = 4e-4;

/// The crossings on the edges of one cell. Sets of planes are bits.
struct Planes {
  int count = 0;
  Vec3 at_mm[kMostPlanes], normal[kMostPlanes];

  unsigned all() const { return (1u << count) - 1; }
  /// Those behind which the point is by more than that.
  unsigned behind(const Vec3& point_mm, double by_mm) const {
    unsigned set = 0;
    for (int n = 0; n < count; ++n)
      set |= glm::dot(normal[n], point_mm - at_mm[n]) <= -by_mm ? 1u << n : 0u;
    return set;
  }
  /// The places of the crossings lie outside of each other's planes, in the mean.
  bool are_hollow() const {
    double sum = 0;
    for (int n = 0; n < count; ++n)
      for (int m = 0; m < count; ++m) sum += glm::dot(normal[n], at_mm[m] - at_mm[n]);
    return sum > 0;
  }
};

Vec3 corner_of(const HermiteGrid& cell, int corner) {
  return cell.origin_mm + Vec3(corner & 1, corner >> 1 & 1, corner >> 2) * cell.cell_mm;
}

Planes planes_of(const HermiteGrid& cell) {
  Planes planes;
  const auto at = [](int n) { return static_cast<std::size_t>(n); };
  for (int axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < kCorners; ++corner) {
      const std::int32_t number = cell.edges[at(axis)][at(corner)];
      if (number < 0) continue;
      const HermiteCrossing& crossing = cell.crossings[at(number)];
      Vec3 place = corner_of(cell, corner);
      place[axis] += static_cast<double>(crossing.t) * cell.cell_mm[axis];
      planes.at_mm[planes.count] = place;
      planes.normal[planes.count++] = Vec3(crossing.normal);
    }
  }
  return planes;
}

bool decide(const HermiteGrid& cell, const Vec3& point_mm, double within_mm) {
  const Planes planes = planes_of(cell);
  const unsigned behind = planes.behind(point_mm, within_mm);
  if (behind == planes.all()) return true;
  if (behind == 0) return false;
  const double slack_mm = kPlaneSlack * glm::length(cell.cell_mm);
  for (int corner = 0; corner < kCorners; ++corner) {
    const bool solid = cell.solid[static_cast<std::size_t>(corner)] != 0;
    const Vec3 node = corner_of(cell, corner);
    // In doubt a node is behind a plane if it is solid, and is not if it is empty.
    const unsigned node_behind = planes.behind(node, solid ? -slack_mm : slack_mm);
    if (solid && (node_behind & ~behind) == 0) return true;
    if (!solid && (behind & ~node_behind) == 0) return false;
  }
  return planes.are_hollow();
}

}  // namespace

bool solid_at(const BrickTree& tree, bool complement, const Vec3& point_mm, double within_mm) {
  const Lattice& lattice = tree.lattice();
  std::array<int, 3> low{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double place = (point_mm[axis] - lattice.origin_mm[axis]) / lattice.cell_mm[axis];
    if (!(place >= 0 && place < lattice.cells[a] + 1)) return false;
    low[a] = static_cast<int>(place);
  }
  int solid = 0;
  for (int corner = 0; corner < kCorners; ++corner) {
    const int i = low[0] + (corner & 1), j = low[1] + (corner >> 1 & 1), k = low[2] + (corner >> 2);
    const BrickRef& brick = tree.brick(i / kBrick, j / kBrick, k / kBrick);
    if (brick.get() == nullptr) {
      solid += brick.is_solid() ? 1 : 0;
    } else {
      solid += brick->columns[j % kBrick * kSide + i % kBrick] >> (k % kBrick) & 1;
    }
  }
  if (solid == 0 || solid == kCorners) return (solid == kCorners) != complement;
  thread_local HermiteGrid cell;
  gather(tree, complement, low, {2, 2, 2}, &cell);
  return decide(cell, point_mm, within_mm);
}

}  // namespace kerf::octree
