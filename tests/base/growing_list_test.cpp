#include "base/growing_list.h"

#include <gtest/gtest.h>

#include <cstddef>

namespace kerf {
namespace {

TEST(GrowingList, HoldsWhatWasAddedAndMovesNothing) {
  GrowingList<int, 3> list;
  EXPECT_TRUE(list.empty());
  list.push_back(0);
  const int* const first = &list[0];
  for (int k = 1; k < 1000; ++k) list.push_back(k * k);
  ASSERT_EQ(list.size(), 1000u);
  EXPECT_EQ(&list[0], first);
  for (std::size_t k = 0; k < list.size(); ++k)
    EXPECT_EQ(list[k], static_cast<int>(k) * static_cast<int>(k));
}

TEST(GrowingList, EndsOfPiecesAreElementsLikeOthers) {
  GrowingList<std::size_t, 3> list;
  for (std::size_t k = 0; k < 8; ++k) list.push_back(k);
  EXPECT_EQ(list[7], 7u);
  list.push_back(8);
  EXPECT_EQ(list[7], 7u);
  EXPECT_EQ(list[8], 8u);
}

TEST(GrowingList, BeginsAnewAfterClear) {
  GrowingList<int, 3> list;
  for (int k = 0; k < 20; ++k) list.push_back(k);
  list.clear();
  EXPECT_TRUE(list.empty());
  list.push_back(5);
  EXPECT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0], 5);
}

}  // namespace
}  // namespace kerf
