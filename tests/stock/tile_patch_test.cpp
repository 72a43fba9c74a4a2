// Patches of tiles against the heights that they show: how far off they are, what is smooth and
// what is a wall, and that they close.
#include "stock/zmap/tile_patch.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <random>
#include <set>
#include <span>
#include <tuple>

#include "stock/zmap/tile_relief.h"
#include "tests/stock/stock_samples.h"

namespace kerf {
namespace {

using Position = std::array<float, 3>;
using Edge = std::pair<Position, Position>;

Position position(const MeshPatch& patch, std::uint32_t vertex) {
  const glm::vec3 p = patch.vertices[vertex].position_mm;
  return {p.x, p.y, p.z};
}

/// A grid whose heights a function gives, NaN for none.
template <class Height>
TileGrid make_grid(int nx, int ny, double cell, const Height& height) {
  TileGrid grid({Vec3(-3, 5, -10), Vec3(-3 + nx * cell, 5 + ny * cell, 0)}, nx, ny);
  std::vector<float> row(static_cast<std::size_t>(nx));
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const double z = height((i + 0.5) * cell, (j + 0.5) * cell);
      row[static_cast<std::size_t>(i)] = std::isnan(z) ? grid.floor_mm() : static_cast<float>(z);
    }
    grid.set_row(j, row.data());
  }
  return grid;
}

/// The heights of a level by brute force: nx, ny and cells row by row.
struct Level {
  int nx, ny, span;
  std::vector<float> z;
  Level(const TileGrid& grid, int level)
      : nx((grid.nx() + (1 << level) - 1) >> level),
        ny((grid.ny() + (1 << level) - 1) >> level),
        span(1 << level),
        z(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny), 1e9f) {
    for (int j = 0; j < grid.ny(); ++j)
      for (int i = 0; i < grid.nx(); ++i)
        at(i >> level, j >> level) = std::min(at(i >> level, j >> level), grid.height(i, j));
  }
  float& at(int i, int j) { return z[static_cast<std::size_t>(j * nx + i)]; }
  float at(int i, int j) const { return z[static_cast<std::size_t>(j * nx + i)]; }
};

std::vector<MeshPatch> all_patches(const TileGrid& grid, int level) {
  std::vector<MeshPatch> patches;
  for (std::uint32_t tile = 0; tile < grid.tile_count(); ++tile)
    patches.push_back(make_tile_patch(grid, tile, level));
  return patches;
}

struct Closedness {
  int open = 0;      ///< edges that do not meet as often in one direction as in the other
  int fourfold = 0;  ///< edges in more than two triangles
  int edges = 0;
};

Closedness closedness(const std::vector<MeshPatch>& patches) {
  std::map<Edge, std::pair<int, int>> uses;
  for (const MeshPatch& patch : patches) {
    const auto indices = patch.surface_indices();
    for (std::size_t n = 0; n < indices.size(); n += 3) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Position a = position(patch, indices[n + k]);
        const Position b = position(patch, indices[n + (k + 1) % 3]);
        EXPECT_NE(a, b) << "an edge without length";
        a < b ? ++uses[{a, b}].first : ++uses[{b, a}].second;
      }
    }
  }
  Closedness result;
  for (const auto& [edge, count] : uses) {
    ++result.edges;
    result.open += count.first != count.second;
    result.fourfold += count.first + count.second > 2;
  }
  return result;
}

double volume_mm3(const std::vector<MeshPatch>& patches) {
  double six = 0;
  for (const MeshPatch& patch : patches) {
    const auto indices = patch.surface_indices();
    const auto at = [&](std::size_t n) { return Vec3(patch.vertices[indices[n]].position_mm); };
    for (std::size_t n = 0; n < indices.size(); n += 3)
      six += glm::dot(at(n), glm::cross(at(n + 1), at(n + 2)));
  }
  return six / 6;
}

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

/// What a rough job leaves: bowls, a step, a slope, a slot one cell wide, a hole, noise.
double rough(double x, double y) {
  if (std::hypot(x - 4, y - 9) < 1.2) return std::nan("");
  if (std::abs(x - 10.05) < 0.04) return -6;
  double z = -0.5 - 0.12 * y;
  if (x > 6 && y < 5) z = -3.5;
  const double d = std::hypot(x - 7, y - 7);
  if (d < 2.9) z = std::min(z, -1 - std::sqrt(9 - d * d));
  if (x < 2) z -= 0.7 * std::abs(std::sin(91 * x + 57 * y));
  return z;
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
  for (const auto& [sx, sy] : {std::pair{0.1, -0.05}, {0.2, 0.2}, {-1.0, 0.3}, {1.5, -2.0}}) {
    SCOPED_TRACE(testing::Message() << sx << " " << sy);
    const TileGrid grid = make_grid(100, 90, 0.05, [&](double x, double y) {
      return -5 + sx * (x - 2.5) * 0.5 + sy * (y - 2.25) * 0.5;
    });
    const glm::vec3 normal =
        glm::normalize(glm::vec3(static_cast<float>(-sx / 2), static_cast<float>(-sy / 2), 1));
    for (const MeshPatch& patch : all_patches(grid, 0)) {
      int tops = 0;
      for (const MeshVertex& v : patch.vertices) {
        const glm::vec3 n = unpack_normal(v.normal);
        if (n.z < 0.1f || v.position_mm.z == grid.floor_mm()) continue;  // walls, skirts
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

constexpr double kDegrees = 180.0 / 3.14159265358979;

/// Angle between a wall's normal and `wanted`, which points away from the material.
double off_deg(const MeshVertex& vertex, double wanted_x, double wanted_y) {
  const glm::vec3 n = unpack_normal(vertex.normal);
  return kDegrees * std::abs(std::atan2(
                        static_cast<double>(n.x) * wanted_y - static_cast<double>(n.y) * wanted_x,
                        static_cast<double>(n.x) * wanted_x + static_cast<double>(n.y) * wanted_y));
}

/// Calls `visit` with each vertex of a wall inside the blank, and its place in cells.
template <class Visit>
void visit_walls(const TileGrid& grid, int level, const Visit& visit) {
  for (const MeshPatch& patch : all_patches(grid, level)) {
    const std::span surface = patch.surface_indices();
    for (const std::uint32_t index : std::set<std::uint32_t>(surface.begin(), surface.end())) {
      const MeshVertex& vertex = patch.vertices[index];
      const double x = (vertex.position_mm.x - grid.bounds_mm().min.x) / grid.cell_x_mm();
      const double y = (vertex.position_mm.y - grid.bounds_mm().min.y) / grid.cell_y_mm();
      const bool on_side = std::min(x, y) < 0.5 || x > grid.nx() - 0.5 || y > grid.ny() - 0.5;
      if (!on_side && std::abs(unpack_normal(vertex.normal).z) < 0.01f) visit(vertex, x, y);
    }
  }
}

TEST(TilePatch, ARoundWallFacesItsCentre) {
  // By level. At level 1 there are half as many cells to go by, and the lowest of each four
  // make no round circle.
  struct Limits {
    double radius;  ///< in cells of level 0
    std::array<double, 2> mean_deg, max_deg;
  };
  for (const auto& [radius, mean_deg, max_deg] :
       {Limits{20, {1.8, 3.2}, {5, 7}}, Limits{50, {1.3, 1.6}, {5, 6}},
        Limits{90, {1.2, 1.2}, {5, 5}}}) {
    for (const bool is_pocket : {true, false}) {
      SCOPED_TRACE(testing::Message() << radius << (is_pocket ? " pocket" : " boss"));
      const double cx = 10.023, cy = 9.841, r = 0.1 * radius;
      const TileGrid grid = make_grid(200, 200, 0.1, [&](double x, double y) {
        return (std::hypot(x - cx, y - cy) < r) == is_pocket ? -9 : -1;
      });
      for (const std::size_t level : {0, 1}) {
        double sum = 0, most = 0;
        int count = 0;
        visit_walls(
            grid, static_cast<int>(level), [&](const MeshVertex& vertex, double x, double y) {
              const double sign = is_pocket ? 1 : -1;
              const double off = off_deg(vertex, sign * (cx / 0.1 - x), sign * (cy / 0.1 - y));
              sum += off;
              most = std::max(most, off);
              ++count;
            });
        EXPECT_GT(count, 10 * radius);
        EXPECT_LT(sum / count, mean_deg[level]) << "level " << level;
        EXPECT_LT(most, max_deg[level]) << "level " << level;
      }
    }
  }
}

TEST(TilePatch, AnObliqueSlotFacesAcrossItsCourse) {
  for (const double angle_deg : {2.0, 7.0, 20.0, 33.0, 45.0, 61.0, 88.5}) {
    SCOPED_TRACE(angle_deg);
    const double c = std::cos(angle_deg / kDegrees), s = std::sin(angle_deg / kDegrees);
    const auto across = [&](double x, double y) { return c * (y - 7.02) - s * (x - 6.97); };
    const TileGrid grid = make_grid(
        140, 140, 0.1, [&](double x, double y) { return std::abs(across(x, y)) < 2 ? -5 : -1; });
    double sum = 0;
    int count = 0;
    visit_walls(grid, 0, [&](const MeshVertex& vertex, double x, double y) {
      // Up to the sides of the blank there is less to go by.
      if (std::min(x, y) < 8 || std::max(x, y) > 132) return;
      const double sign = across(0.1 * x, 0.1 * y) > 0 ? 1 : -1;
      const double off = off_deg(vertex, sign * s, -sign * c);
      EXPECT_LT(off, 5.0) << x << " " << y;
      sum += off;
      ++count;
    });
    ASSERT_GT(count, 400);
    EXPECT_LT(sum / count, 3.0);
  }
}

TEST(TilePatch, WallsAlongAnAxisFaceExactlyAcrossItUpToTheCorner) {
  // Pocket and island, with corners in the middle of a tile, at its border and beside it.
  for (const int low : {20, 61, 64, 65}) {
    for (const bool is_pocket : {true, false}) {
      const int high = low + 41;
      const TileGrid grid = make_grid(130, 130, 0.1, [&](double x, double y) {
        const int i = static_cast<int>(x / 0.1), j = static_cast<int>(y / 0.1);
        return (std::min(i, j) >= low && std::max(i, j) < high) == is_pocket ? -9 : -1;
      });
      for (const int level : {0, 1}) {
        if (level == 1 && low % 2 == 1) continue;  // no square of this level
        const int end = level == 0 ? high : is_pocket ? high + 1 : high - 1;
        int count = 0;
        visit_walls(grid, level, [&](const MeshVertex& vertex, double x, double y) {
          const glm::vec3 n = unpack_normal(vertex.normal);
          const auto near = [](double a, double b) { return std::abs(a - b) < 0.01; };
          const float sign = is_pocket ? 1 : -1;
          const bool is_across_x = (near(x, low) && n.x == sign) || (near(x, end) && n.x == -sign);
          const bool is_across_y = (near(y, low) && n.y == sign) || (near(y, end) && n.y == -sign);
          EXPECT_TRUE(is_across_x || is_across_y) << x << " " << y << ": " << n.x << " " << n.y;
          ++count;
        });
        EXPECT_GE(count, 4 * 2 * ((end - low) >> level));
      }
    }
  }
}

TEST(TilePatch, ASharpObliqueCornerIsNotRounded) {
  // A pocket turned by 30 degrees: from six cells before its corners its walls face as they do.
  const double c = std::cos(30 / kDegrees), s = std::sin(30 / kDegrees);
  const TileGrid grid = make_grid(128, 128, 0.1, [&](double x, double y) {
    const double u = c * (x - 6.43) + s * (y - 6.38), v = -s * (x - 6.43) + c * (y - 6.38);
    return std::max(std::abs(u), std::abs(v)) < 4 ? -5 : -1;
  });
  int count = 0;
  visit_walls(grid, 0, [&](const MeshVertex& vertex, double x, double y) {
    const double u = c * (x - 64.3) + s * (y - 63.8), v = -s * (x - 64.3) + c * (y - 63.8);
    const bool across_u = std::abs(u) > std::abs(v);
    if (std::min(std::abs(u), std::abs(v)) > 34) return;
    const double sign = (across_u ? u : v) > 0 ? -1 : 1;
    EXPECT_LT(across_u ? off_deg(vertex, sign * c, sign * s) : off_deg(vertex, -sign * s, sign * c),
              8.0)
        << u << " " << v;
    ++count;
  });
  EXPECT_GT(count, 500);
}

TEST(TilePatch, WallsFaceTheSameWhereverTheBordersOfTilesAre) {
  const auto part = [](int shift, int i, int j) {
    const double x = i - shift, y = j - shift;
    const double slot = 0.3 * (x - 60) - (y - 60);
    if (std::hypot(x - 70, y - 66) < 33.3) return -9.0;
    if (std::abs(slot) < 6 && x > 10 && x < 120) return -4.0 - 0.01 * x;
    return -1.0;
  };
  using Wall = std::tuple<int, int, float, std::uint32_t>;
  for (const int level : {0, 1, 2}) {
    const auto walls = [&](int shift) {
      const TileGrid grid = make_grid(200, 200, 0.1, [&](double x, double y) {
        return part(shift, static_cast<int>(x / 0.1), static_cast<int>(y / 0.1));
      });
      std::set<Wall> found;
      visit_walls(grid, level, [&](const MeshVertex& vertex, double x, double y) {
        found.emplace(static_cast<int>(std::lround(x)) - shift,
                      static_cast<int>(std::lround(y)) - shift, vertex.position_mm.z,
                      vertex.normal);
      });
      return found;
    };
    const std::set<Wall> wanted = walls(24);
    EXPECT_GT(wanted.size(), 500u >> level);
    for (const int shift : {28, 44, 56}) EXPECT_EQ(walls(shift), wanted) << level << " " << shift;
  }
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

TEST(TilePatch, SkirtsReachTheFloorBelowEveryInnerBorderAndNowhereElse) {
  const TileGrid grid = make_grid(150, 130, 0.1, rough);
  for (int level = 0; level < StockModel::kPatchLevels; ++level) {
    for (const MeshPatch& patch : all_patches(grid, level)) {
      const int tx = static_cast<int>(patch.tile) % grid.tiles_x();
      const int ty = static_cast<int>(patch.tile) / grid.tiles_x();
      const Box box = grid.tile_box(patch.tile);
      // Upper edges of the skirts are edges of the top; the area seen from the side is that of
      // the border's cells.
      std::set<Edge> edges;
      const auto surface = patch.surface_indices();
      for (std::size_t n = 0; n < surface.size(); ++n)
        edges.insert(
            {position(patch, surface[n]), position(patch, surface[n % 3 == 2 ? n - 2 : n + 1])});
      const auto skirts = patch.skirt_indices();
      ASSERT_EQ(skirts.size() % 6, 0u);
      std::size_t expected = 0;
      const Level cells(grid, level);
      const int per_tile = kTileCells >> level;
      for (int j = ty * per_tile; j < std::min(cells.ny, (ty + 1) * per_tile); ++j) {
        for (int i = tx * per_tile; i < std::min(cells.nx, (tx + 1) * per_tile); ++i) {
          if (cells.at(i, j) <= grid.floor_mm()) continue;
          expected += (i > 0 && i % per_tile == 0) + (j > 0 && j % per_tile == 0);
          expected += (i + 1 < cells.nx && (i + 1) % per_tile == 0);
          expected += (j + 1 < cells.ny && (j + 1) % per_tile == 0);
        }
      }
      EXPECT_EQ(skirts.size() / 6, expected);
      for (std::size_t n = 0; n < skirts.size(); n += 6) {
        // (a, b, to), (a, to, from)
        const Position from = position(patch, skirts[n + 5]), to = position(patch, skirts[n + 2]);
        EXPECT_TRUE(edges.count({from, to}));
        for (const std::size_t k : {n, n + 1}) {
          const Position p = position(patch, skirts[k]);
          EXPECT_EQ(p[2], grid.floor_mm());
          const bool border =
              std::abs(p[0] - box.min.x) < 1e-5 || std::abs(p[0] - box.max.x) < 1e-5 ||
              std::abs(p[1] - box.min.y) < 1e-5 || std::abs(p[1] - box.max.y) < 1e-5;
          EXPECT_TRUE(border);
        }
      }
    }
  }
}

TEST(TilePatch, NormalsPackToATenthOfADegree) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  for (int n = 0; n < 2000; ++n) {
    const glm::vec3 v = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
    EXPECT_GT(glm::dot(unpack_normal(pack_normal(v)), v), std::cos(0.0018f));
  }
}

}  // namespace
}  // namespace kerf
