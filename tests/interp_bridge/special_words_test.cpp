#include "interp_bridge/special_words.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "base/text_scan.h"

namespace kerf {
namespace {

TEST(SpecialWords, AreKnownInAllTheirSpellings) {
  for (const char* const line : {"G28", "g 28", "G028 X1", "N10 G30.1", "X1G53G0Y2", "G9 2 X0",
                                 "G1 0L2", "G\t10", "M6", "T1 m06", "M 0 6", "G52X1", "g5\r3"}) {
    EXPECT_TRUE(may_be_special(line)) << line;
    const std::string text =
        "G0 X1\nG1 X2 Y3 Z4 F500\n" + std::string(line) + "\n" + std::string(40, ' ');
    EXPECT_LE(find_special(text), text.find(line) + 4) << line;
  }
  for (const char* const line : {"G0 X10", "G00X1", "G1 X1 Y2", "G01 Y20", "G2X1", "G03 I1", "M3",
                                 "M05 X6", "X1 Y2", "G4 P1", "G64 P0.1", "G80", "", "G", "M0"}) {
    EXPECT_FALSE(may_be_special(line)) << line;
  }
}

/// What most of a long program is made of costs no look at its lines.
TEST(SpecialWords, PlainMovesAreNotStoppedAt) {
  for (const std::string line :
       {"G1 X10.5 Y-3 Z0.25\n", "G01 X1 Y2\n", "G0X5Z1\n", "G03 X1 Y1 I1 J0\r\n", "N100 G00 Z5\n",
        "X1.5 Y2 M3 S8000\n", "G1 F1200\n"}) {
    std::string text;
    for (int i = 0; i < 50; ++i) text += line;
    EXPECT_GE(find_special(text), text.size() - 20) << line;
  }
}

/// All special lines, looked for line by line.
std::vector<std::size_t> special_lines(std::string_view text) {
  std::vector<std::size_t> found;
  for (std::size_t line = 0; !text.empty(); ++line) {
    if (may_be_special(take_line(text))) found.push_back(line);
  }
  return found;
}

/// And by going from place to place.
std::vector<std::size_t> lines_found(std::string_view text) {
  std::vector<std::size_t> found;
  std::size_t line = 0;
  while (!text.empty()) {
    const std::size_t at = find_special(text);
    if (at == text.npos) break;
    const std::size_t before = text.substr(0, at).rfind('\n');
    const std::size_t begin = before == text.npos ? 0 : before + 1;
    for (const char c : text.substr(0, begin)) line += c == '\n' ? 1 : 0;
    text.remove_prefix(begin);
    if (may_be_special(take_line(text))) found.push_back(line);
    ++line;
  }
  return found;
}

TEST(SpecialWords, NoneIsPassedOverInAnyText) {
  std::mt19937 random(5);
  constexpr std::string_view kSigns = "gGmM00112235669  \t\rxX.(-\n";
  std::uniform_int_distribution<std::size_t> sign(0, kSigns.size() - 1);
  std::uniform_int_distribution<std::size_t> length(0, 90);
  std::size_t specials = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::string text(length(random), ' ');
    for (char& c : text) c = kSigns[sign(random)];
    const std::vector<std::size_t> wanted = special_lines(text);
    specials += wanted.size();
    ASSERT_EQ(lines_found(text), wanted) << text;
  }
  EXPECT_GT(specials, 10'000U);
}

}  // namespace
}  // namespace kerf
