#include "twin/report/line_window.h"

#include <gtest/gtest.h>

#include <vector>

namespace kerf {
namespace {

std::vector<Motion> lines(std::initializer_list<std::uint32_t> list) {
  std::vector<Motion> out;
  for (const std::uint32_t line : list) {
    out.emplace_back().source.line = line;
  }
  return out;
}

void expect_split(const LineWindow::Split& split, std::size_t before, std::size_t within) {
  EXPECT_EQ(split.before, before);
  EXPECT_EQ(split.within, within);
}

TEST(LineWindow, WithoutARangeAllIsWithin) {
  LineWindow window({});
  EXPECT_TRUE(window.begun());
  expect_split(window.split(lines({5, 4, 9})), 0, 3);
  EXPECT_FALSE(window.over());
}

TEST(LineWindow, BeginsAtTheFirstLineNotAbove) {
  LineWindow window({.from = 10});
  expect_split(window.split(lines({8, 9})), 2, 0);
  EXPECT_FALSE(window.begun());
  expect_split(window.split(lines({9, 12, 3, 13})), 1, 3);
  EXPECT_TRUE(window.begun());
  expect_split(window.split(lines({2})), 0, 1);
}

TEST(LineWindow, EndsBeforeTheFirstLineBeyondAndStaysEnded) {
  LineWindow window({.until = 10});
  expect_split(window.split(lines({8, 10, 10})), 0, 3);
  EXPECT_FALSE(window.over());
  expect_split(window.split(lines({3, 11, 4})), 0, 1);
  EXPECT_TRUE(window.over());
  expect_split(window.split(lines({4})), 0, 0);
}

TEST(LineWindow, BothInOneBatchAndABeginBeyondTheEnd) {
  LineWindow window({.from = 5, .until = 6});
  expect_split(window.split(lines({4, 5, 6, 7, 5})), 1, 2);
  EXPECT_TRUE(window.over());
  LineWindow skipped({.from = 5, .until = 6});
  expect_split(skipped.split(lines({4, 9})), 1, 0);
  EXPECT_FALSE(skipped.begun());
  EXPECT_TRUE(skipped.over());
}

TEST(LineWindow, OtherFilesAndUnknownLinesGoWithWhatCameBefore) {
  LineWindow window({.from = 10, .until = 20});
  std::vector<Motion> motions = lines({5, 0, 15, 10, 30, 0, 16});
  motions[3].source.file = 1;
  motions[4].source.file = 1;
  expect_split(window.split(motions), 2, 5);
  EXPECT_FALSE(window.over());
}

}  // namespace
}  // namespace kerf
