#include "twin/process/cut_labels.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>

namespace kerf {
namespace {

TEST(CutLabels, OneNumberForAllCutsOfALine) {
  CutLabels labels;
  EXPECT_EQ(labels.number_of({1, {0, 7}}), 0u);
  EXPECT_EQ(labels.number_of({1, {0, 7}}), 0u);
  EXPECT_EQ(labels.number_of({1, {0, 8}}), 1u);
  EXPECT_EQ(labels.number_of({2, {0, 7}}), 2u) << "another tool";
  EXPECT_EQ(labels.number_of({1, {1, 7}}), 3u) << "another file";
  EXPECT_EQ(labels.number_of({1, {0, 7}}), 0u) << "the program runs again";
  ASSERT_EQ(labels.all().size(), 4u);
  EXPECT_EQ(labels.all()[2], (CutLabel{2, {0, 7}}));
}

TEST(CutLabels, WhatTheCutsOfALabelDoAddsUp) {
  CutLabels labels;
  const std::uint32_t seven = labels.number_of({1, {0, 7}});
  const std::uint32_t eight = labels.number_of({1, {0, 8}});
  labels.note(seven, 2.5, 0.5);
  labels.note(eight, 1.0, 0.25);
  labels.note(seven, 0.0, 0.5);
  labels.note(CutLabels::kUnknown, 9.0, 9.0);
  EXPECT_EQ(labels.all()[seven].removed_mm3, 2.5);
  EXPECT_EQ(labels.all()[seven].cut_s, 1.0);
  EXPECT_EQ(labels.all()[eight].removed_mm3, 1.0);
  EXPECT_EQ(labels.number_of({1, {0, 7}}), seven) << "it is the same label";
}

TEST(CutLabels, AsAMapHasThem) {
  CutLabels labels;
  std::map<std::tuple<int, unsigned, unsigned>, std::uint32_t> known;
  std::mt19937 random(7);
  for (int i = 0; i < 100'000; ++i) {
    const CutLabel label{
        static_cast<int>(random() % 5) - 1,
        {static_cast<std::uint32_t>(random() % 3), static_cast<std::uint32_t>(random() % 4000)}};
    const auto [place, is_new] =
        known.emplace(std::tuple(label.tool, label.source.file, label.source.line),
                      static_cast<std::uint32_t>(known.size()));
    const std::uint32_t number = labels.number_of(label);
    ASSERT_EQ(number, place->second);
    ASSERT_EQ(labels.all()[number], label);
  }
  EXPECT_EQ(labels.all().size(), known.size());
}

TEST(CutLabels, BeyondTheMostTheLineIsNotKept) {
  CutLabels labels(100);
  for (std::uint32_t line = 1; line <= 5000; ++line) labels.number_of({1, {0, line}});
  EXPECT_EQ(labels.all().size(), 101u);
  const std::uint32_t number = labels.number_of({1, {0, 6000}});
  EXPECT_EQ(labels.all()[number], (CutLabel{1, {}})) << "but the tool is";
  EXPECT_EQ(labels.number_of({1, {0, 3}}), 2u) << "nor are those forgotten that came before";
  for (int tool = 2; tool < 5000; ++tool) labels.number_of({tool, {0, 1}});
  EXPECT_EQ(labels.all().size(), 100 + CutLabels::kSpare);
  EXPECT_EQ(labels.number_of({6000, {0, 1}}), CutLabels::kUnknown);
}

}  // namespace
}  // namespace kerf
