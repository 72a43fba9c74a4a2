// The extruded sheet is closed and has the sheet's volume.
#include <glm/geometric.hpp>
#include <map>
#include <tuple>

#include "stock/sheet/triangulate.h"
#include "tests/stock/sheet/sheet_samples.h"

namespace kerf {
namespace {

double volume_of(const std::vector<glm::vec3>& p,
                 const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  double six = 0;
  for (const auto& t : triangles) {
    const glm::dvec3 a(p[t[0]]), b(p[t[1]]), c(p[t[2]]);
    six += glm::dot(a, glm::cross(b, c));
  }
  return six / 6;
}

/// How many edges lack the same edge the other way round.
template <class Key>
std::size_t open_edges(const std::vector<std::array<Key, 3>>& triangles) {
  std::map<std::pair<Key, Key>, int> balance;
  for (const auto& t : triangles) {
    for (int i = 0; i < 3; ++i) {
      const Key &a = t[static_cast<std::size_t>(i)], &b = t[static_cast<std::size_t>((i + 1) % 3)];
      if (a == b) continue;
      ++balance[{a, b}];
      --balance[{b, a}];
    }
  }
  return static_cast<std::size_t>(
      std::count_if(balance.begin(), balance.end(), [](const auto& e) { return e.second != 0; }));
}

TEST(SheetMesh, closed_and_of_equal_volume) {
  std::mt19937 random(40);
  for (const int tiles : {1, 3, 8}) {
    for (int round = 0; round < 4; ++round) {
      const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), tiles);
      test::cut(*sheet, 1.2, test::random_moves(random, 25));
      const TriangleMesh mesh = sheet->mesh(0);
      EXPECT_EQ(open_edges(mesh.triangles), 0u) << tiles << ' ' << round;
      EXPECT_NEAR(volume_of(mesh.positions_mm, mesh.triangles), sheet->remaining_mm3(), 0.05)
          << tiles << ' ' << round;
    }
  }
}

TEST(SheetMesh, patches_together_are_the_mesh) {
  std::mt19937 random(41);
  const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), 6);
  test::cut(*sheet, 1.2, test::random_moves(random, 25));
  using Key = std::tuple<float, float, float>;
  std::vector<std::array<Key, 3>> triangles;
  std::vector<glm::vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> indices;
  for (std::uint32_t t = 0; t < sheet->tile_count(); ++t) {
    const MeshPatch patch = sheet->patch(t, 0);
    EXPECT_EQ(patch.tile, t);
    EXPECT_EQ(patch.version, sheet->patch_version(t));
    EXPECT_EQ(patch.skirt_begin, patch.indices.size());
    const Box box = sheet->tile_box(t);
    const auto first = static_cast<std::uint32_t>(positions.size());
    for (const MeshVertex& v : patch.vertices) {
      EXPECT_GE(v.position_mm.x, box.min.x - 1e-4);
      EXPECT_LE(v.position_mm.y, box.max.y + 1e-4);
      positions.push_back(v.position_mm);
    }
    for (std::size_t i = 0; i < patch.indices.size(); i += 3) {
      indices.push_back(
          {first + patch.indices[i], first + patch.indices[i + 1], first + patch.indices[i + 2]});
      // Normals look the way that the corners turn.
      const glm::vec3 &a = positions[indices.back()[0]], &b = positions[indices.back()[1]],
                      &c = positions[indices.back()[2]];
      const glm::vec3 face = glm::cross(b - a, c - a);
      if (glm::length(face) > 1e-3f) {
        const glm::vec3 normal = unpack_normal(patch.vertices[patch.indices[i]].normal);
        EXPECT_GT(glm::dot(glm::normalize(face), normal), 0.8f);
      }
    }
  }
  for (const auto& t : indices) {
    std::array<Key, 3> keys;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::vec3& p = positions[t[i]];
      keys[i] = {p.x, p.y, p.z};
    }
    triangles.push_back(keys);
  }
  EXPECT_EQ(open_edges(triangles), 0u);
  EXPECT_NEAR(volume_of(positions, indices), sheet->remaining_mm3(), 0.05);
}

TEST(SheetMesh, triangles_of_touching_rings) {
  using sheet::Ring;
  const Ring square{{0, 0}, {100, 0}, {100, 50}, {100, 100}, {0, 100}};
  const auto area_of = [](std::vector<Ring> rings) {
    std::vector<const Ring*> pointers;
    Ring all;
    for (const Ring& ring : rings) {
      pointers.push_back(&ring);
      all.insert(all.end(), ring.begin(), ring.end());
    }
    const std::vector<sheet::Triangle> triangles = sheet::triangulate(pointers);
    std::int64_t twice = 0;
    for (const sheet::Triangle& t : triangles) {
      const std::int64_t turned = sheet::turn(all[t[0]], all[t[1]], all[t[2]]);
      EXPECT_GE(turned, 0);
      twice += turned;
    }
    return twice;
  };
  EXPECT_EQ(area_of({square}), 20000);
  // A hole in the middle; one that touches a corner of the outer ring; two that touch each other.
  EXPECT_EQ(area_of({square, {{40, 40}, {40, 60}, {60, 60}, {60, 40}}}), 20000 - 800);
  EXPECT_EQ(area_of({square, {{80, 40}, {80, 60}, {100, 50}}}), 20000 - 400);
  EXPECT_EQ(area_of({square, {{20, 40}, {20, 60}, {40, 50}}, {{40, 50}, {60, 60}, {60, 40}}}),
            20000 - 800);
  EXPECT_EQ(area_of({square, {{0, 0}, {20, 40}, {40, 20}}}), 20000 - 1200);
}

}  // namespace
}  // namespace kerf
