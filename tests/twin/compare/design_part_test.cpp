#include "twin/compare/design_part.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <glm/geometric.hpp>
#include <random>

#include "base/mesh_file.h"
#include "tests/base/temporary_folder.h"
#include "tests/twin/compare/meshes.h"
#include "twin/compare/design_file.h"

namespace kerf {
namespace {

using test::box_distance_mm;
using test::box_mesh;

DesignPart quiet_part(const TriangleMesh& mesh) {
  Diagnostics diagnostics;
  DesignPart part(mesh, "part.stl", diagnostics);
  EXPECT_TRUE(diagnostics.empty()) << to_string(diagnostics.front());
  return part;
}

Vec3 random_point(std::mt19937& random, double reach) {
  std::uniform_real_distribution<double> at(-reach, reach);
  return {at(random), at(random), at(random)};
}

TEST(DesignPart, Box) {
  const Vec3 low(-4, -2, -1), high(3, 5, 2);
  const DesignPart part = quiet_part(box_mesh(low, high));
  EXPECT_NEAR(part.facts().volume_mm3, 7 * 7 * 3, 1e-9);
  EXPECT_EQ(part.facts().edges, 18u);
  std::mt19937 random(1);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p = random_point(random, 8);
    ASSERT_NEAR(part.distance_mm(p), box_distance_mm(low, high, p), 1e-9);
  }
  EXPECT_EQ(part.distance_mm(high), 0);
}

TEST(DesignPart, Sphere) {
  const int around = 200;
  const double radius = 10, sag = radius * (1 - std::cos(2 * kPi / around));
  const DesignPart part = quiet_part(test::sphere_mesh(radius, around));
  std::mt19937 random(2);
  for (int n = 0; n < 5000; ++n) {
    const Vec3 p = random_point(random, 15);
    ASSERT_NEAR(part.distance_mm(p), glm::length(p) - radius, 1.5 * sag);
  }
}

TEST(DesignPart, Cylinder) {
  const double radius = 6, height = 9, sag = radius * (1 - std::cos(kPi / 500));
  const DesignPart part = quiet_part(test::cylinder_mesh(radius, height, 500));
  std::mt19937 random(3);
  for (int n = 0; n < 5000; ++n) {
    const Vec3 p = random_point(random, 14);
    const double from_axis = std::hypot(p.x, p.y);
    const double expected =
        box_distance_mm({-radius, -1e6, 0}, {radius, 1e6, height}, {from_axis, 0, p.z});
    ASSERT_NEAR(part.distance_mm(p), expected, 2 * sag + 1e-6);
  }
}

TEST(DesignPart, NearestIsThatOfAllTriangles) {
  std::mt19937 random(4);
  TriangleMesh mesh;
  std::normal_distribution<float> small(0, 2);
  for (std::uint32_t t = 0; t < 700; ++t) {
    const glm::vec3 middle(random_point(random, 20));
    for (int k = 0; k < 3; ++k) {
      mesh.positions_mm.push_back(middle + glm::vec3{small(random), small(random), small(random)});
    }
    // Some have no area.
    if (t % 17 == 0) mesh.positions_mm.back() = middle;
    if (t % 19 == 0) mesh.positions_mm[3 * t] = mesh.positions_mm[3 * t + 1];
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  const TriangleTree tree(mesh);
  std::uint32_t hint = 0;
  for (int n = 0; n < 3000; ++n) {
    const Vec3 p = random_point(random, 30);
    double least = 1e300;
    for (std::uint32_t t = 0; t < tree.size(); ++t) {
      least = std::min(least, nearest_on_triangle(tree.corners(t), p).distance2_mm2);
    }
    const NearestPoint found = tree.nearest(p, hint);
    hint = found.triangle;
    ASSERT_NEAR(std::sqrt(found.distance2_mm2), std::sqrt(least), 1e-9);
    ASSERT_NEAR(glm::length(p - found.point_mm), std::sqrt(least), 1e-6);
  }
}

TEST(DesignPart, NearestOnTriangleIsThatOfManyPointsOfIt) {
  std::mt19937 random(5);
  for (int n = 0; n < 200; ++n) {
    const std::array<glm::vec3, 3> c{glm::vec3(random_point(random, 3)),
                                     glm::vec3(random_point(random, 3)),
                                     glm::vec3(random_point(random, 3))};
    const Vec3 p = random_point(random, 5);
    double least = 1e300;
    constexpr int kSteps = 120;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const double u = static_cast<double>(i) / kSteps, v = static_cast<double>(j) / kSteps;
        least = std::min(
            least, glm::length(Vec3(c[0]) * (1 - u - v) + Vec3(c[1]) * u + Vec3(c[2]) * v - p));
      }
    }
    const double found = std::sqrt(nearest_on_triangle(c, p).distance2_mm2);
    ASSERT_LE(found, least + 1e-9);
    ASSERT_NEAR(found, least, 0.1);
  }
}

TEST(DesignPart, SidesAtSharpEdges) {
  // A needle: where the nearest point is on an edge or the tip, one face's normal would often err.
  TriangleMesh needle;
  needle.positions_mm = {{0, 0, 10}, {0.5f, 0, 0}, {-0.5f, 0.1f, 0}, {0, -0.1f, 0}};
  needle.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}};
  Diagnostics diagnostics;
  const DesignPart part(needle, "needle.stl", diagnostics);
  std::mt19937 random(6);
  int outside = 0;
  for (int n = 0; n < 5000; ++n) {
    const Vec3 p = Vec3(0, 0, 10) + random_point(random, 1);
    // Above the tip and beside the faces there is no material.
    if (p.z > 10 || std::abs(p.x) > 0.06 || std::abs(p.y) > 0.06) {
      ++outside;
      ASSERT_GT(part.distance_mm(p), 0) << p.x << ' ' << p.y << ' ' << p.z;
    }
  }
  EXPECT_GT(outside, 4000);
  EXPECT_LT(part.distance_mm({0, -0.01, 1}), 0);
}

TEST(DesignPart, InsideOutIsTurned) {
  TriangleMesh mesh = box_mesh({0, 0, 0}, {2, 2, 2});
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  Diagnostics diagnostics;
  const DesignPart part(mesh, "part.stl", diagnostics);
  ASSERT_EQ(diagnostics.size(), 1u);
  EXPECT_EQ(to_string(diagnostics[0]),
            "part.stl: note: is inside out (all normals point inwards); it is turned\n");
  EXPECT_NEAR(part.distance_mm({1, 1, 0.25}), -0.25, 1e-12);
  EXPECT_NEAR(part.distance_mm({1, 1, -0.25}), 0.25, 1e-12);
}

TEST(DesignPart, TrianglesThatDisagree) {
  TriangleMesh mesh = box_mesh({0, 0, 0}, {2, 2, 2});
  std::swap(mesh.triangles[2][1], mesh.triangles[2][2]);
  Diagnostics diagnostics;
  const DesignPart part(mesh, "part.stl", diagnostics);
  ASSERT_EQ(diagnostics.size(), 1u);
  EXPECT_NE(diagnostics[0].message.find("at 3 of 18 edges the triangles disagree"),
            std::string::npos)
      << diagnostics[0].message;
  std::mt19937 random(7);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 p = random_point(random, 3);
    ASSERT_NEAR(part.distance_mm(p), box_distance_mm({0, 0, 0}, {2, 2, 2}, p), 1e-9);
  }
}

TEST(DesignPart, OpenIsToldAndGoodAwayFromTheHole) {
  TriangleMesh mesh = box_mesh({0, 0, 0}, {8, 8, 8});
  mesh.triangles.erase(mesh.triangles.begin());  // half of the floor
  Diagnostics diagnostics;
  const DesignPart part(mesh, "part.stl", diagnostics);
  ASSERT_EQ(diagnostics.size(), 1u);
  EXPECT_EQ(diagnostics[0].severity, Severity::kWarning);
  EXPECT_NE(diagnostics[0].message.find("is not closed: 3 of 18 edges"), std::string::npos);
  EXPECT_NEAR(part.distance_mm({4, 4, 7.5}), -0.5, 1e-9);
  EXPECT_NEAR(part.distance_mm({4, 4, 8.5}), 0.5, 1e-9);
  EXPECT_NEAR(part.distance_mm({8.5, 4, 6}), 0.5, 1e-9);
}

TEST(DesignPart, TouchingBoxesAndSplitSidesHaveRightSides) {
  // Two boxes that share an edge: four triangles there. And a box whose sides share no corners.
  TriangleMesh two = box_mesh({0, 0, 0}, {2, 2, 2});
  const TriangleMesh other = box_mesh({2, 2, 0}, {4, 4, 2});
  std::array<std::uint32_t, 8> number{};
  for (std::uint32_t n = 0; n < 8; ++n) {
    const glm::vec3& p = other.positions_mm[n];
    const auto known = std::find(two.positions_mm.begin(), two.positions_mm.end(), p);
    number[n] = static_cast<std::uint32_t>(known - two.positions_mm.begin());
    if (known == two.positions_mm.end()) two.positions_mm.push_back(p);
  }
  for (const auto& t : other.triangles) {
    two.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  }
  const DesignPart touching = quiet_part(two);
  TriangleMesh loose;
  const TriangleMesh box = box_mesh({0, 0, 0}, {2, 2, 2});
  for (const auto& t : box.triangles) {
    const auto first = static_cast<std::uint32_t>(loose.positions_mm.size());
    for (const std::uint32_t corner : t) loose.positions_mm.push_back(box.positions_mm[corner]);
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  Diagnostics diagnostics;
  const DesignPart unjoined(loose, "part.stl", diagnostics);
  EXPECT_EQ(diagnostics.size(), 1u);
  std::mt19937 random(8);
  for (int n = 0; n < 4000; ++n) {
    const Vec3 p = random_point(random, 5);
    const double a = box_distance_mm({0, 0, 0}, {2, 2, 2}, p);
    const double b = box_distance_mm({2, 2, 0}, {4, 4, 2}, p);
    ASSERT_NEAR(touching.distance_mm(p), std::min(a, b), 1e-9);
    ASSERT_NEAR(unjoined.distance_mm(p), a, 1e-9);
  }
}

TEST(DesignPart, ProbeSaysTheSame) {
  const DesignPart part = quiet_part(test::sphere_mesh(10, 60));
  DesignProbe probe(part), near(part);
  std::mt19937 random(9);
  for (int n = 0; n < 3000; ++n) {
    const Vec3 p = random_point(random, 14);
    const double is = part.distance_mm(p);
    ASSERT_NEAR(probe.distance_mm(p, 100), is, 1e-12);
    ASSERT_NEAR(near.distance_mm(p, 0.5), std::clamp(is, -0.5, 0.5), 1e-12);
  }
}

TEST(DesignPart, FilesThatAreNone) {
  const TemporaryFolder temporary;
  const std::string folder = temporary.path() + "/";
  const auto said = [&](const std::string& name) {
    Diagnostics diagnostics;
    EXPECT_EQ(read_design(folder + name, 1, diagnostics), nullptr);
    EXPECT_EQ(diagnostics.size(), 1u);
    return diagnostics.empty() ? std::string() : diagnostics[0].message;
  };
  EXPECT_EQ(said("missing_design.stl"),
            "--compare: cannot read " + folder + "missing_design.stl: No such file or directory");
  std::ofstream(folder + "empty_design.stl") << "";
  EXPECT_EQ(said("empty_design.stl"), "--compare: " + folder + "empty_design.stl: is empty");
  std::ofstream(folder + "no_triangle.stl") << "solid none\nendsolid none\n";
  EXPECT_EQ(said("no_triangle.stl"), "--compare: " + folder + "no_triangle.stl: has no triangles");
  ASSERT_TRUE(write_stl(folder + "whole_design.stl", box_mesh({0, 0, 0}, {1, 1, 1})));
  Diagnostics diagnostics;
  const auto part = read_design(folder + "whole_design.stl", 1, diagnostics);
  ASSERT_NE(part, nullptr);
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_EQ(part->mesh.triangles.size(), 12u);
}

}  // namespace
}  // namespace kerf
