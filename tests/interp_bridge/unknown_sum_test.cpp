#include "interp_bridge/unknown_sum.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

TEST(UnknownSum, AmountsAddUpAndCancel) {
  const UnknownSum a = UnknownSum::of(1, false), b = UnknownSum::of(2, false);
  EXPECT_EQ(a + b, b + a);
  EXPECT_EQ(a + b - a, b);
  EXPECT_EQ(a - a, UnknownSum());
  EXPECT_EQ(UnknownSum() - a + a, UnknownSum());
  EXPECT_NE(a + a, a);
  EXPECT_EQ(a + a - a, a);
  EXPECT_NE(a, b);
  EXPECT_NE(a, UnknownSum());
  EXPECT_NE(UnknownSum() - a, a);
}

TEST(UnknownSum, DoubtStaysUntilItCancels) {
  const UnknownSum sure = UnknownSum::of(1, false), doubt = UnknownSum::of(2, true);
  EXPECT_FALSE(sure.is_doubtful());
  EXPECT_TRUE((sure + doubt).is_doubtful());
  EXPECT_TRUE((sure - doubt).is_doubtful());
  EXPECT_FALSE((sure + doubt - doubt).is_doubtful());
  EXPECT_FALSE(UnknownSum().is_doubtful());
}

TEST(UnknownSum, TooManyAmountsEqualNothing) {
  UnknownSum sum;
  for (int n = 1; n <= 4; ++n) sum = sum + UnknownSum::of(n, false);
  EXPECT_EQ(sum, sum);
  EXPECT_FALSE(sum.is_doubtful());
  const UnknownSum over = sum + UnknownSum::of(5, false);
  EXPECT_NE(over, over);
  EXPECT_TRUE(over.is_doubtful());
  EXPECT_NE(over - UnknownSum::of(5, false), sum);
  EXPECT_NE(sum - over, sum - over);
}

}  // namespace
}  // namespace kerf
