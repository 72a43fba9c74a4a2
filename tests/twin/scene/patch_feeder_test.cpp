#include "twin/scene/patch_feeder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <thread>
#include <vector>

#include "tests/twin/playback/tracks.h"

namespace kerf {
namespace {

using Clock = PatchFeeder::Clock;

std::set<std::uint32_t> tiles_of(const std::vector<std::shared_ptr<const MeshPatch>>& patches) {
  std::set<std::uint32_t> tiles;
  for (const auto& patch : patches) EXPECT_TRUE(tiles.insert(patch->tile).second);
  return tiles;
}

void cut_line(StockModel& stock, const Vec3& from, const Vec3& to) {
  const ToolShapeArgument ball = parse_tool_argument("1=ball:6").value();
  CutMove move;
  move.from_mm = from;
  move.to_mm = to;
  std::vector<CutReport> reports;
  stock.cut(ball.cutter, std::span(&move, 1), reports);
  stock.finish(reports);
}

TEST(PatchFeeder, FirstAllThenWhatWasCut) {
  const auto stock = test::block_40();
  PatchFeeder feeder;
  feeder.follow(stock->snapshot());
  feeder.set_detail({0.05});
  EXPECT_EQ(tiles_of(feeder.make_until(Clock::time_point::max())).size(), stock->tile_count());
  EXPECT_FALSE(feeder.behind());
  EXPECT_TRUE(feeder.make_until(Clock::time_point::max()).empty());

  cut_line(*stock, {10, 10, -2}, {12, 10, -2});
  feeder.follow(stock->snapshot());
  const auto tiles = tiles_of(feeder.make_until(Clock::time_point::max()));
  EXPECT_GE(tiles.size(), 1u);
  for (const std::uint32_t tile : tiles) {
    // Those that were cut, and their neighbours.
    const Box box = stock->tile_box(tile);
    EXPECT_LT(box.min.x, 15 + box.size().x) << "far from the cut";
    EXPECT_LT(box.min.y, 13 + box.size().y);
  }
}

TEST(PatchFeeder, JumpsToAndFroGiveTheSamePatches) {
  const auto stock = test::block_40();
  const std::shared_ptr<const StockModel> blank = stock->snapshot();
  PatchFeeder feeder;
  feeder.follow(blank);
  const auto first = feeder.make_until(Clock::time_point::max());
  std::map<std::uint32_t, std::size_t> triangles;
  for (const auto& patch : first) triangles[patch->tile] = patch->indices.size();
  const std::size_t all = feeder.triangles();
  cut_line(*stock, {5, 5, -3}, {35, 30, -3});
  feeder.follow(stock->snapshot());
  EXPECT_FALSE(feeder.make_until(Clock::time_point::max()).empty());
  EXPECT_NE(feeder.triangles(), all);
  feeder.follow(blank);
  for (const auto& patch : feeder.make_until(Clock::time_point::max())) {
    EXPECT_EQ(patch->indices.size(), triangles[patch->tile]);
  }
  EXPECT_EQ(feeder.triangles(), all);
}

TEST(PatchFeeder, APassWithoutCuttingChangesNothing) {
  const auto stock = test::block_40();
  PatchFeeder feeder;
  cut_line(*stock, {5, 20, -2}, {35, 20, -2});
  feeder.follow(stock->snapshot());
  feeder.make_until(Clock::time_point::max());
  cut_line(*stock, {35, 20, -1}, {5, 20, -1});
  feeder.follow(stock->snapshot());
  EXPECT_TRUE(feeder.make_until(Clock::time_point::max()).empty());
  EXPECT_FALSE(feeder.behind());
}

TEST(PatchFeeder, WhatWasHandedOutLastIsTheWorkpieceAsItIs) {
  const auto stock = test::block_40(0.1);
  PatchFeeder feeder;
  std::vector<std::shared_ptr<const StockModel>> states{stock->snapshot()};
  for (const double x : {3.0, 6.4, 12.8, 13.0, 30.0}) {
    cut_line(*stock, {x, 2 * x / 3, -1}, {x + 0.4 * x, 6, -2});
    states.push_back(stock->snapshot());
  }
  std::map<std::uint32_t, std::shared_ptr<const MeshPatch>> shown;
  const auto expect_current = [&](const StockModel& state) {
    ASSERT_EQ(shown.size(), state.tile_count());
    for (const auto& [tile, patch] : shown) {
      const MeshPatch wanted = state.patch(tile, patch->level);
      EXPECT_EQ(patch->indices, wanted.indices) << "tile " << tile;
      ASSERT_EQ(patch->vertices.size(), wanted.vertices.size()) << "tile " << tile;
      EXPECT_EQ(0, std::memcmp(patch->vertices.data(), wanted.vertices.data(),
                               wanted.vertices.size() * sizeof(MeshVertex)))
          << "tile " << tile;
    }
  };
  for (const double pixel_mm : {0.1, 0.9}) {
    feeder.set_detail({pixel_mm});
    // Forward, and jumps to and fro; of some states only a part is made before the next comes.
    for (const std::size_t at : {0u, 1u, 2u, 5u, 1u, 3u, 4u, 0u, 5u}) {
      feeder.follow(states[at]);
      const bool in_part = at == 3 || at == 4;
      do {
        const auto until = in_part ? Clock::time_point::min() : Clock::time_point::max();
        for (auto& patch : feeder.make_until(until)) shown[patch->tile] = patch;
      } while (!in_part && feeder.behind());
      if (!in_part) expect_current(*states[at]);
    }
  }
}

TEST(PatchFeeder, WorksInSlicesAndForgetsNoTile) {
  const auto stock = test::block_40();
  PatchFeeder feeder;
  feeder.follow(stock->snapshot());
  std::set<std::uint32_t> seen;
  int slices = 0;
  while (feeder.behind() && slices < 10000) {
    const auto made = feeder.make_until(Clock::now());
    EXPECT_LE(made.size(), 1u);
    for (const auto& patch : made) seen.insert(patch->tile);
    ++slices;
  }
  EXPECT_EQ(seen.size(), stock->tile_count());
}

TEST(PatchFeeder, WhatOneMoveCutComesTogether) {
  const auto stock = test::block_40();
  PatchFeeder feeder;
  feeder.follow(stock->snapshot());
  feeder.make_until(Clock::time_point::max());
  cut_line(*stock, {3, 3, -2}, {37, 20, -2});
  feeder.follow(stock->snapshot());
  const auto made = feeder.make_until(Clock::time_point::min());
  EXPECT_GT(made.size(), 9u);
  EXPECT_TRUE(feeder.make_until(Clock::time_point::max()).empty());
}

TEST(PatchFeeder, FromAfarCellsAreJoined) {
  const auto stock = test::block_40(0.1);
  PatchFeeder feeder;
  feeder.follow(stock->snapshot());
  feeder.set_detail({0.1});
  feeder.make_until(Clock::time_point::max());
  feeder.set_detail({0.9});
  EXPECT_TRUE(feeder.behind());
  for (const auto& patch : feeder.make_until(Clock::time_point::max())) {
    EXPECT_EQ(patch->level, 3) << "0.9 mm a pixel: 0.8 mm is fine enough";
  }
}

std::set<int> levels_of(const std::vector<std::shared_ptr<const MeshPatch>>& patches) {
  std::set<int> levels;
  for (const auto& patch : patches) levels.insert(patch->level);
  return levels;
}

/// Rough ground, so that tiles have many triangles before they are cut again.
std::unique_ptr<ZMap> rough_40() {
  std::unique_ptr<ZMap> stock = test::block_40(0.1);
  for (double y = 1; y < 40; y += 2) cut_line(*stock, {0, y, -1}, {40, y, -2});
  return stock;
}

TEST(PatchFeeder, MuchThatIsCutComesCoarserUntilItIsCalm) {
  const auto stock = rough_40();
  PatchFeeder feeder;
  feeder.follow(stock->snapshot());
  feeder.set_detail({0.1}, 20'000);
  const auto all = feeder.make_until(Clock::time_point::max());
  EXPECT_EQ(levels_of(all), std::set{0}) << "what comes first is not hurried";
  // 8192 triangles a tile: so much is fine in a tile or two, in nine it is too much.
  const auto cut = [&](double z) {
    cut_line(*stock, {9, 9, z}, {9.5, 9.5, z});
    feeder.follow(stock->snapshot());
    return feeder.make_until(Clock::time_point::max());
  };
  std::set<std::uint32_t> coarse;
  for (int round = 1; round < 3 * PatchFeeder::kRounds; ++round) {
    const auto made = cut(-3.0 - 0.1 * round);
    if (round < PatchFeeder::kRounds) {
      EXPECT_EQ(levels_of(made), std::set{0}) << "it may be a jump";
      continue;
    }
    EXPECT_EQ(levels_of(made), std::set{1});
    EXPECT_GE(made.size(), 4u);
    for (const auto& patch : made) coarse.insert(patch->tile);
    EXPECT_FALSE(feeder.behind());
  }
  EXPECT_TRUE(feeder.make_until(Clock::time_point::max()).empty()) << "it may be cut again";
  std::this_thread::sleep_for(PatchFeeder::kCalm);
  const auto fine = feeder.make_until(Clock::time_point::max());
  EXPECT_EQ(levels_of(fine), std::set{0});
  EXPECT_EQ(tiles_of(fine), coarse);
  EXPECT_TRUE(feeder.make_until(Clock::time_point::max()).empty());
  for (const auto& patch : fine) {
    EXPECT_EQ(patch->indices, stock->patch(patch->tile, 0).indices);
  }
}

TEST(PatchFeeder, LittleThatIsCutIsNotMadeCoarser) {
  for (const std::size_t easy_triangles : {std::size_t{0}, std::size_t{300'000}}) {
    const auto stock = rough_40();
    PatchFeeder feeder;
    feeder.follow(stock->snapshot());
    feeder.set_detail({0.1}, easy_triangles);
    feeder.make_until(Clock::time_point::max());
    cut_line(*stock, {9, 9, -3}, {9.5, 9.5, -3});
    feeder.follow(stock->snapshot());
    EXPECT_EQ(levels_of(feeder.make_until(Clock::time_point::max())), std::set{0});
  }
}

TEST(PatchFeeder, WhatIsFarFromTheEyeIsMadeCoarser) {
  const auto stock = test::block_40(0.1);
  PatchFeeder feeder;
  feeder.follow(stock->snapshot());
  // The eye at x = 10, looking along +x.
  const ViewDetail detail{-10 * 0.05, {0.05, 0, 0}};
  feeder.set_detail(detail);
  std::set<int> levels;
  const auto patches = feeder.make_until(Clock::time_point::max());
  EXPECT_EQ(patches.size(), stock->tile_count());
  for (const auto& patch : patches) {
    const Box box = stock->tile_box(patch->tile);
    levels.insert(patch->level);
    if (box.max.x <= 10) {
      EXPECT_EQ(patch->level, StockModel::kPatchLevels - 1) << "behind the eye";
      continue;
    }
    const double nearest_mm = std::max(0.0, 0.05 * (box.min.x - 10));
    const double joined_mm = 0.1 * std::exp2(patch->level);
    EXPECT_LE(joined_mm, std::max(0.1, 1.2501 * nearest_mm)) << box.min.x;
    if (patch->level < StockModel::kPatchLevels - 1) {
      EXPECT_GT(1.6001 * joined_mm, nearest_mm);
    }
  }
  EXPECT_GE(levels.size(), 3u);
  // Nearer to some, farther from others: only these are made.
  feeder.set_detail({-10 * 0.05, {0.05, 0, 1e-9}});
  EXPECT_TRUE(feeder.make_until(Clock::time_point::max()).empty());
  feeder.set_detail({-10 * 0.1, {0.1, 0, 0}});
  const auto again = feeder.make_until(Clock::time_point::max());
  EXPECT_FALSE(again.empty());
  EXPECT_LT(again.size(), patches.size());
}

}  // namespace
}  // namespace kerf
