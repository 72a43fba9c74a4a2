#include "mesh/mesh_body.h"

#include <gtest/gtest.h>

#include "tests/mesh/sample_meshes.h"

namespace kerf {
namespace {

std::string error_of(TriangleMesh mesh) {
  const Result<MeshBody> body = mesh_body(std::move(mesh), "a.stl");
  return body ? "" : body.error();
}

TEST(MeshBody, Box) {
  const Result<MeshBody> body = mesh_body(test::box_of({-1, 2, 3}, {4, 8, 10}), "a.stl");
  ASSERT_TRUE(body) << body.error();
  EXPECT_NEAR(body->volume_mm3, 5 * 6 * 7, 1e-9);
  EXPECT_EQ(body->box_mm, (Box{{-1, 2, 3}, {4, 8, 10}}));
  EXPECT_TRUE(body->is_height_field());
  EXPECT_FALSE(body->was_turned);
  EXPECT_EQ(body->parts, 1u);
}

TEST(MeshBody, InsideOutIsTurned) {
  TriangleMesh mesh = test::box_of({0, 0, 0}, {1, 2, 3});
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  const Result<MeshBody> body = mesh_body(mesh, "a.stl");
  ASSERT_TRUE(body) << body.error();
  EXPECT_NEAR(body->volume_mm3, 6, 1e-9);
  EXPECT_TRUE(body->was_turned);
  EXPECT_NEAR(test::volume_mm3(body->mesh), 6, 1e-9);
}

TEST(MeshBody, OverhangsAreMeasured) {
  // A slab of 10 x 10 on a foot of 4 x 10: 60 mm2 face down, at Z5.
  TriangleMesh mesh = test::box_of({0, 0, 0}, {4, 10, 5});
  test::add_box(mesh, {0, 0, 5}, {10, 10, 8});
  const Result<MeshBody> body = mesh_body(mesh, "a.stl");
  ASSERT_TRUE(body) << body.error();
  // The slab's whole underside: that it stands on the foot is no business of triangles.
  EXPECT_NEAR(body->overhang_mm2, 100, 1e-6);
  EXPECT_NEAR(body->overhang_z_mm, 5, 1e-6);
  EXPECT_FALSE(body->is_height_field());
  EXPECT_EQ(body->parts, 2u);
  // A cone stands; on its point it does not.
  TriangleMesh cone;
  cone.positions_mm = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 5}};
  cone.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  EXPECT_TRUE(mesh_body(cone, "a.stl")->is_height_field());
  for (auto& p : cone.positions_mm) p.z = -p.z;
  for (auto& t : cone.triangles) std::swap(t[0], t[1]);
  EXPECT_NEAR(mesh_body(cone, "a.stl")->overhang_mm2, 8, 1e-6);
}

TEST(MeshBody, WallsThatRoundingTiltsAreUpright) {
  TriangleMesh mesh = test::box_of({0, 0, 0}, {100, 50, 20});
  mesh.positions_mm[5].x += 0.0008f;  // the upper corner leans out
  EXPECT_TRUE(mesh_body(mesh, "a.stl")->is_height_field());
  mesh.positions_mm[5].x += 0.01f;
  EXPECT_FALSE(mesh_body(mesh, "a.stl")->is_height_field());
}

TEST(MeshBody, FaultsSayWhere) {
  TriangleMesh open = test::box_of({0, 0, 0}, {10, 10, 10});
  open.triangles.pop_back();
  const std::string text = error_of(open);
  EXPECT_NE(text.find("a.stl: is not closed: 3 of 18 edges belong to one triangle only, at X"),
            text.npos)
      << text;
  EXPECT_NE(text.find("X5.000 Y5.000 Z10.000"), text.npos) << text;
  TriangleMesh twisted = test::box_of({0, 0, 0}, {10, 10, 10});
  std::swap(twisted.triangles[0][0], twisted.triangles[0][1]);
  EXPECT_NE(error_of(twisted).find("a.stl: at 3 of 18 edges the triangles disagree"), text.npos)
      << error_of(twisted);
  EXPECT_EQ(error_of({}), "a.stl: has no triangles");
  EXPECT_EQ(error_of(test::box_of({0, 0, 0}, {10, 10, 0})),
            "a.stl: encloses nothing: it is 10 x 10 x 0 mm");
  // There and back: closed, and nothing inside.
  TriangleMesh sheet;
  sheet.positions_mm = {{0, 0, 0}, {4, 0, 1}, {0, 4, 2}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 1}};
  EXPECT_NE(error_of(sheet).find("encloses nothing"), text.npos) << error_of(sheet);
}

}  // namespace
}  // namespace kerf
