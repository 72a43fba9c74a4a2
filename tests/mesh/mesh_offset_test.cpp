#include "mesh/mesh_offset.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mesh/mesh_lines.h"
#include "tests/mesh/sample_meshes.h"

namespace kerf {
namespace {

/// By columns.
double volume_of(const MeshBody& body, int cells) {
  ColumnGrid grid{body.box_mm, cells, cells};
  const MeshLines lines(body, 2, grid);
  double sum = 0;
  for (std::size_t cell = 0; cell < grid.size(); ++cell) {
    const auto ends = lines.ends(cell);
    for (std::size_t n = 0; n + 1 < ends.size(); n += 2)
      sum += static_cast<double>(ends[n + 1].at_mm) - static_cast<double>(ends[n].at_mm);
  }
  return sum * grid.cell_mm().x * grid.cell_mm().y;
}

TEST(MeshOffset, Box) {
  const Vec3 size(20, 12, 8);
  const double r = 2;
  const Result<MeshBody> out = grown(test::body_of(test::box_of({0, 0, 0}, size)), r, "a.stl");
  ASSERT_TRUE(out) << out.error();
  EXPECT_NEAR(out->box_mm.min.x, -2, 1e-6);
  EXPECT_NEAR(out->box_mm.max.z, 10, 1e-6);
  // Steiner's formula.
  const double faces = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
  const double edges = size.x + size.y + size.z;
  const double volume =
      size.x * size.y * size.z + faces * r + kPi * r * r * edges + 4.0 / 3 * kPi * r * r * r;
  const double measured = volume_of(*out, 400);
  // Round parts lie within kRounding_mm: 4 quarter turns of each edge's length, and the corners.
  EXPECT_LT(measured, volume + 0.2);
  EXPECT_GT(measured, volume - kRounding_mm * (2 * kPi * r * edges + 4 * kPi * r * r) - 0.2);
}

double segment_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double t = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
  return glm::distance(p, a + t * (b - a));
}

double triangle_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = glm::cross(b - a, c - a);
  const auto left = [&](const Vec3& u, const Vec3& v) {
    return glm::dot(glm::cross(v - u, p - u), n) >= 0;
  };
  if (left(a, b) && left(b, c) && left(c, a)) return std::abs(glm::dot(p - a, n)) / glm::length(n);
  return std::min(
      {segment_distance(p, a, b), segment_distance(p, b, c), segment_distance(p, c, a)});
}

/// Against distances to all triangles.
TEST(MeshOffset, RandomLumps) {
  std::mt19937 random(11);
  for (int round = 0; round < 5; ++round) {
    const TriangleMesh mesh = test::random_lumps(random, 1 + round % 3);
    const double r = 0.3 + 0.7 * round;
    const Result<MeshBody> out = grown(test::body_of(mesh), r, "a.stl");
    ASSERT_TRUE(out) << out.error();
    const ColumnGrid grid{out->box_mm, 37, 31};
    const MeshLines lines(*out, 2, grid);
    int checked = 0;
    for (std::size_t cell = 0; cell < grid.size(); ++cell) {
      const Vec2 middle = grid.center(static_cast<int>(cell % 37), static_cast<int>(cell / 37));
      for (int n = 0; n < 12; ++n) {
        const Vec3 p(middle, out->box_mm.min.z + (n + 0.37) / 12 * out->box_mm.size().z);
        double distance = 1e9;
        for (const auto& t : mesh.triangles)
          distance = std::min(distance, triangle_distance(p, Vec3(mesh.positions_mm[t[0]]),
                                                          Vec3(mesh.positions_mm[t[1]]),
                                                          Vec3(mesh.positions_mm[t[2]])));
        if (test::winding_number(mesh, p) > 0.5) distance = 0;
        if (distance > r - kRounding_mm - 1e-4 && distance < r + 1e-4) continue;
        std::size_t before = 0;
        for (const LineEnd& end : lines.ends(cell))
          before += static_cast<double>(end.at_mm) < p.z ? 1 : 0;
        EXPECT_EQ(before % 2 == 1, distance < r)
            << "round " << round << " at " << p.x << " " << p.y << " " << p.z << ", " << distance;
        ++checked;
      }
    }
    EXPECT_GT(checked, 10000);
  }
}

}  // namespace
}  // namespace kerf
