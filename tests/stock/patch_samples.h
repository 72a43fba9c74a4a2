// tests/stock/patch_samples.h - grids to make patches of, and what patches of all tiles say.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "stock/zmap/tile_patch.h"

namespace kerf::test {

using Position = std::array<float, 3>;
using Edge = std::pair<Position, Position>;

inline Position position(const MeshPatch& patch, std::uint32_t vertex) {
  const glm::vec3 p = patch.vertices[vertex].position_mm;
  return {p.x, p.y, p.z};
}

/// Those of skirts alone come behind them.
inline std::span<const MeshVertex> surface_vertices(const MeshPatch& patch) {
  const auto surface = patch.surface_indices();
  const std::size_t count =
      surface.empty() ? 0 : *std::max_element(surface.begin(), surface.end()) + std::size_t{1};
  return std::span(patch.vertices).first(count);
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

inline std::vector<MeshPatch> all_patches(const TileGrid& grid, int level) {
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

inline Closedness closedness(const std::vector<MeshPatch>& patches) {
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

inline double volume_mm3(const std::vector<MeshPatch>& patches) {
  double six = 0;
  for (const MeshPatch& patch : patches) {
    const auto indices = patch.surface_indices();
    const auto at = [&](std::size_t n) { return Vec3(patch.vertices[indices[n]].position_mm); };
    for (std::size_t n = 0; n < indices.size(); n += 3)
      six += glm::dot(at(n), glm::cross(at(n + 1), at(n + 2)));
  }
  return six / 6;
}

/// What a rough job leaves: bowls, a step, a slope, a slot one cell wide, a hole, noise.
inline double rough(double x, double y) {
  if (std::hypot(x - 4, y - 9) < 1.2) return std::nan("");
  if (std::abs(x - 10.05) < 0.04) return -6;
  double z = -0.5 - 0.12 * y;
  if (x > 6 && y < 5) z = -3.5;
  const double d = std::hypot(x - 7, y - 7);
  if (d < 2.9) z = std::min(z, -1 - std::sqrt(9 - d * d));
  if (x < 2) z -= 0.7 * std::abs(std::sin(91 * x + 57 * y));
  return z;
}

}  // namespace kerf::test
