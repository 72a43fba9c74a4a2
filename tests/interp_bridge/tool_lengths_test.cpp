#include "interp_bridge/tool_lengths.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "interp_bridge/motion_fold.h"

namespace kerf {
namespace {

using Verdict = ToolLengthState::Verdict;

/// Calls as a listing has them, folded with T1 60, T2 75, T52 -0.1 mm long.
struct Shop {
  MotionFold fold;
  std::vector<Motion> motions;
  std::uint32_t line = 0;
  int row_of = 0;

  explicit Shop(ToolLengthSetup::Calls calls) {
    ToolLengthSetup setup;
    setup.lengths = {{1, {0, 0, 60}}, {2, {0, 0, 75}}, {52, {0, 0, -0.1}}};
    setup.calls = calls;
    setup.table_unit_mm = calls == ToolLengthSetup::Calls::kCoded ? 25.4 : 1;
    fold.set_lengths(setup);
  }
  Shop& call(const std::string& text) {
    CanonicalLine parsed;
    parse_canonical_line("    1 N..... " + text, parsed);
    EXPECT_EQ(parsed.kind, CanonicalLineKind::kCommand) << text;
    if (row_of > 0 && parsed.command.name == CanonicalName::kUseToolLengthOffset) {
      parsed.command.argument_count = 11;  // as kerf-interp has it: G43 H
      parsed.command.arguments[9] = 1;
      parsed.command.arguments[10] = row_of;
    }
    fold.fold(parsed.command, {0, ++line}, motions);
    return *this;
  }
  Shop& mount(int tool) {
    return call("SELECT_TOOL(" + std::to_string(tool) + ")").call("CHANGE_TOOL(1)");
  }
  Shop& offset(double z, int u, int w) {
    return call("USE_TOOL_LENGTH_OFFSET(0 0 " + std::to_string(z) + ", 0 0 0, " +
                std::to_string(u) + " 0 " + std::to_string(w) + ")");
  }
  Shop& go(double x, double z) {
    return call("STRAIGHT_TRAVERSE(" + std::to_string(x) + ", 0, " + std::to_string(z) +
                ", 0, 0, 0)");
  }
  const Motion& last() const { return motions.back(); }
};

TEST(ToolLengths, TheTipIsWhereTheRealLengthPutsIt) {
  Shop shop(ToolLengthSetup::Calls::kTrue);
  shop.row_of = 1;
  shop.mount(2).offset(60, 0, 0).go(1, 100).go(1, 2);
  const Motion& m = shop.last();
  EXPECT_EQ(m.from_mm, Vec3(1, 0, 85));
  EXPECT_EQ(m.to_mm, Vec3(1, 0, -13));
  EXPECT_EQ(m.tool_offset_mm, Vec3(0, 0, 75)) << "tip and offset are the machine's place";
  EXPECT_EQ(m.length.applied_mm, Vec3(0, 0, 60));
  EXPECT_EQ(m.length.real_mm, Vec3(0, 0, 75));
  EXPECT_EQ(m.length.set_at, (SourceRef{0, 3}));
  EXPECT_EQ(m.length.verdict, Verdict::kWrong);
  EXPECT_EQ(m.length.offset_tool, 1);
}

TEST(ToolLengths, RowsAreNamedByUAndW) {
  Shop shop(ToolLengthSetup::Calls::kCoded);
  shop.mount(2).offset(0, 1, 1).go(1, 100).go(1, 2);
  EXPECT_EQ(shop.last().to_mm, Vec3(1, 0, -13));
  EXPECT_EQ(shop.last().length.verdict, Verdict::kWrong);
  EXPECT_EQ(shop.last().length.offset_tool, 1);
  EXPECT_EQ(shop.last().to_uvw_mm, Vec3(0));
  shop.offset(0, 2, 1).go(1, 3);
  EXPECT_EQ(shop.last().length, ToolLengthState{});
  EXPECT_EQ(shop.last().from_mm, Vec3(1, 0, -13)) << "the machine stood still";
  EXPECT_EQ(shop.last().to_mm, Vec3(1, 0, 3));
  // G43.2 H52 upon it: wear.
  shop.offset(0, 54, 2).go(1, 4);
  EXPECT_EQ(shop.last().length, ToolLengthState{});
}

TEST(ToolLengths, AnotherToolOfTheSameOffsetHasItsTipElsewhere) {
  Shop shop(ToolLengthSetup::Calls::kCoded);
  shop.mount(1).offset(0, 1, 1).go(0, 100).go(0, 20).mount(2).go(5, 20);
  EXPECT_EQ(shop.last().from_mm, Vec3(0, 0, 5));
  EXPECT_EQ(shop.last().to_mm, Vec3(5, 0, 5));
  EXPECT_EQ(shop.last().length.set_at.line, 0U) << "no G43 since the change";
}

TEST(ToolLengths, G49LeavesTheTipWhereItIs) {
  Shop shop(ToolLengthSetup::Calls::kCoded);
  shop.mount(1).offset(0, 1, 1).go(0, 100).go(0, 20).offset(0, 0, 0).go(30, 20);
  EXPECT_EQ(shop.last().to_mm, Vec3(30, 0, 20)) << "Z is not named";
  shop.go(30, 200);
  EXPECT_EQ(shop.last().to_mm, Vec3(30, 0, 140));
}

TEST(ToolLengths, G10ChangesTheRow) {
  Shop shop(ToolLengthSetup::Calls::kCoded);
  shop.mount(2).offset(0, 2, 1).go(1, 100).go(1, 9);
  shop.call("SET_TOOL_TABLE_ENTRY(2, 2, 0 0 3.1496 0 0 0 2 0 1, 0, 0, 0)").go(1, 10);  // 80 mm
  EXPECT_NEAR(shop.last().to_mm.z, 5, 2e-3);
  EXPECT_NEAR(shop.last().length.real_mm.z, 80, 2e-3);
}

TEST(ToolLengths, WhatNothingTellsIsTakenToBeRight) {
  Shop shop(ToolLengthSetup::Calls::kCoded);
  shop.mount(9).offset(0, 1, 1).go(1, 100).go(1, 2);
  EXPECT_EQ(shop.last().length, ToolLengthState{}) << "a tool without a row";
  shop.mount(2).offset(0, 8, 1).go(1, 3);
  EXPECT_EQ(shop.last().length, ToolLengthState{}) << "an offset without one";
  ToolTableRow row;
  row.tool = 1;
  EXPECT_TRUE(known_lengths({row}, 7).empty());
}

TEST(ToolLengths, AHeightThatNobodyHasSaidIsNotMoved) {
  Shop shop(ToolLengthSetup::Calls::kCoded);
  shop.mount(2).go(1, 0).go(2, 0);
  EXPECT_EQ(shop.last().to_mm, Vec3(2, 0, 0));
  shop.go(2, 100);
  EXPECT_EQ(shop.last().to_mm, Vec3(2, 0, 25));
}

}  // namespace
}  // namespace kerf
