#include "viewer/window/code_words.h"

#include <gtest/gtest.h>

#include <string>

namespace kerf {
namespace {

/// "G1 :motion|X5 :place".
std::string words_of(std::string_view line) {
  constexpr const char* kNames[] = {"other", "motion",  "machine", "feed",
                                    "place", "control", "number",  "comment"};
  std::string text;
  std::size_t end = 0;
  for (const CodeWord& word : code_words(line)) {
    EXPECT_EQ(word.begin, end) << line;
    end = word.begin + word.length;
    if (!text.empty()) text += '|';
    text += std::string(line.substr(word.begin, word.length)) + ':' +
            kNames[static_cast<int>(word.kind)];
  }
  EXPECT_EQ(end, line.size()) << line;
  return text;
}

TEST(CodeWords, AreKnownByTheirLetters) {
  EXPECT_EQ(words_of("N10 G1 X-1.5Y2 F300 (to)"),
            "N10 :number|G1 :motion|X-1.5:place|Y2 :place|F300 :feed|(to):comment");
  EXPECT_EQ(words_of("t1 m6 s8000 ; end (really)"),
            "t1 :machine|m6 :machine|s8000 :machine|; end (really):comment");
  EXPECT_EQ(words_of("o100 if [#5 gt 3]"), "o100 :control|if :control|[#5 gt 3]:other");
  EXPECT_EQ(words_of("#<depth> = 3"), "#<depth> :control|= 3:other");
  EXPECT_EQ(words_of("g1x[#<a> + 2]z#3"), "g1:motion|x[#<a> + 2]:place|z#3:place");
}

TEST(CodeWords, AnyLineHasThem) {
  EXPECT_EQ(words_of(""), "");
  EXPECT_EQ(words_of("  G0"), "  :other|G0:motion");
  for (const char* line :
       {"(", "[", "]]>", "#", "G", "%", "\xc3\xa4", "o<", "x[(", "12 34", "==="}) {
    words_of(line);
  }
}

TEST(FindText, LooksPastTheCaseOfLetters) {
  EXPECT_EQ(find_text("N5 G1 x10", "X10"), 6u);
  EXPECT_EQ(find_text("N5 G1 x10", "g2"), std::string_view::npos);
  EXPECT_EQ(find_text("G1", ""), std::string_view::npos);
}

}  // namespace
}  // namespace kerf
