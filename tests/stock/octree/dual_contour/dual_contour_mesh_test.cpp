#include "stock/octree/dual_contour_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "stock/octree/dual_contour_simplify.h"
#include "tests/stock/octree/dual_contour/bodies.h"
#include "tests/stock/octree/dual_contour/mesh_checks.h"
#include "tests/stock/octree/dual_contour/sampled_field.h"

namespace kerf {
namespace {

/// Triangles by their places, each from its least corner on, sorted.
std::vector<std::array<float, 9>> places(const TriangleMesh& mesh) {
  std::vector<std::array<float, 9>> out;
  for (const auto& t : mesh.triangles) {
    std::array<std::array<float, 3>, 3> p;
    for (std::size_t n = 0; n < 3; ++n) {
      const glm::vec3& at = mesh.positions_mm[t[n]];
      p[n] = {at.x, at.y, at.z};
    }
    std::rotate(p.begin(), std::min_element(p.begin(), p.end()), p.end());
    out.push_back(
        {p[0][0], p[0][1], p[0][2], p[1][0], p[1][1], p[1][2], p[2][0], p[2][1], p[2][2]});
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// A block with an oblique slot, a bore and a ball's trace.
Body machined_part() {
  Body part = box_body({0.05, 0.02, -0.03}, {4.1, 3.3, 2.2});
  part = without(part, box_body({0, 0, 2}, {6, 0.8, 1}, turned({0.1, 0, 1}, 0.5)), 1);
  Body bore;
  bore.distance = [](const Vec3& p) {
    return std::max(std::hypot(p.x - 2.1, p.y + 1.4) - 1.1, -0.813 - p.z);
  };
  bore.normal = [](const Vec3& p) {
    const double r = std::hypot(p.x - 2.1, p.y + 1.4);
    return r - 1.1 > -0.813 - p.z ? Vec3((p.x - 2.1) / r, (p.y + 1.4) / r, 0) : Vec3(0, 0, -1);
  };
  part = without(part, bore, 2);
  return without(part, capsule_body({-3, 2, 2.5}, {5, 2.2, 2.1}, 0.9), 3);
}
SampledField machined_field(double cell_mm) {
  return SampledField::of(machined_part(), {Vec3(-5.013), Vec3(5)}, cell_mm);
}

// A single choice of pairs, usual or other, for all cells fails this.
TEST(DualContourMesh, RandomSignsMakeClosedOrientedManifolds) {
  std::minstd_rand random(20260);
  for (int trial = 0; trial < 1500; ++trial) {
    const int nx = 4 + trial % 3, ny = 4 + trial / 3 % 3, nz = 4 + trial / 9 % 4;
    const double share = 0.1 + 0.8 * (trial % 17) / 16.0;
    const SampledField field = SampledField::random(&random, {nx, ny, nz}, share);
    ASSERT_EQ(manifold_fault(field.mesh(16)), "") << "trial " << trial;
  }
  const SampledField field = SampledField::random(&random, {40, 40, 40}, 0.5);
  const TriangleMesh mesh = field.mesh(16);
  EXPECT_GT(mesh.triangles.size(), 100'000u);
  EXPECT_EQ(manifold_fault(mesh), "");
}

// Nodes of two cells that have only a face's diagonal in common, in all their surroundings.
TEST(DualContourMesh, EachPairOfNeighbouringCellsMakesAManifold) {
  std::minstd_rand random(7);
  for (int signs = 0; signs < 4096; ++signs) {
    SampledField field = SampledField::random(&random, {5, 4, 4}, 0.0);
    for (int bit = 0; bit < 12; ++bit) {
      if ((signs >> bit & 1) != 0) field.set_solid(1 + bit % 3, 1 + bit / 3 % 2, 1 + bit / 6);
    }
    ASSERT_EQ(manifold_fault(field.mesh(8)), "") << "signs " << signs;
  }
}

TEST(DualContourMesh, IsOrientedOutwards) {
  std::minstd_rand random(3);
  // Crossings in the middle of edges, as if all nodes were boxes: the volume is that of the nodes.
  const SampledField field = SampledField::random(&random, {20, 19, 18}, 0.5);
  double solid = 0.0;
  for (int k = 0; k < 18; ++k) {
    for (int j = 0; j < 19; ++j) {
      for (int i = 0; i < 20; ++i) solid += field.solid(i, j, k) ? field.node_volume() : 0.0;
    }
  }
  const double volume = mesh_volume(field.mesh(16));
  EXPECT_GT(volume, 0.6 * solid);
  EXPECT_LT(volume, 1.4 * solid);
}

TEST(DualContourMesh, BoxesThatTouchAtAnEdgeOrCornerStayManifold) {
  for (const Vec3& way : {Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(1, -1, 0), Vec3(-1, 1, 1)}) {
    // Apart, in contact and overlapping, by less than a cell.
    for (const double gap : {-0.11, -0.02, 0.0, 0.03, 0.12}) {
      const Vec3 shift = way * (0.5 + 0.25 * gap);
      const Body pair =
          either(box_body(-shift, Vec3(0.5)), box_body(shift + Vec3(0.01), Vec3(0.5)));
      for (const double cell_mm : {0.25, 0.21, 0.125}) {
        const SampledField field = SampledField::of(pair, {Vec3(-1.5), Vec3(1.5)}, cell_mm);
        const TriangleMesh mesh = field.mesh(8);
        ASSERT_EQ(manifold_fault(mesh), "") << gap << " at " << cell_mm;
        EXPECT_NEAR(mesh_volume(mesh), 2.0, 0.06) << gap << " at " << cell_mm;
      }
    }
  }
}

TEST(DualContourMesh, TilesAndThreadsChangeNothing) {
  const SampledField field = machined_field(0.25);
  const TriangleMesh whole = field.mesh(64);
  EXPECT_EQ(manifold_fault(whole), "");
  for (const int cells_per_side : {1, 5, 8, 16}) {
    const TriangleMesh mesh = field.mesh(cells_per_side);
    EXPECT_EQ(manifold_fault(mesh), "") << cells_per_side;
    EXPECT_EQ(places(mesh), places(whole)) << cells_per_side;
  }
  for (const double tolerance_mm : {0.0, 0.01}) {
    const TriangleMesh one = field.mesh(8, tolerance_mm, 1);
    const TriangleMesh three = field.mesh(8, tolerance_mm, 3);
    EXPECT_EQ(one.positions_mm, three.positions_mm);
    EXPECT_EQ(one.triangles, three.triangles);
  }
}

TEST(DualContourMesh, TilesMayHaveNegativeNumbers) {
  const Body ball = sphere_body({0.02, 0.03, -0.01}, 1.0);
  const SampledField field = SampledField::of(ball, {Vec3(-1.5), Vec3(1.5)}, 0.125);
  DualField shifted = field.field();
  const auto gather = shifted.gather;
  shifted.gather = [&](const std::array<int, 3>& first, const std::array<int, 3>& nodes,
                       HermiteGrid* grid) {
    gather({first[0] + 12, first[1] + 12, first[2] + 12}, nodes, grid);
  };
  shifted.origin_mm = Vec3(0);
  std::vector<std::array<int, 3>> tiles;
  for (int n = 0; n < 64; ++n) tiles.push_back({n % 4 - 2, n / 4 % 4 - 2, n / 16 - 2});
  const TriangleMesh mesh = mesh_dual_field(shifted, {7, tiles}, 0.0, 2);
  EXPECT_EQ(manifold_fault(mesh), "");
  EXPECT_EQ(mesh.triangles.size(), field.mesh(64).triangles.size());
  EXPECT_NEAR(mesh_volume(mesh), mesh_volume(field.mesh(64)), 1e-5);
}

TEST(DualContourMesh, NothingIsAnEmptyMesh) {
  std::minstd_rand random(1);
  const SampledField field = SampledField::random(&random, {5, 5, 5}, 0.0);
  EXPECT_TRUE(field.mesh(4).positions_mm.empty());
  EXPECT_TRUE(field.mesh(4, 0.1).triangles.empty());
  EXPECT_TRUE(mesh_dual_field(field.field(), {8, {}}, 0.1, 2).triangles.empty());
}

TEST(DualContourSimplify, LeavesFewTrianglesOfABox) {
  for (const double angle : {0.0, 0.4, 1.1}) {
    const Body box =
        box_body({0.013, 0.021, 0.037}, {2.1, 1.7, 1.3}, turned({1, 0.3, -0.7}, angle));
    const SampledField field = SampledField::of(box, {Vec3(-3.5), Vec3(3.5)}, 0.125);
    const TriangleMesh mesh = field.mesh(16, 0.001);
    EXPECT_EQ(manifold_fault(mesh), "");
    EXPECT_LE(mesh.triangles.size(), 30u) << "of " << field.mesh(64).triangles.size();
    EXPECT_LT(farthest_mm(mesh, box), 0.001);
    EXPECT_NEAR(mesh_volume(mesh), 8 * 2.1 * 1.7 * 1.3, 0.001 * mesh_area(mesh));
  }
}

TEST(DualContourSimplify, StaysWithinTheTolerance) {
  const Body part = machined_part();
  const SampledField field = machined_field(0.125);
  const TriangleMesh full = field.mesh(32);
  const double own_mm = farthest_mm(full, part);
  std::size_t triangles = full.triangles.size();
  for (const double tolerance_mm : {0.001, 0.005, 0.02, 0.1}) {
    const TriangleMesh mesh = field.mesh(32, tolerance_mm);
    EXPECT_EQ(manifold_fault(mesh), "") << tolerance_mm;
    EXPECT_LT(mesh.triangles.size(), triangles) << tolerance_mm;
    triangles = mesh.triangles.size();
    EXPECT_LT(farthest_mm(mesh, part), own_mm + tolerance_mm);
    EXPECT_NEAR(mesh_volume(mesh), mesh_volume(full), tolerance_mm * mesh_area(full));
  }
  EXPECT_LT(triangles, full.triangles.size() / 20);
}

TEST(DualContourSimplify, KeepsAnyManifoldOne) {
  std::minstd_rand random(99);
  for (int trial = 0; trial < 60; ++trial) {
    const SampledField field =
        SampledField::random(&random, {12, 11, 10}, 0.15 + 0.7 * (trial % 8) / 7.0);
    // Far more than the size of the whole: only what keeps the mesh sound holds vertices back.
    const TriangleMesh mesh = field.mesh(4 + trial % 3, 1000.0);
    ASSERT_EQ(manifold_fault(mesh), "") << "trial " << trial;
    ASSERT_LT(mesh.triangles.size(), field.mesh(16).triangles.size()) << "trial " << trial;
  }
}

TEST(DualContourSimplify, LocksVertices) {
  const TriangleMesh full =
      SampledField::of(box_body(Vec3(0.01), Vec3(1)), {Vec3(-1.5), Vec3(1.5)}, 0.25).mesh(16);
  SimplifiedMesh part{full, std::vector<float>(full.triangles.size(), 0.0f),
                      std::vector<std::uint8_t>(full.positions_mm.size(), 0)};
  for (std::size_t v = 0; v < part.is_locked.size(); v += 3) part.is_locked[v] = 1;
  const std::vector<std::uint32_t> numbers = simplify(&part, 0.01);
  std::size_t gone = 0;
  for (std::size_t v = 0; v < numbers.size(); ++v) {
    if (numbers[v] == kTakenOut) {
      EXPECT_NE(v % 3, 0u);
      ++gone;
    } else {
      EXPECT_EQ(part.mesh.positions_mm[numbers[v]], full.positions_mm[v]);
    }
  }
  EXPECT_GT(gone, numbers.size() / 4);
  EXPECT_EQ(part.mesh.positions_mm.size(), numbers.size() - gone);
  EXPECT_EQ(manifold_fault(part.mesh), "");
}

}  // namespace
}  // namespace kerf
