#include "twin/collision/pair_rules.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace kerf {
namespace {

TEST(PairRules, AToolIsItsParts) {
  EXPECT_TRUE(PairRules::means("tool", "holder"));
  EXPECT_TRUE(PairRules::means("tool", "cutter"));
  EXPECT_FALSE(PairRules::means("tool", "spindle"));
  EXPECT_FALSE(PairRules::means("holder", "tool"));
  EXPECT_TRUE(PairRules::means("head", "head"));
}

TEST(PairRules, TheOrderOfTheTwoDoesNotMatter) {
  PairRules rules;
  rules.ignored = {{"ram", "head"}, {"tool", "vise"}};
  EXPECT_TRUE(rules.ignores("head", "ram"));
  EXPECT_TRUE(rules.ignores("ram", "head"));
  EXPECT_TRUE(rules.ignores("vise", "shank"));
  EXPECT_FALSE(rules.ignores("vise", "spindle"));
  EXPECT_FALSE(rules.ignores("head", "head"));
}

TEST(PairRules, TheFirstClearanceThatFitsCounts) {
  PairRules rules;
  rules.clearances = {{{"vise", "holder"}, 2}, {{"tool", "vise"}, 1}};
  EXPECT_EQ(rules.clearance_mm("holder", "vise"), 2);
  EXPECT_EQ(rules.clearance_mm("vise", "cutter"), 1);
  EXPECT_EQ(rules.clearance_mm("vise", "table"), std::nullopt);
}

TEST(PairRules, NamesAreThoseOfBodiesAndOfWhatEachMachineHas) {
  const std::vector<std::string> bodies{"head", "vise"};
  const std::vector<std::string> names = PairRules::names(bodies);
  for (const char* name : {"head", "vise", "tool", "holder", "spindle", "workpiece"})
    EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
}

}  // namespace
}  // namespace kerf
