#include "stock/zmap/sparse_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "tests/stock/patch_samples.h"
#include "tests/stock/random_part.h"

namespace kerf {
namespace {

using test::closedness;
using test::Closedness;

std::vector<MeshPatch> patches_of(const SparseSurface& surface, std::size_t tiles) {
  std::vector<MeshPatch> out;
  for (std::uint32_t tile = 0; tile < tiles; ++tile) out.push_back(surface.patch(tile));
  return out;
}

std::vector<MeshPatch> full_patches(const StockModel& stock) {
  std::vector<MeshPatch> out;
  for (std::uint32_t tile = 0; tile < stock.tile_count(); ++tile)
    out.push_back(stock.patch(tile, 0));
  return out;
}

void cut(ZMap& map, const char* shape, const Vec3& from, const Vec3& to, std::uint64_t id) {
  CutMove move = test::line(from, to);
  move.id = id;
  test::cut(map, *parse_shape(shape), {move});
}

std::size_t triangles(const std::vector<MeshPatch>& patches) {
  std::size_t count = 0;
  for (const MeshPatch& patch : patches) count += patch.surface_indices().size() / 3;
  return count;
}

/// Height of what looks up, at places that lie on no line of cells: three by three a cell.
std::vector<float> heights_from_above(const std::vector<MeshPatch>& patches, const Box& box,
                                      double cell_mm) {
  const double step = cell_mm / 3;
  const int nx = static_cast<int>(box.size().x / step), ny = static_cast<int>(box.size().y / step);
  const auto x = [&](int i) { return box.min.x + (i + 0.437) * step; };
  const auto y = [&](int j) { return box.min.y + (j + 0.561) * step; };
  std::vector<float> out(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny),
                         std::numeric_limits<float>::quiet_NaN());
  for (const MeshPatch& patch : patches) {
    const auto seen = patch.surface_indices();
    for (std::size_t n = 0; n < seen.size(); n += 3) {
      std::array<Vec3, 3> p;
      Box about;
      for (std::size_t k = 0; k < 3; ++k) {
        p[k] = Vec3(patch.vertices[seen[n + k]].position_mm);
        about.extend(p[k]);
      }
      const auto cross = [](const Vec3& a, const Vec3& b, double u, double v) {
        return (b.x - a.x) * (v - a.y) - (b.y - a.y) * (u - a.x);
      };
      const double twice = cross(p[0], p[1], p[2].x, p[2].y);
      if (twice < 1e-9) continue;
      const int i0 = std::max(0, static_cast<int>((about.min.x - box.min.x) / step) - 1);
      const int j0 = std::max(0, static_cast<int>((about.min.y - box.min.y) / step) - 1);
      for (int j = j0; j < ny && y(j) <= about.max.y; ++j) {
        for (int i = i0; i < nx && x(i) <= about.max.x; ++i) {
          const double a = cross(p[1], p[2], x(i), y(j)), b = cross(p[2], p[0], x(i), y(j)),
                       c = cross(p[0], p[1], x(i), y(j));
          if (a < 0 || b < 0 || c < 0) continue;
          out[static_cast<std::size_t>(j * nx + i)] =
              static_cast<float>((a * p[0].z + b * p[1].z + c * p[2].z) / twice);
        }
      }
    }
  }
  return out;
}

/// All that is said of a sparse surface, against the full one.
void expect_as_good(const ZMap& map, double most_mm, double of_full) {
  const std::vector<MeshPatch> full = full_patches(map);
  const auto surface = map.sparse_surface({.most_mm = most_mm, .group_of = {}, .threads = 2});
  const std::vector<MeshPatch> sparse = patches_of(*surface, map.tile_count());
  EXPECT_LT(static_cast<double>(triangles(sparse)), of_full * static_cast<double>(triangles(full)));
  const Closedness closed = closedness(sparse);
  EXPECT_EQ(closed.open, 0);
  EXPECT_LE(closed.fourfold, closedness(full).fourfold);
  const std::vector<float> wanted = heights_from_above(full, map.bounds_mm(), map.cell_mm());
  const std::vector<float> found = heights_from_above(sparse, map.bounds_mm(), map.cell_mm());
  double worst = 0;
  std::size_t seen = 0, torn = 0;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    if (std::isnan(wanted[k]) != std::isnan(found[k])) ++torn;
    if (std::isnan(wanted[k]) || std::isnan(found[k])) continue;
    ++seen;
    worst = std::max(worst, static_cast<double>(std::abs(wanted[k] - found[k])));
  }
  EXPECT_GT(seen, wanted.size() / 2);
  EXPECT_EQ(torn, 0u);
  EXPECT_LE(worst, most_mm + 1e-5);
  EXPECT_GT(worst, 0.1 * most_mm);  // or nothing would be left out
}

TEST(SparseTiles, AreNearTheFullSurfaceAndClosed) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    SCOPED_TRACE(seed);
    expect_as_good(*test::random_part(seed, 0.1), 0.01, 0.8);
    expect_as_good(*test::random_part(seed, 0.1, true), 0.01, 0.9);
  }
}

TEST(SparseTiles, ABowlAndItsRimAreFew) {
  auto map = test::make_map("box:0,0,-8:24,18,0", 0.05);
  cut(*map, "ball:10", {12, 9, 5}, {12, 9, -3}, 0);
  test::finish(*map);
  expect_as_good(*map, 0.005, 0.25);
}

/// 128 x 128 cells, untouched: two triangles a tile, four below, and the sides as they are.
TEST(SparseTiles, ABlankIsNextToNothing) {
  const auto map = test::make_map("box:0,0,-1:12.8,12.8,0", 0.1);
  const auto surface = map->sparse_surface({});
  const std::vector<MeshPatch> sparse = patches_of(*surface, map->tile_count());
  // Corners at the sides are split, so cells there are kept: 2 x 508, and as much again between.
  EXPECT_LT(triangles(sparse), 4600u);
  EXPECT_EQ(closedness(sparse).open, 0);
  EXPECT_NEAR(test::volume_mm3(sparse), 12.8 * 12.8, 1e-4);
}

TEST(SparseTiles, JoinNoCellsOfSeveralGroups) {
  auto map = test::make_map("box:0,0,-8:24,18,0", 0.1);
  map->keep_cut_ids(true);
  cut(*map, "flat:6", {-5, 9, -2}, {30, 9, -2}, 0);  // one level floor ..
  cut(*map, "flat:6", {12, -5, -2}, {12, 25, -2}, 1);
  test::finish(*map);
  SparseOptions options;
  options.group_of = [](std::uint32_t move) { return move; };
  for (const MeshPatch& patch : patches_of(*map->sparse_surface(options), map->tile_count())) {
    const auto seen = patch.surface_indices();
    for (std::size_t n = 0; n < seen.size(); n += 3) {
      std::set<std::uint32_t> groups;
      Box about;
      for (std::size_t k = 0; k < 3; ++k) {
        groups.insert(patch.cut_by[seen[n + k]]);
        about.extend(Vec3(patch.vertices[seen[n + k]].position_mm));
      }
      if (about.size().z > 1e-4 || about.max.z < -7) continue;  // walls, and what is below
      if (groups.size() > 1) {
        EXPECT_LT(std::max(about.size().x, about.size().y), 0.1 + 1e-4);
      }
    }
  }
}

}  // namespace
}  // namespace kerf
