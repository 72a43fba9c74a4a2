// The surface that `kerf run --png` draws: closed, fine enough for its pixels, walls where the
// cutter left them.
#include "twin/scene/part_patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "tests/stock/stock_samples.h"

namespace kerf {
namespace {

constexpr double kCell_mm = 0.1;
constexpr double kFloor_mm = 2;
/// Root of the mean square distance that a wall's corners may have, in cells. Those of the cells
/// themselves are off by 0.37.
constexpr double kWallOff_cells = 0.15;

std::unique_ptr<ZMap> blank() { return test::make_map("box:0,0,0:20,20,5", kCell_mm); }

void mill(StockModel& stock, const char* tool, const Vec3& from_mm, const Vec3& to_mm) {
  const CutMove move = test::line(from_mm, to_mm);
  std::vector<CutReport> reports;
  stock.cut(*parse_shape(tool), std::span(&move, 1), reports);
  stock.finish(reports);
}

struct Walls {
  std::size_t corners = 0;
  double off_cells = 0;     ///< root of the mean square
  double facing_worst = 1;  ///< cosine between a wall's normal and the true one
};

/// Corners of walls inside the blank, against `off_mm(x, y)` and `out(x, y)`: distance from the
/// true wall, and the way it faces.
template <class Off, class Out>
Walls walls_of(const PartPatches& part, double pixel_mm, const Off& off_mm, const Out& out) {
  Walls walls;
  double sum = 0;
  for (std::size_t n = 0; n < part.count; ++n) {
    const MeshPatch patch = part.make(n, pixel_mm);
    const std::span surface = patch.surface_indices();
    for (const std::uint32_t index : std::set<std::uint32_t>(surface.begin(), surface.end())) {
      const Vec3 at(patch.vertices[index].position_mm);
      const glm::vec3 normal = unpack_normal(patch.vertices[index].normal);
      const bool on_side = std::min(at.x, at.y) < 0.5 || std::max(at.x, at.y) > 19.5;
      if (on_side || std::abs(normal.z) > 0.01f) continue;
      ++walls.corners;
      sum += std::pow(off_mm(at.x, at.y) / kCell_mm, 2);
      const glm::dvec2 facing(normal.x, normal.y);
      walls.facing_worst = std::min(walls.facing_worst, glm::dot(facing, out(at.x, at.y)));
    }
  }
  walls.off_cells = std::sqrt(sum / static_cast<double>(walls.corners));
  return walls;
}

TEST(PartPatches, ARoundPocketIsRound) {
  const std::unique_ptr<ZMap> stock = blank();
  const Vec3 middle(10.023, 9.841, kFloor_mm);
  for (const double diameter_mm : {2.0, 8.0, 12.0}) {
    mill(*stock, ("flat:" + std::to_string(diameter_mm)).c_str(), middle + Vec3(0, 0, 9), middle);
    const glm::dvec2 center(middle);
    const auto off_mm = [&](double x, double y) {
      return glm::length(glm::dvec2(x, y) - center) - 0.5 * diameter_mm;
    };
    const auto out = [&](double x, double y) { return glm::normalize(center - glm::dvec2(x, y)); };
    const Walls walls = walls_of(part_patches(*stock), kCell_mm, off_mm, out);
    EXPECT_GT(walls.corners, static_cast<std::size_t>(2 * 3 * diameter_mm / kCell_mm));
    EXPECT_LT(walls.off_cells, kWallOff_cells) << diameter_mm;
    EXPECT_GT(walls.facing_worst, std::cos(0.15)) << diameter_mm;
  }
}

TEST(PartPatches, AnObliqueWallIsStraight) {
  const std::unique_ptr<ZMap> stock = blank();
  // From beyond one side of the blank to beyond the other: two walls and no round end.
  const Vec3 from(-20, 3.1, kFloor_mm), to(40, 18.4, kFloor_mm);
  mill(*stock, "flat:4", from, to);
  const glm::dvec2 along = glm::normalize(glm::dvec2(to - from)), across(-along.y, along.x);
  const auto side = [&](double x, double y) {
    return glm::dot(glm::dvec2(x, y) - glm::dvec2(from), across);
  };
  const auto off_mm = [&](double x, double y) { return std::abs(side(x, y)) - 2; };
  const auto out = [&](double x, double y) { return side(x, y) > 0 ? -across : across; };
  const Walls walls = walls_of(part_patches(*stock), kCell_mm, off_mm, out);
  EXPECT_GT(walls.corners, 2U * 2U * 190U);
  EXPECT_LT(walls.off_cells, kWallOff_cells);
  EXPECT_GT(walls.facing_worst, std::cos(0.15));
}

/// Edges of triangles that are not as often run through one way as the other.
std::size_t open_edges(const PartPatches& part, double pixel_mm) {
  using Edge = std::array<float, 6>;
  std::map<Edge, int> balance;
  for (std::size_t n = 0; n < part.count; ++n) {
    const MeshPatch patch = part.make(n, pixel_mm);
    const std::span indices = patch.surface_indices();
    for (std::size_t k = 0; k < indices.size(); ++k) {
      const glm::vec3 a = patch.vertices[indices[k]].position_mm;
      const glm::vec3 b = patch.vertices[indices[k % 3 == 2 ? k - 2 : k + 1]].position_mm;
      const Edge there{a.x, a.y, a.z, b.x, b.y, b.z}, back{b.x, b.y, b.z, a.x, a.y, a.z};
      balance[std::min(there, back)] += there < back ? 1 : -1;
    }
  }
  const auto is_open = [](const auto& edge) { return edge.second != 0; };
  return static_cast<std::size_t>(std::count_if(balance.begin(), balance.end(), is_open));
}

TEST(PartPatches, AreClosedAtEveryLevelAndCoarserForLargerPixels) {
  const std::unique_ptr<ZMap> stock = blank();
  mill(*stock, "ball:6", {3, 4, 3}, {16, 15, 4});
  mill(*stock, "flat:3", {4, 16, 2}, {17, 3, 2});
  const PartPatches part = part_patches(*stock);
  EXPECT_EQ(part.bounds_mm, stock->bounds_mm());
  std::size_t last = 0;
  for (const double pixel_mm : {0.0, 0.2, 0.4, 0.8}) {
    EXPECT_EQ(open_edges(part, pixel_mm), 0U) << pixel_mm;
    std::size_t triangles = 0;
    for (std::size_t n = 0; n < part.count; ++n)
      triangles += part.make(n, pixel_mm).surface_indices().size() / 3;
    if (pixel_mm > 0) {
      EXPECT_LT(triangles, last) << pixel_mm;
    }
    last = triangles;
  }
}

TEST(PartPatches, LevelsFollowThePixels) {
  // 1.6 cells a pixel are joined by twos; each level has room for twice as many.
  EXPECT_EQ(patch_level(0.159, 0.1), 0);
  EXPECT_EQ(patch_level(0.161, 0.1), 1);
  EXPECT_EQ(patch_level(0.319, 0.1), 1);
  EXPECT_EQ(patch_level(0.321, 0.1), 2);
  EXPECT_EQ(patch_level(100, 0.1), StockModel::kPatchLevels - 1);
  EXPECT_EQ(patch_level(-1, 0.1), 0);
}

}  // namespace
}  // namespace kerf
