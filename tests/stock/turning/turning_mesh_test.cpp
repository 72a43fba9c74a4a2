// Surfaces of turned parts: closed, the right way round, as exact as they say.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "stock/turning/revolve.h"
#include "tests/stock/turning/edge_count.h"
#include "tests/stock/turning/turning_oracle.h"

namespace kerf {
namespace {

using namespace turning_test;

/// A bore, a groove, a taper, a ball and a face.
TurnedPart sample() {
  TurnedPart part = *TurnedPart::create(bar_profile(-64, 0, 40));
  const TurningTool tool(*nose_insert({0.4, 2, radians(85), radians(5), 12}));
  cut_along(part, tool,
            {{-1, 25}, {-1, -0.4}, {1, -0.4}, {1, 10}, {-10, 16}, {-30, 16}, {-30, 22}});
  part.cut(TurningTool(round_insert(2)), line({-40, 25}, {-40, 19}));
  part.cut(TurningTool(*groove_insert({3, 0.2, 20, 2})), line({-25, 22}, {-25, 12}));
  const Cutter drill = *Cutter::from_profile("drill", {{ProfilePiece::Kind::kLine, 0, 0, 4, 2.4},
                                                       {ProfilePiece::Kind::kLine, 4, 2.4, 4, 50}});
  part.cut(TurningTool(*axial_outline(drill, 80)), line({5, 0}, {-20, 0}));
  return part;
}

TEST(TurningMesh, a_mesh_is_closed_and_has_the_volume) {
  const TurnedPart part = sample();
  for (const double tolerance : {0.0, 0.005, 0.05}) {
    const TriangleMesh mesh = part.mesh(tolerance);
    const EdgeCount edges = count(mesh);
    EXPECT_EQ(edges.unpaired(), 0) << tolerance;
    EXPECT_NEAR(edges.volume_mm3() / part.remaining_mm3(), 1, tolerance == 0 ? 1e-4 : tolerance / 5)
        << tolerance;
    for (const glm::vec3& p : mesh.positions_mm) EXPECT_LE(std::hypot(p.x, p.y), 20 + 1e-5);
  }
  EXPECT_LT(part.mesh(0.05).triangles.size(), part.mesh(0.005).triangles.size());
}

TEST(TurningMesh, random_parts_have_closed_meshes) {
  for (unsigned seed = 0; seed < 15; ++seed) {
    std::mt19937 random(seed);
    TurnedPart part = *TurnedPart::create(bar_profile(-30, 0, 40));
    for (const TurnMove& move : random_moves(random, 10))
      part.cut(TurningTool(random_tool(random)), move);
    const EdgeCount edges = count(part.mesh(0.01));
    EXPECT_EQ(edges.unpaired(), 0) << seed;
    EXPECT_NEAR(edges.volume_mm3(), part.remaining_mm3(), 0.005 * part.remaining_mm3() + 1) << seed;
  }
}

EdgeCount count_patches(const TurnedPart& part, const std::vector<int>& levels) {
  EdgeCount edges;
  for (std::size_t band = 0; band < TurnedPart::kBands; ++band) {
    const MeshPatch patch = part.patch(band, levels[band % levels.size()]);
    EXPECT_EQ(patch.tile, band);
    EXPECT_EQ(patch.version, part.band_version(band));
    EXPECT_EQ(patch.skirt_begin, patch.indices.size());
    const auto low = static_cast<float>(part.band_low_z_mm(band)),
               high = static_cast<float>(part.band_low_z_mm(band + 1));
    for (const MeshVertex& v : patch.vertices) {
      EXPECT_GE(v.position_mm.z, low);
      EXPECT_LE(v.position_mm.z, high);
    }
    for (std::size_t i = 0; i < patch.indices.size(); i += 3) {
      const MeshVertex &a = patch.vertices[patch.indices[i]],
                       &b = patch.vertices[patch.indices[i + 1]],
                       &c = patch.vertices[patch.indices[i + 2]];
      edges.add(a.position_mm, b.position_mm, c.position_mm);
      // Normals point out of the material, as the triangle does.
      const glm::vec3 face =
          glm::cross(b.position_mm - a.position_mm, c.position_mm - a.position_mm);
      if (glm::length(face) > 1e-4f) {
        for (const MeshVertex* v : {&a, &b, &c})
          EXPECT_GT(glm::dot(glm::normalize(face), unpack_normal(v->normal)), 0.8f);
      }
    }
  }
  return edges;
}

TEST(TurningMesh, patches_of_any_levels_fit_together) {
  const TurnedPart part = sample();
  std::size_t before = 0;
  for (const std::vector<int>& levels :
       {std::vector{0}, std::vector{2}, std::vector{4}, std::vector{0, 4, 2, 1}}) {
    const EdgeCount edges = count_patches(part, levels);
    EXPECT_EQ(edges.unpaired(), 0) << levels[0];
    // A polygon of 120 sides has 1 / 2190 less than its circle.
    EXPECT_NEAR(edges.volume_mm3() / part.remaining_mm3(), 1 - 1.0 / 2190,
                levels[0] == 4 ? 0.02 : 2e-3);
  }
  for (int level = 0; level < 5; ++level) {
    std::size_t triangles = 0;
    for (std::size_t band = 0; band < TurnedPart::kBands; ++band)
      triangles += part.patch(band, level).indices.size() / 3;
    EXPECT_TRUE(level == 0 || triangles <= before) << level;
    before = triangles;
  }
}

/// The farthest that a patch's triangles are from the contour that they show.
double farthest_mm(const std::vector<std::vector<Vec2>>& profile, const MeshPatch& patch) {
  double farthest = 0;
  const auto off = [&](const glm::vec3& p) {
    const Vec2 at(p.z, std::hypot(p.x, p.y));
    double nearest = 1e9;
    for (const std::vector<Vec2>& ring : profile) {
      for (std::size_t i = 0; i < ring.size(); ++i)
        nearest = std::min(nearest,
                           turning::distance_to_edge_mm(at, ring[i], ring[(i + 1) % ring.size()]));
    }
    farthest = std::max(farthest, nearest);
  };
  for (std::size_t i = 0; i < patch.indices.size(); i += 3) {
    const glm::vec3 &a = patch.vertices[patch.indices[i]].position_mm,
                    &b = patch.vertices[patch.indices[i + 1]].position_mm,
                    &c = patch.vertices[patch.indices[i + 2]].position_mm;
    for (const glm::vec3& p : {a, b, c, (a + b) / 2.0f, (b + c) / 2.0f, (c + a) / 2.0f}) off(p);
  }
  return farthest;
}

TEST(TurningMesh, patches_keep_within_three_times_their_tolerance) {
  const TurnedPart part = sample();
  const std::vector<std::vector<Vec2>> profile = part.profile();
  for (int level = 1; level < 5; ++level) {
    double farthest = 0;
    for (std::size_t band = 0; band < TurnedPart::kBands; band += 3)
      farthest = std::max(farthest, farthest_mm(profile, part.patch(band, level)));
    const double tolerance = TurnedPart::kFinestPatch_mm * std::pow(4.0, level);
    // 120 sides are all there are, 0.007 mm off at 20 mm.
    EXPECT_LT(farthest, 3 * tolerance + (level == 1 ? 0.002 : 0)) << level;
    EXPECT_GT(farthest, 0.2 * tolerance) << level;
  }
}

/// 2000 moves of 0.08 mm, each with a mark of its own, seen from where a pixel is 0.13 mm: so many
/// triangles that a window draws them 60 times a second.
TEST(TurningMesh, a_shaft_of_short_moves_is_coarse_from_afar) {
  TurnedPart part = *TurnedPart::create(bar_profile(-170, 0, 60));
  part.keep_cut_ids(true);
  const TurningTool tool(*nose_insert({0.4, 2, radians(85), radians(30), 12}));
  const auto at = [](int i) {
    return Vec2{-0.08 * i, 24 + 4 * std::sin(0.02 * i) + 0.05 * std::sin(1.7 * i)};
  };
  for (int i = 0; i < 2000; ++i) {
    TurnMove move = line(at(i), at(i + 1));
    move.id = static_cast<std::uint32_t>(i);
    part.cut(tool, move);
  }
  const auto triangles = [&](int level) {
    std::size_t all = 0;
    for (std::size_t band = 0; band < TurnedPart::kBands; ++band)
      all += part.patch(band, level).indices.size() / 3;
    return all;
  };
  EXPECT_GT(triangles(0), 450'000u);
  EXPECT_LT(triangles(2), 150'000u);
  EXPECT_EQ(count_patches(part, {2, 0, 1, 3}).unpaired(), 0);
}

TEST(TurningMesh, random_parts_have_patches_that_fit) {
  for (unsigned seed = 0; seed < 15; ++seed) {
    std::mt19937 random(seed);
    TurnedPart part = *TurnedPart::create(bar_profile(-30, 0, 40));
    for (const TurnMove& move : random_moves(random, 10))
      part.cut(TurningTool(random_tool(random)), move);
    EXPECT_EQ(count_patches(part, {0, 3}).unpaired(), 0) << seed;
  }
}

TEST(TurningMesh, chains_keep_within_the_tolerance) {
  std::vector<Vec2> chain;
  for (int i = 0; i <= 500; ++i) chain.emplace_back(0.02 * i, 3 + std::sin(0.02 * i));
  for (const double tolerance : {0.001, 0.01, 0.1}) {
    const std::vector<Vec2> fewer = turning::simplified(chain, tolerance);
    EXPECT_LT(fewer.size(), chain.size());
    EXPECT_EQ(fewer.front(), chain.front());
    EXPECT_EQ(fewer.back(), chain.back());
    double worst = 0;
    for (const Vec2& p : chain) {
      double least = 1e300;
      for (std::size_t i = 1; i < fewer.size(); ++i)
        least = std::min(least, distance_to_edge(fewer[i - 1], {fewer[i], std::nullopt, {}}, p));
      worst = std::max(worst, least);
    }
    EXPECT_LE(worst, tolerance);
    EXPECT_GT(worst, tolerance / 20);
  }
}

}  // namespace
}  // namespace kerf
