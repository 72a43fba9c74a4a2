// Which axes MotionFold knows, block by block.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "interp_bridge/motion_fold.h"

namespace kerf {
namespace {

constexpr std::uint8_t kX = 1;
constexpr std::uint8_t kY = 2;
constexpr std::uint8_t kZ = 4;
constexpr std::uint8_t kXyz = 7;

/// Blocks with the calls that the interpreter makes of them, from a start that is not known.
class Places : public testing::Test {
 protected:
  explicit Places(std::uint8_t zero_known = 0) { fold_.start_unknown({}, kXyz, zero_known); }

  Motion run(const char* block, std::initializer_list<const char*> calls) {
    words_ = words_of_block(block);
    fold_.set_block(&words_);
    ++line_;
    for (const char* call : calls) {
      const std::string text = "    1 N..... " + std::string(call);
      CanonicalLine line;
      parse_canonical_line(text, line);
      EXPECT_EQ(line.kind, CanonicalLineKind::kCommand) << call;
      fold_.fold(line.command, {0, line_}, motions_);
    }
    return motions_.empty() ? Motion{} : motions_.back();
  }

  MotionFold fold_;
  BlockWords words_;
  std::uint32_t line_ = 0;
  std::vector<Motion> motions_;
};

class PlacesWithOffset : public Places {
 protected:
  PlacesWithOffset() : Places(kXyz) {}
};

TEST_F(Places, EachAxisByTheBlockThatNamesIt) {
  const Motion xy = run("G0 X50 Y30", {"STRAIGHT_TRAVERSE(50, 30, 0, 0, 0, 0)"});
  EXPECT_FALSE(xy.start_known);
  EXPECT_EQ(xy.unknown_from, kXyz);
  EXPECT_EQ(xy.unknown_to, kZ);
  EXPECT_EQ(xy.from_mm, xy.to_mm);
  const Motion z = run("G43 Z15 H1", {"STRAIGHT_TRAVERSE(50, 30, 15, 0, 0, 0)"});
  EXPECT_FALSE(z.start_known);
  EXPECT_EQ(z.unknown_from, kZ);
  EXPECT_EQ(z.unknown_to, 0);
  const Motion down = run("G1 Z-1", {"STRAIGHT_FEED(50, 30, -1, 0, 0, 0)"});
  EXPECT_TRUE(down.start_known);
  EXPECT_EQ(down.from_mm, Vec3(50, 30, 15));
}

TEST_F(Places, ANamedZeroIsAPlace) {
  EXPECT_EQ(run("G0 Z0", {"STRAIGHT_TRAVERSE(0, 0, 0, 0, 0, 0)"}).unknown_to, kX | kY);
  EXPECT_EQ(run("G0 X0", {"STRAIGHT_TRAVERSE(0, 0, 0, 0, 0, 0)"}).unknown_to, kY);
  EXPECT_EQ(run("G0 Y0", {"STRAIGHT_TRAVERSE(0, 0, 0, 0, 0, 0)"}).unknown_to, 0);
}

TEST_F(Places, IncrementalFromNowhereEndsNowhere) {
  run("G91", {"COMMENT(\"interpreter: distance mode changed to incremental\")"});
  EXPECT_EQ(run("G0 X5 Y5 Z5", {"STRAIGHT_TRAVERSE(5, 5, 5, 0, 0, 0)"}).unknown_to, kXyz);
  run("G90", {"COMMENT(\"interpreter: distance mode changed to absolute\")"});
  EXPECT_EQ(run("G0 Z5", {"STRAIGHT_TRAVERSE(5, 5, 5, 0, 0, 0)"}).unknown_to, kX | kY);
}

TEST_F(Places, MachinePlacesAreNotKnown) {
  run("G0 X5 Y5 Z5", {"STRAIGHT_TRAVERSE(5, 5, 5, 0, 0, 0)"});
  const Motion up = run("G53 G0 Z0", {"STRAIGHT_TRAVERSE(5, 5, 0, 0, 0, 0)"});
  EXPECT_FALSE(up.start_known);
  EXPECT_TRUE(up.to_machine_place);
  EXPECT_EQ(up.unknown_from, 0);
  EXPECT_EQ(up.unknown_to, kZ);
  const Motion aside = run("G0 X9", {"STRAIGHT_TRAVERSE(9, 5, 0, 0, 0, 0)"});
  EXPECT_EQ(aside.unknown_to, kZ);
  EXPECT_FALSE(aside.to_machine_place);
}

TEST_F(Places, ReferenceGoesByWayOfAKnownPlace) {
  run("G0 X5 Y5 Z5", {"STRAIGHT_TRAVERSE(5, 5, 5, 0, 0, 0)"});
  for (int pass = 0; pass < 2; ++pass) {
    run("G28 Z20", {"STRAIGHT_TRAVERSE(5, 5, 20, 0, 0, 0)", "STRAIGHT_TRAVERSE(5, 5, 0, 0, 0, 0)"});
    const Motion& way = motions_[motions_.size() - 2];
    const Motion& home = motions_.back();
    EXPECT_EQ(way.unknown_to, 0) << pass;
    EXPECT_EQ(way.to_mm.z, 20) << pass;
    EXPECT_EQ(home.unknown_from, 0) << pass;
    EXPECT_EQ(home.unknown_to, kZ) << pass;
    --line_;  // the same block once more, as in a loop
  }
  run("G28", {"STRAIGHT_TRAVERSE(5, 5, 0, 0, 0, 0)", "STRAIGHT_TRAVERSE(0, 0, 0, 0, 0, 0)"});
  EXPECT_EQ(motions_.back().unknown_to, kXyz);
}

/// A lathe has no Y.
TEST_F(Places, AnAxisThatDoesNotMatterIsKnownEverywhere) {
  fold_.start_unknown({}, 5, 0, 5);
  EXPECT_EQ(run("G30", {"STRAIGHT_TRAVERSE(0.0, 0.0, 0.0, 0, 0, 0)",
                        "STRAIGHT_TRAVERSE(3.0, 4.0, 5.0, 0, 0, 0)"})
                .unknown_to,
            5);
  EXPECT_EQ(run("G0 X1", {"STRAIGHT_TRAVERSE(1.0, 4.0, 5.0, 0, 0, 0)"}).unknown_to, 4);
  EXPECT_EQ(run("G0 Z1", {"STRAIGHT_TRAVERSE(1.0, 4.0, 1.0, 0, 0, 0)"}).unknown_to, 0);
}

TEST_F(PlacesWithOffset, MachinePlacesAreKnown) {
  run("", {"SET_G5X_OFFSET(1, 10, 20, -50, 0, 0, 0)"});
  const Motion up = run("G53 G0 Z0", {"STRAIGHT_TRAVERSE(-10, -20, 50, 0, 0, 0)"});
  EXPECT_EQ(up.unknown_to, kX | kY);
  EXPECT_FALSE(up.to_machine_place);
  const Motion xy = run("G0 X5 Y5", {"STRAIGHT_TRAVERSE(5, 5, 50, 0, 0, 0)"});
  EXPECT_EQ(xy.unknown_to, 0);
  EXPECT_EQ(xy.to_mm, Vec3(5, 5, 50));
}

TEST_F(Places, TheProgramSaysWhereTheToolStands) {
  run("G92 X0 Z3", {"SET_G92_OFFSET(0, 0, -3, 0, 0, 0)"});
  const Motion y = run("G0 Y5", {"STRAIGHT_TRAVERSE(0, 5, 3, 0, 0, 0)"});
  EXPECT_EQ(y.unknown_from, kY);
  EXPECT_EQ(y.to_mm, Vec3(0, 5, 3));
  EXPECT_TRUE(run("G0 Z9", {"STRAIGHT_TRAVERSE(0, 5, 9, 0, 0, 0)"}).start_known);
  // Back in the offset without it nothing says where that is.
  run("G92.1", {"SET_G92_OFFSET(0, 0, 0, 0, 0, 0)"});
  const Motion z = run("G0 Z9", {"STRAIGHT_TRAVERSE(0, 5, 9, 0, 0, 0)"});
  EXPECT_EQ(z.unknown_from, 0);
  EXPECT_EQ(z.unknown_to, kZ);
}

TEST_F(Places, AShiftWhereAllIsKnownStaysKnown) {
  run("G0 X5 Y5 Z5", {"STRAIGHT_TRAVERSE(5, 5, 5, 0, 0, 0)"});
  run("G92 Z0", {"SET_G92_OFFSET(0, 0, 5, 0, 0, 0)"});
  const Motion up = run("G0 Z10", {"STRAIGHT_TRAVERSE(5, 5, 10, 0, 0, 0)"});
  EXPECT_TRUE(up.start_known);
  EXPECT_EQ(up.to_mm.z, 15);
  run("G92.1", {"SET_G92_OFFSET(0, 0, 0, 0, 0, 0)"});
  EXPECT_TRUE(run("G0 Z10", {"STRAIGHT_TRAVERSE(5, 5, 10, 0, 0, 0)"}).start_known);
}

TEST_F(Places, AShiftIsThatOfThePlaceWhereItWasGiven) {
  run("G92 Z10", {"SET_G92_OFFSET(0, 0, -10, 0, 0, 0)"});
  run("G0 X0 Y0 Z5", {"STRAIGHT_TRAVERSE(0, 0, 5, 0, 0, 0)"});
  EXPECT_EQ(motions_.back().unknown_to, 0);
  // The shift goes with the program from system to system.
  run("G55", {"SET_G5X_OFFSET(2, 0, 0, 0, 0, 0, 0)", "SET_G92_OFFSET(0, 0, -10, 0, 0, 0)"});
  EXPECT_EQ(run("G0 Z6", {"STRAIGHT_TRAVERSE(0, 0, 6, 0, 0, 0)"}).unknown_to, 0);
  run("G92.2", {"SET_G92_OFFSET(0, 0, 0, 0, 0, 0)"});
  EXPECT_EQ(run("G0 Z6", {"STRAIGHT_TRAVERSE(0, 0, 6, 0, 0, 0)"}).unknown_to, kZ);
  run("G92.3", {"SET_G92_OFFSET(0, 0, -10, 0, 0, 0)"});
  EXPECT_EQ(run("G0 Z6", {"STRAIGHT_TRAVERSE(0, 0, 6, 0, 0, 0)"}).unknown_to, 0);
  run("G92.1", {"SET_G92_OFFSET(0, 0, 0, 0, 0, 0)"});
  run("G92.3", {"SET_G92_OFFSET(0, 0, 0, 0, 0, 0)"});
  EXPECT_EQ(run("G0 Z6", {"STRAIGHT_TRAVERSE(0, 0, 6, 0, 0, 0)"}).unknown_to, kZ);
}

TEST_F(Places, ALocalSystemTakesThePlaceOfAShift) {
  run("G92 X0 Y0 Z10", {"SET_G92_OFFSET(0, 0, -10, 0, 0, 0)"});
  EXPECT_EQ(run("G0 X0 Y0 Z5", {"STRAIGHT_TRAVERSE(0, 0, 5, 0, 0, 0)"}).unknown_to, 0);
  run("G52 X3", {"SET_G92_OFFSET(3, 0, -10, 0, 0, 0)"});
  EXPECT_EQ(run("G0 Z6", {"STRAIGHT_TRAVERSE(-3, 0, 6, 0, 0, 0)"}).unknown_to, 0);
  EXPECT_EQ(run("G0 X0", {"STRAIGHT_TRAVERSE(0, 0, 6, 0, 0, 0)"}).unknown_to, kX);
}

TEST_F(Places, ASystemThatIsTouchedOffIsRelatedToNoOther) {
  run("G10 L20 P1 X0 Y0 Z10", {"SET_G5X_OFFSET(1, 0, 0, -10, 0, 0, 0)"});
  run("G0 X0 Y0 Z5", {"STRAIGHT_TRAVERSE(0, 0, 5, 0, 0, 0)"});
  EXPECT_EQ(motions_.back().unknown_to, 0);
  run("G55", {"SET_G5X_OFFSET(2, 0, 0, 0, 0, 0, 0)"});
  EXPECT_EQ(run("G0 Z5", {"STRAIGHT_TRAVERSE(0, 0, 5, 0, 0, 0)"}).unknown_to, kZ);
  // What is touched off there is G55's.
  fold_.store(words_of_block("G10 L20 P3 Z0"));
  run("G56", {"SET_G5X_OFFSET(3, 0, 0, 5, 0, 0, 0)"});
  EXPECT_EQ(run("G0 Z1", {"STRAIGHT_TRAVERSE(0, 0, 1, 0, 0, 0)"}).unknown_to, kZ);
  run("G54", {"SET_G5X_OFFSET(1, 0, 0, -10, 0, 0, 0)"});
  EXPECT_EQ(run("G0 Z5", {"STRAIGHT_TRAVERSE(0, 0, 5, 0, 0, 0)"}).unknown_to, 0);
  // And here that of the workpiece.
  fold_.store(words_of_block("G10 L20 P3 Z0"));
  run("G56", {"SET_G5X_OFFSET(3, 0, 0, -5, 0, 0, 0)"});
  EXPECT_EQ(run("G0 Z1", {"STRAIGHT_TRAVERSE(0, 0, 1, 0, 0, 0)"}).unknown_to, 0);
}

TEST_F(Places, AnArcFromNowhereHasNoSweep) {
  run("G0 Y0 Z5", {"STRAIGHT_TRAVERSE(0, 0, 5, 0, 0, 0)"});
  const Motion arc = run("G2 X10 I5", {"ARC_FEED(10, 0, 5, 0, -1, 5, 0, 0, 0)"});
  EXPECT_FALSE(arc.start_known);
  EXPECT_EQ(arc.arc.sweep_rad, 0);
  EXPECT_EQ(arc.unknown_to, 0);
}

TEST_F(Places, AToolChangeThatMovesTheMachine) {
  run("G0 X5 Y5 Z5", {"STRAIGHT_TRAVERSE(5, 5, 5, 0, 0, 0)"});
  EXPECT_EQ(run("T1 M6", {"STRAIGHT_TRAVERSE(5, 5, 100, 0, 0, 0)"}).unknown_to, kZ);
}

}  // namespace
}  // namespace kerf
