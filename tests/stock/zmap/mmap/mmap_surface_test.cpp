// What the M-map shows: patches that close and enclose the volume, and a mesh that is a manifold.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>
#include <span>

#include "tests/stock/zmap/mmap/mmap_samples.h"

namespace kerf {
namespace {

using test::line;
using test::make_mmap;
using test::removed_mm3;
using test::shape;

using Position = std::array<float, 3>;
using Edge = std::pair<Position, Position>;

Position position(const glm::vec3& p) { return {p.x, p.y, p.z}; }

struct Closedness {
  int open = 0;      ///< edges that do not meet as often in one direction as in the other
  int fourfold = 0;  ///< edges in more than two triangles
  int edges = 0;
  double volume_mm3 = 0;
};

/// By position, of triangles given as three points each.
Closedness closedness(std::span<const glm::vec3> corners) {
  std::map<Edge, std::pair<int, int>> uses;
  Closedness result;
  for (std::size_t n = 0; n < corners.size(); n += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Position a = position(corners[n + k]), b = position(corners[n + (k + 1) % 3]);
      EXPECT_NE(a, b) << "an edge without length";
      a < b ? ++uses[{a, b}].first : ++uses[{b, a}].second;
    }
    const Vec3 a(corners[n]), b(corners[n + 1]), c(corners[n + 2]);
    result.volume_mm3 += glm::dot(a, glm::cross(b, c)) / 6;
  }
  for (const auto& [edge, count] : uses) {
    ++result.edges;
    result.open += count.first != count.second;
    result.fourfold += count.first + count.second > 2;
  }
  return result;
}

std::vector<glm::vec3> corners_of_patches(const StockModel& map, int level) {
  std::vector<glm::vec3> corners;
  for (std::uint32_t tile = 0; tile < map.tile_count(); ++tile) {
    const MeshPatch patch = map.patch(tile, level);
    EXPECT_EQ(patch.cut_by.size(), map.keeps_cut_ids() ? patch.vertices.size() : 0u);
    for (const std::uint32_t index : patch.surface_indices())
      corners.push_back(patch.vertices[index].position_mm);
  }
  return corners;
}

std::unique_ptr<MMap> random_part(unsigned seed, double cell) {
  auto map = make_mmap("box:0,0,-10:24,18,0", cell);
  for (const test::Job& job : test::random_jobs(seed)) removed_mm3(*map, job.cutter, job.moves);
  return map;
}

TEST(MMapPatch, AllTilesOfALevelCloseAndEncloseTheVolume) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const auto map = random_part(seed, 0.15);
    ASSERT_TRUE(map->has_gaps());
    for (int level = 0; level < StockModel::kPatchLevels; ++level) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << " level " << level);
      const Closedness result = closedness(corners_of_patches(*map, level));
      EXPECT_GT(result.edges, 0);
      EXPECT_EQ(result.open, 0);
      EXPECT_LT(result.fourfold, 0.1 * result.edges);
      if (level > 0) continue;
      EXPECT_NEAR(result.volume_mm3, map->remaining_mm3(), 0.002 * map->remaining_mm3());
    }
  }
}

/// Each edge in exactly two triangles, by number and by place.
void expect_manifold(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  std::vector<glm::vec3> corners;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(++sides[std::pair(t[k], t[(k + 1) % 3])], 1);
      corners.push_back(mesh.positions_mm[t[k]]);
    }
  }
  for (const auto& [side, count] : sides)
    EXPECT_TRUE(sides.count({side.second, side.first})) << "an open edge";
  const Closedness places = closedness(corners);
  EXPECT_EQ(places.open, 0);
  EXPECT_EQ(places.fourfold, 0);
}

double volume_mm3(const TriangleMesh& mesh) {
  double six = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    six += glm::dot(Vec3(mesh.positions_mm[a]),
                    glm::cross(Vec3(mesh.positions_mm[b]), Vec3(mesh.positions_mm[c])));
  }
  return six / 6;
}

TEST(MMapMesh, IsAManifoldWithTheVolumeOfTheColumns) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    SCOPED_TRACE(seed);
    auto map = make_mmap("box:0,0,-10:24,18,0", 0.3);
    for (const test::Job& job : test::random_jobs(seed)) {
      removed_mm3(*map, job.cutter, job.moves);
      if (!job.cutter.undercuts()) continue;
      const TriangleMesh mesh = map->mesh(0);
      expect_manifold(mesh);
      EXPECT_NEAR(volume_mm3(mesh), map->remaining_mm3(), 0.003 * map->remaining_mm3());
    }
  }
}

TEST(MMapMesh, PiecesThatTouchAtAnEdgeHaveEdgesOfTheirOwn) {
  // Four square pillars about one corner of cells, two of them high; and a gap in one of them.
  auto map = make_mmap("box:0,0,-4:4,4,0", 1);
  for (const Vec3 at : {Vec3(0.5, 0.5, -2), Vec3(2.5, 2.5, -2), Vec3(1.5, 1.5, -2),
                        Vec3(3.5, 1.5, -4), Vec3(0.5, 2.5, -4)}) {
    removed_mm3(*map, shape("flat:0.5"), {line(at + Vec3(0, 0, 5), at)});
  }
  removed_mm3(*map, shape("tslot:2.2:1:0.5"), {line(Vec3(2.5, 7, -3), Vec3(2.5, 3.5, -3))});
  ASSERT_TRUE(map->has_gaps());
  const TriangleMesh mesh = map->mesh(0);
  expect_manifold(mesh);
  // Of four cells across, what is smooth between cells counts for much.
  EXPECT_NEAR(volume_mm3(mesh), map->remaining_mm3(), 0.05 * map->remaining_mm3());
}

TEST(MMapMesh, AnObliqueGrooveHasNoStairs) {
  auto map = make_mmap("box:0,0,-10:30,30,0", 0.25);
  const Vec3 from(-5, -2, -7), to(35, 21, -7);
  removed_mm3(*map, shape("tslot:8:2:3"), {line(from, to)});
  const TriangleMesh mesh = map->mesh(0);
  const Vec3 along = glm::normalize(to - from);
  const auto across = [&](const glm::vec3& p) {
    const Vec3 d = Vec3(p) - from;
    return std::abs(d.x * along.y - d.y * along.x);
  };
  // Walls below the lips, away from the sides of the blank.
  double worst = 0;
  int count = 0;
  for (const auto& t : mesh.triangles) {
    const std::array<glm::vec3, 3> p{mesh.positions_mm[t[0]], mesh.positions_mm[t[1]],
                                     mesh.positions_mm[t[2]]};
    const glm::vec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
    if (std::abs(normal.z) > 1e-3f * glm::length(normal)) continue;
    if (std::max({p[0].z, p[1].z, p[2].z}) > -4.9f) continue;  // of the neck
    for (const glm::vec3& q : p) {
      if (q.x < 1 || q.y < 1 || q.x > 29 || q.y > 29 || q.z < -7.1f) continue;
      worst = std::max(worst, std::abs(across(q) - 4));
      ++count;
    }
  }
  EXPECT_GT(count, 100);
  RecordProperty("worst_mm", std::to_string(worst));
  EXPECT_LT(worst, 0.15);  // stairs: up to 0.18
}

}  // namespace
}  // namespace kerf
