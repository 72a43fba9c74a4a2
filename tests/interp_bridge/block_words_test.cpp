#include "interp_bridge/block_words.h"

#include <gtest/gtest.h>

#include "tests/base/temporary_folder.h"

namespace kerf {
namespace {

using Offset = BlockWords::Offset;
using Place = BlockWords::Place;
using Speed = BlockWords::Speed;

constexpr int kX = 1;
constexpr int kY = 2;
constexpr int kZ = 4;

TEST(BlockWords, NamedAxes) {
  EXPECT_EQ(words_of_block("G0 X50 Y30").named, kX | kY);
  EXPECT_EQ(words_of_block("n10g43z15h1").named, kZ);
  EXPECT_EQ(words_of_block("X1.5Y-.2Z[3+#<z_top>] F200").named, kX | kY | kZ);
  EXPECT_EQ(words_of_block("G1 X#1 (Y and Z)").named, kX);
  EXPECT_EQ(words_of_block("G1 Z- 2 ; X5 Y5").named, kZ);
  EXPECT_EQ(words_of_block("@10 ^45").named, kX | kY);
}

TEST(BlockWords, ExpressionsNameNothing) {
  EXPECT_EQ(words_of_block("#5=[exp[2]+max[#x]] G1 F100").named, 0);
  EXPECT_EQ(words_of_block("#<xyz> = 5").named, 0);
  EXPECT_EQ(words_of_block("G1 X fix[#<y>] F[exp[1]]").named, kX);
  EXPECT_EQ(words_of_block("G1 X atan[#2]/[#3] Z1").named, kX | kZ);
  EXPECT_EQ(words_of_block("G1 Y-exp[2]").named, kY);
}

TEST(BlockWords, ComputedWordsAreToldApart) {
  EXPECT_EQ(words_of_block("G1 X1 Y[#1+1] Z-#<z>").computed, kY | kZ);
  EXPECT_EQ(words_of_block("G10 L20 P1 Z19.1").computed, 0);
  EXPECT_EQ(words_of_block("G92 Z[19.1]").computed, kZ);
}

TEST(BlockWords, OWordsHaveNoAxes) {
  EXPECT_EQ(words_of_block("o<box> call [10] [#<z>]").named, 0);
  EXPECT_EQ(words_of_block("N12 o100 if [#1 EQ 2]").named, 0);
}

TEST(BlockWords, Places) {
  EXPECT_EQ(words_of_block("G53 G0 Z0").place, Place::kMachine);
  EXPECT_EQ(words_of_block("G053Z0").place, Place::kMachine);
  EXPECT_EQ(words_of_block("g91 g28 z0").place, Place::kReference);
  EXPECT_EQ(words_of_block("G30").place, Place::kReference);
  EXPECT_EQ(words_of_block("T1 M06").place, Place::kToolChange);
  EXPECT_EQ(words_of_block("T1 M6 G53 G0 Z0").place, Place::kMachine);
  for (const char* other : {"G28.1", "G30.1", "G2 X3", "G54", "M60", "G5 X3", "(G53)"}) {
    EXPECT_EQ(words_of_block(other).place, Place::kProgram) << other;
  }
}

TEST(BlockWords, Offsets) {
  EXPECT_EQ(words_of_block("G92 X0").offset, Offset::kShift);
  EXPECT_EQ(words_of_block("G92.1").offset, Offset::kUnshift);
  EXPECT_EQ(words_of_block("G92.2").offset, Offset::kSuspend);
  EXPECT_EQ(words_of_block("G92.3").offset, Offset::kReshift);
  EXPECT_EQ(words_of_block("G10 L20 P1 Z0").offset, Offset::kTouchOff);
  EXPECT_EQ(words_of_block("G10 L2 P1 X5").offset, Offset::kMachine);
  EXPECT_EQ(words_of_block("G10 L1 P1 Z5").offset, Offset::kNone);
  EXPECT_EQ(words_of_block("G1 L2 X5").offset, Offset::kNone);
}

TEST(BlockWords, Speeds) {
  EXPECT_EQ(words_of_block("G00X5").speed, Speed::kRapid);
  EXPECT_EQ(words_of_block("G03 X5").speed, Speed::kFeed);
  EXPECT_EQ(words_of_block("X5").speed, Speed::kUnsaid);
}

/// A file in a folder of its own.
class BlockFile : public testing::Test {
 protected:
  void write(const std::string& text) { write_file(path_, text); }

  TemporaryFolder folder_;
  std::string path_ = folder_ / "blocks.ngc";
};

TEST_F(BlockFile, LinesForthAndBack) {
  std::string text;
  // Longer than the pieces in which files are read.
  for (int i = 1; i <= 40'000; ++i) text += i % 1000 == 0 ? "G53 Z0\n" : "G1 X5 (a line)\n";
  write(text + "Y7");
  BlockReader reader;
  const std::vector<std::string> files = {path_};
  for (const std::uint32_t line : {1U, 39'999U, 2U, 1001U, 40'000U, 1000U}) {
    const BlockWords* const words = reader.at({0, line}, files, 7);
    ASSERT_NE(words, nullptr) << line;
    EXPECT_EQ(words->named, line % 1000 == 0 ? kZ : kX) << line;
  }
  EXPECT_EQ(reader.at({0, 40'001}, files, 7)->named, kY);
  EXPECT_EQ(reader.at({0, 40'002}, files, 7), nullptr);
  EXPECT_EQ(reader.at({0, 0}, files, 7), nullptr);
  EXPECT_EQ(reader.at({1, 1}, files, 7), nullptr);
}

TEST_F(BlockFile, OnlySpecialBlocksWhereAllIsPlaced) {
  write("G0 X5\nG53 G0 Z0\nT1 M6\n");
  BlockReader reader;
  const std::vector<std::string> files = {path_};
  EXPECT_EQ(reader.at({0, 1}, files, 0)->named, 0);
  EXPECT_EQ(reader.at({0, 2}, files, 0)->named, kZ);
  EXPECT_EQ(reader.at({0, 3}, files, 0)->place, Place::kToolChange);
}

TEST(BlockWords, WhatIsKeptForLater) {
  using Store = BlockWords::Store;
  EXPECT_EQ(words_of_block("G28.1").store, Store::kFirst);
  EXPECT_EQ(words_of_block("g 30 . 1").store, Store::kSecond);
  EXPECT_EQ(words_of_block("G28").store, Store::kNone);
  EXPECT_TRUE(words_of_block("G30 Z0").second_reference);
  const BlockWords offset = words_of_block("G10 L20 P2 Z-19.1 X#1");
  EXPECT_TRUE(stores(offset));
  EXPECT_EQ(offset.system, 2);
  EXPECT_EQ(offset.z, -19.1);
  EXPECT_EQ(words_of_block("G10 L2 P[#5220] X0").system, -1);
  EXPECT_FALSE(stores(words_of_block("G10 L1 P1 Z5")));
  for (const char* line : {"G28.1", "g 030.1", "G10L2P1", "N5 G10 P2 L20"}) {
    EXPECT_TRUE(may_store(line)) << line;
  }
  for (const char* line : {"G1 X28.1 F30.1", "G17", "M6 T1", "(x)"}) {
    EXPECT_FALSE(may_store(line)) << line;
  }
}

TEST_F(BlockFile, AxesThatAreNeverNamed) {
  write("G0 X5 (Z5)\nG1 Y5 F100\nM2\n");
  EXPECT_EQ(BlockReader().named_in(path_), kX | kY);
  write("G0 X5\no<side> call\nM2\n");
  EXPECT_EQ(BlockReader().named_in(path_), 7);
  write("X5\nM98 P100\nM2\n");
  EXPECT_EQ(BlockReader().named_in(path_), 7);
  EXPECT_EQ(BlockReader().named_in("/nonexistent/x.ngc"), 7);
}

}  // namespace
}  // namespace kerf
