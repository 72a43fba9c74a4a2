#include "base/suggest.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {
namespace {

TEST(NearestWord, FindsTypingErrorsOnly) {
  const std::vector<std::string> words = {"--stock", "--tool", "--tool-table", "--stl", "run"};
  EXPECT_EQ(nearest_word("--stcok", words), "--stock");
  EXPECT_EQ(nearest_word("--tools", words), "--tool");
  EXPECT_EQ(nearest_word("rnu", words), "run");
  EXPECT_EQ(nearest_word("--fixture", words), "");
}

TEST(DidYouMean, EndsASentence) {
  constexpr std::array<std::string_view, 2> kNames{"flat", "ball"};
  EXPECT_EQ(did_you_mean("Flt", kNames), "; did you mean 'flat'?");
  EXPECT_EQ(did_you_mean("drill", kNames), ".");
}

}  // namespace
}  // namespace kerf
