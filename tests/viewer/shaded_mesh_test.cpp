#include "viewer/shaded_mesh.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "tests/viewer/test_meshes.h"

namespace kerf {
namespace {

/// One step of the ten-bit normals, with room for rounding.
constexpr float kNormalTolerance = 0.003f;

void expect_same_triangles(const TriangleMesh& mesh, const ShadedMesh& shaded) {
  ASSERT_EQ(shaded.indices.size(), mesh.triangles.size() * 3);
  for (std::size_t i = 0; i < shaded.indices.size(); ++i) {
    ASSERT_LT(shaded.indices[i], shaded.vertices.size());
    EXPECT_EQ(shaded.vertices[shaded.indices[i]].position_mm,
              mesh.positions_mm[mesh.triangles[i / 3][i % 3]]);
  }
}

TEST(ShadedMeshTest, BoxHasThreeNormalsPerCorner) {
  const TriangleMesh mesh = box_mesh(Box{{0, 0, 0}, {10, 20, 30}});
  const ShadedMesh shaded = shade_mesh(mesh, {});
  EXPECT_EQ(shaded.vertices.size(), 24u);
  expect_same_triangles(mesh, shaded);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const glm::vec3 p = mesh.positions_mm[a];
    const glm::vec3 n =
        glm::normalize(glm::cross(mesh.positions_mm[b] - p, mesh.positions_mm[c] - p));
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::vec3 found = unpack_normal(shaded.vertices[shaded.indices[3 * t + k]].normal);
      EXPECT_LT(glm::length(found - n), kNormalTolerance);
    }
  }
}

TEST(ShadedMeshTest, RoundWallIsSmoothAndItsRimSharp) {
  constexpr int kSides = 72;  // 5 degrees a side; the caps are fans of 72 triangles
  const TriangleMesh mesh = prism_mesh(kSides, 10.0f, 40.0f);
  const ShadedMesh shaded = shade_mesh(mesh, {});
  EXPECT_EQ(shaded.vertices.size(), 4u * kSides + 2u);
  expect_same_triangles(mesh, shaded);
  for (const MeshVertex& vertex : shaded.vertices) {
    const glm::vec3 n = unpack_normal(vertex.normal);
    if (std::fabs(n.z) > 0.5f) {
      EXPECT_NEAR(std::fabs(n.z), 1.0f, kNormalTolerance);
      continue;
    }
    const glm::vec3 radial = glm::normalize(glm::vec3(glm::vec2(vertex.position_mm), 0.0f));
    EXPECT_LT(glm::length(n - radial), 0.02f);
  }
}

TEST(ShadedMeshTest, CreaseAngleDecides) {
  const TriangleMesh mesh = prism_mesh(12, 10.0f, 40.0f);  // 30 degrees a side
  ShadingOptions options;
  options.crease_deg = 31.0;
  EXPECT_EQ(shade_mesh(mesh, options).vertices.size(), 4u * 12u + 2u);
  options.crease_deg = 29.0;
  EXPECT_EQ(shade_mesh(mesh, options).vertices.size(), 6u * 12u + 2u);
}

TEST(ShadedMeshTest, TrianglesWithoutAreaCountForNothing) {
  TriangleMesh mesh = box_mesh(Box{{0, 0, 0}, {1, 1, 1}});
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({2, 2, 2});
  const ShadedMesh shaded = shade_mesh(mesh, {});
  expect_same_triangles(mesh, shaded);
  for (std::size_t i = 0; i < 36; ++i) {
    EXPECT_NEAR(glm::length(unpack_normal(shaded.vertices[shaded.indices[i]].normal)), 1.0f,
                kNormalTolerance);
  }
}

TEST(ShadedMeshTest, EmptyMesh) {
  const ShadedMesh shaded = shade_mesh(TriangleMesh{}, {});
  EXPECT_TRUE(shaded.vertices.empty());
  EXPECT_TRUE(shaded.indices.empty());
}

}  // namespace
}  // namespace kerf
