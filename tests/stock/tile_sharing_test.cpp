// Dirty tiles and snapshots of the Z-map against plain copies of its heights.
#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

#include "stock/zmap/sweep_ops.h"
#include "tests/stock/stock_samples.h"

namespace kerf {
namespace {

using test::cut;
using test::finish;
using test::line;
using test::make_map;
using test::random_path;
using Tiles = std::vector<std::uint32_t>;

/// Tiles whose heights differ, cell by cell.
Tiles changed_tiles(const ZMap& map, const std::vector<float>& before,
                    const std::vector<float>& after) {
  const int tiles_x = (map.nx() + kTileCells - 1) / kTileCells;
  std::set<std::uint32_t> changed;
  for (std::size_t n = 0; n < before.size(); ++n) {
    if (before[n] == after[n]) continue;
    const int i = static_cast<int>(n) % map.nx(), j = static_cast<int>(n) / map.nx();
    changed.insert(static_cast<std::uint32_t>(j / kTileCells * tiles_x + i / kTileCells));
  }
  return {changed.begin(), changed.end()};
}

Tiles all_tiles(const StockModel& map) {
  Tiles tiles;
  for (std::uint32_t i = 0; i < map.tile_count(); ++i) tiles.push_back(i);
  return tiles;
}

bool same_patch(const MeshPatch& a, const MeshPatch& b) {
  const auto same_vertex = [](const MeshVertex& v, const MeshVertex& w) {
    return v.position_mm == w.position_mm && v.normal == w.normal;
  };
  return a.indices == b.indices && a.skirt_begin == b.skirt_begin &&
         std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
                    same_vertex);
}

TEST(ZMapTiles, BoxesCoverTheBlank) {
  const auto map = make_map("box:1,2,-5:31,19.3,0", 0.1);
  ASSERT_EQ(map->tile_count(), 5u * 3u);
  double area = 0;
  Box sum;
  for (std::uint32_t i = 0; i < map->tile_count(); ++i) {
    const Box box = map->tile_box(i);
    area += box.size().x * box.size().y;
    sum.extend(box);
    EXPECT_EQ(box.min.z, -5);
    EXPECT_EQ(box.max.z, 0);
  }
  EXPECT_NEAR(area, 30 * 17.3, 1e-9);
  EXPECT_EQ(sum, map->bounds_mm());
  EXPECT_NEAR(map->tile_box(6).min.x, 1 + 6.4, 1e-9);
}

TEST(ZMapDirtyTiles, AreExactlyThoseWhoseHeightsChanged) {
  for (const int threads : {1, 3}) {
    const auto map = make_map("box:0,0,-10:60,40,0", 0.1, threads);
    const auto cutter = parse_shape("ball:3");
    std::mt19937 random(7);
    const Box reach{Vec3(-3, -3, -9), Vec3(63, 43, 2)};
    EXPECT_EQ(map->take_dirty_tiles(), all_tiles(*map));
    EXPECT_EQ(map->take_dirty_tiles(), Tiles{});
    std::vector<float> before = map->heights_mm();
    std::size_t dirty_tiles = 0, quiet = 0;
    for (int round = 0; round < 60; ++round) {
      cut(*map, *cutter, random_path(random, reach, 12));
      if (round % 4 == 0) finish(*map);
      const std::vector<float> after = map->heights_mm();
      const Tiles expected = changed_tiles(*map, before, after);
      EXPECT_EQ(map->take_dirty_tiles(), expected) << round;
      dirty_tiles += expected.size();
      before = after;
      // Once more the same way: nothing changes, although every tile is visited.
      if (round % 10 == 9) {
        cut(*map, *cutter, {line(Vec3(0, 20, 5), Vec3(60, 20, 5))});
        finish(*map);
        before = map->heights_mm();
        map->take_dirty_tiles();
        cut(*map, *cutter, {line(Vec3(60, 20, 5), Vec3(0, 20, 5))});
        finish(*map);
        const std::uint64_t version = map->patch_version(20);
        EXPECT_EQ(map->take_dirty_tiles(), Tiles{});
        const std::uint64_t settled = map->patch_version(20);
        quiet += version != settled;
      }
    }
    EXPECT_GT(dirty_tiles, 100u);
    EXPECT_LT(dirty_tiles, 60 * map->tile_count() / 2);
    EXPECT_GT(quiet, 0u);  // the versions of tiles that were visited in vain are taken back
  }
}

TEST(ZMapDirtyTiles, EqualPatchVersionsMeanEqualPatches) {
  const auto map = make_map("box:0,0,-10:40,40,0", 0.1);
  const auto cutter = parse_shape("bull:3:0.5");
  std::mt19937 random(19);
  const Box reach{Vec3(0, 0, -9), Vec3(40, 40, 1)};
  std::vector<std::unique_ptr<StockModel>> snapshots;
  for (int round = 0; round < 12; ++round) {
    cut(*map, *cutter, random_path(random, reach, 5));
    map->take_dirty_tiles();
    snapshots.push_back(map->snapshot());
  }
  int same = 0, different = 0;
  for (std::size_t n = 1; n < snapshots.size(); ++n) {
    const StockModel& a = *snapshots[n - 1];
    const StockModel& b = *snapshots[n];
    for (std::uint32_t tile = 0; tile < a.tile_count(); ++tile) {
      const bool equal = a.patch_version(tile) == b.patch_version(tile);
      (equal ? same : different) += 1;
      for (const int level : {0, 2, 4}) {
        const MeshPatch p = a.patch(tile, level), q = b.patch(tile, level);
        EXPECT_EQ(p.version, a.patch_version(tile));
        EXPECT_EQ(p.tile, tile);
        EXPECT_EQ(p.level, level);
        if (equal) {
          EXPECT_TRUE(same_patch(p, q)) << n << " tile " << tile << " level " << level;
        }
      }
    }
  }
  EXPECT_GT(same, 50);
  EXPECT_GT(different, 50);
}

TEST(ZMapDifferingTiles, AreThoseThatDiffer) {
  const auto map = make_map("box:0,0,-10:40,40,0", 0.1);
  const auto cutter = parse_shape("flat:3");
  std::mt19937 random(23);
  const Box reach{Vec3(0, 0, -9), Vec3(40, 40, 1)};
  std::vector<std::unique_ptr<StockModel>> all;
  for (int round = 0; round < 8; ++round) {
    cut(*map, *cutter, random_path(random, reach, 4));
    all.push_back(map->snapshot());
  }
  for (const auto& a : all) {
    for (const auto& b : all) {
      const ZMap& x = dynamic_cast<const ZMap&>(*a);
      const ZMap& y = dynamic_cast<const ZMap&>(*b);
      EXPECT_EQ(a->differing_tiles(*b), changed_tiles(x, x.heights_mm(), y.heights_mm()));
    }
  }
  const auto stranger = make_map("box:0,0,-10:40,40,0", 0.1);
  const auto blank = make_map("box:0,0,-10:40,40,0", 0.1);
  EXPECT_EQ(stranger->differing_tiles(*blank), Tiles{});
  EXPECT_EQ(blank->differing_tiles(*make_map("box:0,0,-10:40,40,0", 0.2)), all_tiles(*blank));
}

/// Snapshots, snapshots of snapshots, cuts in any of them and drops in any order, each held
/// against a plain copy of the heights.
TEST(ZMapSnapshot, StaysWhatItWasWhateverHappensToOthers) {
  std::mt19937 random(101);
  const auto cutter = parse_shape("ball:4");
  const Box reach{Vec3(0, 0, -9), Vec3(40, 30, 1)};
  struct Held {
    std::unique_ptr<StockModel> model;
    std::vector<float> heights;
  };
  const auto heights = [](const StockModel& m) {
    return dynamic_cast<const ZMap&>(m).heights_mm();
  };
  std::vector<Held> held;
  held.push_back({make_map("box:0,0,-10:40,30,0", 0.2, 2), {}});
  held[0].heights = heights(*held[0].model);
  int cuts = 0, drops = 0;
  for (int step = 0; step < 400; ++step) {
    Held& one = held[random() % held.size()];
    switch (random() % 4) {
      case 0:
      case 1:
        cut(*one.model, *cutter, random_path(random, reach, 3));
        finish(*one.model);
        one.heights = heights(*one.model);
        ++cuts;
        break;
      case 2: {
        Held copy{one.model->snapshot(), one.heights};
        if (held.size() < 9) held.push_back(std::move(copy));
        break;
      }
      default:
        if (held.size() < 2) break;
        std::swap(one, held.back());
        held.pop_back();
        ++drops;
    }
    if (step % 5 != 0) continue;
    for (const Held& other : held) ASSERT_EQ(heights(*other.model), other.heights) << step;
  }
  EXPECT_GT(cuts, 100);
  EXPECT_GT(drops, 40);
}

TEST(ZMapSnapshot, TakesTheSameDigestAsTheModelAndAsAFreshRun) {
  const auto cutter = parse_shape("ball:4");
  std::mt19937 random(55);
  const std::vector<CutMove> moves = random_path(random, {Vec3(0, 0, -9), Vec3(40, 30, 1)}, 300);
  const auto plain = make_map("box:0,0,-10:40,30,0", 0.1);
  const auto shown = make_map("box:0,0,-10:40,30,0", 0.1);
  cut(*plain, *cutter, moves);
  std::vector<CutReport> reports;
  std::unique_ptr<StockModel> middle;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    shown->cut(*cutter, std::span(moves).subspan(i, 1), reports);
    shown->take_dirty_tiles();
    shown->patch(3, 1);
    const auto frame = shown->snapshot();
    if (i == 150) middle = shown->snapshot();
  }
  finish(*plain);
  finish(*shown);
  EXPECT_EQ(shown->digest(), plain->digest());
  EXPECT_EQ(shown->snapshot()->digest(), plain->digest());
  // From a keyframe on: what was held back has been completed there, so its last cells are cut
  // twice; no height is another.
  middle->cut(*cutter, std::span(moves).subspan(151), reports);
  finish(*middle);
  EXPECT_NEAR(middle->remaining_mm3(), plain->remaining_mm3(), 1e-3);
}

TEST(ZMapSnapshot, CostsOnlyWhatChangesAndGivesItBack) {
  const std::size_t tile_bytes = kTileFloats * sizeof(float);
  const auto map = make_map("box:0,0,-10:40,40,0", 0.1);
  const auto cutter = parse_shape("flat:2");
  // Of the 49 tiles all but that in the corner, which is as small as no other, have an equal.
  EXPECT_EQ(map->unique_bytes(), tile_bytes);
  cut(*map, *parse_shape("flat:100"), {line(Vec3(-60, 20, -0.5), Vec3(100, 20, -0.5))});
  finish(*map);
  EXPECT_EQ(map->unique_bytes(), map->tile_count() * tile_bytes);
  auto frame = map->snapshot();
  EXPECT_EQ(frame->unique_bytes(), 0u);
  EXPECT_EQ(map->unique_bytes(), 0u);
  cut(*map, *cutter, {line(Vec3(3, 3, -1), Vec3(4, 3, -1))});
  finish(*map);
  EXPECT_EQ(frame->unique_bytes(), tile_bytes);
  // Beside heights, where the slot's walls stand: some 5 mm of them, of 8 bytes for each line of
  // cells that they cross.
  const auto expect_tiles = [&](std::size_t count) {
    EXPECT_GT(map->unique_bytes(), count * tile_bytes + 8 * 50);
    EXPECT_LT(map->unique_bytes(), count * tile_bytes + tile_bytes / 8);
  };
  expect_tiles(1);
  cut(*map, *cutter, {line(Vec3(3, 3, -2), Vec3(4, 3, -2))});
  finish(*map);
  expect_tiles(1);  // once a snapshot
  frame.reset();
  expect_tiles(map->tile_count());
}

TEST(ZMapSnapshot, EqualTilesOfABlankAreCutEachByItself) {
  // Neighbours that share a tile, cut by several threads at once, against a blank of which no two
  // tiles are alike.
  const auto cutter = parse_shape("ball:3");
  const Box reach{Vec3(-3, -3, -9), Vec3(43, 43, -1)};
  for (const int threads : {1, 3}) {
    const auto map = make_map("box:0,0,-10:40,40,0", 0.1, threads);
    const auto uneven = make_map("box:0,0,-10:40,40,0", 0.1, threads);
    std::vector<CutMove> notches;
    for (std::uint32_t tile = 0; tile < uneven->tile_count(); ++tile) {
      const Box box = uneven->tile_box(tile);
      Vec3 at = 0.5 * (box.min + box.max);
      at.z = -0.001 * tile;
      notches.push_back(line(at, at));
    }
    cut(*uneven, *cutter, notches);
    finish(*uneven);
    const auto blank = map->snapshot();
    const std::string digest = blank->digest();
    std::mt19937 random(23);
    const auto path = random_path(random, reach, 60);
    cut(*map, *cutter, path);
    cut(*map, *cutter, notches);
    cut(*uneven, *cutter, path);
    finish(*map);
    finish(*uneven);
    EXPECT_EQ(map->digest(), uneven->digest()) << threads;
    EXPECT_EQ(blank->digest(), digest);
    EXPECT_NE(map->digest(), digest);
  }
}

/// For ThreadSanitizer as much as for its own checks: the origin cuts on while another thread
/// reads, meshes and drops snapshots.
void read_while_the_origin_cuts(bool keep_cut_ids) {
  struct Frame {
    std::unique_ptr<StockModel> snapshot;
    std::string digest;
  };
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<Frame> frames;
  bool done = false;
  const auto cutter = parse_shape("ball:4");
  int checked = 0;
  std::size_t triangles = 0;
  std::thread reader([&] {
    for (;;) {
      Frame frame;
      {
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return done || !frames.empty(); });
        if (frames.empty()) return;
        frame = std::move(frames.front());
        frames.erase(frames.begin());
      }
      const StockModel& stock = *frame.snapshot;
      EXPECT_EQ(stock.digest(), frame.digest);
      for (std::uint32_t tile = 0; tile < stock.tile_count(); ++tile)
        triangles += stock.patch(tile, static_cast<int>(tile % 5)).indices.size() / 3;
      stock.first_contact(*cutter, line(Vec3(0, 15, -2), Vec3(40, 15, -2)), 0.01);
      const auto again = stock.snapshot();
      EXPECT_EQ(again->differing_tiles(stock), Tiles{});
      EXPECT_EQ(stock.digest(), frame.digest);
      ++checked;
    }
  });
  const auto map = make_map("box:0,0,-10:40,30,0", 0.2, 2);
  map->keep_cut_ids(keep_cut_ids);
  std::mt19937 random(3);
  const Box reach{Vec3(0, 0, -9), Vec3(40, 30, 1)};
  for (int round = 0; round < 40; ++round) {
    cut(*map, *cutter, random_path(random, reach, 20));
    map->take_dirty_tiles();
    Frame frame{map->snapshot(), {}};
    frame.digest = frame.snapshot->digest();
    const std::lock_guard lock(mutex);
    frames.push_back(std::move(frame));
    changed.notify_one();
  }
  {
    const std::lock_guard lock(mutex);
    done = true;
  }
  changed.notify_one();
  reader.join();
  EXPECT_EQ(checked, 40);
  EXPECT_GT(triangles, 100000u);
}

TEST(ZMapSnapshot, MayBeReadOnAnotherThreadWhileItsOriginCuts) {
  read_while_the_origin_cuts(false);
}

TEST(ZMapSnapshot, MayBeReadOnAnotherThreadWhileItsOriginCutsAndKeepsCutIds) {
  read_while_the_origin_cuts(true);
}

}  // namespace
}  // namespace kerf
