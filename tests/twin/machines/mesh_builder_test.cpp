#include "twin/machines/mesh_builder.h"

#include <gtest/gtest.h>

#include "tests/twin/machines/mesh_support.h"
#include "twin/machines/linked_machine.h"

namespace kerf {
namespace {

/// A regular polygon of 32 corners instead of a circle.
double round_area(double radius) { return 16 * radius * radius * std::sin(kPi / 16); }

TEST(MeshBuilder, PiecesAreClosedAndHaveTheirVolumeAlongEveryAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto expect = [&](const MeshBuilder& mesh, double volume, const char* what) {
      EXPECT_EQ(open_edges(mesh.mesh()), 0U) << what << axis;
      EXPECT_NEAR(volume_mm3(mesh.mesh()), volume, 1e-3 * volume) << what << axis;
    };
    MeshBuilder block;
    block.block({1, 2, 3}, {11, 22, 33}, axis, 2);
    const double length = axis == 0 ? 10 : axis == 1 ? 20 : 30;
    expect(block, 6000 - length * 4 * 2 * 2 / 2, "block");
    MeshBuilder cylinder;
    cylinder.cylinder({5, 6, 7}, axis, 4, -9);
    expect(cylinder, round_area(4) * 9, "cylinder");
    MeshBuilder ring;
    ring.turned({0, 0, 0}, axis,
                std::array<Vec2, 4>{Vec2(3, 0), Vec2(5, 0), Vec2(5, 2), Vec2(3, 2)});
    expect(ring, (round_area(5) - round_area(3)) * 2, "ring");
    MeshBuilder cone;
    cone.turned({0, 0, 0}, axis, std::array<Vec2, 3>{Vec2(0, 0), Vec2(6, 0), Vec2(0, 10)});
    expect(cone, round_area(6) * 10 / 3, "cone");
    MeshBuilder hook;  // concave
    hook.prism(
        std::array<Vec2, 6>{Vec2(0, 0), Vec2(4, 0), Vec2(4, 1), Vec2(1, 1), Vec2(1, 3), Vec2(0, 3)},
        axis, -1, 4);
    expect(hook, 6 * 5, "hook");
  }
}

TEST(MeshBuilder, ABoxWithoutVolumeAddsNothing) {
  MeshBuilder mesh;
  mesh.box({0, 0, 0}, {1, 1, 0});
  mesh.block({0, 0, 0}, {0, 1, 1}, 2, 0.1);
  EXPECT_TRUE(mesh.mesh().triangles.empty());
}

TEST(MeshBuilder, ShapesOfStockTexts) {
  const Result<Blank> shape =
      parse_blank("box:0,0,0:10,20,30+cylinder:5,5,0:10:8:x+tube:0,0,-5:5:20:10");
  ASSERT_TRUE(shape);
  ASSERT_EQ(shape->bodies.size(), 3U);
  for (const BlankBody& body : shape->bodies) {
    const TriangleMesh mesh = mesh_of(body);
    EXPECT_EQ(open_edges(mesh), 0U);
    const Box box = bounds_of(mesh);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(box.min[axis], body.bounds_mm.min[axis], 1e-5);
      EXPECT_NEAR(box.max[axis], body.bounds_mm.max[axis], 1e-5);
    }
  }
  EXPECT_NEAR(volume_mm3(mesh_of(shape->bodies[2])), (round_area(10) - round_area(5)) * 10, 1);
}

}  // namespace
}  // namespace kerf
