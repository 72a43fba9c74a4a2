#include "twin/playback/keyframe_store.h"

#include <gtest/gtest.h>

#include "tests/twin/playback/tracks.h"

namespace kerf {
namespace {

/// A workpiece whose copies differ in `slots` slots each; so many bytes apart.
class Sample {
 public:
  Sample() : stock_(test::block_40()), cutter_(parse_shape("flat:2").value()) {}

  std::unique_ptr<StockModel> next() {
    CutMove move;
    const double y = 1 + static_cast<double>(turn_ % 20) * 1.9;
    move.from_mm = {-3, y, -0.001 * ++turn_};
    move.to_mm = {43, y, move.from_mm.z};
    std::vector<CutReport> reports;
    stock_->cut(cutter_, std::span(&move, 1), reports);
    stock_->finish(reports);
    return stock_->snapshot();
  }
  std::unique_ptr<StockModel> same() const { return stock_->snapshot(); }
  std::size_t whole_bytes() const { return stock_->cell_count() * sizeof(float); }

 private:
  std::unique_ptr<ZMap> stock_;
  Cutter cutter_;
  int turn_ = 0;
};

TEST(KeyframeStore, FindsTheOneBefore) {
  Sample sample;
  KeyframeStore store(std::size_t{1} << 30, 0.001);
  EXPECT_EQ(store.at_or_before(5), nullptr);
  store.add(0, 0, sample.same());
  store.add(100, 1, sample.next());
  store.add(50, 0.5, sample.next());
  EXPECT_EQ(store.at_or_before(0)->motion, 0U);
  EXPECT_EQ(store.at_or_before(49)->motion, 0U);
  EXPECT_EQ(store.at_or_before(50)->motion, 50U);
  EXPECT_EQ(store.at_or_before(99)->motion, 50U);
  EXPECT_EQ(store.at_or_before(1000)->motion, 100U);
  EXPECT_DOUBLE_EQ(store.worst_s(), 0.5);
}

TEST(KeyframeStore, CountsOnlyWhatNeighboursDoNotShare) {
  Sample sample;
  KeyframeStore store(std::size_t{1} << 30, 0.001);
  store.add(0, 0, sample.same());
  EXPECT_EQ(store.bytes(), 0U) << "the blank is there anyway";
  store.add(10, 1, sample.same());
  EXPECT_EQ(store.bytes(), 0U);
  store.add(20, 2, sample.next());
  EXPECT_GT(store.bytes(), 0U);
  EXPECT_LT(store.bytes(), sample.whole_bytes() / 2) << "one slot touches a row of tiles";
}

TEST(KeyframeStore, WhatIsNotTheLastIsPackedAndComesBackAsItWas) {
  Sample sample;
  KeyframeStore store(std::size_t{1} << 30, 0.001);
  store.add(0, 0, sample.same());
  std::vector<std::string> digests;
  std::size_t raw_bytes = 0;
  const std::size_t tile_bytes = sample.whole_bytes() / sample.same()->tile_count();
  auto before = sample.same();
  for (std::size_t i = 1; i <= 60; ++i) {
    auto stock = sample.next();
    raw_bytes += stock->differing_tiles(*before).size() * tile_bytes;
    digests.push_back(stock->digest());
    before = stock->snapshot();
    store.add(i, 0.01 * static_cast<double>(i), std::move(stock));
  }
  before.reset();
  // The last one is not, and the floors of slots are flat.
  EXPECT_LT(store.bytes(), raw_bytes / 3);
  EXPECT_GT(store.bytes(), 0U);
  for (std::size_t i = 60; i >= 1; --i) {
    EXPECT_EQ(store.at_or_before(i)->stock->snapshot()->digest(), digests[i - 1]) << i;
  }
}

TEST(KeyframeStore, StaysWithinItsBudgetAndSpreadsEvenly) {
  Sample sample;
  KeyframeStore store(6 * sample.whole_bytes(), 0.001);
  store.add(0, 0, sample.same());
  constexpr std::size_t kMany = 2000;
  for (std::size_t i = 1; i <= kMany; ++i) {
    const double cost_s = 0.01 * static_cast<double>(i);
    if (store.wants(i, cost_s)) store.add(i, cost_s, sample.next());
    ASSERT_LE(store.bytes(), store.budget_bytes());
  }
  EXPECT_GT(store.count(), 5U);
  EXPECT_NE(store.at_or_before(0), nullptr);
  const double even = 0.01 * kMany / static_cast<double>(store.count());
  EXPECT_LT(store.worst_s(), 3 * even);
  EXPECT_GE(store.at_or_before(kMany)->motion, kMany * 3 / 4);
}

TEST(KeyframeStore, WantsNoneWhereItSavesNothing) {
  Sample sample;
  KeyframeStore store(std::size_t{1} << 30, 0.01);
  EXPECT_TRUE(store.wants(0, 0));
  store.add(0, 0, sample.same());
  EXPECT_FALSE(store.wants(0, 0));
  EXPECT_FALSE(store.wants(10, 0.009));
  EXPECT_TRUE(store.wants(11, 0.011));
  store.add(100, 0.1, sample.next());
  EXPECT_TRUE(store.wants(50, 0.05)) << "in the middle of the worst gap";
  EXPECT_FALSE(store.wants(10, 0.01)) << "at its edge";
  store.add(1000, 1, sample.next());
  EXPECT_FALSE(store.wants(50, 0.05)) << "that gap is not the worst any more";
  EXPECT_TRUE(store.wants(500, 0.5));
}

TEST(KeyframeStore, WithoutABudgetTheBlankStays) {
  Sample sample;
  KeyframeStore store(0, 0.001);
  store.add(0, 0, sample.same());
  for (std::size_t i = 1; i < 20; ++i) store.add(i, 0.1 * static_cast<double>(i), sample.next());
  EXPECT_EQ(store.count(), 1U);
  EXPECT_EQ(store.bytes(), 0U);
  EXPECT_EQ(store.at_or_before(19)->motion, 0U);
}

}  // namespace
}  // namespace kerf
