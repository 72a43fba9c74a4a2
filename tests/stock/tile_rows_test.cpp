// Rows of a grid in tiles: one by one and several at once, sums over all of them.
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "stock/zmap/blank_grid.h"
#include "stock/zmap/tile_grid.h"

namespace kerf {
namespace {

/// Whole tiles, and what is left over along X, along Y, along both.
constexpr std::array<std::pair<int, int>, 5> kSizes = {
    {{128, 64}, {131, 70}, {64, 67}, {1, 1}, {127, 129}}};

TileGrid grid_of(int nx, int ny) {
  return TileGrid({{0, 0, -3}, {0.5 * nx, 0.25 * ny, 2}}, nx, ny);
}

std::size_t index(int i, int j, int nx) {
  return static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i);
}

/// Sets all heights, and returns them.
std::vector<float> fill(TileGrid& grid, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> height(-3, 2);
  std::vector<float> all(index(0, grid.ny(), grid.nx()));
  for (float& h : all) h = height(random);
  for (int j = 0; j < grid.ny(); ++j) grid.set_row(j, all.data() + index(0, j, grid.nx()));
  return all;
}

TEST(TileRows, AFreshGridIsAtItsFloor) {
  for (const auto& [nx, ny] : kSizes) {
    const TileGrid grid = grid_of(nx, ny);
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) ASSERT_EQ(grid.height(i, j), -3.0f) << i << " " << j;
    }
    // What pads the last tiles lies below any floor.
    if (nx % kTileCells != 0) {
      EXPECT_LT(grid.tile(nx / kTileCells, 0)[TileGrid::offset(nx, 0)], -1e30f);
    }
    if (ny % kTileCells != 0) {
      EXPECT_LT(grid.tile(0, ny / kTileCells)[TileGrid::offset(0, ny)], -1e30f);
    }
    EXPECT_EQ(volume_of(grid), 0);
  }
}

TEST(TileRows, RowsComeOutAsTheyWentIn) {
  for (const auto& [nx, ny] : kSizes) {
    TileGrid grid = grid_of(nx, ny);
    const std::vector<float> all = fill(grid, 7);
    std::vector<float> row(static_cast<std::size_t>(nx)), rows(kBlockY * row.size());
    for (int j = 0; j < ny; ++j) {
      grid.copy_row(j, row.data());
      for (int i = 0; i < nx; ++i) {
        ASSERT_EQ(row[static_cast<std::size_t>(i)], all[index(i, j, nx)]) << i << " " << j;
        ASSERT_EQ(grid.height(i, j), all[index(i, j, nx)]) << i << " " << j;
      }
    }
    for (int j = 0; j < ny; j += kBlockY) {
      rows.assign(rows.size(), -100.0f);
      grid.copy_rows(j, rows.data());
      for (int y = 0; y < kBlockY; ++y) {
        for (int i = 0; i < nx; ++i) {
          const float expected = j + y < ny ? all[index(i, j + y, nx)] : -100.0f;
          ASSERT_EQ(rows[index(i, y, nx)], expected) << i << " " << j + y;
        }
      }
    }
  }
}

TEST(TileRows, TheVolumeIsTheSumOfItsRowsToTheLastBit) {
  for (const auto& [nx, ny] : kSizes) {
    TileGrid grid = grid_of(nx, ny);
    const std::vector<float> all = fill(grid, 11);
    double sum = 0;
    for (int j = 0; j < ny; ++j) {
      double row = 0;
      for (int i = 0; i < nx; ++i) row += static_cast<double>(all[index(i, j, nx)]) + 3;
      sum += row;
    }
    EXPECT_EQ(volume_of(grid), sum * grid.cell_x_mm() * grid.cell_y_mm());
  }
}

TEST(TileRows, TheHashKnowsEachCell) {
  for (const auto& [nx, ny] : kSizes) {
    TileGrid grid = grid_of(nx, ny);
    std::vector<float> all = fill(grid, 13);
    const std::string before = hash_of(grid).text();
    float& last = all.back();
    last += 0.5f;
    grid.set_row(ny - 1, all.data() + index(0, ny - 1, nx));
    EXPECT_NE(hash_of(grid).text(), before);
    last -= 0.5f;
    grid.set_row(ny - 1, all.data() + index(0, ny - 1, nx));
    EXPECT_EQ(hash_of(grid).text(), before);
  }
}

}  // namespace
}  // namespace kerf
