#include "stock/zmap/height_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <vector>

namespace kerf {
namespace {

/// A grid with its own heights. Cells of 0.5 x 0.25 mm, floor at -2, not at the origin.
struct TestGrid {
  static constexpr double kFloor = -2.0;
  int nx;
  int ny;
  std::vector<float> heights;

  TestGrid(int nx_cells, int ny_cells, const std::function<double(int, int)>& height)
      : nx(nx_cells), ny(ny_cells) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) heights.push_back(float(height(i, j)));
    }
  }
  Box bounds() const {
    return {{10.0, -20.0, kFloor}, {10.0 + 0.5 * nx, -20.0 + 0.25 * ny, 100.0}};
  }
  TriangleMesh mesh(double tolerance_mm, int threads = 1) const {
    return mesh_height_grid({nx, ny, bounds(), heights}, tolerance_mm, threads);
  }
  float at(int i, int j) const {
    const float h = heights[std::size_t(std::clamp(j, 0, ny - 1)) * std::size_t(nx) +
                            std::size_t(std::clamp(i, 0, nx - 1))];
    return std::max(h, float(kFloor));
  }
  bool solid(int i, int j) const { return at(i, j) > float(kFloor); }
  double cell_area() const { return 0.5 * 0.25; }
  double volume() const {
    double sum = 0.0;
    for (const float h : heights) sum += (std::max(h, float(kFloor)) - kFloor) * cell_area();
    return sum;
  }
};

using Heights = std::function<double(int, int)>;

Heights noise(std::uint32_t seed, double amplitude) {
  return [=](int i, int j) {
    std::minstd_rand random(seed + 7919u * std::uint32_t(i) + 104729u * std::uint32_t(j));
    random.discard(3);
    return 5.0 + amplitude * (double(random()) / double(std::minstd_rand::max()) - 0.5);
  };
}
Heights waves() {
  return
      [](int i, int j) { return 6.0 + 2.0 * std::sin(0.11 * i) + std::cos(0.07 * j + 0.02 * i); };
}
Heights with_holes(const Heights& heights, const std::function<bool(int, int)>& is_hole) {
  return [=](int i, int j) { return is_hole(i, j) ? TestGrid::kFloor : heights(i, j); };
}
std::function<bool(int, int)> random_holes(std::uint32_t seed, double share) {
  const Heights random = noise(seed, 1.0);
  return [=](int i, int j) { return random(i, j) - 4.5 < share; };
}
std::function<bool(int, int)> outside_disc(int n) {
  return [=](int i, int j) { return std::hypot(i - 0.5 * (n - 1), j - 0.5 * (n - 1)) > 0.5 * n; };
}

struct Case {
  std::string name;
  TestGrid grid;
};

std::vector<Case> cases() {
  std::vector<Case> out;
  for (const auto& [nx, ny] : std::vector<std::pair<int, int>>{{1, 1},
                                                               {1, 2},
                                                               {2, 1},
                                                               {2, 2},
                                                               {1, 17},
                                                               {23, 1},
                                                               {3, 3},
                                                               {5, 4},
                                                               {2, 9},
                                                               {9, 9},
                                                               {16, 16},
                                                               {17, 17},
                                                               {33, 18},
                                                               {40, 61},
                                                               {130, 7},
                                                               {6, 133},
                                                               {64, 70}}) {
    const std::string size = ", cells " + std::to_string(nx) + " by " + std::to_string(ny);
    const auto add = [&, nx = nx, ny = ny](const char* name, const Heights& heights) {
      out.push_back({name + size, TestGrid(nx, ny, heights)});
    };
    const std::uint32_t seed = std::uint32_t(nx * 1000 + ny);
    add("flat", [](int, int) { return 3.0; });
    add("tilted", [](int i, int j) { return 3.0 + 0.01 * i + 0.02 * j; });
    add("waves", waves());
    add("noise", noise(seed, 3.0));
    add("ripple", noise(seed, 0.05));
    add("step", [](int i, int j) { return 2 * i + j > 11 ? 8.0 : 1.0; });
    add("spike", [](int i, int j) { return i == 3 && j == 2 ? 90.0 : 1.0; });
    // Straight along one diagonal, bent along the other.
    add("rising valley", [](int i, int j) { return 1.0 + 0.004 * (i - j) * (i - j); });
    add("falling valley", [](int i, int j) { return 1.0 + 0.004 * (i + j - 40) * (i + j - 40); });
    add("hole", with_holes(waves(), [](int i, int j) { return i / 4 == 1 && j / 3 == 1; }));
    add("pinhole", with_holes(waves(), [](int i, int j) { return i == 5 && j == 3; }));
    add("slot", with_holes(waves(), [](int i, int j) { return i == 2 && j > 1; }));
    add("slots", with_holes(waves(), [](int i, int j) { return i % 3 == 1 || j % 5 == 3; }));
    add("diagonal slots", with_holes(waves(), [](int i, int j) {
          return (i + j) % 5 == 0 || (i - j + 1000) % 7 == 0;
        }));
    add("chequerboard", with_holes(waves(), [](int i, int j) { return (i + j) % 2 == 0; }));
    add("coarse chequerboard",
        with_holes(waves(), [](int i, int j) { return (i / 2 + j / 2) % 2 == 0; }));
    add("islands", with_holes(waves(), [](int i, int j) { return i % 4 != 1 || j % 3 != 1; }));
    add("frame", with_holes(waves(), [nx = nx, ny = ny](int i, int j) {
          return i == 0 || j == 0 || i == nx - 1 || j == ny - 1;
        }));
    add("disc", with_holes(waves(), outside_disc(std::max(nx, ny))));
    for (const double share : {0.02, 0.2, 0.5, 0.8, 0.97}) {
      add("random holes", with_holes(noise(seed, 2.0), random_holes(seed + 1, share)));
    }
  }
  return out;
}

using Point = std::array<std::uint32_t, 3>;

Point exact(const glm::vec3& p) {
  const glm::vec3 q = p + 0.0f;  // -0 and 0 are one place
  return {std::bit_cast<std::uint32_t>(q.x), std::bit_cast<std::uint32_t>(q.y),
          std::bit_cast<std::uint32_t>(q.z)};
}

/// Every edge is used once in each direction, by any way of naming the corners.
template <class Name>
bool edges_pair_up(const TriangleMesh& mesh, const Name& name) {
  using Edge = std::pair<decltype(name(0)), decltype(name(0))>;
  std::vector<Edge> edges, reversed;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      edges.emplace_back(name(t[k]), name(t[(k + 1) % 3]));
      reversed.emplace_back(edges.back().second, edges.back().first);
    }
  }
  std::sort(edges.begin(), edges.end());
  std::sort(reversed.begin(), reversed.end());
  return std::adjacent_find(edges.begin(), edges.end()) == edges.end() && edges == reversed;
}

/// The triangles around each vertex form one closed fan.
bool vertices_have_one_fan(const TriangleMesh& mesh) {
  std::vector<std::map<std::uint32_t, std::uint32_t>> next(mesh.positions_mm.size());
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) next[t[k]][t[(k + 1) % 3]] = t[(k + 2) % 3];
  }
  for (const auto& around : next) {
    if (around.empty()) return false;  // a vertex that nothing uses
    std::size_t walked = 0;
    std::uint32_t at = around.begin()->first;
    do {
      const auto found = around.find(at);
      if (found == around.end()) return false;
      at = found->second;
      ++walked;
    } while (at != around.begin()->first && walked <= around.size());
    if (walked != around.size()) return false;
  }
  return true;
}

double signed_volume(const TriangleMesh& mesh) {
  const glm::dvec3 origin = mesh.positions_mm.empty() ? glm::vec3(0.0f) : mesh.positions_mm[0];
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    const glm::dvec3 a = glm::dvec3(mesh.positions_mm[t[0]]) - origin;
    const glm::dvec3 b = glm::dvec3(mesh.positions_mm[t[1]]) - origin;
    const glm::dvec3 c = glm::dvec3(mesh.positions_mm[t[2]]) - origin;
    sum += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return sum;
}

/// Twice the area seen from above.
double plan_area2(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const glm::dvec3 a = mesh.positions_mm[t[0]];
  const glm::dvec3 b = glm::dvec3(mesh.positions_mm[t[1]]) - a;
  const glm::dvec3 c = glm::dvec3(mesh.positions_mm[t[2]]) - a;
  return b.x * c.y - b.y * c.x;
}

void expect_sound(const TriangleMesh& mesh) {
  EXPECT_TRUE(edges_pair_up(mesh, [&](std::uint32_t v) { return exact(mesh.positions_mm[v]); }));
  EXPECT_TRUE(edges_pair_up(mesh, [](std::uint32_t v) { return v; }));
  EXPECT_TRUE(vertices_have_one_fan(mesh));
  int without_area = 0, slanted_floor = 0;
  for (const auto& t : mesh.triangles) {
    const glm::dvec3 a = mesh.positions_mm[t[0]];
    const glm::dvec3 b = mesh.positions_mm[t[1]];
    const glm::dvec3 c = mesh.positions_mm[t[2]];
    without_area += glm::length(glm::cross(b - a, c - a)) > 0.0 ? 0 : 1;
    const bool flat_on_floor = a.z == TestGrid::kFloor && b.z == a.z && c.z == a.z;
    slanted_floor += plan_area2(mesh, t) < 0.0 && !flat_on_floor ? 1 : 0;
  }
  EXPECT_EQ(without_area, 0);
  EXPECT_EQ(slanted_floor, 0);  // whatever looks down is the floor: the surface has no overhang
}

/// Walls seen from outside do not overlap: their areas add up to those of the side views.
double wall_area(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    if (plan_area2(mesh, t) != 0.0) continue;
    const glm::dvec3 a = mesh.positions_mm[t[0]];
    const glm::dvec3 b = mesh.positions_mm[t[1]];
    const glm::dvec3 c = mesh.positions_mm[t[2]];
    sum += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return sum;
}

/// Where the surface is at half steps of the cells: heights[2j][2i] at cell centres, odd indices
/// half way between; NaN where it is not.
std::vector<double> sampled_surface(const TestGrid& grid, const TriangleMesh& mesh) {
  const int columns = 2 * grid.nx - 1;
  const int rows = 2 * grid.ny - 1;
  std::vector<double> out(std::size_t(columns) * std::size_t(rows),
                          std::numeric_limits<double>::quiet_NaN());
  const auto to_steps = [&](const glm::vec3& p) {
    return glm::dvec3((p.x - grid.bounds().min.x) / 0.25 - 1.0,
                      (p.y - grid.bounds().min.y) / 0.125 - 1.0, p.z);
  };
  for (const auto& t : mesh.triangles) {
    if (!(plan_area2(mesh, t) > 0.0)) continue;
    const glm::dvec3 a = to_steps(mesh.positions_mm[t[0]]);
    const glm::dvec3 b = to_steps(mesh.positions_mm[t[1]]);
    const glm::dvec3 c = to_steps(mesh.positions_mm[t[2]]);
    const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    const int j0 = std::max(0, int(std::floor(std::min({a.y, b.y, c.y}))));
    const int j1 = std::min(rows - 1, int(std::ceil(std::max({a.y, b.y, c.y}))));
    const int i0 = std::max(0, int(std::floor(std::min({a.x, b.x, c.x}))));
    const int i1 = std::min(columns - 1, int(std::ceil(std::max({a.x, b.x, c.x}))));
    for (int j = j0; j <= j1; ++j) {
      for (int i = i0; i <= i1; ++i) {
        const double wb = ((i - a.x) * (c.y - a.y) - (j - a.y) * (c.x - a.x)) / area;
        const double wc = ((b.x - a.x) * (j - a.y) - (b.y - a.y) * (i - a.x)) / area;
        const double slack = 1e-4;  // positions are single precision
        if (wb < -slack || wc < -slack || wb + wc > 1 + slack) continue;
        const double z = a.z + wb * (b.z - a.z) + wc * (c.z - a.z);
        double& there = out[std::size_t(j) * std::size_t(columns) + std::size_t(i)];
        there = std::isnan(there) ? z : std::min(there, z);
      }
    }
  }
  return out;
}

/// The surface of all cells with alternating diagonals at half steps.
double reference(const TestGrid& grid, int i2, int j2) {
  const int i = i2 / 2;
  const int j = j2 / 2;
  if (i2 % 2 == 0 && j2 % 2 == 0) return grid.at(i, j);
  if (j2 % 2 == 0) return 0.5 * (double(grid.at(i, j)) + grid.at(i + 1, j));
  if (i2 % 2 == 0) return 0.5 * (double(grid.at(i, j)) + grid.at(i, j + 1));
  if ((i + j) % 2 == 0) return 0.5 * (double(grid.at(i, j)) + grid.at(i + 1, j + 1));
  return 0.5 * (double(grid.at(i + 1, j)) + grid.at(i, j + 1));
}

/// Greatest vertical distance at cell centres and half way between. `step` 2: centres alone.
double greatest_deviation(const TestGrid& grid, const TriangleMesh& mesh, int step) {
  const std::vector<double> surface = sampled_surface(grid, mesh);
  double greatest = 0.0;
  for (int j = 0; j < 2 * grid.ny - 1; j += step) {
    for (int i = 0; i < 2 * grid.nx - 1; i += step) {
      const double z = surface[std::size_t(j) * std::size_t(2 * grid.nx - 1) + std::size_t(i)];
      const double expected = reference(grid, i, j);
      greatest = std::max(greatest, std::abs((std::isnan(z) ? TestGrid::kFloor : z) - expected));
    }
  }
  return greatest;
}

/// What single precision and the slack of the sampling make of steep places.
double sampling_error(const TestGrid& grid) {
  const auto [low, high] = std::minmax_element(grid.heights.begin(), grid.heights.end());
  return 1e-5 + 2e-5 * (double(*high) - *low);
}

int count_holes(const TestGrid& grid) {
  return int(std::count_if(grid.heights.begin(), grid.heights.end(),
                           [](float h) { return !(h > float(TestGrid::kFloor)); }));
}

bool same_bits(const TriangleMesh& a, const TriangleMesh& b) {
  return a.triangles == b.triangles && a.positions_mm == b.positions_mm;
}

// ---- All cells ----------------------------------------------------------------------------------

TEST(HeightMesh, all_cells_is_closed_and_sound) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    expect_sound(c.grid.mesh(0.0));
    if (HasFailure()) return;
  }
}

TEST(HeightMesh, all_cells_volume_is_that_of_the_cells) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const TestGrid& g = c.grid;
    double expected = g.volume();
    if (g.nx > 1 && g.ny > 1) {
      const double corners =
          double(g.at(0, 0)) + g.at(g.nx - 1, g.ny - 1) - g.at(g.nx - 1, 0) - g.at(0, g.ny - 1);
      expected += corners * g.cell_area() / 12.0;
    }
    const double film = double(kHoleFilmMm) * count_holes(g) * g.cell_area();
    const double volume = signed_volume(g.mesh(0.0));
    EXPECT_GE(volume, expected * (1 - 1e-6) - film / 12);
    EXPECT_LE(volume, expected * (1 + 1e-6) + film * 13 / 12);
  }
}

TEST(HeightMesh, all_cells_passes_through_all_centres) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const double film = count_holes(c.grid) > 0 ? double(kHoleFilmMm) : 0.0;
    EXPECT_LE(greatest_deviation(c.grid, c.grid.mesh(0.0), 2), sampling_error(c.grid) + film);
  }
}

TEST(HeightMesh, all_cells_has_every_cell_as_a_vertex) {
  const TestGrid grid(7, 5, noise(3, 2.0));
  const TriangleMesh mesh = grid.mesh(0.0);
  EXPECT_EQ(mesh.positions_mm.size(), 9u * 7u + 4u);
  // Two a square, two for the floor, and one for each edge around a wall.
  EXPECT_EQ(mesh.triangles.size(), 2u * 8u * 6u + 2u + 2u * 8u + 2u * 6u + 4u);
  for (int j = 0; j < 5; ++j) {
    for (int i = 0; i < 7; ++i) {
      const glm::vec3 centre(10.25 + 0.5 * i, -19.875 + 0.25 * j, grid.at(i, j));
      EXPECT_EQ(std::count(mesh.positions_mm.begin(), mesh.positions_mm.end(), centre), 1);
    }
  }
}

// ---- Within a tolerance -------------------------------------------------------------------------

TEST(HeightMesh, tolerance_is_closed_and_sound) {
  for (const Case& c : cases()) {
    for (const double tolerance : {1e-6, 0.02, 0.7}) {
      SCOPED_TRACE(c.name + ", tolerance " + std::to_string(tolerance));
      expect_sound(c.grid.mesh(tolerance));
      if (HasFailure()) return;
    }
  }
}

TEST(HeightMesh, tolerance_is_kept) {
  for (const Case& c : cases()) {
    const double film = count_holes(c.grid) > 0 ? double(kHoleFilmMm) : 0.0;
    const int step = c.grid.nx > 1 && c.grid.ny > 1 ? 1 : 2;
    for (const double tolerance : {1e-6, 0.02, 0.3, 5.0}) {
      SCOPED_TRACE(c.name + ", tolerance " + std::to_string(tolerance));
      EXPECT_LE(greatest_deviation(c.grid, c.grid.mesh(tolerance), step),
                tolerance + sampling_error(c.grid) + film);
    }
  }
}

TEST(HeightMesh, tolerance_is_kept_at_sizes_up_to_forty) {
  for (int nx = 1; nx <= 40; nx += 3) {
    for (int ny = 1; ny <= 40; ny += 2) {
      SCOPED_TRACE(std::to_string(nx) + "x" + std::to_string(ny));
      const TestGrid grid(nx, ny, noise(std::uint32_t(nx * 50 + ny), 0.3));
      const TriangleMesh mesh = grid.mesh(0.1);
      expect_sound(mesh);
      EXPECT_LE(greatest_deviation(grid, mesh, nx > 1 && ny > 1 ? 1 : 2),
                0.1 + sampling_error(grid));
      if (HasFailure()) return;
    }
  }
}

TEST(HeightMesh, tolerance_is_kept_where_it_nearly_suffices_for_large_triangles) {
  for (std::uint32_t seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Heights ripple = noise(seed * 31337, 1.0);
    const double bend = 0.04 * (seed % 4);
    const TestGrid grid(9 + int(seed % 3), 9, [&](int i, int j) {
      const int across = seed % 8 < 4 ? i + j - 8 : i - j;
      return ripple(i, j) + bend * across * across;
    });
    const double tolerance = 0.4 + 0.05 * (seed % 10);
    EXPECT_LE(greatest_deviation(grid, grid.mesh(tolerance), 1), tolerance + sampling_error(grid));
    if (HasFailure()) return;
  }
}

TEST(HeightMesh, walls_do_not_overlap) {
  // The sides of a grid without holes: height profiles carried on level to the corners.
  for (const double tolerance : {0.0, 1e-6}) {
    const TestGrid grid(40, 23, noise(11, 12.0));
    double expected = 0.0;
    for (int i = 0; i < grid.nx; ++i) {
      expected += 0.5 * (double(grid.at(i, 0)) + grid.at(i, grid.ny - 1) - 2 * TestGrid::kFloor);
    }
    for (int j = 0; j < grid.ny; ++j) {
      expected += 0.25 * (double(grid.at(0, j)) + grid.at(grid.nx - 1, j) - 2 * TestGrid::kFloor);
    }
    EXPECT_NEAR(wall_area(grid.mesh(tolerance)), expected, 1e-5 * expected);
  }
}

TEST(HeightMesh, plates_need_few_triangles) {
  const Heights flat = [](int, int) { return 3.0; };
  const Heights tilted = [](int i, int j) { return 3.0 + i / 128.0 + j / 64.0; };
  for (const auto& [nx, ny] : std::vector<std::pair<int, int>>{
           {1, 1}, {2, 2}, {1, 500}, {64, 64}, {500, 77}, {129, 129}}) {
    SCOPED_TRACE(std::to_string(nx) + "x" + std::to_string(ny));
    EXPECT_EQ(TestGrid(nx, ny, flat).mesh(1e-3).triangles.size(), 20u);
    EXPECT_LE(TestGrid(nx, ny, tilted).mesh(1e-3).triangles.size(), 40u);
  }
}

TEST(HeightMesh, greater_tolerance_needs_fewer_triangles) {
  const TestGrid grid(700, 531, waves());
  std::size_t before = grid.mesh(0.0).triangles.size();
  for (const double tolerance : {0.01, 0.1, 1.0}) {
    const TriangleMesh mesh = grid.mesh(tolerance);
    EXPECT_LT(mesh.triangles.size(), before / 2) << tolerance;
    EXPECT_LE(greatest_deviation(grid, mesh, 1), tolerance + sampling_error(grid));
    before = mesh.triangles.size();
  }
}

TEST(HeightMesh, far_from_a_hole_the_floor_is_coarse) {
  const TestGrid grid(257, 257,
                      with_holes([](int, int) { return 3.0; },
                                 [](int i, int j) { return std::hypot(i - 100, j - 90) < 10; }));
  const TriangleMesh mesh = grid.mesh(0.01);
  EXPECT_GT(mesh.triangles.size(), 500u);   // every cell around the hole
  EXPECT_LT(mesh.triangles.size(), 3000u);  // all cells: 264 000
}

// ---- Holes --------------------------------------------------------------------------------------

TEST(HeightMesh, without_material_is_empty) {
  for (const double tolerance : {0.0, 0.1}) {
    const TriangleMesh mesh = TestGrid(6, 4, [](int, int) { return -3.0; }).mesh(tolerance);
    EXPECT_TRUE(mesh.triangles.empty());
    EXPECT_TRUE(mesh.positions_mm.empty());
  }
}

TEST(HeightMesh, heights_below_the_floor_count_as_the_floor) {
  const auto is_hole = [](int i, int j) { return i / 3 == 1 && j / 3 == 1; };
  const TestGrid at_floor(12, 10, with_holes(waves(), is_hole));
  TestGrid below = at_floor;
  for (float& h : below.heights) h = h > float(TestGrid::kFloor) ? h : -50.0f;
  for (const double tolerance : {0.0, 0.1}) {
    EXPECT_TRUE(same_bits(at_floor.mesh(tolerance), below.mesh(tolerance)));
  }
}

TEST(HeightMesh, wide_hole_is_open_and_has_no_film) {
  const TestGrid grid(20, 20, with_holes(waves(), [](int i, int j) {
                        return i >= 5 && i < 12 && j >= 6 && j < 13;
                      }));
  for (const double tolerance : {0.0, 0.05}) {
    const TriangleMesh mesh = grid.mesh(tolerance);
    const float film_top = float(TestGrid::kFloor) + 2 * kHoleFilmMm;
    for (const glm::vec3& p : mesh.positions_mm) {
      EXPECT_TRUE(p.z == float(TestGrid::kFloor) || p.z > film_top);
    }
    // 6 x 6 squares between 7 x 7 centres have neither surface nor floor.
    double floor_area = 0.0;
    for (const auto& t : mesh.triangles) floor_area += std::max(0.0, -plan_area2(mesh, t)) / 2;
    EXPECT_NEAR(floor_area, (20 * 20 - 6 * 6) * grid.cell_area(), 1e-4);
  }
}

TEST(HeightMesh, narrow_slot_into_a_wide_hole_is_closed_up_to_the_hole) {
  const TestGrid grid(24, 24, with_holes(waves(), [](int i, int j) {
                        return (i >= 4 && i < 12 && j >= 6 && j < 13) ||
                               (j == 9 && i < 20 && i >= 4);
                      }));
  int films = 0;
  for (const glm::vec3& p : grid.mesh(0.0).positions_mm) {
    films += p.z > float(TestGrid::kFloor) && p.z < float(TestGrid::kFloor) + 2 * kHoleFilmMm;
  }
  EXPECT_GE(films, 6);
  EXPECT_LE(films, 8);
}

TEST(HeightMesh, film_is_thick_enough_far_from_the_origin) {
  TestGrid grid(9, 9,
                with_holes([](int, int) { return 20003.0; },
                           [](int i, int j) { return i == 4 && j > 2 && j < 7; }));
  Box bounds = grid.bounds();
  bounds.min.z = 20000.0;
  for (const double tolerance : {0.0, 0.1}) {
    const TriangleMesh mesh = mesh_height_grid({9, 9, bounds, grid.heights}, tolerance);
    EXPECT_TRUE(edges_pair_up(mesh, [&](std::uint32_t v) { return exact(mesh.positions_mm[v]); }));
  }
}

// ---- Threads ------------------------------------------------------------------------------------

TEST(HeightMesh, same_mesh_for_any_number_of_threads) {
  const Heights holes = with_holes(waves(), random_holes(5, 0.01));
  for (const Heights& heights : {waves(), noise(4, 0.2), holes}) {
    const TestGrid grid(700, 450, heights);
    for (const double tolerance : {0.0, 0.05}) {
      const TriangleMesh one = grid.mesh(tolerance, 1);
      for (const int threads : {2, 3, 7}) {
        EXPECT_TRUE(same_bits(one, grid.mesh(tolerance, threads))) << threads;
      }
    }
  }
}

}  // namespace
}  // namespace kerf
