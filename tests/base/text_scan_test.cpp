#include "base/text_scan.h"

#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <cstdint>
#include <string>

#include "base/newline_count.h"

namespace kerf {
namespace {

TEST(TextScan, ClassesAreThoseOfTheLocaleC) {
  for (int code = 0; code < 256; ++code) {
    const char c = static_cast<char>(code);
    EXPECT_EQ(is_digit(c), code < 128 && std::isdigit(code) != 0) << code;
    EXPECT_EQ(is_letter(c), code < 128 && std::isalpha(code) != 0) << code;
    EXPECT_EQ(is_space(c), code < 128 && std::isspace(code) != 0) << code;
    EXPECT_EQ(to_lower(c), static_cast<char>(code < 128 ? std::tolower(code) : code)) << code;
    EXPECT_EQ(to_upper(c), static_cast<char>(code < 128 ? std::toupper(code) : code)) << code;
  }
}

TEST(TextScan, BlanksOfAWordALineAndATextAreWiderOneAfterTheOther) {
  for (int code = 0; code < 256; ++code) {
    const char c = static_cast<char>(code);
    EXPECT_EQ(is_blank(c), c == ' ' || c == '\t') << code;
    EXPECT_EQ(is_line_blank(c), is_blank(c) || c == '\r') << code;
    EXPECT_EQ(is_text_blank(c), is_line_blank(c) || c == '\n') << code;
  }
}

TEST(TextScan, TrimCutsBothEndsAndNothingWithin) {
  EXPECT_EQ(trim(" \t a b\r\n"), "a b");
  EXPECT_EQ(trim("a"), "a");
  EXPECT_EQ(trim(" \n\t\r"), "");
  EXPECT_EQ(trim(""), "");
  EXPECT_EQ(trim("\fa\v"), "\fa\v");
  EXPECT_EQ(trim("\fa \v", is_space), "a");
  EXPECT_EQ(trim(" a\r\n", is_line_blank), "a\r\n");
  EXPECT_EQ(trim("\ta \r", is_blank), "a \r");
}

TEST(TextScan, LettersChangeTheirSizeAndOtherBytesStay) {
  EXPECT_EQ(to_lower("G1 X-3 \xc3\x84Z"), "g1 x-3 \xc3\x84z");
  EXPECT_EQ(to_upper("g1 x-3 \xc3\xa4z"), "G1 X-3 \xc3\xa4Z");
  EXPECT_TRUE(contains("end mill", "d m"));
  EXPECT_TRUE(contains("end mill", ""));
  EXPECT_FALSE(contains("end", "end mill"));
}

TEST(TextScan, LinesAreTakenOneByOne) {
  std::string_view text = "a\r\n\nb";
  EXPECT_EQ(take_line(text), "a\r");
  EXPECT_EQ(take_line(text), "");
  EXPECT_EQ(text, "b");
  EXPECT_EQ(take_line(text), "b");
  EXPECT_EQ(text, "");
  text = "a\n";
  EXPECT_EQ(take_line(text), "a");
  EXPECT_TRUE(text.empty());
}

TEST(TextScan, APrefixIsTakenOrNothing) {
  std::string_view text = "joint.3";
  EXPECT_FALSE(take_prefix(text, "axis."));
  EXPECT_FALSE(take_prefix(text, "joint.33"));
  EXPECT_EQ(text, "joint.3");
  EXPECT_TRUE(take_prefix(text, "joint."));
  EXPECT_EQ(text, "3");
}

TEST(TextScan, PartsAndWords) {
  using Parts = std::vector<std::string_view>;
  EXPECT_EQ(split("a::b", ':'), (Parts{"a", "", "b"}));
  EXPECT_EQ(split("", ':'), Parts{""});
  EXPECT_EQ(split(":", ':'), (Parts{"", ""}));
  EXPECT_EQ(words_of(" a\tbc \r"), (Parts{"a", "bc"}));
  EXPECT_EQ(words_of(" \t"), Parts{});
}

TEST(TextScan, AWholeNumberOrNone) {
  int whole = 0;
  EXPECT_TRUE(read_number("-17", whole));
  EXPECT_EQ(whole, -17);
  for (const char* none : {"", "+1", " 1", "1 ", "1.0", "99999999999", "0x1"}) {
    EXPECT_FALSE(read_number(none, whole)) << none;
  }
  std::uint32_t hex = 0;
  EXPECT_TRUE(read_number("8090a0", hex, 16));
  EXPECT_EQ(hex, 0x8090a0u);
  EXPECT_FALSE(read_number("8090g0", hex, 16));
  double value = 0;
  EXPECT_TRUE(read_number("1e-3", value));
  EXPECT_EQ(value, 1e-3);
  EXPECT_TRUE(read_number("nan", value));
  EXPECT_TRUE(std::isnan(value));
  EXPECT_FALSE(read_number("1e999", value));
}

TEST(TextScan, ADecimalIsFinite) {
  EXPECT_EQ(parse_decimal("12"), 12.0);
  EXPECT_EQ(parse_decimal("+3."), 3.0);
  EXPECT_EQ(parse_decimal("-0.5"), -0.5);
  for (const char* none : {"", "+", "+-1", "++1", "nan", "inf", "1e999", "1,5", "1 "}) {
    EXPECT_EQ(parse_decimal(none), std::nullopt) << none;
  }
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(10), "10");
  EXPECT_EQ(number_text(-0.0), "0");
}

TEST(TextScan, WhatAMessageShows) {
  EXPECT_EQ(shown("a\x01\x7f"), "a??");
  EXPECT_EQ(shown(std::string(60, 'x')), std::string(60, 'x'));
  EXPECT_EQ(shown(std::string(61, 'x')), std::string(60, 'x') + "...");
}

TEST(TextScan, NewlinesAreCountedAtAnyLength) {
  std::string text;
  std::size_t expected = 0;
  for (std::size_t i = 0; i < 9000; ++i) {
    if (i % 61 == 0 || i < 700) {
      EXPECT_EQ(newline_count(text), expected) << i;
    }
    // Runs of them, too, and what differs from them in one bit.
    const bool newline = i % 7 == 0 || (i > 4000 && i < 8500);
    text += newline ? '\n' : i % 3 == 0 ? '\x8a' : '\x0b';
    expected += newline ? 1 : 0;
  }
  EXPECT_EQ(newline_count(text), expected);
}

}  // namespace
}  // namespace kerf
