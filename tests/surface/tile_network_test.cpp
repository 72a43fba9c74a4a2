#include "surface/tile_network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace kerf {
namespace {

constexpr int kCells = TileNetwork::kCells;
using Lattice = TileNetwork::Lattice;
using Corner = TileNetwork::Corner;

template <class Height>
std::unique_ptr<Lattice> lattice_of(const Height& z, bool rising = true) {
  auto lattice = std::make_unique<Lattice>();
  lattice->cell.fill(TileNetwork::Cell::kFree);
  for (int j = 0; j <= kCells; ++j)
    for (int i = 0; i <= kCells; ++i)
      lattice->z[Lattice::corner(i, j)] = static_cast<float>(z(i, j));
  for (int j = 0; j < kCells; ++j) {
    for (int i = 0; i < kCells; ++i) {
      const auto at = [&](int di, int dj) { return lattice->z[Lattice::corner(i + di, j + dj)]; };
      lattice->middle[Lattice::at(i, j)] = (rising ? at(0, 0) + at(1, 1) : at(1, 0) + at(0, 1)) / 2;
    }
  }
  return lattice;
}

struct Pieces {
  std::vector<std::array<Corner, 3>> triangles;
  std::vector<Corner> cells;
  double area = 0;  ///< in cells
};

Pieces pieces_of(const TileNetwork& network) {
  Pieces out;
  network.each([](int, int) { return false; },
               [&](int i, int j) {
                 out.cells.push_back({i, j});
                 out.area += 1;
               },
               [&](const Corner& a, const Corner& b, const Corner& c) {
                 out.triangles.push_back({a, b, c});
                 const int twice = (b.i - a.i) * (c.j - a.j) - (b.j - a.j) * (c.i - a.i);
                 EXPECT_GT(twice, 0) << "not counter-clockwise";
                 out.area += twice / 2.0;
               });
  return out;
}

/// Covers the tile once; within it each edge has two sides.
void expect_whole(const Pieces& pieces) {
  EXPECT_EQ(pieces.area, kCells * kCells);
  std::map<std::array<int, 4>, int> sides;
  const auto add = [&](const Corner& a, const Corner& b) {
    const bool forward = std::pair(a.i, a.j) < std::pair(b.i, b.j);
    const Corner& low = forward ? a : b;
    const Corner& high = forward ? b : a;
    sides[{low.i, low.j, high.i, high.j}] += forward ? 1 : -1;
  };
  for (const auto& [a, b, c] : pieces.triangles) add(a, b), add(b, c), add(c, a);
  for (const auto& [i, j] : pieces.cells) {
    add({i, j}, {i + 1, j}), add({i + 1, j}, {i + 1, j + 1});
    add({i + 1, j + 1}, {i, j + 1}), add({i, j + 1}, {i, j});
  }
  for (const auto& [edge, count] : sides) {
    const auto [i, j, k, l] = edge;
    const bool is_rim = (i == k && i % kCells == 0) || (j == l && j % kCells == 0);
    EXPECT_EQ(std::abs(count), is_rim ? 1 : 0) << i << ',' << j << ' ' << k << ',' << l;
  }
}

/// Of the triangles from the full surface: at every corner of a cell, and in the middle of every
/// one, that each has.
double farthest(const Lattice& lattice, const Pieces& pieces) {
  double worst = 0;
  for (const auto& corners : pieces.triangles) {
    const Corner a = corners[0], b = corners[1], c = corners[2];
    const double twice = (b.i - a.i) * (c.j - a.j) - (b.j - a.j) * (c.i - a.i);
    const auto z = [&](const Corner& at) {
      return static_cast<double>(lattice.z[Lattice::corner(at.i, at.j)]);
    };
    const auto look = [&](double x, double y, double full) {
      const double of_a = ((b.i - x) * (c.j - y) - (b.j - y) * (c.i - x)) / twice;
      const double of_b = ((c.i - x) * (a.j - y) - (c.j - y) * (a.i - x)) / twice;
      const double of_c = 1 - of_a - of_b;
      if (std::min({of_a, of_b, of_c}) < -1e-9) return;
      worst = std::max(worst, std::abs(of_a * z(a) + of_b * z(b) + of_c * z(c) - full));
    };
    for (int j = 0; j <= kCells; ++j) {
      for (int i = 0; i <= kCells; ++i) {
        look(i, j, z({i, j}));
        if (i < kCells && j < kCells)
          look(i + 0.5, j + 0.5, static_cast<double>(lattice.middle[Lattice::at(i, j)]));
      }
    }
  }
  return worst;
}

TEST(TileNetwork, APlaneIsTwoTriangles) {
  const auto plane = lattice_of([](int i, int j) { return 3 + 0.25 * i - 0.125 * j; });
  const Pieces pieces = pieces_of(TileNetwork(*plane, 1e-4f));
  EXPECT_EQ(pieces.triangles.size(), 2u);
  EXPECT_EQ(pieces.area, kCells * kCells);
}

/// One corner 1 mm high: it is there, and a step of triangles leads to it. 64 cells are halved
/// six times on the way to any corner.
TEST(TileNetwork, KeepsASinglePeak) {
  const auto peak = lattice_of([](int i, int j) { return i == 21 && j == 40 ? 1.0 : 0.0; });
  const TileNetwork network(*peak, 0.01f);
  EXPECT_TRUE(network.needs(21, 40));
  const Pieces pieces = pieces_of(network);
  EXPECT_LT(pieces.triangles.size() + 2 * pieces.cells.size(), 150u);
  expect_whole(pieces);
  EXPECT_LE(farthest(*peak, pieces), 0.01);
}

TEST(TileNetwork, IsNowhereFartherThanItMayBe) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int n = 0; n < 6; ++n) {
    const double ax = any(random), ay = any(random), bx = any(random), noise = n < 3 ? 0.002 : 0;
    const auto lattice = lattice_of(
        [&](int i, int j) {
          return 0.4 * std::sin(0.1 * (ax * i + ay * j)) + 0.1 * std::sin(0.17 * (i + bx * j)) +
                 noise * any(random);
        },
        n % 2 == 0);
    for (const float most : {0.003f, 0.02f, 0.1f}) {
      const Pieces pieces = pieces_of(TileNetwork(*lattice, most));
      expect_whole(pieces);
      const double off = farthest(*lattice, pieces);
      EXPECT_LE(off, static_cast<double>(most) + 1e-6) << n;
      EXPECT_GT(off, 0.3 * static_cast<double>(most)) << n;  // it makes use of what it may
    }
  }
}

TEST(TileNetwork, CellsThatAreKeptStayWhole) {
  const auto lattice = lattice_of([](int, int) { return 0.0; });
  for (const auto& [i, j] : {Corner{0, 0}, Corner{31, 32}, Corner{63, 17}})
    lattice->cell[Lattice::at(i, j)] = TileNetwork::Cell::kKept;
  const Pieces pieces = pieces_of(TileNetwork(*lattice, 1));
  for (const Corner& kept : {Corner{0, 0}, Corner{31, 32}, Corner{63, 17}}) {
    EXPECT_TRUE(std::ranges::any_of(
        pieces.cells, [&](const Corner& at) { return at.i == kept.i && at.j == kept.j; }));
  }
  EXPECT_EQ(pieces.area, kCells * kCells);
}

TEST(TileNetwork, TakesARimFromItsNeighbour) {
  const auto flat = lattice_of([](int, int) { return 0.0; });
  TileNetwork network(*flat, 0.01f);
  EXPECT_EQ(network.rim(TileNetwork::Side::kRight), 0u);
  const std::uint64_t wanted = std::uint64_t{1} << 13;
  EXPECT_TRUE(network.add_rim(TileNetwork::Side::kRight, wanted));
  // 13 lies between 12 and 14, that between 12 and 16, that between 8 and 16 ..
  const std::uint64_t all = wanted | std::uint64_t{1} << 14 | std::uint64_t{1} << 12 |
                            std::uint64_t{1} << 8 | std::uint64_t{1} << 16 | std::uint64_t{1} << 32;
  EXPECT_EQ(network.rim(TileNetwork::Side::kRight) & all, all);
  EXPECT_EQ(network.rim(TileNetwork::Side::kRight) >> 33, 0u);  // nothing of the other half
  expect_whole(pieces_of(network));
  EXPECT_FALSE(network.add_rim(TileNetwork::Side::kRight, wanted));
  EXPECT_EQ(network.rim(TileNetwork::Side::kLeft), 0u);
}

}  // namespace
}  // namespace kerf
