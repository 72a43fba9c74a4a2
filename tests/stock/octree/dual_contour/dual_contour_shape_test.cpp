#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "stock/octree/dual_contour.h"
#include "tests/stock/octree/dual_contour/bodies.h"
#include "tests/stock/octree/dual_contour/mesh_checks.h"
#include "tests/stock/octree/dual_contour/sampled_field.h"

namespace kerf {
namespace {

struct Errors {
  double volume, area, surface_mm, vertex_mm, normal_rad;
};

/// Of volume and area relative, of places and normals the greatest.
Errors errors_of(const Body& body, const Box& box, double cell_mm, double volume, double area) {
  const SampledField field = SampledField::of(body, box, cell_mm);
  const TriangleMesh mesh = field.mesh(32);
  EXPECT_EQ(manifold_fault(mesh), "");
  DualContour contour;
  const DualField dual = field.field();
  contour.contour(dual, {{0, 0, 0}, field.nodes()});
  double normal_rad = 0.0;
  for (const DualContour::Vertex& vertex : contour.vertices()) {
    const Vec3 at(dual.place_mm(contour.cell_of(vertex), vertex.offset_mm));
    EXPECT_EQ(vertex.facets, 1);
    const Vec3 normal(contour.facets()[vertex.first_facet].normal);
    normal_rad = std::max(normal_rad, glm::length(glm::cross(normal, body.normal(at))));
  }
  return {std::abs(mesh_volume(mesh) / volume - 1), std::abs(mesh_area(mesh) / area - 1),
          farthest_mm(mesh, body), farthest_vertex_mm(mesh, body), normal_rad};
}

/// Half the cells: a quarter of the errors.
void expect_second_order(const Body& body, const Box& box, double cell_mm, double volume,
                         double area) {
  Errors coarse = errors_of(body, box, cell_mm, volume, area);
  for (const double share : {0.5, 0.25}) {
    const Errors fine = errors_of(body, box, share * cell_mm, volume, area);
    EXPECT_LT(fine.volume, 0.3 * coarse.volume);
    EXPECT_LT(fine.area, 0.3 * coarse.area);
    EXPECT_LT(fine.surface_mm, 0.35 * coarse.surface_mm);
    // Of a sphere they are exact: the mean of the crossings' normals is that at their mean.
    EXPECT_LT(fine.normal_rad, std::max(0.7 * coarse.normal_rad, 1e-4));
    EXPECT_LT(fine.vertex_mm, 0.5 * fine.surface_mm);
    coarse = fine;
  }
}

TEST(DualContourShape, SphereConvergesWithTheSquareOfTheCell) {
  const double r = 4.0;
  const Body sphere = sphere_body({0.1, -0.05, 0.07}, r);
  expect_second_order(sphere, {Vec3(-5), Vec3(5)}, 0.5, 4.0 / 3.0 * kPi * r * r * r,
                      4.0 * kPi * r * r);
}

TEST(DualContourShape, CapsuleConvergesWithTheSquareOfTheCell) {
  const Vec3 a(-1.9, -1, -0.5), b(2, 1.5, 1);
  const double r = 2.0, length = glm::length(b - a);
  expect_second_order(capsule_body(a, b, r), {Vec3(-4.3), Vec3(4.4)}, 0.4,
                      kPi * r * r * (length + 4.0 / 3.0 * r), 2.0 * kPi * r * (length + 2.0 * r));
}

TEST(DualContourShape, BoxesAreExact) {
  const Vec3 center(0.013, 0.021, 0.037), half(2.1, 1.7, 1.3);
  for (int trial = 0; trial < 12; ++trial) {
    const glm::dmat3 turn =
        trial == 0 ? glm::dmat3(1) : turned({1, 0.3 * trial, 0.2 * trial - 0.7}, 0.35 * trial);
    const Body box = box_body(center, half, turn);
    const SampledField field = SampledField::of(box, {Vec3(-4), Vec3(4)}, 0.25);
    const TriangleMesh mesh = field.mesh(32);
    ASSERT_EQ(manifold_fault(mesh), "");
    EXPECT_LT(farthest_mm(mesh, box), 1e-6) << trial;
    EXPECT_NEAR(mesh_volume(mesh), 8.0 * half.x * half.y * half.z, 1e-5) << trial;
    // No triangle is folded over another one.
    EXPECT_NEAR(mesh_area(mesh), 8.0 * (half.x * half.y + half.y * half.z + half.z * half.x), 1e-5)
        << trial;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 sign((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                      (corner & 4) != 0 ? 1 : -1);
      const Vec3 at = center + turn * (sign * half);
      double nearest = 1e9;
      for (const glm::vec3& p : mesh.positions_mm)
        nearest = std::min(nearest, glm::length(Vec3(p) - at));
      EXPECT_LT(nearest, 1e-6) << trial;
    }
  }
}

// Corners that the wall's two sides cut off face each other across cells: only the normals tell
// that there is a wall between them and not a gap.
TEST(DualContourShape, WallsOfMoreThanOneAndAHalfCellsAreExact) {
  for (int trial = 1; trial < 6; ++trial) {
    const Body wall = box_body({0.013, 0.021, 0.037}, {2.1, 1.7, 0.2},
                               turned({1, 0.3 * trial, 0.2 * trial - 0.7}, 0.1 + 0.35 * trial));
    const TriangleMesh mesh = SampledField::of(wall, {Vec3(-4), Vec3(4)}, 0.25).mesh(32);
    EXPECT_EQ(manifold_fault(mesh), "") << trial;
    EXPECT_LT(farthest_mm(mesh, wall), 1e-6) << trial;
    EXPECT_NEAR(mesh_area(mesh), 8.0 * (2.1 * 1.7 + 1.7 * 0.2 + 0.2 * 2.1), 1e-5) << trial;
  }
}

TEST(DualContourShape, CellsNeedNotBeCubes) {
  const Body box = box_body({0.013, 0.021, 0.037}, {2.1, 1.7, 1.3}, turned({1, 2, -0.5}, 0.8));
  const TriangleMesh mesh =
      SampledField::of(box, {33, 41, 27}, Vec3(-4, -4, -3.9), {0.25, 0.2, 0.3}).mesh(16);
  EXPECT_EQ(manifold_fault(mesh), "");
  EXPECT_LT(farthest_mm(mesh, box), 1e-6);
}

TEST(DualContourShape, FacesOnNodesAreExact) {
  const Body box = box_body(Vec3(0), {1, 0.75, 0.5});
  const TriangleMesh mesh = SampledField::of(box, {Vec3(-2), Vec3(2)}, 0.25).mesh(16);
  EXPECT_EQ(manifold_fault(mesh), "");
  EXPECT_LT(farthest_mm(mesh, box), 1e-7);
  EXPECT_NEAR(mesh_volume(mesh), 3.0, 1e-6);
}

// Walls and floor of a round pocket, 0.25 mm cells, radii as trochoids leave them.
TEST(DualContourShape, RoundWallsAreWithinAHundredthOfAMillimetre) {
  for (const double radius : {1.3, 3.0, 5.2}) {
    Body bore;
    bore.distance = [=](const Vec3& p) {
      return std::max(std::hypot(p.x - 0.1, p.y + 0.07) - radius, -0.513 - p.z);
    };
    bore.normal = [=](const Vec3& p) {
      const double r = std::hypot(p.x - 0.1, p.y + 0.07);
      return r - radius > -0.513 - p.z ? Vec3((p.x - 0.1) / r, (p.y + 0.07) / r, 0)
                                       : Vec3(0, 0, -1);
    };
    const Body part = without(box_body(Vec3(0), {6.03, 6.04, 2.01}), bore);
    const TriangleMesh mesh =
        SampledField::of(part, {Vec3(-7, -7, -3), Vec3(7, 7, 3)}, 0.25).mesh(32);
    EXPECT_EQ(manifold_fault(mesh), "");
    // Walls and floor; the rim is where the bore's edge would be bevelled.
    EXPECT_LT(farthest_vertex_mm(mesh, part), 0.003) << radius;
    EXPECT_LT(farthest_mm(mesh, part), 0.010) << radius;
  }
}

TEST(DualContourShape, VerticesStayOnObliquePlanes) {
  const Body box = box_body({60.1, 40.2, 20.3}, {2.9, 2.9, 2.9}, turned({1, 1, 0.2}, 0.3));
  const TriangleMesh mesh =
      SampledField::of(box, {Vec3(55, 35, 15), Vec3(66, 46, 26)}, 0.25).mesh(32);
  EXPECT_LT(farthest_vertex_mm(mesh, box), 1e-5);  // what single precision leaves at 60 mm
}

std::vector<DualSample> samples_of(std::initializer_list<DualSample> list) { return list; }

TEST(DualContourVertex, LiesWhereTwoOrThreePlanesMeet) {
  const glm::vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), cell(1);
  const DualPlacement edge = place_dual_vertex(
      samples_of({{{0.3f, 0, 0}, x}, {{0.3f, 0, 1}, x}, {{0, 0.6f, 0}, y}, {{0, 0.6f, 1}, y}}),
      cell);
  EXPECT_EQ(edge.clusters, 2);
  EXPECT_LT(glm::length(edge.at_mm - glm::vec3(0.3f, 0.6f, 0.5f)), 1e-6f);
  const DualPlacement corner = place_dual_vertex(
      samples_of({{{0.3f, 0, 0}, x}, {{0, 0.6f, 0}, y}, {{0, 0, 0.1f}, z}}), cell);
  EXPECT_EQ(corner.clusters, 3);
  EXPECT_LT(glm::length(corner.at_mm - glm::vec3(0.3f, 0.6f, 0.1f)), 1e-6f);
}

TEST(DualContourVertex, IsInTheCellWherePlanesDoNotMeet) {
  std::minstd_rand random(5);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  const glm::vec3 cell(0.5f, 1.0f, 2.0f);
  for (int trial = 0; trial < 20'000; ++trial) {
    std::vector<DualSample> samples(4 + std::size_t(trial % 9));
    for (DualSample& sample : samples) {
      sample.at_mm = glm::vec3{unit(random), unit(random), unit(random)} * cell;
      sample.normal =
          glm::normalize(glm::vec3{unit(random) - 0.5f, unit(random) - 0.5f, unit(random) - 0.5f} +
                         glm::vec3(1e-4f));
    }
    const DualPlacement placed = place_dual_vertex(samples, cell);
    float miss = 0.0f;
    for (const DualSample& sample : samples)
      miss = std::max(miss, std::abs(glm::dot(sample.normal, placed.at_mm - sample.at_mm)));
    const glm::vec3 inside = glm::clamp(placed.at_mm, glm::vec3(0), cell);
    if (inside != placed.at_mm) {
      ASSERT_LT(miss, 0.026f) << trial;
      ASSERT_LE(glm::length((inside - placed.at_mm) / cell), std::sqrt(3.0f)) << trial;
    }
  }
}

}  // namespace
}  // namespace kerf
