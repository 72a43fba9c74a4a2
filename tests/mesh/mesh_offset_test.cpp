#include "mesh/mesh_offset.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesh/mesh_lines.h"
#include "tests/mesh/sample_meshes.h"

namespace kerf {
namespace {

/// By columns.
double volume_of(const MeshBody& body, int cells) {
  ColumnGrid grid{body.box_mm, cells, cells};
  const MeshLines lines(body.mesh, 2, grid);
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

/// Against distances to all triangles, at so many places across; how many were looked at.
int compare_with_distances(const TriangleMesh& mesh, double r, const MeshBody& out, int across) {
  const ColumnGrid grid{out.box_mm, across, across - 6};
  const MeshLines lines(out.mesh, 2, grid);
  int checked = 0;
  for (std::size_t cell = 0; cell < grid.size(); ++cell) {
    const int width = grid.nx, n_cell = static_cast<int>(cell);
    const Vec2 middle = grid.center(n_cell % width, n_cell / width);
    for (int n = 0; n < 12; ++n) {
      const Vec3 p(middle, out.box_mm.min.z + (n + 0.37) / 12 * out.box_mm.size().z);
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
          << "grown by " << r << " at " << p.x << " " << p.y << " " << p.z << ", " << distance;
      ++checked;
    }
  }
  return checked;
}

TEST(MeshOffset, RandomLumps) {
  std::mt19937 random(11);
  for (int round = 0; round < 5; ++round) {
    const TriangleMesh mesh = test::random_lumps(random, 1 + round % 3);
    const double r = 0.3 + 0.7 * round;
    const Result<MeshBody> out = grown(test::body_of(mesh), r, "a.stl");
    ASSERT_TRUE(out) << out.error();
    EXPECT_GT(compare_with_distances(mesh, r, *out, 37), 10000);
  }
}

/// A ring of round section: smooth all over, with a hole in its middle that an allowance closes.
TriangleMesh round_ring(double radius, double section, int around, int about) {
  std::vector<Vec2> outline;
  for (const Vec2& p : test::circle(section, about)) outline.emplace_back(-p.x, radius + p.y);
  return test::ring_of(outline, around);
}

TEST(MeshOffset, ASmoothSurfaceGrowsByItsOwnTriangles) {
  const double radius = 10, section = 4;
  const TriangleMesh mesh = round_ring(radius, section, 200, 120);
  for (const double r : {0.5, 2.0}) {
    const Result<MeshBody> out = grown(test::body_of(mesh), r, "a.stl");
    ASSERT_TRUE(out) << out.error();
    EXPECT_EQ(out->mesh.triangles.size(), mesh.triangles.size());
    const double volume = 2 * kPi * kPi * radius * (section + r) * (section + r);
    EXPECT_NEAR(volume_of(*out, 500), volume, 0.004 * volume);
  }
}

/// A disc whose rim is sharp and round: its corners lie close together, and narrow pieces do.
TEST(MeshOffset, ASharpRimOfManyCornersTakesFewTriangles) {
  TriangleMesh mesh;
  const double radius = 10, height = 4, r = 2;
  test::add_prism(mesh, test::circle(radius, 240), 0, height);
  const Result<MeshBody> out = grown(test::body_of(mesh), r, "a.stl");
  ASSERT_TRUE(out) << out.error();
  EXPECT_LT(out->mesh.triangles.size(), 800u * 240u);
  // The disc, and around it half a circle about its rim (Pappus).
  const double volume = kPi * radius * radius * (height + 2 * r) + 2 * kPi * radius * r * height +
                        kPi * r * r * height +
                        2 * (kPi * kPi * r * r * radius / 2 + 2.0 / 3 * kPi * r * r * r);
  const double measured = volume_of(*out, 400);
  EXPECT_LT(measured, volume + 0.5);
  EXPECT_GT(measured, volume - kRounding_mm * 2 * (2 * kPi * (radius + r) * kPi * r) - 1);
  EXPECT_GT(compare_with_distances(mesh, r, *out, 15), 700);
}

/// The hole is 1.5 mm wide: grown by 2 mm nothing of it is left, and its triangles would be turned
/// inside out. The same where a fillet is narrower than the allowance.
TEST(MeshOffset, HollowsNarrowerThanTheAllowanceClose) {
  const TriangleMesh ring = round_ring(3, 2.25, 40, 16);
  const Result<MeshBody> closed = grown(test::body_of(ring), 2, "a.stl");
  ASSERT_TRUE(closed) << closed.error();
  EXPECT_GT(compare_with_distances(ring, 2, *closed, 23), 2500);
  const MeshLines through(closed->mesh, 2, {{{-0.01, -0.01, 0}, {0.01, 0.01, 0}}, 1, 1});
  ASSERT_EQ(through.ends(0).size(), 2u) << "it is closed";
  // A groove of radius 1 around a rod.
  std::vector<Vec2> section{{-8, 0.5}, {8, 0.5}, {8, 6}};
  for (int k = 0; k <= 16; ++k)
    section.emplace_back(std::cos(kPi * k / 16), 6 - std::sin(kPi * k / 16));
  section.emplace_back(-8, 6);
  std::reverse(section.begin(), section.end());
  const TriangleMesh groove = test::ring_of(section, 40);
  const Result<MeshBody> filled = grown(test::body_of(groove), 1.5, "a.stl");
  ASSERT_TRUE(filled) << filled.error();
  EXPECT_GT(compare_with_distances(groove, 1.5, *filled, 23), 2500);
}

}  // namespace
}  // namespace kerf
