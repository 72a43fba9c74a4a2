// Walls of patches against the walls that they mean: where they stand, which way they face.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <iostream>
#include <numeric>
#include <random>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "stock/stock_model.h"
#include "tests/stock/patch_samples.h"

namespace kerf {
namespace {

using test::all_patches;
using test::make_grid;
using test::volume_mm3;

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

TEST(PatchWalls, ARoundWallFacesItsCentre) {
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

TEST(PatchWalls, AnObliqueSlotFacesAcrossItsCourse) {
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

TEST(PatchWalls, WallsAlongAnAxisFaceExactlyAcrossItUpToTheCorner) {
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

TEST(PatchWalls, ASharpObliqueCornerIsNotRounded) {
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

TEST(PatchWalls, WallsFaceTheSameWhereverTheBordersOfTilesAre) {
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

/// A wall that is known: how far points in cells are from it, which cells are high, and how high.
struct KnownWall {
  const char* name;
  double perimeter, mean_height, volume;  ///< cells, cells, cells^3
  std::function<double(double, double)> distance;
  std::function<double(double, double)> height;  ///< in cells, of the grid
};

std::vector<KnownWall> known_walls() {
  const double pi = 3.14159265358979;
  std::vector<KnownWall> walls;
  const auto round = [](double x, double y) { return std::hypot(x - 80.3, y - 78.6) - 51.7; };
  walls.push_back({"round pocket", 2 * pi * 51.7, 60, 160. * 160 * 90 - pi * 51.7 * 51.7 * 60,
                   round, [round](double x, double y) { return round(x, y) < 0 ? -70.0 : -10.0; }});
  const auto block = [](double x, double y) {
    const double c = std::cos(25 / kDegrees), s = std::sin(25 / kDegrees);
    return std::max(std::abs(c * (x - 77.2) + s * (y - 81.4)) - 40.6,
                    std::abs(-s * (x - 77.2) + c * (y - 81.4)) - 33.3);
  };
  // An island in a level field, with a top that rises along x.
  walls.push_back(
      {"inclined island", 4 * (40.6 + 33.3), 10, 160. * 160 * 70 + 4 * 40.6 * 33.3 * 10, block,
       [block](double x, double y) { return block(x, y) < 0 ? -20 + 0.1 * (x - 77.2) : -30.0; }});
  return walls;
}

TEST(PatchWalls, WallsAreWhereTheyAreAndEncloseWhatIsThere) {
  constexpr double kCell = 0.1;
  for (const KnownWall& wall : known_walls()) {
    SCOPED_TRACE(wall.name);
    const TileGrid grid = make_grid(160, 160, kCell, [&](double x, double y) {
      return kCell * wall.height(x / kCell, y / kCell);
    });
    std::vector<double> before, after;
    double squares = 0, squares_before = 0;
    visit_walls(grid, 0, [&](const MeshVertex&, double x, double y) {
      after.push_back(std::abs(wall.distance(x, y)));
      before.push_back(std::abs(wall.distance(std::round(x), std::round(y))));
      squares += after.back() * after.back();
      squares_before += before.back() * before.back();
    });
    std::sort(after.begin(), after.end());
    const double count = static_cast<double>(after.size());
    ASSERT_GT(count, 500);
    EXPECT_GT(std::sqrt(squares_before / count), 0.35);
    EXPECT_LT(std::sqrt(squares / count), 0.14);
    EXPECT_LT(after[after.size() / 2], 0.12);
    EXPECT_LT(after[after.size() * 95 / 100], 0.27);
    // As a shift of the whole wall, in cells: against the cells, and against the true part.
    const std::vector<MeshPatch> patches = all_patches(grid, 0);
    double of_cells = 0;
    for (int j = 0; j < grid.ny(); ++j)
      for (int i = 0; i < grid.nx(); ++i)
        of_cells += static_cast<double>(grid.height(i, j) - grid.floor_mm()) * kCell * kCell;
    const double true_mm3 = wall.volume * kCell * kCell * kCell;
    const double area_mm2 = wall.perimeter * wall.mean_height * kCell * kCell;
    const double volume = volume_mm3(patches);
    std::cout << wall.name << ": rms " << std::sqrt(squares_before / count) << " -> "
              << std::sqrt(squares / count) << " cells; off the cells "
              << (volume - of_cells) / area_mm2 / kCell << ", off the part "
              << (volume - true_mm3) / area_mm2 / kCell << " (cells "
              << (of_cells - true_mm3) / area_mm2 / kCell << ")\n";
    EXPECT_NEAR((volume - of_cells) / area_mm2, 0, 0.03 * kCell);
    EXPECT_NEAR((volume - true_mm3) / area_mm2, 0, 0.03 * kCell);
  }
}

/// All that a card or a file gets of it, byte for byte.
std::string bytes_of(const MeshPatch& patch) {
  std::string bytes;
  const auto add = [&bytes](const auto& values) {
    bytes += std::to_string(values.size()) + ":";
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0]));
  };
  add(patch.vertices);
  add(patch.indices);
  add(patch.cut_by);
  add(std::array{patch.tile, patch.skirt_begin, static_cast<std::uint32_t>(patch.level)});
  return bytes;
}

/// The patches of these tiles at a level, by tile, each made by whichever of the threads is free.
std::vector<std::string> patch_bytes(const TileGrid& grid, int level,
                                     const std::vector<std::uint32_t>& order, int threads) {
  std::vector<std::string> patches(order.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t n = next++; n < order.size(); n = next++) {
      patches[order[n]] = bytes_of(make_tile_patch(grid, order[n], level));
    }
  };
  {
    std::vector<std::jthread> others;
    for (int thread = 1; thread < threads; ++thread) others.emplace_back(work);
    work();
  }
  return patches;
}

TEST(PatchWalls, AreTheSameBytesInAnyOrderAndByAnyNumberOfThreads) {
  // Round, oblique and sharp walls that run through many tiles, as both sides of a border see them.
  TileGrid grid = make_grid(400, 300, 0.1, [](double x, double y) {
    const double from_center = std::hypot(x - 20.02, y - 14.9);
    if (from_center < 11.3 && from_center > 4.1) return -4.0 - 0.05 * x;
    if (std::abs(0.6 * (x - 33) + 0.8 * (y - 9)) < 1.3) return -6.5;
    return x > 3 && x < 7.5 && y > 0.7 * x ? -2.5 : -0.5;
  });
  grid.keep_cut_ids(true);
  grid.begin_change();
  for (std::uint32_t tile = 0; tile < grid.tile_count(); ++tile) {
    std::fill_n(cut_ids_of(grid.make_writable(tile)), kTileFloats, 7 * tile);
  }
  std::vector<std::uint32_t> order(grid.tile_count());
  std::iota(order.begin(), order.end(), 0u);
  ASSERT_GE(order.size(), 20u);
  std::mt19937 random(5);
  for (int level = 0; level < StockModel::kPatchLevels; ++level) {
    SCOPED_TRACE(level);
    const std::vector<std::string> wanted = patch_bytes(grid, level, order, 1);
    EXPECT_EQ(std::set(wanted.begin(), wanted.end()).size(), order.size()) << "tiles are alike";
    std::vector<std::uint32_t> other = order;
    std::reverse(other.begin(), other.end());
    EXPECT_TRUE(patch_bytes(grid, level, other, 1) == wanted);
    for (const int threads : {2, 3, 8}) {
      std::shuffle(other.begin(), other.end(), random);
      EXPECT_TRUE(patch_bytes(grid, level, other, threads) == wanted) << threads << " threads";
    }
  }
}

}  // namespace
}  // namespace kerf
