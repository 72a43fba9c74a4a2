#include "viewer/shaded_mesh.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "tests/viewer/test_meshes.h"

namespace kerf {
namespace {

/// One step of the ten-bit normals, with room for rounding.
constexpr float kNormalTolerance = 0.003f;

glm::vec3 unpack(std::uint32_t normal) {
  const auto field = [normal](unsigned shift) {
    const int bits = static_cast<int>((normal >> shift) & 0x3FFu);
    return static_cast<float>(bits >= 512 ? bits - 1024 : bits) / 511.0f;
  };
  return {field(0), field(10), field(20)};
}

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
      const glm::vec3 found = unpack(shaded.vertices[shaded.indices[3 * t + k]].normal);
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
  for (const ShadedVertex& vertex : shaded.vertices) {
    const glm::vec3 n = unpack(vertex.normal);
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

/// A wall 10 mm high whose plan is a zigzag of right angles with sides of 0.1 mm.
TriangleMesh zigzag_wall() {
  TriangleMesh mesh;
  glm::vec2 at(0.0f);
  for (std::uint32_t i = 0; i <= 20; ++i) {
    mesh.positions_mm.push_back({at.x, at.y, 0.0f});
    mesh.positions_mm.push_back({at.x, at.y, 10.0f});
    if (i > 0) {
      const std::uint32_t a = 2 * i - 2;
      mesh.triangles.push_back({a, a + 2, a + 3});
      mesh.triangles.push_back({a, a + 3, a + 1});
    }
    at += i % 2 == 0 ? glm::vec2(0.1f, 0.0f) : glm::vec2(0.0f, 0.1f);
  }
  return mesh;
}

TEST(ShadedMeshTest, ZigzagsBelowTheSmallestVisibleSizeAreSmoothed) {
  const TriangleMesh mesh = zigzag_wall();
  ShadingOptions options;
  EXPECT_EQ(shade_mesh(mesh, options).vertices.size(), 2u * (2u + 19u * 2u));
  options.smallest_visible_mm = 0.15;
  const ShadedMesh smooth = shade_mesh(mesh, options);
  EXPECT_EQ(smooth.vertices.size(), mesh.positions_mm.size());
  const glm::vec3 expected = glm::normalize(glm::vec3(1, -1, 0));
  for (std::size_t i = 2; i + 2 < smooth.vertices.size(); ++i) {
    EXPECT_GT(glm::dot(unpack(smooth.vertices[i].normal), expected), 0.9f);
  }
}

TEST(ShadedMeshTest, SliversAlongASharpEdgeDoNotBlurIt) {
  // A level strip 0.1 mm wide over a wall 0.1 mm high; the wall is a fan around its far lower
  // corner.
  TriangleMesh mesh;
  constexpr std::uint32_t kSteps = 50;
  for (std::uint32_t i = 0; i <= kSteps; ++i) {
    mesh.positions_mm.push_back({0.1f * static_cast<float>(i), 0.0f, 0.0f});
    mesh.positions_mm.push_back({0.1f * static_cast<float>(i), 0.1f, 0.0f});
  }
  mesh.positions_mm.push_back({20.0f, 0.0f, -0.1f});
  for (std::uint32_t a = 0; a < 2 * kSteps; a += 2) {
    mesh.triangles.push_back({a, a + 2, a + 3});
    mesh.triangles.push_back({a, a + 3, a + 1});
    mesh.triangles.push_back({2 * kSteps + 2, a + 2, a});
  }
  ShadingOptions options;
  options.smallest_visible_mm = 0.5;
  for (const ShadedVertex& vertex : shade_mesh(mesh, options).vertices) {
    const glm::vec3 n = unpack(vertex.normal);
    EXPECT_GT(std::max(n.z, -n.y), 0.999f);
  }
}

TEST(ShadedMeshTest, TinyTriangleThatIsTheTipOfALargeFaceStaysSharp) {
  // A level strip as above, a triangle of its size in the plane of the wall, and the wall itself
  // below that.
  TriangleMesh mesh;
  mesh.positions_mm = {{0, 0, 0},          {0.1f, 0, 0},  {0.1f, 0.1f, 0},
                       {0.05f, 0, -0.05f}, {-40, 0, -20}, {40, 0, -20}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 4, 3}, {3, 5, 1}, {4, 5, 3}};
  ShadingOptions options;
  options.smallest_visible_mm = 0.5;
  for (const ShadedVertex& vertex : shade_mesh(mesh, options).vertices) {
    const glm::vec3 n = unpack(vertex.normal);
    EXPECT_GT(std::max(n.z, -n.y), 0.999f);
  }
}

TEST(ShadedMeshTest, TrianglesWithoutAreaCountForNothing) {
  TriangleMesh mesh = box_mesh(Box{{0, 0, 0}, {1, 1, 1}});
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({2, 2, 2});
  const ShadedMesh shaded = shade_mesh(mesh, {});
  expect_same_triangles(mesh, shaded);
  for (std::size_t i = 0; i < 36; ++i) {
    EXPECT_NEAR(glm::length(unpack(shaded.vertices[shaded.indices[i]].normal)), 1.0f,
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
