#include "stock/octree/dual_contour_patch.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "tests/stock/octree/dual_contour/bodies.h"
#include "tests/stock/octree/dual_contour/mesh_checks.h"
#include "tests/stock/octree/dual_contour/sampled_field.h"

namespace kerf {
namespace {

constexpr int kTileCells = 16;
constexpr int kLevels = 5;

using Place = std::array<float, 3>;
Place place(const MeshPatch& patch, std::uint32_t vertex) {
  const glm::vec3& at = patch.vertices[vertex].position_mm;
  return {at.x, at.y, at.z};
}

/// How often each edge is passed in one direction more than in the other.
class EdgeBalance {
 public:
  void add(const MeshPatch& patch) {
    for (std::size_t n = 0; n < patch.indices.size(); n += 3) {
      for (std::size_t side = 0; side < 3; ++side) {
        const Place from = place(patch, patch.indices[n + side]);
        const Place to = place(patch, patch.indices[n + (side + 1) % 3]);
        ++count_[{from, to}];
        --count_[{to, from}];
      }
    }
  }
  /// Ends of edges that are left open.
  std::set<Place> open() const {
    std::set<Place> out;
    for (const auto& [edge, count] : count_) {
      if (count == 0) continue;
      out.insert(edge.first);
      out.insert(edge.second);
    }
    return out;
  }

 private:
  std::map<std::pair<Place, Place>, int> count_;
};

Body part() {
  Body body = box_body({0.05, 0.02, -0.03}, {4.1, 3.3, 2.2}, turned({1, 2, 3}, 0.2));
  body = without(body, box_body({0, 0, 2}, {6, 0.8, 1}, turned({0.1, 0, 1}, 0.5)), 11);
  return without(body, capsule_body({-3, 2, 2.5}, {5, 2.2, 2.1}, 0.9), 12);
}
const SampledField& field() {
  static const SampledField sampled = SampledField::of(part(), {Vec3(-5.013), Vec3(5.2)}, 0.125);
  return sampled;
}
MeshPatch patch_of(const SampledField& sampled, const std::array<int, 3>& tile, int level,
                   bool keeps_cut_ids = false) {
  DualContour contour;
  const DualTiles tiles{kTileCells, {}};
  return make_dual_patch(sampled.field(), tiles.box(tile), level, keeps_cut_ids, &contour);
}

TEST(DualContourPatch, LevelZeroIsTheMesh) {
  double volume = 0.0;
  std::size_t triangles = 0;
  EdgeBalance balance;
  for (const auto& tile : field().tiles(kTileCells)) {
    const MeshPatch patch = patch_of(field(), tile, 0);
    balance.add(patch);
    triangles += patch.indices.size() / 3;
    EXPECT_EQ(patch.skirt_begin, patch.indices.size());
    EXPECT_TRUE(patch.cut_by.empty());
    for (std::size_t n = 0; n < patch.indices.size(); n += 3) {
      const auto at = [&](std::size_t c) {
        return Vec3(patch.vertices[patch.indices[n + c]].position_mm);
      };
      volume += glm::dot(at(0), glm::cross(at(1), at(2))) / 6.0;
    }
  }
  const TriangleMesh mesh = field().mesh(64);
  EXPECT_TRUE(balance.open().empty());
  EXPECT_EQ(triangles, mesh.triangles.size());
  EXPECT_NEAR(volume, mesh_volume(mesh), 1e-4);
}

TEST(DualContourPatch, PatchesOfAnyLevelsMeetWithoutCracks) {
  std::minstd_rand random(4);
  for (int trial = 0; trial < 8; ++trial) {
    EdgeBalance balance;
    for (const auto& tile : field().tiles(kTileCells)) {
      const int level = trial < kLevels ? trial : int(random() % kLevels);
      balance.add(patch_of(field(), tile, level));
    }
    EXPECT_TRUE(balance.open().empty()) << "trial " << trial;
  }
}

TEST(DualContourPatch, RandomFieldsMeetWithoutCracks) {
  std::minstd_rand random(77);
  for (int trial = 0; trial < 12; ++trial) {
    const SampledField sampled =
        SampledField::random(&random, {22, 20, 19}, 0.1 + 0.8 * trial / 11.0);
    EdgeBalance balance;
    for (const auto& tile : sampled.tiles(kTileCells))
      balance.add(patch_of(sampled, tile, int(random() % kLevels)));
    EXPECT_TRUE(balance.open().empty()) << "trial " << trial;
  }
}

TEST(DualContourPatch, BorderIsTheSameAtEachLevel) {
  for (const auto& tile : field().tiles(kTileCells)) {
    EdgeBalance full;
    full.add(patch_of(field(), tile, 0));
    for (int level = 1; level < kLevels; ++level) {
      EdgeBalance coarse;
      coarse.add(patch_of(field(), tile, level));
      EXPECT_EQ(coarse.open(), full.open()) << "level " << level;
    }
  }
}

TEST(DualContourPatch, HigherLevelsHaveFewerTrianglesNearTheSurface) {
  const Body ball = sphere_body({0.02, 0.03, -0.01}, 3.6);
  const SampledField sampled = SampledField::of(ball, {Vec3(-4), Vec3(4)}, 0.0625);
  const std::array<int, 3> tile{3, 3, 7};  // on top
  const double cell_mm = 0.0625;
  std::size_t before = 1'000'000;
  for (int level = 0; level < 4; ++level) {
    const MeshPatch patch = patch_of(sampled, tile, level);
    EXPECT_LT(patch.indices.size(), before) << level;
    EXPECT_GT(patch.indices.size(), 30u) << level;
    before = patch.indices.size();
    const double group_mm = cell_mm * (1 << level);
    for (const MeshVertex& vertex : patch.vertices) {
      const Vec3 at(vertex.position_mm);
      EXPECT_LT(std::abs(ball.distance(at)), 0.5 * group_mm * group_mm / 3.6);
      EXPECT_GT(glm::dot(ball.normal(at), Vec3(unpack_normal(vertex.normal))), 0.995);
    }
  }
}

TEST(DualContourPatch, EdgesAreSharp) {
  const SampledField sampled =
      SampledField::of(box_body(Vec3(0.01), Vec3(0.8)), {Vec3(-1), Vec3(1)}, 0.125);
  for (int level = 0; level < 2; ++level) {
    const MeshPatch patch = patch_of(sampled, {0, 0, 0}, level);
    std::map<Place, int> vertices_at;
    for (std::uint32_t n = 0; n < patch.vertices.size(); ++n) {
      ++vertices_at[place(patch, n)];
      // Each normal is that of a face, and the vertex is on that face.
      const glm::vec3 normal = unpack_normal(patch.vertices[n].normal);
      const glm::vec3 most = glm::abs(normal);
      const int axis = most.x > 0.9f ? 0 : most.y > 0.9f ? 1 : 2;
      EXPECT_GT(most[axis], 0.999f);
      const glm::vec3 at = patch.vertices[n].position_mm - glm::vec3(0.01f);
      EXPECT_NEAR(at[axis], 0.8f * normal[axis], 1e-3f);
    }
    std::array<int, 4> places{};
    for (const auto& [at, count] : vertices_at) ++places.at(std::size_t(count));
    EXPECT_EQ(places[3], 8) << level;
    EXPECT_EQ(places[2], level == 0 ? 12 * 12 : places[2]);
    EXPECT_GT(places[2], 12 * 4);
  }
}

TEST(DualContourPatch, TellsWhichMoveCutWhere) {
  const Body body = part();
  std::set<std::uint32_t> seen;
  for (const auto& tile : field().tiles(kTileCells)) {
    const MeshPatch patch = patch_of(field(), tile, 0, true);
    ASSERT_EQ(patch.cut_by.size(), patch.vertices.size());
    for (std::size_t n = 0; n < patch.vertices.size(); ++n) {
      seen.insert(patch.cut_by[n]);
      // A little towards the middle of the face that the normal belongs to there is no other.
      const Vec3 at(patch.vertices[n].position_mm);
      bool is_alone = true;
      for (int way = 0; way < 27; ++way) {
        const Vec3 near = at + 0.13 * Vec3(way % 3 - 1, way / 3 % 3 - 1, way / 9 - 1);
        is_alone = is_alone && body.cut_by(near) == body.cut_by(at);
      }
      EXPECT_TRUE(!is_alone || patch.cut_by[n] == body.cut_by(at));
    }
    EXPECT_EQ(patch_of(field(), tile, 2, true).cut_by.size(),
              patch_of(field(), tile, 2, true).vertices.size());
  }
  EXPECT_EQ(seen, (std::set<std::uint32_t>{11, 12, MeshPatch::kNotCut}));
}

}  // namespace
}  // namespace kerf
