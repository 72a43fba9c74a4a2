#include "stock/turning/covered_passes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

namespace kerf::turning {
namespace {

/// A tool of this outline along -z, 10 mm of it.
ThreadPass straight(ConvexChain corners, double lead_mm = 1.5) {
  return *ThreadPass::restored(std::move(corners), {5, 10}, {-5, 10}, lead_mm, 0, 0, 30, 1);
}

/// A V that points to the axis, 60 degrees, its tip at 0,0.
ConvexChain vee(double height) {
  const double half = height * std::tan(kPi / 6);
  return {{0, 0}, {half, height}, {-half, height}};
}

PassBeside beside(const ThreadPass& pass, const Vec2& offset, double low = 0, double high = 1) {
  return {&pass, offset, {0, 0}, low, high};
}

TEST(CoveredPasses, ADeeperVeeCoversWhatLiesBetweenItsFlanks) {
  // The tip of another V of the same flanks is in the deeper one where it is not nearer to a flank
  // than that: at a height h above the deeper tip, up to h tan 30 beside it.
  const ThreadPass tool = straight(vee(3)), deep = straight(vee(6)), flat = straight(vee(3));
  const double h = 0.4, edge = h * std::tan(kPi / 6);
  for (const auto& [along, is_covered] :
       {std::pair{0.0, true}, {0.99 * edge, true}, {-0.99 * edge, true}, {1.01 * edge, false}}) {
    std::vector<PassBeside> list{beside(flat, {along, 0}), beside(deep, {0, -h})};
    drop_covered(tool, 0, 0, 1, list);
    ASSERT_EQ(list.size(), is_covered ? 1U : 2U) << along;
    EXPECT_EQ(list.back().pass, &deep);
  }
}

TEST(CoveredPasses, OnlyWhatIsAtTheHeightOfTheToolCounts) {
  // Two rectangles: the lower one is narrower above 2, where the tool does not reach.
  const ThreadPass low_tool = straight({{-1, 0}, {1, 0}, {1, 2}, {-1, 2}});
  const ThreadPass high_tool = straight({{-1, 0}, {1, 0}, {1, 4}, {-1, 4}});
  const ThreadPass wide = straight({{-2, 0}, {2, 0}, {2, 4}, {-2, 4}});
  const ThreadPass short_one = straight({{-3, 0}, {3, 0}, {3, 2}, {-3, 2}});
  std::vector<PassBeside> list{beside(wide, {0, 0}), beside(short_one, {0, 0})};
  drop_covered(low_tool, 0, 0, 1, list);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].pass, &short_one);
  list = {beside(wide, {0, 0}), beside(short_one, {0, 0})};
  drop_covered(high_tool, 0, 0, 1, list);
  EXPECT_EQ(list.size(), 2U);
}

TEST(CoveredPasses, OfEqualOnesOneIsLeft) {
  const ThreadPass tool = straight(vee(3)), same = straight(vee(3)), again = straight(vee(3));
  std::vector<PassBeside> list{beside(same, {0.1, 0}), beside(again, {0.1, 0}),
                               beside(same, {0.1, 0})};
  drop_covered(tool, 0, 0, 1, list);
  EXPECT_EQ(list.size(), 1U);
}

TEST(CoveredPasses, WhoLeavesEarlierOrMovesOutCoversNothing) {
  const ThreadPass tool = straight(vee(3)), shallow = straight(vee(3)), deep = straight(vee(6));
  const auto left = [&](double low, double high, const Vec2& per_way) {
    std::vector<PassBeside> list{beside(shallow, {0, 0}, 0.2, 0.8), beside(deep, {0, -0.5})};
    list[1].low_way = low;
    list[1].high_way = high;
    list[1].per_way = per_way;
    drop_covered(tool, 0, 0, 1, list);
    return list.size();
  };
  EXPECT_EQ(left(0, 1, {0, 0}), 1U);
  EXPECT_EQ(left(0.2, 0.8, {0, 0}), 1U);
  EXPECT_EQ(left(0.2, 0.7, {0, 0}), 2U);
  EXPECT_EQ(left(0.3, 1, {0, 0}), 2U);
  // Up by 0.6 a mm: at 0.8 its tip is at -0.02, still below.
  EXPECT_EQ(left(0, 1, {0, 0.6}), 1U);
  // At 0.8 it is at 0.02, above the other's tip.
  EXPECT_EQ(left(0, 1, {0, 0.65}), 2U);
}

bool holds(const PassBeside& b, const Vec2& p, double way) {
  if (way < b.low_way || way > b.high_way) return false;
  const Vec2 q = p - b.offset - way * b.per_way;
  const ConvexChain& chain = b.pass->corners();
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const Vec2 &a = chain[i == 0 ? chain.size() - 1 : i - 1], e = chain[i] - a;
    if (e.x * (q.y - a.y) - e.y * (q.x - a.x) < 0) return false;
  }
  return true;
}

/// By sampling: at no height of the tool and at no way does the union of them lose a place; and who
/// is alone in covering one stays.
TEST(CoveredPasses, RandomOnesLeaveTheirUnion) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t dropped = 0;
  for (int round = 0; round < 150; ++round) {
    const ThreadPass tool = straight(vee(1 + 2 * unit(random)));
    std::vector<std::unique_ptr<ThreadPass>> passes;
    std::vector<PassBeside> list;
    for (int i = 0; i < 7; ++i) {
      const double half = 0.2 + unit(random), high = 1 + 3 * unit(random);
      const double foot = half * unit(random);
      passes.push_back(std::make_unique<ThreadPass>(
          straight({{-foot, 0}, {foot, 0}, {half, high}, {-half, high}})));
      PassBeside one = beside(*passes.back(), {0.6 * unit(random), unit(random) - 0.5});
      if (i % 2 == 1) one.per_way = {0.3 * unit(random) - 0.15, 0.3 * unit(random) - 0.15};
      if (i % 3 == 1) one.low_way = 0.3 * unit(random);
      if (i % 3 == 2) one.high_way = 1 - 0.3 * unit(random);
      list.push_back(one);
    }
    std::vector<PassBeside> kept = list;
    drop_covered(tool, 0, 0, 1, kept);
    dropped += list.size() - kept.size();
    for (int w = 0; w <= 8; ++w) {
      const double way = w / 8.0;
      for (int k = 0; k < 200; ++k) {
        const Vec2 p{3 * unit(random) - 1.5,
                     tool.low_mm().y + unit(random) * (tool.high_mm().y - tool.low_mm().y)};
        const auto is_in = [&](const std::vector<PassBeside>& of) {
          return std::ranges::any_of(of, [&](const PassBeside& b) { return holds(b, p, way); });
        };
        ASSERT_EQ(is_in(list), is_in(kept)) << "round " << round << ", way " << way;
      }
    }
  }
  EXPECT_GT(dropped, 100U);
}

}  // namespace
}  // namespace kerf::turning
