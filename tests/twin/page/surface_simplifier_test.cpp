#include "twin/page/surface_simplifier.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>
#include <utility>

#include "base/geometry.h"

namespace kerf {
namespace {

/// n x n squares of 1 mm, two triangles each, at heights of `z`.
template <class Height>
PageSurface sheet(std::uint32_t n, const Height& z) {
  PageSurface out;
  for (std::uint32_t y = 0; y <= n; ++y) {
    for (std::uint32_t x = 0; x <= n; ++x)
      out.corners.emplace_back(x, y, z(static_cast<double>(x), static_cast<double>(y)));
  }
  for (std::uint32_t y = 0; y < n; ++y) {
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
      for (const std::uint32_t corner : {a, b, d, a, d, c}) out.indices.push_back(corner);
    }
  }
  return out;
}

/// A sphere of 10 mm, as latitudes and longitudes.
PageSurface sphere(std::uint32_t n) {
  PageSurface out;
  const auto at = [&](std::uint32_t i, std::uint32_t k) {
    return i == 0 ? 0 : i == n ? 1 : 2 + (i - 1) * 2 * n + k % (2 * n);
  };
  out.corners = {{0, 0, 10}, {0, 0, -10}};
  for (std::uint32_t i = 1; i < n; ++i) {
    for (std::uint32_t k = 0; k < 2 * n; ++k) {
      const double down = kPi * i / n, round = kPi * k / n;
      out.corners.emplace_back(10 * std::sin(down) * std::cos(round),
                               10 * std::sin(down) * std::sin(round), 10 * std::cos(down));
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t k = 0; k < 2 * n; ++k) {
      const std::uint32_t a = at(i, k), b = at(i + 1, k), c = at(i + 1, k + 1), d = at(i, k + 1);
      if (i + 1 < n) out.indices.insert(out.indices.end(), {a, b, c});
      if (i > 0) out.indices.insert(out.indices.end(), {a, c, d});
    }
  }
  return out;
}

double area_mm2(const PageSurface& surface) {
  double twice = 0;
  for (std::size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
    const Vec3 a(surface.corners[surface.indices[i]]), b(surface.corners[surface.indices[i + 1]]);
    twice += glm::length(glm::cross(b - a, Vec3(surface.corners[surface.indices[i + 2]]) - a));
  }
  return twice / 2;
}

/// Edges that are not run through once in either direction.
std::size_t open_edges(const PageSurface& surface) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = surface.indices[i + k], b = surface.indices[i + (k + 1) % 3];
      edges[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  return static_cast<std::size_t>(
      std::count_if(edges.begin(), edges.end(), [](const auto& edge) { return edge.second != 0; }));
}

TEST(SurfaceSimplifier, LeavesAFlatSheetItsAreaAndItsRim) {
  PageSurface surface = sheet(40, [](double, double) { return 3.0; });
  simplify_surface(surface, {.most_mm = 0.001, .keeps_rim = true});
  EXPECT_EQ(open_edges(surface), 160u);
  EXPECT_NEAR(area_mm2(surface), 1600, 1e-9);         // a fold would add to it
  EXPECT_LE(surface.indices.size() / 3, 158u + 40u);  // 158 are needed for 160 corners of a rim
}

TEST(SurfaceSimplifier, KeepsRidges) {
  PageSurface surface = sheet(20, [](double x, double) { return std::abs(x - 10); });
  simplify_surface(surface, {.most_mm = 0.001, .keeps_rim = true});
  EXPECT_NEAR(area_mm2(surface), 400 * std::sqrt(2.0), 1e-4);
}

TEST(SurfaceSimplifier, DeviatesByNoMoreThanItMay) {
  PageSurface surface = sphere(60);
  const std::size_t full = surface.indices.size() / 3;
  simplify_surface(surface, {.most_mm = 0.05});
  EXPECT_EQ(open_edges(surface), 0u);
  EXPECT_LT(surface.indices.size() / 3, full / 2);
  EXPECT_GT(surface.indices.size() / 3, 100u);
  // Corners are those of the sphere; the middles of triangles lie within it.
  for (std::size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
    Vec3 middle{0};
    for (std::size_t k = 0; k < 3; ++k)
      middle += Vec3(surface.corners[surface.indices[i + k]]) / 3.0;
    EXPECT_NEAR(glm::length(middle), 10, 0.25);
  }
  EXPECT_NEAR(area_mm2(surface), 400 * kPi, 400 * kPi * 0.01);
}

TEST(SurfaceSimplifier, StopsWhenItIsFewEnough) {
  PageSurface surface = sphere(40);
  const std::size_t full = surface.indices.size() / 3;
  simplify_surface(surface, {.most_mm = 10, .least_triangles = full / 2});
  EXPECT_LE(surface.indices.size() / 3, full / 2);
  EXPECT_GE(surface.indices.size() / 3, full / 2 - 2);
  EXPECT_EQ(open_edges(surface), 0u);
}

TEST(SurfaceSimplifier, KeepsWhereGroupsMeet) {
  PageSurface surface = sheet(20, [](double, double) { return 0.0; });
  for (const glm::vec3& corner : surface.corners) surface.groups.push_back(corner.x <= 10 ? 1 : 2);
  simplify_surface(surface, {.most_mm = 0.001, .keeps_rim = true});
  EXPECT_NEAR(area_mm2(surface), 400, 1e-9);
  EXPECT_LT(surface.indices.size() / 3, 200u);  // of 800
  double mixed_mm2 = 0;
  for (std::size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
    PageSurface one;
    one.corners = surface.corners;
    one.indices.assign(surface.indices.begin() + static_cast<std::ptrdiff_t>(i),
                       surface.indices.begin() + static_cast<std::ptrdiff_t>(i + 3));
    std::set<int> groups;
    for (const std::uint32_t corner : one.indices) groups.insert(surface.groups[corner]);
    if (groups.size() > 1) mixed_mm2 += area_mm2(one);
  }
  EXPECT_NEAR(mixed_mm2, 20, 1e-6);  // between X10 and X11, as before
}

TEST(SurfaceSimplifier, TakesNothingAndTrianglesWithoutArea) {
  PageSurface none;
  simplify_surface(none, {.most_mm = 1});
  EXPECT_TRUE(none.indices.empty());
  PageSurface surface = sheet(3, [](double, double) { return 0.0; });
  surface.corners[5] = surface.corners[4];  // beside each other: two triangles have none
  const double before = area_mm2(surface);
  simplify_surface(surface, {.most_mm = 0.001, .keeps_rim = true});
  EXPECT_NEAR(area_mm2(surface), before, 1e-9);
}

}  // namespace
}  // namespace kerf
