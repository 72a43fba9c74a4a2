// tests/stock/octree/octree_samples.h - octrees, cutters and moves for its tests.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/octree/octree.h"

namespace kerf::test {

inline std::unique_ptr<Octree> make_octree(const std::string& blank, double cell, int threads = 1,
                                           bool additive = false) {
  OctreeOptions options;
  const Result<Blank> parsed = parse_blank(blank);
  EXPECT_TRUE(parsed) << blank;
  options.blank = *parsed;
  options.cell_mm = cell;
  options.threads = threads;
  options.additive = additive;
  Result<std::unique_ptr<Octree>> tree = Octree::create(options);
  EXPECT_TRUE(tree) << (tree ? "" : tree.error());
  return std::move(*tree);
}

inline Cutter make_cutter(const std::string& shape) {
  const Result<Cutter> cutter = parse_shape(shape);
  EXPECT_TRUE(cutter) << shape;
  return *cutter;
}

inline CutMove line(const Vec3& from, const Vec3& to, std::uint64_t id = 0,
                    const Vec3& axis = {0, 0, 1}) {
  CutMove move;
  move.from_mm = from;
  move.to_mm = to;
  move.id = id;
  move.axis_from = move.axis_to = axis;
  return move;
}

inline std::vector<CutReport> cut(Octree& tree, const Cutter& cutter,
                                  const std::vector<CutMove>& moves) {
  std::vector<CutReport> reports;
  tree.cut(cutter, moves, reports);
  tree.finish(reports);
  return reports;
}

inline double removed_mm3(const std::vector<CutReport>& reports) {
  double sum = 0;
  for (const CutReport& report : reports) sum += report.removed_mm3;
  return sum;
}

/// All nodes.
inline HermiteGrid whole(const Octree& tree) { return tree.gather({0, 0, 0}, tree.node_counts()); }

struct SurfacePoint {
  Vec3 at;
  Vec3 normal;
  std::uint32_t cut_by;
};

inline std::vector<SurfacePoint> surface_points(const HermiteGrid& grid) {
  std::vector<SurfacePoint> points;
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<std::int32_t>& edges = grid.edges[static_cast<std::size_t>(axis)];
    for (std::size_t n = 0; n < edges.size(); ++n) {
      if (edges[n] < 0) continue;
      const HermiteCrossing& c = grid.crossings[static_cast<std::size_t>(edges[n])];
      const std::size_t nx = static_cast<std::size_t>(grid.nodes[0]),
                        ny = static_cast<std::size_t>(grid.nodes[1]);
      Vec3 place(static_cast<double>(n % nx), static_cast<double>(n / nx % ny),
                 static_cast<double>(n / (nx * ny)));
      place[axis] += static_cast<double>(c.t);
      points.push_back({grid.origin_mm + place * grid.cell_mm, Vec3(c.normal), c.cut_by});
    }
  }
  return points;
}

/// Every edge between a solid and an empty node has a crossing, and no other edge has.
inline void expect_sound(const HermiteGrid& grid) {
  const int step[3] = {1, grid.nodes[0], grid.nodes[0] * grid.nodes[1]};
  int wrong = 0;
  for (int k = 0; k < grid.nodes[2]; ++k) {
    for (int j = 0; j < grid.nodes[1]; ++j) {
      for (int i = 0; i < grid.nodes[0]; ++i) {
        const int at[3] = {i, j, k};
        const int n = i * step[0] + j * step[1] + k * step[2];
        for (int axis = 0; axis < 3; ++axis) {
          const std::size_t a = static_cast<std::size_t>(axis);
          const bool has = grid.edges[a][static_cast<std::size_t>(n)] >= 0;
          const bool differ = at[axis] + 1 < grid.nodes[a] &&
                              grid.solid[static_cast<std::size_t>(n)] !=
                                  grid.solid[static_cast<std::size_t>(n + step[axis])];
          wrong += has != differ;
        }
      }
    }
  }
  EXPECT_EQ(wrong, 0);
}

/// Is the point in the cutter, as `slack` mm thinner (negative: thicker) on all sides? `local` has
/// the tip at 0 and the spindle up z.
inline bool in_cutter(const Cutter& cutter, double r, double z, double slack) {
  r = std::max(0.0, r + slack);
  const double low = z - slack, high = z + slack;
  if (cutter.neck_radius_mm() && r <= *cutter.neck_radius_mm() && low >= cutter.height_mm(r))
    return true;
  if (r > cutter.radius_mm() || low < cutter.height_mm(r)) return false;
  return !cutter.undercuts() || high <= cutter.upper_height_mm(r);
}

}  // namespace kerf::test
