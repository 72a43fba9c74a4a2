// Which move cut where: against brute force over all moves, and what patches, points and snapshots
// tell of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <set>

#include "stock/zmap/sweep_ops.h"
#include "stock/zmap/tile_cut_ids.h"
#include "tests/stock/patch_samples.h"
#include "tests/stock/stock_samples.h"
#include "tests/stock/sweep_oracle.h"

namespace kerf {
namespace {

using test::cut;
using test::finish;
using test::line;
using test::make_map;
using test::random_path;
constexpr std::uint32_t kNotCut = MeshPatch::kNotCut;

std::unique_ptr<ZMap> make_tracking(const std::string& blank, double cell, int threads = 1) {
  auto map = make_map(blank, cell, threads);
  map->keep_cut_ids(true);
  EXPECT_TRUE(map->keeps_cut_ids());
  return map;
}

Vec3 centre_of(const ZMap& map, int i, int j) {
  const Box box = map.bounds_mm();
  return Vec3(box.min.x + (i + 0.5) * box.size().x / map.nx(),
              box.min.y + (j + 0.5) * box.size().y / map.ny(),
              static_cast<double>(map.height_mm(i, j)));
}

/// Of every cell, row by row.
std::vector<std::uint32_t> cut_ids(const ZMap& map) {
  std::vector<std::uint32_t> ids;
  for (int j = 0; j < map.ny(); ++j)
    for (int i = 0; i < map.nx(); ++i)
      ids.push_back(map.cut_id_at(centre_of(map, i, j)).value_or(kNotCut));
  return ids;
}

CutMove numbered(CutMove move, std::uint64_t id) {
  move.id = id;
  return move;
}

/// Everything about one patch at one vertex, to be looked up by its place.
struct Cells {
  const ZMap& map;
  double edge;
  explicit Cells(const ZMap& m) : map(m), edge(m.bounds_mm().size().x / m.nx()) {}
  bool in_grid(int i, int j) const { return i >= 0 && j >= 0 && i < map.nx() && j < map.ny(); }
  std::uint32_t id(int i, int j) const {
    return in_grid(i, j) ? map.cut_id_at(centre_of(map, i, j)).value_or(kNotCut) : kNotCut;
  }
};

TEST(CutIds, AreThoseOfBruteForce) {
  for (const char* shape : {"ball:4", "flat:3", "bull:5:1", "vee:6:60", "drill:5:118"}) {
    for (const unsigned seed : {1u, 2u}) {
      SCOPED_TRACE(testing::Message() << shape << " seed " << seed);
      const auto cutter = parse_shape(shape);
      ASSERT_TRUE(cutter) << cutter.error();
      const auto map = make_tracking("box:0,0,-10:20,16,0", 0.25, static_cast<int>(seed));
      std::mt19937 random(seed);
      const Box reach{Vec3(-1, -1, -8), Vec3(21, 17, 1)};
      const std::vector<CutMove> moves = random_path(random, reach, 60);
      cut(*map, *cutter, moves);
      finish(*map);
      int cut_cells = 0, uncut_cells = 0, unsure = 0;
      for (int j = 0; j < map->ny(); j += 2) {
        for (int i = 0; i < map->nx(); i += 2) {
          const Vec3 c = centre_of(*map, i, j);
          double lowest = 0, edge_distance = 1;
          std::vector<double> heights;
          for (const CutMove& move : moves) {
            const test::OracleHeight h = test::sweep_height(*cutter, move, c.x, c.y, 40);
            heights.push_back(h.z);
            lowest = std::min(lowest, h.z);
            edge_distance = std::min(edge_distance, h.edge_distance);
          }
          if (edge_distance < 1e-5 || (lowest < 0 && lowest > -1e-4)) {
            ++unsure;
            continue;
          }
          const auto id = map->cut_id_at(c);
          ASSERT_EQ(id.has_value(), lowest < 0) << i << " " << j;
          if (!id) {
            ++uncut_cells;
            continue;
          }
          ++cut_cells;
          ASSERT_LT(*id, moves.size());
          EXPECT_NEAR(heights[*id], lowest, 1e-4) << i << " " << j << " move " << *id;
        }
      }
      EXPECT_GT(cut_cells, 100);
      EXPECT_GT(uncut_cells, 20);
      EXPECT_LT(unsure, 100);
    }
  }
}

TEST(CutIds, OfEquallyDeepMovesTheFirstKeepsTheCell) {
  // Two parts of the cutter (a drill's cone and its rim) and one: neither may let a later one win.
  for (const char* shape : {"flat:4", "drill:5:118", "bull:5:1"}) {
    SCOPED_TRACE(shape);
    const auto cutter = parse_shape(shape);
    for (const std::size_t at_once : {std::size_t{1}, std::size_t{4}}) {
      const auto map = make_tracking("box:0,0,-10:40,20,0", 0.25);
      const std::vector<CutMove> moves{numbered(line(Vec3(5, 10, -2), Vec3(25, 10, -2)), 7),
                                       numbered(line(Vec3(25, 10, -2), Vec3(15, 10, -2)), 8),
                                       numbered(line(Vec3(15, 10, -2), Vec3(35, 10, -2)), 9),
                                       numbered(line(Vec3(35, 10, -2), Vec3(5, 10, -2)), 10)};
      std::vector<CutReport> reports;
      for (std::size_t i = 0; i < moves.size(); i += at_once)
        map->cut(*cutter, std::span(moves).subspan(i, at_once), reports);
      map->finish(reports);
      const auto along = [&](double x) { return map->cut_id_at(Vec3(x, 10.1, -2)); };
      EXPECT_EQ(along(10), 7u);
      EXPECT_EQ(along(20), 7u);
      EXPECT_EQ(along(30), 9u);
      const std::vector<std::uint32_t> ids = cut_ids(*map);
      EXPECT_EQ((std::set<std::uint32_t>(ids.begin(), ids.end())),
                (std::set<std::uint32_t>{7, 9, kNotCut}));
    }
  }
}

TEST(CutIds, DoNotDependOnCallsThreadsOrKernel) {
  for (const char* shape : {"ball:4", "drill:5:118", "bull:6:1"}) {
    SCOPED_TRACE(shape);
    const auto cutter = parse_shape(shape);
    std::mt19937 random(77);
    const std::vector<CutMove> moves =
        random_path(random, {Vec3(-1, -1, -9), Vec3(31, 26, 1)}, 1500);
    std::vector<std::uint32_t> expected;
    std::string digest;
    std::uniform_int_distribution<std::size_t> some(1, 90);
    const std::vector<ZMapKernel> kernels = zmap_kernels();
    const int variants = 4 + static_cast<int>(kernels.size());
    for (int variant = 0; variant < variants; ++variant) {
      SCOPED_TRACE(variant);
      ZMapOptions options;
      options.blank = *parse_blank("box:0,0,-10:30,25,0");
      options.cell_mm = 0.15;
      options.threads = variant == 2 ? 3 : 1;
      if (variant >= 4) options.kernel = kernels[static_cast<std::size_t>(variant - 4)];
      const std::unique_ptr<ZMap> map = std::move(*ZMap::create(options));
      map->keep_cut_ids(variant != 3);
      std::vector<CutReport> reports;
      for (std::size_t i = 0; i < moves.size();) {
        const std::size_t count =
            std::min(variant == 0 ? moves.size() : some(random), moves.size() - i);
        map->cut(*cutter, std::span(moves).subspan(i, count), reports);
        i += count;
        if (variant == 1) map->snapshot();
      }
      map->finish(reports);
      ASSERT_EQ(reports.size(), moves.size());
      if (variant == 0) {
        expected = cut_ids(*map);
        digest = map->digest();
        EXPECT_GT(std::set<std::uint32_t>(expected.begin(), expected.end()).size(), 100u);
        continue;
      }
      EXPECT_EQ(map->digest(), digest);  // without ids as well
      if (variant == 3) {
        EXPECT_TRUE(map->patch(0, 0).cut_by.empty());
        EXPECT_EQ(map->cut_id_at(centre_of(*map, 80, 80)), std::nullopt);
      } else {
        EXPECT_EQ(cut_ids(*map), expected);
      }
    }
  }
}

TEST(CutIds, LargeNumbersOfMovesNeverLookUncut) {
  const auto map = make_tracking("box:0,0,-10:20,20,0", 0.5);
  const auto cutter = parse_shape("flat:4");
  cut(*map, *cutter,
      {numbered(line(Vec3(5, 5, -1), Vec3(15, 5, -1)), 0xffff'fffd),
       numbered(line(Vec3(5, 10, -1), Vec3(15, 10, -1)), 0xffff'ffff),
       numbered(line(Vec3(5, 15, -1), Vec3(15, 15, -1)), 0x7'0000'0001)});
  finish(*map);
  EXPECT_EQ(map->cut_id_at(Vec3(10, 5.1, -1)), 0xffff'fffdu);
  EXPECT_EQ(map->cut_id_at(Vec3(10, 10.1, -1)), 0xffff'fffeu);
  EXPECT_EQ(map->cut_id_at(Vec3(10, 15.1, -1)), 0xffff'fffeu);
}

TEST(CutIds, OfAPointOnAWallIsTheOneThatCutTheLowerSide) {
  const auto map = make_tracking("box:0,0,-10:20,20,0", 0.5);
  const auto cutter = parse_shape("flat:4");
  // A groove with a deeper one in its middle, and one through the blank's side; walls at y 8, 12.
  cut(*map, *cutter,
      {numbered(line(Vec3(-5, 10, -2), Vec3(25, 10, -2)), 1),
       numbered(line(Vec3(10, 10, 3), Vec3(10, 10, -5)), 2),
       numbered(line(Vec3(10, 10, 5), Vec3(10, 0, 5)), 3),
       numbered(line(Vec3(3, 25, -3), Vec3(3, 16, -3)), 4)});
  finish(*map);
  const auto id = [&](double x, double y, double z) { return map->cut_id_at(Vec3(x, y, z)); };
  for (const double off : {-1e-4, 0.0, 1e-4}) {
    SCOPED_TRACE(off);
    EXPECT_EQ(id(5.2, 8 + off, -1), 1u);
    EXPECT_EQ(id(5.2, 12 + off, -1), 1u);
    EXPECT_EQ(id(10.2, 8 + off, -3), 2u);
    EXPECT_EQ(id(3.2, 14 + off, -1.5), 4u);
    EXPECT_EQ(id(off, 10.2, -6), std::nullopt);  // the blank's side below the groove
    EXPECT_EQ(id(off, 3.2, -6), std::nullopt);   // and where nothing was cut
    EXPECT_EQ(id(20 + off, 10.2, -6), std::nullopt);
    EXPECT_EQ(id(off, 10.2, -2), 1u);  // its floor up to the very end
  }
  EXPECT_EQ(id(10.2, 10.2, -5), 2u);
  EXPECT_EQ(id(5.2, 5.2, 0), std::nullopt);
  EXPECT_EQ(id(5.2, 9, -2), 1u);
  EXPECT_EQ(id(-3, 10, -2), std::nullopt);
  EXPECT_EQ(id(5, 40, -2), std::nullopt);
  EXPECT_EQ(id(-1e30, 1e30, 0), std::nullopt);
}

/// At every vertex: the number is that of a cell at this corner whose height fits; on a wall of the
/// lower one; on the blank's sides and floor none.
TEST(CutIds, OfPatchesAreThoseOfTheCellsAtEachVertex) {
  const auto map = make_tracking("box:0,0,-10:30,25,0", 0.2);
  std::mt19937 random(5);
  const Box reach{Vec3(-1, -1, -9), Vec3(31, 26, 1)};
  cut(*map, *parse_shape("flat:5"), random_path(random, reach, 60));
  std::vector<CutMove> more = random_path(random, reach, 150);
  for (CutMove& move : more) move.id += 1000;
  cut(*map, *parse_shape("ball:4"), more);
  finish(*map);
  const Cells cells(*map);
  std::set<std::uint32_t> seen;
  int tops = 0, steep = 0, walls = 0, sides = 0;
  for (std::uint32_t tile = 0; tile < map->tile_count(); ++tile) {
    const MeshPatch patch = map->patch(tile, 0);
    ASSERT_EQ(patch.cut_by.size(), patch.vertices.size());
    EXPECT_EQ(patch.bytes(), 20 * patch.vertices.size() + 4 * patch.indices.size());
    for (std::size_t n = 0; n < test::surface_vertices(patch).size(); ++n) {
      const Vec3 p(patch.vertices[n].position_mm);
      const float up = unpack_normal(patch.vertices[n].normal).z;
      const std::uint32_t id = patch.cut_by[n];
      seen.insert(id);
      if (up < -0.5f) {
        EXPECT_EQ(id, kNotCut);
        continue;
      }
      const int i = static_cast<int>(std::lround(p.x / cells.edge));
      const int j = static_cast<int>(std::lround(p.y / cells.edge));
      std::set<std::uint32_t> about;
      for (const auto& [u, v] : {std::pair{i - 1, j - 1}, {i, j - 1}, {i, j}, {i - 1, j}})
        about.insert(cells.id(u, v));
      EXPECT_TRUE(about.count(id)) << "tile " << tile << " vertex " << n;
      const bool on_side = i == 0 || j == 0 || i == map->nx() || j == map->ny();
      if (up > 0.5f) {
        ++tops;
      } else if (up > 0.01f) {
        ++steep;
      } else if (on_side) {
        ++sides;
      } else {
        ++walls;
        EXPECT_NE(id, kNotCut);  // in a box every wall within has been cut
      }
    }
  }
  EXPECT_GT(tops, 10000);
  EXPECT_GT(steep, 100);
  EXPECT_GT(walls, 1000);
  EXPECT_GT(sides, 400);
  EXPECT_GT(seen.size(), 50u);
}

/// Heights with many equals among them, in a grid that ends within its last tiles.
TEST(CutIds, OfJoinedCellsAreThoseOfTheFirstOfTheLowest) {
  constexpr int kX = 150, kY = 131;
  TileGrid grid({Vec3(0, 0, -10), Vec3(kX, kY, 0)}, kX, kY);
  grid.keep_cut_ids(true);
  std::mt19937 random(3);
  grid.begin_change();
  for (std::size_t tile = 0; tile < grid.tile_count(); ++tile) {
    float* const heights = grid.make_writable(tile);
    for (std::size_t k = 0; k < kTileFloats; ++k) {
      heights[k] = -static_cast<float>(random() % 6);
      cut_ids_of(heights)[k] = static_cast<std::uint32_t>(random());
    }
  }
  const auto expected = [&](int i0, int j0, int span) {
    std::uint32_t id = kNotCut;
    float lowest = 1;
    for (int j = std::max(0, j0); j < std::min(kY, j0 + span); ++j) {
      for (int i = std::max(0, i0); i < std::min(kX, i0 + span); ++i) {
        if (grid.height(i, j) >= lowest) continue;
        lowest = grid.height(i, j);
        id = grid.cut_id(i, j);
      }
    }
    return id;
  };
  for (std::size_t tile = 0; tile < grid.tile_count(); ++tile) {
    const int i0 = static_cast<int>(tile) % grid.tiles_x() * kTileCells;
    const int j0 = static_cast<int>(tile) / grid.tiles_x() * kTileCells;
    for (int level = 0; level < StockModel::kPatchLevels; ++level) {
      const TileCutIds ids(grid, tile, level);
      const int span = 1 << level, cells = kTileCells >> level;
      for (int j = -1; j <= cells; ++j) {
        for (int i = -1; i <= cells; ++i) {
          ASSERT_EQ(ids.of(TileRelief::slot(i, j)), expected(i0 + i * span, j0 + j * span, span))
              << "tile " << tile << " level " << level << " cell " << i << ' ' << j;
        }
      }
    }
  }
}

TEST(CutIds, OfPatchesAgreeAcrossTilesAndWithPoints) {
  const auto map = make_tracking("box:0,0,-10:30,25,0", 0.2);
  std::mt19937 random(15);
  cut(*map, *parse_shape("ball:4"), random_path(random, {Vec3(-1, -1, -9), Vec3(31, 26, 1)}, 200));
  finish(*map);
  for (int level = 0; level < StockModel::kPatchLevels; ++level) {
    SCOPED_TRACE(level);
    std::map<std::array<float, 3>, std::uint32_t> at;
    int shared = 0, points = 0, agree = 0;
    for (std::uint32_t tile = 0; tile < map->tile_count(); ++tile) {
      const MeshPatch patch = map->patch(tile, level);
      std::set<std::array<float, 3>> mine;
      for (std::size_t n = 0; n < test::surface_vertices(patch).size(); ++n) {
        const glm::vec3 p = patch.vertices[n].position_mm;
        if (unpack_normal(patch.vertices[n].normal).z < 0.5f || p.z <= -10) continue;
        const std::array<float, 3> key{p.x, p.y, p.z};
        if (!mine.insert(key).second) continue;
        const auto [found, fresh] = at.insert({key, patch.cut_by[n]});
        shared += !fresh;
        EXPECT_EQ(found->second, patch.cut_by[n]);
      }
      // Triangles cut by one move throughout: so is the surface within.
      const auto indices = patch.surface_indices();
      for (std::size_t n = 0; level == 0 && n < indices.size(); n += 3) {
        const std::uint32_t id = patch.cut_by[indices[n]];
        if (id != patch.cut_by[indices[n + 1]] || id != patch.cut_by[indices[n + 2]]) continue;
        const glm::vec3 middle =
            (patch.vertices[indices[n]].position_mm + patch.vertices[indices[n + 1]].position_mm +
             patch.vertices[indices[n + 2]].position_mm) /
            3.0f;
        ++points;
        agree += map->cut_id_at(Vec3(middle)).value_or(kNotCut) == id;
      }
    }
    EXPECT_GT(shared, 100 >> level);
    if (level > 0) continue;
    EXPECT_GT(points, 10000);
    EXPECT_GT(agree, 0.97 * points);
  }
}

TEST(CutIds, CoarseLevelsShowTheMoveOfTheirLowestCell) {
  const auto map = make_tracking("box:0,0,-10:12.8,12.8,0", 0.1);
  const auto cutter = parse_shape("flat:0.1");
  cut(*map, *parse_shape("flat:40"), {numbered(line(Vec3(0, 6, -1), Vec3(13, 6, -1)), 1)});
  cut(*map, *cutter, {numbered(line(Vec3(-1, 6.45, -3), Vec3(14, 6.45, -3)), 2)});
  finish(*map);
  for (int level = 0; level < StockModel::kPatchLevels; ++level) {
    std::set<float> deep, wall;
    for (const std::uint32_t tile : {2u, 3u}) {
      const MeshPatch patch = map->patch(tile, level);
      for (std::size_t n = 0; n < test::surface_vertices(patch).size(); ++n) {
        const MeshVertex& v = patch.vertices[n];
        const bool is_top = unpack_normal(v.normal).z > 0.5f;
        if (is_top && v.position_mm.z == -3) {
          deep.insert(v.position_mm.y);
          EXPECT_EQ(patch.cut_by[n], 2u);
        }
        if (is_top && v.position_mm.z == -1) {
          EXPECT_EQ(patch.cut_by[n], 1u);
        }
      }
    }
    EXPECT_EQ(deep.size(), 2u) << level;  // both sides of the slot
  }
}

TEST(CutIds, SnapshotsShareAndKeepThem) {
  const std::size_t tile_bytes = 2 * kTileFloats * sizeof(float);
  const auto map = make_tracking("box:0,0,-10:40,30,0", 0.2, 2);
  EXPECT_EQ(map->unique_bytes(), tile_bytes);  // of the 4 x 3 tiles that in the corner alone
  const auto cutter = parse_shape("ball:4");
  std::mt19937 random(31);
  const Box reach{Vec3(0, 0, -9), Vec3(40, 30, 1)};
  struct Held {
    std::unique_ptr<StockModel> model;
    std::vector<std::uint32_t> ids;
  };
  const auto ids = [](const StockModel& m) { return cut_ids(dynamic_cast<const ZMap&>(m)); };
  std::vector<Held> held;
  std::uint64_t next_id = 0;
  for (int step = 0; step < 60; ++step) {
    std::vector<CutMove> moves = random_path(random, reach, 3);
    for (CutMove& move : moves) move.id = next_id++;
    cut(*map, *cutter, moves);
    if (step % 3 == 0) finish(*map);
    if (step % 4 == 0) {
      held.push_back({map->snapshot(), {}});
      EXPECT_TRUE(held.back().model->keeps_cut_ids());
      held.back().ids = ids(*held.back().model);
    }
    if (step % 10 == 9) {  // one of them goes its own way
      Held& one = held[random() % held.size()];
      moves[0].id = 1'000'000 + static_cast<std::uint64_t>(step);
      cut(*one.model, *cutter, {moves[0]});
      finish(*one.model);
      one.ids = ids(*one.model);
    }
    if (held.size() > 6) held.erase(held.begin() + 2);
  }
  for (const Held& one : held) EXPECT_EQ(ids(*one.model), one.ids);
  held.clear();
  finish(*map);
  const auto frame = map->snapshot();
  EXPECT_EQ(frame->unique_bytes(), 0u);
  cut(*map, *cutter, {line(Vec3(3, 3, -9.5), Vec3(4, 3, -9.5))});
  finish(*map);
  EXPECT_EQ(map->differing_tiles(*frame).size(), 1u);
  // And where its walls stand.
  EXPECT_GE(frame->unique_bytes(), tile_bytes);
  EXPECT_LE(frame->unique_bytes(), tile_bytes * 5 / 4);
}

TEST(CutIds, SwitchedOnLaterCountFromThenOnAndLeaveSnapshotsAlone) {
  const auto map = make_map("box:0,0,-10:40,30,0", 0.2);
  const auto cutter = parse_shape("flat:4");
  cut(*map, *cutter, {numbered(line(Vec3(5, 5, -2), Vec3(35, 5, -2)), 1)});
  finish(*map);
  EXPECT_FALSE(map->keeps_cut_ids());
  const auto before = map->snapshot();
  const std::string digest = map->digest();
  const std::uint64_t version = map->patch_version(2);
  map->keep_cut_ids(true);
  EXPECT_EQ(map->digest(), digest);
  EXPECT_NE(map->patch_version(2), version);
  EXPECT_FALSE(before->keeps_cut_ids());
  EXPECT_EQ(before->digest(), digest);
  EXPECT_EQ(map->differing_tiles(*before), std::vector<std::uint32_t>{});
  EXPECT_EQ(map->cut_id_at(Vec3(20, 5.1, -2)), std::nullopt);
  cut(*map, *cutter, {numbered(line(Vec3(20, 5, -3), Vec3(35, 5, -3)), 2)});
  finish(*map);
  EXPECT_EQ(map->cut_id_at(Vec3(30, 5.1, -3)), 2u);
  EXPECT_EQ(map->cut_id_at(Vec3(10, 5.1, -2)), std::nullopt);
  const auto with = map->snapshot();
  map->keep_cut_ids(false);
  EXPECT_TRUE(map->patch(0, 0).cut_by.empty());
  EXPECT_EQ(map->cut_id_at(Vec3(30, 5.1, -3)), std::nullopt);
  EXPECT_EQ(with->cut_id_at(Vec3(30, 5.1, -3)), 2u);
  // The slot, 30 mm long and 4 mm wide, is in tiles of 12.8 mm: three of them side by side.
  EXPECT_GE(map->unique_bytes(), 3 * kTileFloats * sizeof(float));
  EXPECT_LT(map->unique_bytes(), 5 * kTileFloats * sizeof(float));
  EXPECT_EQ(map->digest(), with->digest());
}

}  // namespace
}  // namespace kerf
