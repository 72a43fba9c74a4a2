// Surfaces and sections of parts with threads.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/stock/turning/edge_count.h"
#include "tests/stock/turning/turning_oracle.h"

namespace kerf {
namespace {

using namespace turning_test;

/// An outer thread that begins in air and runs out, a bore with a thread of another hand.
TurnedPart threaded(double lead = 1.5) {
  TurnedPart part = *TurnedPart::create(tube_profile(-64, 0, 40, 20));
  const TurningTool tool(*thread_insert({radians(60), 0.1, 3, 6}));
  const TurningTool inner(*thread_insert({radians(60), 0.1, 3, 8}));
  part.cut(TurningTool(right_hand(0)), line({0.5, 18}, {-2, 20.5}));
  part.cut(tool, {{4, 19.1}, {-20, 19.1}, std::nullopt, 1, lead});
  part.cut(tool, {{-20, 19.1}, {-22, 20.2}, std::nullopt, 2, 1.1 * lead});
  part.cut(tool, line({-22, 20.2}, {-22, 30}));
  part.cut(inner, {{5, 10.9}, {-40, 10.9}, std::nullopt, 3, -2});
  part.cut(inner, line({-40, 10.9}, {-40, 5}));
  return part;
}

TEST(ThreadMesh, a_mesh_is_closed_and_has_the_volume) {
  for (const double lead : {1.5, 6.0}) {
    const TurnedPart part = threaded(lead);
    double most = 1;
    for (const double tolerance : {0.05, 0.01, 0.0}) {
      const EdgeCount edges = count(part.mesh(tolerance));
      EXPECT_EQ(edges.unpaired(), 0) << tolerance;
      const double off = std::abs(edges.volume_mm3() / part.remaining_mm3() - 1);
      EXPECT_LT(off, tolerance > 0 ? tolerance / 20 : 1e-4) << tolerance;
      EXPECT_LT(off, most);
      most = off;
    }
  }
}

TEST(ThreadMesh, vertices_lie_on_the_section_at_their_angle) {
  const TurnedPart part = threaded();
  const TriangleMesh mesh = part.mesh(0.02);
  std::size_t grooved = 0;
  for (std::size_t i = 0; i < mesh.positions_mm.size(); i += 37) {
    const glm::vec3& p = mesh.positions_mm[i];
    const double angle = std::atan2(double{p.y}, double{p.x});
    const Vec2 at(p.z, std::hypot(p.x, p.y));
    double least = 1e300;
    for (const std::vector<Vec2>& ring : part.section(angle)) {
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const Vec2 from = ring[k == 0 ? ring.size() - 1 : k - 1];
        least = std::min(least, distance_to_edge(from, {ring[k], std::nullopt, {}}, at));
      }
    }
    EXPECT_LT(least, 2e-5) << i;
    grooved += at.y > 19.05 && at.y < 19.15;
  }
  EXPECT_GT(grooved, 20u);
}

/// At each angle the tips of the groove lie where M3 and a way toward -z have them: a right-hand
/// helix, z rises with the angle.
TEST(ThreadMesh, sections_turn_with_the_lead) {
  const TurnedPart part = threaded();
  for (const double turns : {0.1, 0.35, 0.6, 0.85}) {
    std::vector<double> tips;
    for (const std::vector<Vec2>& ring : part.section(2 * kPi * turns)) {
      for (const Vec2& p : ring) {
        if (p.y > 19.099 && p.y < 19.101 && p.x > -19 && p.x < -1) tips.push_back(p.x);
      }
    }
    ASSERT_GT(tips.size(), 20u);
    for (const double z : tips) {
      // Corners of the flat, 0.05 to either side of the tip.
      const double s = 4 - z, tip = (s + 1.5 * turns) / 1.5;
      EXPECT_NEAR(std::abs(tip - std::round(tip)) * 1.5, 0.05, 1e-4) << turns << " " << z;
    }
  }
}

TEST(ThreadMesh, patches_fit_together) {
  const TurnedPart part = threaded();
  for (const std::vector<int>& levels :
       {std::vector{0}, std::vector{2}, std::vector{4}, std::vector{0, 4, 2, 1}}) {
    EdgeCount edges;
    std::size_t turned = 0, all = 0;
    for (std::size_t band = 0; band < TurnedPart::kBands; ++band) {
      const MeshPatch patch = part.patch(band, levels[band % levels.size()]);
      EXPECT_EQ(patch.version, part.band_version(band));
      for (std::size_t i = 0; i < patch.indices.size(); i += 3) {
        const MeshVertex &a = patch.vertices[patch.indices[i]],
                         &b = patch.vertices[patch.indices[i + 1]],
                         &c = patch.vertices[patch.indices[i + 2]];
        edges.add(a.position_mm, b.position_mm, c.position_mm);
        const glm::vec3 face =
            glm::cross(b.position_mm - a.position_mm, c.position_mm - a.position_mm);
        if (glm::length(face) < 1e-3f) continue;
        all += 3;
        for (const MeshVertex* v : {&a, &b, &c})
          turned += glm::dot(glm::normalize(face), unpack_normal(v->normal)) < 0.8f;
      }
    }
    EXPECT_EQ(edges.unpaired(), 0) << levels[0];
    EXPECT_NEAR(edges.volume_mm3() / part.remaining_mm3(), 1 - 1.0 / 2190,
                levels[0] == 4 ? 0.02 : 2e-3);
    // Where a groove begins or ends a step of the angle is a step of the surface.
    EXPECT_LT(static_cast<double>(turned), 0.01 * static_cast<double>(all)) << levels[0];
  }
}

TEST(ThreadMesh, a_taper_thread_has_patches_that_fit) {
  TurnedPart part = *TurnedPart::create({{{-30, 0}, {0, 0}, {0, 10}, {-30, 10.9375}}});
  const TurningTool tool(*thread_insert({radians(60), 0.1, 3, 6}));
  part.cut(tool, {{5, 9.1}, {-19, 9.85}, std::nullopt, 1, 1.814});
  part.cut(tool, line({-19, 9.85}, {-19, 14}));
  EdgeCount edges;
  for (std::size_t band = 0; band < TurnedPart::kBands; ++band) {
    const MeshPatch patch = part.patch(band, 1);
    for (std::size_t i = 0; i < patch.indices.size(); i += 3) {
      edges.add(patch.vertices[patch.indices[i]].position_mm,
                patch.vertices[patch.indices[i + 1]].position_mm,
                patch.vertices[patch.indices[i + 2]].position_mm);
    }
  }
  EXPECT_EQ(edges.unpaired(), 0);
  EXPECT_EQ(count(part.mesh(0.02)).unpaired(), 0);
}

/// A coil: the groove goes through the wall, so sections are in pieces.
TEST(ThreadMesh, what_is_cut_through_is_shown_closed) {
  TurnedPart part = *TurnedPart::create(tube_profile(-20, 0, 20, 18));
  const TurningTool blade(*groove_insert({1, 0, 5, 8}));
  part.cut(blade, {{-2, 8.5}, {-15, 8.5}, std::nullopt, 1, 3});
  EXPECT_NEAR(part.remaining_mm3(), cylinder_mm3(20, 20) - cylinder_mm3(18, 20), 60);
  EXPECT_LT(part.remaining_mm3(), cylinder_mm3(20, 20) - cylinder_mm3(18, 20));
  EXPECT_EQ(count(part.mesh(0.02)).unpaired(), 0);
}

}  // namespace
}  // namespace kerf
