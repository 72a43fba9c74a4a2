#include "viewer/source_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace kerf {
namespace {

constexpr int kBlock = SourceFile::kBlockLines;

/// As a program of milling is written.
std::string program_of(int lines) {
  std::string text;
  for (int n = 1; n <= lines; ++n) text += fmt::format("G1 X{}.25 Y{}.5 Z-{}\n", n, n % 150, n % 7);
  return text;
}

std::string line_of_program(int n) {
  return fmt::format("G1 X{}.25 Y{}.5 Z-{}", n, n % 150, n % 7);
}

TEST(SourceFile, EveryLineInAnyOrder) {
  for (const int count : {1, 2, kBlock - 1, kBlock, kBlock + 1, 2 * kBlock, 5 * kBlock + 17}) {
    const SourceFile file("a.ngc", program_of(count));
    ASSERT_EQ(file.line_count(), count);
    SourceLines lines(file);
    for (int n = 1; n <= count; ++n) ASSERT_EQ(lines.line(n), line_of_program(n));
    for (int n = count; n >= 1; --n) ASSERT_EQ(lines.line(n), line_of_program(n));
    std::mt19937 random(7);
    for (int i = 0; i < 50; ++i) {
      const int n = 1 + static_cast<int>(random() % static_cast<unsigned>(count));
      ASSERT_EQ(file.line(n), line_of_program(n));
    }
    EXPECT_EQ(lines.line(0), "");
    EXPECT_EQ(lines.line(-1), "");
    EXPECT_EQ(lines.line(count + 1), "");
  }
}

TEST(SourceFile, EndsOfLines) {
  EXPECT_EQ(SourceFile("a", "").line_count(), 0);
  EXPECT_EQ(SourceFile("a", "").line(1), "");
  EXPECT_EQ(SourceFile("a", "\n").line_count(), 1);
  const SourceFile file("a", "G21\r\n\r\n\nM2 \n  end");
  ASSERT_EQ(file.line_count(), 5);
  EXPECT_EQ(file.line(1), "G21");
  EXPECT_EQ(file.line(2), "");
  EXPECT_EQ(file.line(3), "");
  EXPECT_EQ(file.line(4), "M2 ");
  EXPECT_EQ(file.line(5), "  end");
  // One that has no end is the last line of a block, and the first of one.
  for (const int whole : {kBlock - 1, kBlock}) {
    const SourceFile open("a", program_of(whole) + "M30");
    EXPECT_EQ(open.line_count(), whole + 1);
    EXPECT_EQ(open.line(whole + 1), "M30");
    EXPECT_EQ(open.line(whole), line_of_program(whole));
  }
}

TEST(SourceFile, AStreamIsTheSame) {
  // Longer than what is read at once, with lines that lie across.
  const std::string text = program_of(9000) + "M2";
  std::istringstream stream(text);
  const SourceFile read("a", stream), given("a", text);
  ASSERT_EQ(read.line_count(), 9001);
  SourceLines of_read(read), of_given(given);
  for (int n = 1; n <= 9001; ++n) ASSERT_EQ(of_read.line(n), of_given.line(n));
  std::istringstream empty;
  EXPECT_EQ(SourceFile("a", empty).line_count(), 0);
}

TEST(SourceFile, BytesOfAllKindsAndLinesOfAnyLength) {
  std::mt19937 random(3);
  std::vector<std::string> lines;
  std::string text;
  const auto add = [&](std::size_t length) {
    std::string line(length, '\0');
    for (char& c : line) c = static_cast<char>(random());
    for (char& c : line) c = c == '\n' || c == '\r' ? 'x' : c;
    text += line + '\n';
    lines.push_back(std::move(line));
  };
  for (int n = 0; n < 600; ++n) add(random() % 40);
  add(2 * SourceFile::kMostPacked);
  for (int n = 0; n < 300; ++n) add(random() % 40);
  lines.emplace_back(3 * SourceFile::kMostPacked, 'G');
  text += lines.back();
  const SourceFile file("a", text);
  ASSERT_EQ(file.line_count(), static_cast<int>(lines.size()));
  SourceLines read(file);
  for (std::size_t n = 0; n < lines.size(); ++n) {
    ASSERT_EQ(read.line(static_cast<int>(n) + 1), lines[n]) << n;
  }
}

TEST(SourceFile, AProgramIsSmall) {
  const std::string text = program_of(100'000);
  EXPECT_LT(SourceFile("a", text).bytes(), text.size() / 3);
}

}  // namespace
}  // namespace kerf
