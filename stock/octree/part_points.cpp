#include "stock/octree/part_points.h"

#include <algorithm>
#include <limits>

namespace kerf::octree {
namespace {

/// Of solid bricks one node: the material around them has its surface elsewhere.
constexpr int kSparse = kBrick;

Vec3 node_place(const Lattice& lattice, const int brick[3], int i, int j, int k) {
  return {lattice.place_mm(0, brick[0] * kBrick + i), lattice.place_mm(1, brick[1] * kBrick + j),
          lattice.place_mm(2, brick[2] * kBrick + k)};
}

}  // namespace

void PartPoints::clear() {
  count_ = 0;
  for (std::vector<double>* v : {&x_, &y_, &z_}) v->assign(kLanes, 0.0);
}

void PartPoints::add(const Vec3& point_mm) {
  x_[count_] = point_mm.x;
  y_[count_] = point_mm.y;
  z_[count_] = point_mm.z;
  ++count_;
  for (std::vector<double>* v : {&x_, &y_, &z_}) v->push_back(0.0);
}

void field_of(const SweepKernel& kernel, std::span<const Sweep> sweeps, const PartPoints& points,
              std::vector<double>& f) {
  const std::size_t room = points.size() + kLanes;
  f.assign(room, std::numeric_limits<double>::infinity());
  std::vector<double> one(sweeps.empty() ? 0 : room);
  for (const Sweep& sweep : sweeps) {
    kernel.distance(sweep, static_cast<int>(points.size()), points.x(), points.y(), points.z(),
                    one.data());
    for (std::size_t n = 0; n < points.size(); ++n) f[n] = std::min(f[n], one[n]);
  }
}

void add_crossings(const BrickTree& tree, int bx, int by, int bz, PartPoints& points) {
  const BrickRef& ref = tree.brick(bx, by, bz);
  const Brick* const brick = ref.get();
  if (!brick) return;
  const Lattice& lattice = tree.lattice();
  const int place[3] = {bx, by, bz};
  std::size_t next = 0;
  for_each_crossed(brick->columns, [&](int axis, int i, int j, int k) {
    Vec3 at = node_place(lattice, place, i, j, k);
    at[axis] += lattice.cell_mm[axis] * brick->places()[next++] / kEdgeParts;
    points.add(at);
  });
}

void add_material(const BrickTree& tree, int bx, int by, int bz, PartPoints& points) {
  const BrickRef& ref = tree.brick(bx, by, bz);
  if (ref.is_empty()) return;
  add_crossings(tree, bx, by, bz, points);
  const int place[3] = {bx, by, bz};
  const Brick* const brick = ref.get();
  const int step = brick ? 1 : kSparse;
  for (int j = 0; j < kBrick; j += step) {
    for (int i = 0; i < kBrick; i += step) {
      const unsigned column = brick ? brick->columns[j * kSide + i] : kFullColumn;
      for (int k = 0; k < kBrick; k += step)
        if (column >> k & 1u) points.add(node_place(tree.lattice(), place, i, j, k));
    }
  }
}

}  // namespace kerf::octree
