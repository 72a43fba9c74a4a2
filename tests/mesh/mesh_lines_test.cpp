#include "mesh/mesh_lines.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <memory>

#include "mesh/mesh_lows.h"
#include "tests/mesh/sample_meshes.h"

namespace kerf {
namespace {

bool is_within(std::span<const LineEnd> ends, double at) {
  std::size_t before = 0;
  for (const LineEnd& end : ends) before += static_cast<double>(end.at_mm) < at ? 1 : 0;
  return before % 2 == 1;
}

TEST(MeshLines, PartsThatTouchAreOne) {
  TriangleMesh mesh = test::box_of({0, 0, 0}, {4, 4, 2});
  test::add_box(mesh, {0, 0, 2}, {4, 4, 5});    // on it
  test::add_box(mesh, {1, 1, 4}, {3, 3, 9});    // into it
  test::add_box(mesh, {0, 0, 12}, {4, 4, 13});  // above
  const MeshLines lines(mesh, 2, {{{0, 0, 0}, {4, 4, 0}}, 4, 4});
  ASSERT_EQ(lines.ends(0).size(), 4u);
  EXPECT_EQ(lines.ends(0)[1].at_mm, 5);
  EXPECT_EQ(lines.ends(5)[0].at_mm, 0);
  EXPECT_EQ(lines.ends(5)[1].at_mm, 9);
  EXPECT_EQ(lines.ends(5)[2].at_mm, 12);
}

/// Of a box whose edges lie on lines of all axes: where a line of one axis runs in a face, those of
/// the others, through the same point, have it on the same side.
TEST(MeshLines, LinesOfAllAxesAgreeOnFaces) {
  const TriangleMesh mesh = test::box_of({2, 2, 2}, {6, 6, 6});
  const ColumnGrid grid{{{-0.5, -0.5, 0}, {8.5, 8.5, 0}}, 9, 9};  // lines at 0, 1 .. 8
  std::array<std::unique_ptr<MeshLines>, 3> lines;
  for (int axis = 0; axis < 3; ++axis)
    lines[static_cast<std::size_t>(axis)] = std::make_unique<MeshLines>(mesh, axis, grid);
  // Towards -X, +Y and +Z: the low face of X is outside, the high one inside; of Y, Z as is.
  const bool inside[3][9] = {{false, false, false, true, true, true, true, false, false},
                             {false, false, true, true, true, true, false, false, false},
                             {false, false, true, true, true, true, false, false, false}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (std::size_t j = 0; j < 9; ++j)
      for (std::size_t i = 0; i < 9; ++i)
        EXPECT_EQ(lines[axis]->ends(j * 9 + i).size(), inside[u][i] && inside[v][j] ? 2u : 0u)
            << "axis " << axis << ": " << i << " " << j;
  }
}

/// Against winding numbers, along each axis.
TEST(MeshLines, RandomLumps) {
  std::mt19937 random(7);
  for (int round = 0; round < 12; ++round) {
    const TriangleMesh mesh = test::random_lumps(random, 1 + round % 5);
    for (int axis = 0; axis < 3; ++axis) {
      const ColumnGrid grid{{{-15, -15, 0}, {15, 15, 0}}, 23, 19};
      const MeshLines lines(mesh, axis, grid);
      for (std::size_t cell = 0; cell < grid.size(); ++cell) {
        const Vec2 middle = grid.center(static_cast<int>(cell % 23), static_cast<int>(cell / 23));
        for (double at = -14.37; at < 15; at += 2.9) {
          Vec3 p;
          p[axis] = at;
          p[(axis + 1) % 3] = middle.x;
          p[(axis + 2) % 3] = middle.y;
          const double winding = test::winding_number(mesh, p);
          if (std::abs(winding - std::round(winding)) > 0.01) continue;  // on the surface
          EXPECT_EQ(is_within(lines.ends(cell), at), winding > 0.5)
              << "axis " << axis << " at " << p.x << " " << p.y << " " << p.z;
        }
      }
    }
  }
}

/// Against points of the triangles.
TEST(MeshLows, AreBelowEachPointOfTheTriangles) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(0, 1);
  for (int round = 0; round < 6; ++round) {
    const MeshBody body = test::body_of(test::random_lumps(random, 2));
    const ColumnGrid grid{{body.box_mm.min, body.box_mm.max}, 31, 17};
    std::vector<double> low(grid.size(), 1e9);
    each_low_over_cells(body, grid,
                        [&](std::size_t cell, double z) { low[cell] = std::min(low[cell], z); });
    for (const auto& t : body.mesh.triangles) {
      for (int n = 0; n < 200; ++n) {
        double u = part(random), v = part(random);
        if (u + v > 1) {
          u = 1 - u;
          v = 1 - v;
        }
        const Vec3 a(body.mesh.positions_mm[t[0]]), b(body.mesh.positions_mm[t[1]]),
            c(body.mesh.positions_mm[t[2]]);
        const Vec3 p = a + u * (b - a) + v * (c - a);
        const Vec2 cell = grid.cell_mm();
        const double x = (p.x - grid.bounds_mm.min.x) / cell.x;
        const double y = (p.y - grid.bounds_mm.min.y) / cell.y;
        if (std::abs(x - std::round(x)) < 1e-4 || std::abs(y - std::round(y)) < 1e-4) continue;
        const auto at = static_cast<std::size_t>(y) * 31 + static_cast<std::size_t>(x);
        ASSERT_LE(low[at], p.z + 1e-5);
        ASSERT_GE(low[at], body.box_mm.min.z - 1e-5);
      }
    }
  }
}

TEST(MeshLows, WallsOnTheBordersOfCellsAreInNone) {
  const MeshBody body = test::body_of(test::box_of({0, 0, 0}, {4, 3, 2}));
  std::map<std::size_t, double> low;
  const auto take = [&](std::size_t cell, double z) {
    low.emplace(cell, z).first->second = std::min(low.emplace(cell, z).first->second, z);
  };
  each_low_over_cells(body, {{{0, 0, 0}, {4, 3, 2}}, 4, 3}, take);
  EXPECT_EQ(low.size(), 12u);
  for (const auto& [cell, z] : low) EXPECT_EQ(z, 2) << cell;
  low.clear();
  each_low_over_cells(body, {{{-0.5, 0, 0}, {4.5, 3, 2}}, 5, 3}, take);
  EXPECT_EQ(low[0], 0) << "the wall stands in the middle of it";
  EXPECT_EQ(low[1], 2);
}

}  // namespace
}  // namespace kerf
