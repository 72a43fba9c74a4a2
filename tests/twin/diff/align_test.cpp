// Alignment against the longest common subsequence by the textbook's table.
#include "twin/diff/align.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace kerf {
namespace {

using Items = std::vector<int>;

std::vector<AlignedGap> aligned(const Items& a, const Items& b) {
  AlignedPair pair;
  pair.a_size = a.size();
  pair.b_size = b.size();
  pair.equal = [&](std::size_t i, std::size_t j) { return a[i] == b[j]; };
  pair.a_key = [&](std::size_t i) { return static_cast<std::uint64_t>(a[i]); };
  pair.b_key = [&](std::size_t j) { return static_cast<std::uint64_t>(b[j]); };
  return align(pair);
}

/// Pairs that the gaps leave; every one of them must be equal.
std::size_t pairs_between(const Items& a, const Items& b, const std::vector<AlignedGap>& gaps) {
  std::size_t pairs = 0, i = 0, j = 0;
  const auto run = [&](std::size_t a_end, std::size_t b_end) {
    EXPECT_EQ(a_end - i, b_end - j);
    for (; i < a_end; ++i, ++j, ++pairs) EXPECT_EQ(a[i], b[j]);
  };
  for (const AlignedGap& gap : gaps) {
    EXPECT_TRUE(gap.a_end > gap.a_begin || gap.b_end > gap.b_begin);
    run(gap.a_begin, gap.b_begin);
    i = gap.a_end;
    j = gap.b_end;
  }
  run(a.size(), b.size());
  return pairs;
}

std::size_t longest_common(const Items& a, const Items& b) {
  std::vector<std::vector<std::size_t>> table(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      table[i + 1][j + 1] =
          a[i] == b[j] ? table[i][j] + 1 : std::max(table[i + 1][j], table[i][j + 1]);
    }
  }
  return table[a.size()][b.size()];
}

TEST(Align, EqualSequencesHaveNoGap) {
  EXPECT_TRUE(aligned({}, {}).empty());
  EXPECT_TRUE(aligned({1, 2, 2, 3}, {1, 2, 2, 3}).empty());
}

TEST(Align, WhatIsInOneAloneIsAGap) {
  EXPECT_EQ(aligned({1, 2, 3, 4}, {1, 4}), (std::vector<AlignedGap>{{1, 3, 1, 1}}));
  EXPECT_EQ(aligned({}, {7}), (std::vector<AlignedGap>{{0, 0, 0, 1}}));
  EXPECT_EQ(aligned({5}, {6}), (std::vector<AlignedGap>{{0, 1, 0, 1}}));
}

/// Few values: none stands once, so all is left to the edits, which are as few as can be.
TEST(Align, FindsAsManyPairsAsTheTableOfRepeatedItems) {
  std::mt19937 random(7);
  for (int round = 0; round < 400; ++round) {
    Items a(random() % 60), b(random() % 60);
    for (Items* items : {&a, &b}) {
      for (int& item : *items) item = static_cast<int>(random() % 3);
    }
    // Twice each, so that no item is an anchor.
    const auto doubled = [](Items items) {
      items.insert(items.end(), {0, 0, 1, 1, 2, 2});
      return items;
    };
    a = doubled(a);
    b = doubled(b);
    EXPECT_EQ(pairs_between(a, b, aligned(a, b)), longest_common(a, b)) << round;
  }
}

TEST(Align, FindsAsManyPairsAsTheTableOfItemsThatStandOnce) {
  std::mt19937 random(11);
  for (int round = 0; round < 200; ++round) {
    Items a(50), b;
    std::iota(a.begin(), a.end(), 0);
    b = a;
    for (int swaps = 0; swaps < 5; ++swaps) std::swap(b[random() % 50], b[random() % 50]);
    EXPECT_EQ(pairs_between(a, b, aligned(a, b)), longest_common(a, b)) << round;
  }
}

/// A block of more items than edits are looked for.
TEST(Align, ALongBlockThatIsMissingIsOneGap) {
  Items a(20'000), b;
  std::iota(a.begin(), a.end(), 0);
  b.assign(a.begin(), a.begin() + 5000);
  b.insert(b.end(), a.begin() + 12'000, a.end());
  EXPECT_EQ(aligned(a, b), (std::vector<AlignedGap>{{5000, 12'000, 5000, 5000}}));
}

/// Nothing in common at all: it ends, and soon.
TEST(Align, SequencesWithNothingInCommonAreOneGap) {
  Items a(100'000), b(90'000);
  std::iota(a.begin(), a.end(), 0);
  std::iota(b.begin(), b.end(), 1'000'000);
  EXPECT_EQ(aligned(a, b), (std::vector<AlignedGap>{{0, 100'000, 0, 90'000}}));
}

}  // namespace
}  // namespace kerf
