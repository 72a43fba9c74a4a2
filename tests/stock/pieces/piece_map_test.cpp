// Pieces of models that are read in columns: closed forms, and a flood fill over all columns.
#include "stock/pieces/piece_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "stock/cutter/shape_spec.h"
#include "stock/octree/octree.h"
#include "stock/zmap/mmap/mmap.h"
#include "stock/zmap/zmap.h"
#include "tests/stock/stock_samples.h"

namespace kerf {
namespace {

using test::line;
using test::tool;

std::unique_ptr<StockModel> model(const std::string& name, const char* blank, double cell_mm) {
  if (name == "octree") {
    OctreeOptions options;
    options.blank = *parse_blank(blank);
    options.cell_mm = cell_mm;
    return std::move(*Octree::create(options));
  }
  ZMapOptions options;
  options.blank = *parse_blank(blank);
  options.cell_mm = cell_mm;
  if (name == "mmap") return std::move(*MMap::create(options));
  return std::move(*ZMap::create(options));
}

const ColumnSource& columns(const StockModel& stock) {
  return dynamic_cast<const ColumnSource&>(stock);
}

void cut(StockModel& stock, const Cutter& cutter, const CutMove& move) {
  std::vector<CutReport> reports;
  stock.cut(cutter, std::span(&move, 1), reports);
  stock.finish(reports);
}

std::vector<double> volumes(const PieceMap& map, double least_mm3) {
  std::vector<double> out;
  for (const PieceMap::Piece& piece : map.pieces())
    if (piece.mm3 >= least_mm3) out.push_back(piece.mm3);
  std::ranges::sort(out);
  return out;
}

class PieceMaps : public testing::TestWithParam<const char*> {};

TEST_P(PieceMaps, AnIslandIsOnePieceOfItsVolume) {
  const auto stock = model(GetParam(), "box:0,0,-10:60,60,0", 0.25);
  PieceMap map;
  EXPECT_TRUE(map.update(columns(*stock)).empty());
  ASSERT_EQ(map.pieces().size(), 1u);
  EXPECT_NEAR(map.pieces()[0].mm3, 36'000, 0.5);
  const Cutter cutter = tool("flat:6");
  const Vec3 corners[] = {{10, 10, -10.5}, {40, 10, -10.5}, {40, 40, -10.5}, {10, 40, -10.5}};
  std::vector<PieceMap::Parting> partings;
  for (int n = 0; n < 4; ++n) {
    EXPECT_TRUE(partings.empty());
    cut(*stock, cutter, line(corners[n], corners[(n + 1) % 4]));
    partings = map.update(columns(*stock));
  }
  ASSERT_EQ(partings.size(), 1u);
  EXPECT_EQ(partings[0].parent, 0u);
  const std::optional<std::uint32_t> island = map.piece_at({25, 25, -5}),
                                     frame = map.piece_at({2, 2, -5});
  ASSERT_TRUE(island && frame);
  EXPECT_NE(*island, *frame);
  EXPECT_FALSE(map.piece_at({10, 25, -5}));
  const PieceMap::Piece& piece = *map.find(*island);
  EXPECT_TRUE(piece.thick);
  EXPECT_NEAR(piece.mm3, 24 * 24 * 10, 0.5);
  for (int a = 0; a < 2; ++a) {
    EXPECT_NEAR(piece.box_mm.min[a], 13, 0.251);
    EXPECT_NEAR(piece.box_mm.max[a], 37, 0.251);
  }
  // Four round corners of 4.7 mm are 10 mm high: a tenth of a cell along them.
  EXPECT_NEAR(map.find(*frame)->mm3, stock->remaining_mm3() - piece.mm3, 4 * 4.7 * 10 * 0.025);
}

TEST_P(PieceMaps, AShelfThatIsUndercutFromBothSidesComesOff) {
  if (std::string(GetParam()) == "zmap") GTEST_SKIP() << "holds no undercuts";
  const auto stock = model(GetParam(), "box:0,0,0:40,10,20", 0.2);
  PieceMap map;
  map.update(columns(*stock));
  // A disc of 20 mm, 4 mm thick: from either side 6 mm deep, the neck of 6 mm stays outside.
  const Cutter cutter = tool("tslot:20:4:6");
  cut(*stock, cutter, line({-15, -4, 8}, {55, -4, 8}));
  EXPECT_TRUE(map.update(columns(*stock)).empty());
  EXPECT_EQ(volumes(map, 1).size(), 1u);
  cut(*stock, cutter, line({-15, 14, 8}, {55, 14, 8}));
  ASSERT_EQ(map.update(columns(*stock)).size(), 1u);
  // 8 mm are left above, 8 mm below.
  const std::vector<double> left = volumes(map, 1);
  ASSERT_EQ(left.size(), 2u);
  EXPECT_NEAR(left[0], 40 * 10 * 8, 3);
  EXPECT_NEAR(left[1], 40 * 10 * 8, 3);
  EXPECT_NE(map.piece_at({20, 5, 16}), map.piece_at({20, 5, 4}));
}

/// All columns at once, without tiles: volumes of what hangs together.
std::vector<double> flooded(const ColumnSource& source) {
  const ColumnLayout layout = source.column_layout();
  const int nx = layout.tiles[0] * layout.columns[0], ny = layout.tiles[1] * layout.columns[1];
  struct Run {
    int i, j;
    SolidRun z;
    bool seen = false;
  };
  std::vector<std::vector<std::size_t>> at(static_cast<std::size_t>(nx * ny));
  std::vector<Run> runs;
  ColumnRuns tile;
  for (int n = 0; n < layout.tiles[0] * layout.tiles[1] * layout.tiles[2]; ++n) {
    source.read_columns(static_cast<std::uint32_t>(n), tile);
    const int i0 = n % layout.tiles[0] * layout.columns[0];
    const int j0 = n / layout.tiles[0] % layout.tiles[1] * layout.columns[1];
    for (int j = 0; j < tile.ny; ++j) {
      for (int i = 0; i < tile.nx; ++i) {
        for (std::uint32_t r = tile.first[tile.column(i, j)]; r < tile.first[tile.column(i, j) + 1];
             ++r) {
          at[static_cast<std::size_t>((j0 + j) * nx + i0 + i)].push_back(runs.size());
          runs.push_back({i0 + i, j0 + j, tile.runs[r]});
        }
      }
    }
  }
  std::vector<double> out;
  for (std::size_t n = 0; n < runs.size(); ++n) {
    if (runs[n].seen) continue;
    std::vector<std::size_t> open{n};
    runs[n].seen = true;
    double sum = 0;
    while (!open.empty()) {
      const Run here = runs[open.back()];
      open.pop_back();
      sum +=
          layout.cell_mm.x * layout.cell_mm.y * static_cast<double>(here.z.high_mm - here.z.low_mm);
      for (int j = std::max(0, here.j - 1); j <= std::min(ny - 1, here.j + 1); ++j) {
        for (int i = std::max(0, here.i - 1); i <= std::min(nx - 1, here.i + 1); ++i) {
          for (const std::size_t m : at[static_cast<std::size_t>(j * nx + i)]) {
            Run& other = runs[m];
            if (other.seen) continue;
            const bool same = i == here.i && j == here.j;
            const bool touches =
                same ? other.z.low_mm == here.z.high_mm || other.z.high_mm == here.z.low_mm
                     : std::min(other.z.high_mm, here.z.high_mm) >
                           std::max(other.z.low_mm, here.z.low_mm);
            if (!touches) continue;
            other.seen = true;
            open.push_back(m);
          }
        }
      }
    }
    out.push_back(sum);
  }
  std::ranges::sort(out);
  return out;
}

TEST_P(PieceMaps, AgreesWithAFloodFillAfterEveryMove) {
  const std::string name = GetParam();
  std::size_t most = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937 random(seed);
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<>(low, high)(random);
    };
    const auto stock = model(name, "box:0,0,0:30,26,24", 0.4);
    const Cutter cutter = tool(name == "zmap" ? "ball:4" : "tslot:12:2:3");
    PieceMap map;
    map.update(columns(*stock));
    std::size_t partings = 0;
    for (int n = 0; n < 20; ++n) {
      const double z = name == "zmap" ? -1.5 : uniform(-1, 22);
      const bool along = n % 2 == 0;
      const double at = uniform(-6, 32);
      CutMove move = along ? line({-9, at, z}, {40, uniform(-6, 32), z})
                           : line({at, -9, z}, {uniform(-6, 32), 40, z});
      if (name == "octree") move.axis_from = move.axis_to = Vec3(0.6, 0, 0.8);
      cut(*stock, cutter, move);
      partings += map.update(columns(*stock)).size();
      const std::vector<double> truth = flooded(columns(*stock)), found = volumes(map, 0);
      ASSERT_EQ(truth.size(), found.size()) << "seed " << seed << " move " << n;
      for (std::size_t k = 0; k < truth.size(); ++k)
        ASSERT_NEAR(truth[k], found[k], 1e-6 + 1e-6 * truth[k]);
      double sum = 0;
      for (const double volume : found) sum += volume;
      // The model's own sum; a Z-map's by middles, an octree's is one of nodes and crossings.
      const auto* const zmap = dynamic_cast<const ZMap*>(stock.get());
      const double own = zmap ? test::volume_by_cells(*zmap) : stock->remaining_mm3();
      EXPECT_NEAR(sum, own, 0.01 * own + 2);
      most = std::max(most, found.size());
    }
    EXPECT_GT(partings, 0u);
  }
  EXPECT_GE(most, 4u);
}

INSTANTIATE_TEST_SUITE_P(Models, PieceMaps, testing::Values("zmap", "mmap", "octree"),
                         [](const auto& one) { return std::string(one.param); });

}  // namespace
}  // namespace kerf
