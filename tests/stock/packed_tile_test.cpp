// Packed tiles against what they were made of, bit for bit.
#include "stock/zmap/packed_tile.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "stock/zmap/tile_grid.h"
#include "tests/stock/stock_samples.h"

namespace kerf {
namespace {

using test::cut;
using test::finish;
using test::make_map;
using test::random_path;

constexpr std::size_t kOfTile = kTileFloats;

std::vector<float> tile_of(const std::function<float(int, int)>& height,
                           const std::function<std::uint32_t(int, int)>& id) {
  std::vector<float> cells(2 * kOfTile);
  for (int j = 0; j < kTileCells; ++j) {
    for (int i = 0; i < kTileCells; ++i) {
      cells[TileGrid::offset(i, j)] = height(i, j);
      cut_ids_of(cells.data())[TileGrid::offset(i, j)] = id(i, j);
    }
  }
  return cells;
}

/// Returns the bytes it took.
std::size_t expect_same(const std::vector<float>& cells, bool has_ids) {
  const PackedTile packed(cells.data(), has_ids);
  const std::size_t count = (has_ids ? 2 : 1) * kOfTile;
  std::vector<float> back(count + 1, 7.0f);
  packed.unpack(back.data());
  EXPECT_EQ(std::memcmp(back.data(), cells.data(), count * sizeof(float)), 0);
  EXPECT_EQ(back[count], 7.0f) << "nothing behind it is written";
  return packed.bytes();
}

TEST(PackedTile, WhatIsFlatTakesNextToNothing) {
  const auto cells = tile_of([](int, int) { return -3.25f; }, [](int, int) { return 4'000'000u; });
  // Two bytes a group of 64 cells, and the first cells.
  EXPECT_LT(expect_same(cells, true), 2 * (2 * kOfTile / 64 + 200));
  EXPECT_LT(expect_same(cells, false), 2 * kOfTile / 64 + 200);
}

TEST(PackedTile, ARasterOverASmoothSurfaceTakesHalf) {
  // Rows of two cells to and fro, a move for two cells along them.
  const auto cells = tile_of(
      [](int i, int j) {
        return static_cast<float>(-6 + 3 * std::sin(i / 130.0) * std::cos(j / 170.0));
      },
      [](int i, int j) {
        const int row = j / 2, along = row % 2 == 0 ? i / 2 : 999 - i / 2;
        return static_cast<std::uint32_t>(500'000 + 1000 * row + along);
      });
  EXPECT_LT(expect_same(cells, true), 2 * kOfTile * sizeof(float) / 2);
}

TEST(PackedTile, AnyBitsComeBack) {
  std::mt19937 random(11);
  const std::vector<float> odd{0.0f,
                               -0.0f,
                               std::numeric_limits<float>::infinity(),
                               -std::numeric_limits<float>::infinity(),
                               std::numeric_limits<float>::lowest(),
                               std::numeric_limits<float>::denorm_min(),
                               std::bit_cast<float>(0x7fc01234u),
                               std::bit_cast<float>(0xffffffffu)};
  for (const unsigned rare : {1u, 2u, 20u, 500u}) {
    const auto cells = tile_of(
        [&](int i, int) {
          const unsigned any = static_cast<unsigned>(random());
          if (any % rare != 0) return 0.01f * static_cast<float>(i);
          return any % 3 == 0 ? std::bit_cast<float>(static_cast<std::uint32_t>(random()))
                              : odd[any / 7 % odd.size()];
        },
        [&](int i, int j) {
          const auto any = static_cast<std::uint32_t>(random());
          if (any % rare != 0) return static_cast<std::uint32_t>(i + j);
          return any % 3 == 0 ? 0xffffffffu : static_cast<std::uint32_t>(random());
        });
    const std::size_t bytes = expect_same(cells, true);
    expect_same(cells, false);
    // Never more than a little larger than it was.
    EXPECT_LT(bytes, 2 * kOfTile * sizeof(float) + 2 * (2 * kOfTile / 64) + 200) << rare;
  }
}

TEST(PackedTile, OneWideValueInAFlatTile) {
  for (int bit = 0; bit < 32; ++bit) {
    for (const int place : {0, 1, 31, 63}) {
      const auto cells = tile_of([](int, int) { return 1.0f; },
                                 [&](int i, int j) {
                                   const bool is_it = i == place && j == 63 - place;
                                   return is_it ? 1u << bit : 5u;
                                 });
      EXPECT_LT(expect_same(cells, true), 1000u) << bit;
    }
  }
}

TEST(PackedCopies, ComeBackAsTheyWereInWhateverOrder) {
  const auto cutter = parse_shape("bull:3:0.5");
  std::mt19937 random(5);
  const Box reach{Vec3(0, 0, -9), Vec3(60, 40, 1)};
  for (const bool keeps_ids : {false, true}) {
    const auto map = make_map("cylinder:30,20,-10:0:40", 0.1, 2);
    map->keep_cut_ids(keeps_ids);
    struct Copy {
      std::unique_ptr<StockModel> kept;
      std::string digest;
      std::vector<std::uint32_t> ids;
      std::vector<std::uint64_t> versions, columns;  ///< of patches, of tiles alone
    };
    const auto ids_of = [](const StockModel& model) {
      const ZMap& one = dynamic_cast<const ZMap&>(model);
      std::vector<std::uint32_t> ids;
      for (int j = 0; j < one.ny(); ++j)
        for (int i = 0; i < one.nx(); ++i) ids.push_back(one.present_cut_id(i, j));
      return ids;
    };
    const auto columns_of = [](const StockModel& model) {
      std::vector<std::uint64_t> versions;
      for (std::uint32_t i = 0; i < model.tile_count(); ++i) {
        versions.push_back(dynamic_cast<const ZMap&>(model).column_version(i));
      }
      return versions;
    };
    const auto versions_of = [](const StockModel& model) {
      std::vector<std::uint64_t> versions;
      for (std::uint32_t i = 0; i < model.tile_count(); ++i) {
        versions.push_back(model.patch_version(i));
      }
      return versions;
    };
    std::vector<Copy> copies;
    const auto keep = [&](std::size_t at, const StockModel& model) {
      copies.insert(
          copies.begin() + static_cast<std::ptrdiff_t>(at),
          {model.snapshot(), model.digest(), ids_of(model), versions_of(model), columns_of(model)});
    };
    const auto pack = [&](std::size_t at) {
      std::vector<StockModel*> kept;
      for (const Copy& copy : copies) kept.push_back(copy.kept.get());
      return kept[at]->pack(kept, at);
    };
    const auto expect_all_same = [&] {
      for (const Copy& copy : copies) {
        const auto seen = copy.kept->snapshot();
        EXPECT_EQ(seen->digest(), copy.digest);
        EXPECT_EQ(ids_of(*seen), copy.ids);
        EXPECT_EQ(versions_of(*seen), copy.versions);
      }
    };
    std::uint64_t id = 0;
    const auto cut_some = [&](StockModel& model) {
      std::vector<CutMove> moves = random_path(random, reach, 3);
      for (CutMove& move : moves) move.id = ++id;
      cut(model, *cutter, moves);
      finish(model);
    };
    keep(0, *map);
    for (int step = 0; step < 10; ++step) {
      cut_some(*map);
      keep(copies.size(), *map);
      EXPECT_FALSE(pack(copies.size() - 1)) << "the map has it all as well";
      EXPECT_TRUE(pack(copies.size() - 2)) << "nobody else has what was cut since";
    }
    expect_all_same();
    const std::size_t tile_bytes = (keeps_ids ? 2 : 1) * kOfTile * sizeof(float);
    for (std::size_t n = 1; n + 1 < copies.size(); ++n) {
      const StockModel& after = *copies[n + 1].kept;
      std::size_t tiles = 0;
      for (std::uint32_t i = 0; i < map->tile_count(); ++i) {
        tiles += copies[n].columns[i] != copies[n + 1].columns[i];
      }
      const std::size_t bytes = copies[n].kept->kept_bytes(*copies[n - 1].kept, &after);
      EXPECT_GT(bytes, 0u);
      EXPECT_LT(bytes, tiles * tile_bytes * 3 / 4);
    }
    // One goes on from an older copy, by another way, and leaves a copy between the others.
    auto other = copies[4].kept->snapshot();
    cut_some(*other);
    keep(5, *other);
    EXPECT_FALSE(pack(5)) << "the other one has what it has cut";
    cut_some(*other);
    keep(6, *other);
    other.reset();
    pack(5);
    pack(6);
    expect_all_same();
    while (copies.size() > 2) {
      copies.erase(copies.begin() +
                   static_cast<std::ptrdiff_t>(1 + random() % (copies.size() - 2)));
      for (std::size_t n = 0; n < copies.size(); ++n) pack(n);
    }
    expect_all_same();
  }
}

TEST(PackedCopies, BesideAnotherModelNothingIsPacked) {
  const auto small = make_map("box:0,0,-10:20,20,0", 0.1);
  const auto large = make_map("box:0,0,-10:40,40,0", 0.2);
  const std::vector<StockModel*> one{small.get()};
  EXPECT_FALSE(small->pack(one, 0));
  EXPECT_EQ(small->kept_bytes(*small, nullptr), 0u);
  EXPECT_GT(large->snapshot()->kept_bytes(*small->snapshot(), nullptr), 0u);
}

}  // namespace
}  // namespace kerf
