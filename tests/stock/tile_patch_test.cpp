// Patches of tiles against the heights that they show: how far off they are, what is smooth and
// what is a wall, and that they close.
#include "stock/zmap/tile_patch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <set>

#include "surface/tile_relief.h"
#include "tests/stock/patch_samples.h"
#include "tests/stock/stock_samples.h"

namespace kerf {
namespace {

using test::all_patches;
using test::closedness;
using test::Closedness;
using test::Edge;
using test::Level;
using test::make_grid;
using test::Position;
using test::position;
using test::rough;
using test::volume_mm3;

/// Height of the top over (x, y), straight above; the greatest of those found.
double top_at(const MeshPatch& patch, double x, double y) {
  double top = -1e9;
  const auto indices = patch.surface_indices();
  for (std::size_t n = 0; n < indices.size(); n += 3) {
    const Vec3 a(patch.vertices[indices[n]].position_mm);
    const Vec3 b(patch.vertices[indices[n + 1]].position_mm);
    const Vec3 c(patch.vertices[indices[n + 2]].position_mm);
    const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if (!(area > 1e-12)) continue;  // a wall, or seen from below
    const double u = ((b.x - x) * (c.y - y) - (c.x - x) * (b.y - y)) / area;
    const double v = ((c.x - x) * (a.y - y) - (a.x - x) * (c.y - y)) / area;
    const double w = 1 - u - v;
    if (u < -1e-9 || v < -1e-9 || w < -1e-9) continue;
    top = std::max(top, u * a.z + v * b.z + w * c.z);
  }
  return top;
}

TEST(TilePatch, AllTilesOfALevelCloseAndEncloseTheVolume) {
  const auto check = [](const TileGrid& grid, bool exact) {
    for (int level = 0; level < StockModel::kPatchLevels; ++level) {
      SCOPED_TRACE(testing::Message() << grid.nx() << " x " << grid.ny() << " level " << level);
      const std::vector<MeshPatch> patches = all_patches(grid, level);
      const Closedness result = closedness(patches);
      EXPECT_GT(result.edges, 0);
      EXPECT_EQ(result.open, 0);
      EXPECT_LT(result.fourfold, 0.1 * result.edges);
      const Level cells(grid, level);
      double volume = 0;
      for (int j = 0; j < grid.ny(); ++j)
        for (int i = 0; i < grid.nx(); ++i)
          volume += static_cast<double>(cells.at(i >> level, j >> level) - grid.floor_mm());
      volume *= grid.cell_x_mm() * grid.cell_y_mm();
      EXPECT_NEAR(volume_mm3(patches), volume, (exact ? 1e-5 : 0.02) * volume);
    }
  };
  check(make_grid(150, 130, 0.1, rough), false);
  check(make_grid(64, 64, 0.1, rough), false);
  check(make_grid(129, 65, 0.1, rough), false);
  check(make_grid(1, 1, 0.1, rough), true);
  check(make_grid(3, 200, 0.1, rough), false);
  check(make_grid(200, 140, 0.1, [](double, double) { return -1.5; }), true);
}

TEST(TilePatch, AnythingAtAllCloses) {
  std::mt19937 random(20241);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 12; ++round) {
    SCOPED_TRACE(round);
    // Cells of every kind next to each other: some steps small, some large, some equal, holes.
    const double spread = round % 3 == 0 ? 0.02 : round % 3 == 1 ? 0.6 : 8;
    const double holes = round % 4 == 0 ? 0 : 0.1 * (round % 4);
    const TileGrid grid = make_grid(70, 67, 0.1, [&](double, double) {
      if (unit(random) < holes) return std::nan("");
      const double z = unit(random) * spread;
      return -1 - (unit(random) < 0.5 ? z : std::floor(4 * z) / 4);
    });
    for (int level = 0; level < StockModel::kPatchLevels; ++level) {
      SCOPED_TRACE(level);
      const Closedness result = closedness(all_patches(grid, level));
      if (level < 2) {  // coarser, the holes take everything
        EXPECT_GT(result.edges, 0);
      }
      EXPECT_EQ(result.open, 0);
      if (holes == 0 && spread < 0.025) {
        EXPECT_EQ(result.fourfold, 0);
      }
    }
  }
}

TEST(TilePatch, StaysBetweenTheHeightsAboutACellAndNearItsCentre) {
  const TileGrid grid = make_grid(150, 130, 0.1, rough);
  for (int level = 0; level < StockModel::kPatchLevels; ++level) {
    SCOPED_TRACE(level);
    const Level cells(grid, level);
    const double edge = grid.cell_x_mm() * cells.span;
    const double bound = 1.5 * TileRelief::kSteepestSlope * edge;
    const std::vector<MeshPatch> patches = all_patches(grid, level);
    const int per_tile = kTileCells >> level;
    int checked = 0;
    double sum = 0;
    const int stride = level == 0 ? 3 : 1;
    for (int j = 0; j + 1 < cells.ny; j += stride) {
      for (int i = 0; i + 1 < cells.nx; i += stride) {
        const float z = cells.at(i, j);
        const MeshPatch& patch =
            patches[static_cast<std::size_t>(j / per_tile * grid.tiles_x() + i / per_tile)];
        const double x = grid.bounds_mm().min.x + (i + 0.5) * edge;
        const double y = grid.bounds_mm().min.y + (j + 0.5) * edge;
        const double top = top_at(patch, x, y);
        if (z <= grid.floor_mm()) {
          EXPECT_EQ(top, -1e9) << i << " " << j;
          continue;
        }
        EXPECT_NEAR(top, z, bound) << i << " " << j;
        float low = z, high = z;
        for (int v = std::max(0, j - 1); v <= std::min(cells.ny - 1, j + 1); ++v) {
          for (int u = std::max(0, i - 1); u <= std::min(cells.nx - 1, i + 1); ++u) {
            if (cells.at(u, v) <= grid.floor_mm()) continue;
            low = std::min(low, cells.at(u, v));
            high = std::max(high, cells.at(u, v));
          }
        }
        EXPECT_GE(top, low - 1e-5);
        EXPECT_LE(top, high + 1e-5);
        sum += std::abs(top - static_cast<double>(z));
        ++checked;
      }
    }
    ASSERT_GT(checked, 40);
    EXPECT_LT(sum / checked, 0.15 * edge);
  }
}

TEST(TilePatch, APlaneIsExactAndHasOneNormal) {
  for (const std::pair<double, double>& slopes :
       {std::pair{0.1, -0.05}, {0.2, 0.2}, {-1.0, 0.3}, {1.5, -2.0}}) {
    const double sx = slopes.first, sy = slopes.second;
    SCOPED_TRACE(testing::Message() << sx << " " << sy);
    const TileGrid grid = make_grid(100, 90, 0.05, [&](double x, double y) {
      return -5 + sx * (x - 2.5) * 0.5 + sy * (y - 2.25) * 0.5;
    });
    const glm::vec3 normal =
        glm::normalize(glm::vec3(static_cast<float>(-sx / 2), static_cast<float>(-sy / 2), 1));
    for (const MeshPatch& patch : all_patches(grid, 0)) {
      int tops = 0;
      for (const MeshVertex& v : test::surface_vertices(patch)) {
        const glm::vec3 n = unpack_normal(v.normal);
        if (n.z < 0.1f) continue;  // walls
        const double x = v.position_mm.x + 3, y = v.position_mm.y - 5;
        const bool rim = x < 0.051 || y < 0.051 || x > 4.949 || y > 4.449;
        if (!rim) {  // on the rim the corner is the mean of fewer cells
          EXPECT_NEAR(v.position_mm.z, -5 + sx * (x - 2.5) * 0.5 + sy * (y - 2.25) * 0.5, 2e-5);
        }
        EXPECT_GT(glm::dot(n, normal), 0.9999f);
        ++tops;
      }
      EXPECT_GT(tops, 500);
    }
  }
}

TEST(TilePatch, AStepIsAWallAndASlopeIsNot) {
  const TileGrid step = make_grid(40, 40, 0.1, [](double x, double) { return x < 2 ? -1 : -1.05; });
  const MeshPatch walled = make_tile_patch(step, 0, 0);
  int wall_vertices = 0;
  std::set<float> heights;
  for (const MeshVertex& v : walled.vertices) {
    if (v.position_mm.x < -2.5 || v.position_mm.x > 0.5) continue;
    const glm::vec3 n = unpack_normal(v.normal);
    const bool on_side = v.position_mm.y < 5.01 || v.position_mm.y > 8.99;
    if (on_side) continue;
    if (n.z > 0.5f) {
      EXPECT_GT(n.z, 0.9999f);
    }
    if (std::abs(n.z) < 0.5f) {
      EXPECT_NEAR(v.position_mm.x, -1, 1e-5);
      EXPECT_GT(n.x, 0.999f);
      ++wall_vertices;
    }
    heights.insert(v.position_mm.z);
  }
  EXPECT_GT(wall_vertices, 40);
  // Level on both sides, nothing between.
  EXPECT_EQ(heights, (std::set<float>{-10, -1.05f, -1}));

  // A ball's bowl: no walls but the sides of the blank.
  const TileGrid bowl = make_grid(60, 60, 0.1, [](double x, double y) {
    const double d2 = (x - 3) * (x - 3) + (y - 3) * (y - 3);
    return -1 - (d2 < 6.25 ? std::sqrt(9 - d2) - std::sqrt(9 - 6.25) : 0.0);
  });
  const MeshPatch smooth = make_tile_patch(bowl, 0, 0);
  for (const MeshVertex& v : smooth.vertices) {
    const glm::vec3 n = unpack_normal(v.normal);
    const double x = v.position_mm.x + 3.0, y = v.position_mm.y - 5.0;
    if (x < 0.01 || x > 5.99 || y < 0.01 || y > 5.99 || n.z < -0.5f) continue;
    EXPECT_GT(n.z, 0.4f);
    const double d = std::hypot(x - 3, y - 3);
    if (d > 2.2) continue;
    const glm::vec3 truth(glm::normalize(Vec3(3 - x, 3 - y, std::sqrt(9 - d * d))));
    EXPECT_GT(glm::dot(n, truth), 0.999f) << x << " " << y;
  }
}

TEST(TilePatch, NoTopTurnsOver) {
  std::mt19937 random(11);
  const auto check = [](const TileGrid& grid) {
    for (int level = 0; level < StockModel::kPatchLevels; ++level) {
      double solid = 0, over = 0;
      const Level cells(grid, level);
      for (int j = 0; j < grid.ny(); ++j)
        for (int i = 0; i < grid.nx(); ++i)
          solid += cells.at(i >> level, j >> level) > grid.floor_mm();
      for (const MeshPatch& patch : all_patches(grid, level)) {
        const auto indices = patch.surface_indices();
        for (std::size_t n = 0; n < indices.size(); n += 3) {
          const Vec3 a(patch.vertices[indices[n]].position_mm);
          const Vec3 b(patch.vertices[indices[n + 1]].position_mm);
          const Vec3 c(patch.vertices[indices[n + 2]].position_mm);
          const double area = 0.5 * ((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));
          const bool is_floor = std::max({a.z, b.z, c.z}) <= static_cast<double>(grid.floor_mm());
          const bool is_top = unpack_normal(patch.vertices[indices[n]].normal).z > 0.05f;
          if (is_floor) {
            EXPECT_LT(area, 0) << "level " << level << " tile " << patch.tile << " at " << a.x
                               << " " << a.y << ", " << b.x << " " << b.y << ", " << c.x << " "
                               << c.y;
          } else if (is_top) {
            EXPECT_GT(area, 0);
            over += area;
          } else {
            EXPECT_NEAR(area, 0, 1e-5);  // a wall
          }
        }
      }
      // Seen from above the tops cover each place with material once: but for what corners beside
      // holes are moved by, all of it.
      const double cell_mm2 = grid.cell_x_mm() * grid.cell_y_mm();
      EXPECT_NEAR(over, solid * cell_mm2, 0.02 * solid * cell_mm2 + 1e-3);
    }
  };
  check(make_grid(150, 130, 0.1, rough));
  check(make_grid(133, 75, 0.1, [&](double x, double y) {  // grained all over
    const bool is_low = (random() % 3 == 0) != (std::hypot(x - 6, y - 4) < 2.7);
    return is_low ? -4 - 0.02 * (random() % 4) : -1 - 0.01 * (random() % 3);
  }));
}

TEST(TilePatch, DependsOnTheTileAndItsNeighboursAlone) {
  // So that tile_patch_version() tells all.
  const auto grid_of = [](unsigned seed) {
    std::mt19937 inner(1), outer(seed);
    return make_grid(320, 320, 0.1, [&](double x, double y) {
      const bool is_near = std::min(x, y) > 6.4 && std::max(x, y) < 25.6;
      return -1.0 - static_cast<double>((is_near ? inner : outer)() % 64 == 0 ? 3 : 0) -
             (std::hypot(x - 16, y - 16) < (is_near ? 11.3 : 9 + seed) ? 2 : 0);
    });
  };
  const TileGrid one = grid_of(2), other = grid_of(3);
  for (int level = 0; level < StockModel::kPatchLevels; ++level) {
    const MeshPatch a = make_tile_patch(one, 12, level), b = make_tile_patch(other, 12, level);
    ASSERT_EQ(a.indices, b.indices) << level;
    ASSERT_EQ(a.vertices.size(), b.vertices.size()) << level;
    for (std::size_t n = 0; n < a.vertices.size(); ++n) {
      ASSERT_EQ(a.vertices[n].position_mm, b.vertices[n].position_mm) << level;
      ASSERT_EQ(a.vertices[n].normal, b.vertices[n].normal) << level;
    }
  }
}

TEST(TilePatch, ASlotOneCellWideKeepsItsBottomAtEveryLevel) {
  const TileGrid grid = make_grid(
      128, 128, 0.1, [](double x, double) { return std::abs(x - 7.15) < 0.04 ? -3 : -1; });
  for (int level = 0; level < StockModel::kPatchLevels; ++level) {
    const MeshPatch patch = make_tile_patch(grid, 1, level);
    const int cell = 71 >> level;
    const double x = -3 + (cell + 0.5) * 0.1 * (1 << level);
    EXPECT_NEAR(top_at(patch, x, 5 + 3.21), -3, 1e-5) << level;
  }
}

/// Lowest of the cells that any level joins with those beside a border of a tile: across x at cell
/// line `at`, or across y.
float lowest_about_border(const TileGrid& grid, bool across_x, int at, int first) {
  constexpr int kReach = 16;
  float lowest = std::numeric_limits<float>::infinity();
  for (int along = first - kReach; along < first + kTileCells + kReach; ++along) {
    for (int k = at - kReach; k < at + kReach; ++k) {
      const int i = across_x ? k : along, j = across_x ? along : k;
      if (i < 0 || j < 0 || i >= grid.nx() || j >= grid.ny()) continue;
      lowest = std::min(lowest, grid.height(i, j));
    }
  }
  return std::max(lowest, grid.floor_mm());
}

/// Upper edges of the skirts are edges of the top; they end on the border; and there is one
/// wherever the top is higher than the skirts' end.
TEST(TilePatch, SkirtsHangFromEveryInnerBorderAndNowhereElse) {
  const TileGrid grid = make_grid(150, 130, 0.1, rough);
  std::size_t all_least = 0, all_most = 0;
  for (int level = 0; level < StockModel::kPatchLevels; ++level) {
    for (const MeshPatch& patch : all_patches(grid, level)) {
      const int x0 = static_cast<int>(patch.tile) % grid.tiles_x() * kTileCells;
      const int y0 = static_cast<int>(patch.tile) / grid.tiles_x() * kTileCells;
      const Box box = grid.tile_box(patch.tile);
      std::set<Edge> edges;
      const auto surface = patch.surface_indices();
      for (std::size_t n = 0; n < surface.size(); ++n)
        edges.insert(
            {position(patch, surface[n]), position(patch, surface[n % 3 == 2 ? n - 2 : n + 1])});
      // Of cells that have material; of cells that with all those about them are above the end.
      std::size_t most = 0, least = 0;
      const Level cells(grid, level);
      const auto count = [&](int i, int j, float end) {
        if (cells.at(i, j) <= grid.floor_mm()) return;
        ++most;
        float lowest = cells.at(i, j);
        for (int v = std::max(0, j - 1); v <= std::min(j + 1, cells.ny - 1); ++v)
          for (int u = std::max(0, i - 1); u <= std::min(i + 1, cells.nx - 1); ++u)
            lowest = std::min(lowest, cells.at(u, v));
        least += lowest > end;
      };
      const int i0 = x0 >> level, j0 = y0 >> level, per_tile = kTileCells >> level;
      const int i1 = std::min(i0 + per_tile, cells.nx), j1 = std::min(j0 + per_tile, cells.ny);
      for (int j = j0; j < j1; ++j) {
        if (i0 > 0) count(i0, j, lowest_about_border(grid, true, x0, y0));
        if (i1 < cells.nx) count(i1 - 1, j, lowest_about_border(grid, true, x0 + kTileCells, y0));
      }
      for (int i = i0; i < i1; ++i) {
        if (j0 > 0) count(i, j0, lowest_about_border(grid, false, y0, x0));
        if (j1 < cells.ny) count(i, j1 - 1, lowest_about_border(grid, false, y0 + kTileCells, x0));
      }
      const auto skirts = patch.skirt_indices();
      ASSERT_EQ(skirts.size() % 6, 0u);
      EXPECT_GE(skirts.size() / 6, least);
      EXPECT_LE(skirts.size() / 6, most);
      all_least += least;
      all_most += most;
      for (std::size_t n = 0; n < skirts.size(); n += 6) {
        // (a, b, to), (a, to, from)
        const Position from = position(patch, skirts[n + 5]), to = position(patch, skirts[n + 2]);
        EXPECT_TRUE(edges.count({from, to}));
        for (const std::size_t k : {n, n + 1}) {
          const Position p = position(patch, skirts[k]);
          EXPECT_LE(p[2], from[2]);
          EXPECT_LE(p[2], to[2]);
          const bool border =
              std::abs(p[0] - box.min.x) < 1e-5 || std::abs(p[0] - box.max.x) < 1e-5 ||
              std::abs(p[1] - box.min.y) < 1e-5 || std::abs(p[1] - box.max.y) < 1e-5;
          EXPECT_TRUE(border);
        }
      }
    }
  }
  EXPECT_GT(3 * all_least, all_most) << "or this says little";
}

/// No corner on the border of a neighbour, of whatever level, lies lower than the skirts there; and
/// they go no lower than the lowest cell that any level joins with those beside the border.
TEST(TilePatch, SkirtsReachAsDeepAsNeighboursOfAnyLevelAndNoDeeper) {
  const TileGrid grid = make_grid(150, 130, 0.1, rough);
  // A corner may stand a little beside the border that it belongs to.
  const float near = 0.5f * 0.1f * 16;
  int compared = 0, bordered = 0;
  for (int tile = 0; tile < static_cast<int>(grid.tile_count()); ++tile) {
    const int tx = tile % grid.tiles_x(), ty = tile / grid.tiles_x();
    if (tx + 1 >= grid.tiles_x()) continue;
    const int border = (tx + 1) * kTileCells;
    const float lowest = lowest_about_border(grid, true, border, ty * kTileCells);
    const auto x = static_cast<float>(grid.bounds_mm().min.x + border * 0.1);
    for (int level = 0; level < StockModel::kPatchLevels; ++level) {
      const MeshPatch mine = make_tile_patch(grid, static_cast<std::uint32_t>(tile), level);
      float end = std::numeric_limits<float>::infinity();
      const auto skirts = mine.skirt_indices();
      for (std::size_t n = 0; n < skirts.size(); n += 6) {
        const Position a = position(mine, skirts[n]), b = position(mine, skirts[n + 1]);
        if (std::abs(a[0] - x) < 1e-5f && std::abs(b[0] - x) < 1e-5f) end = std::min(end, a[2]);
      }
      EXPECT_TRUE(std::isinf(end) || end == lowest) << end;
      bordered += !std::isinf(end);
      for (int other = 0; other < StockModel::kPatchLevels; ++other) {
        const MeshPatch next = make_tile_patch(grid, static_cast<std::uint32_t>(tile) + 1, other);
        for (const std::uint32_t index : next.surface_indices()) {
          const Position p = position(next, index);
          const bool is_top = unpack_normal(next.vertices[index].normal).z > 0.1f;
          if (!is_top || std::abs(p[0] - x) > near / static_cast<float>(16 >> other)) continue;
          EXPECT_GE(p[2], lowest) << "tile " << tile << " levels " << level << ' ' << other;
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 1000);
  EXPECT_GT(bordered, 10);
}

TEST(TilePatch, NormalsPackToATenthOfADegree) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  for (int n = 0; n < 2000; ++n) {
    const glm::vec3 v = glm::normalize(glm::vec3{normal(random), normal(random), normal(random)});
    EXPECT_GT(glm::dot(unpack_normal(pack_normal(v)), v), std::cos(0.0018f));
  }
}

}  // namespace
}  // namespace kerf
