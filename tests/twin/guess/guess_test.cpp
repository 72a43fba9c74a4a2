// What is taken of a program when nothing is known: tools, beams, and how it is said.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "stock/blank.h"
#include "stock/cutter/shape_spec.h"
#include "tests/twin/process/motions.h"
#include "twin/guess/beam_guess.h"
#include "twin/guess/program_survey.h"
#include "twin/guess/tool_guess.h"
#include "twin/job/blank_choice.h"
#include "twin/motion/motion_geometry.h"
#include "twin/report/guess_row.h"

namespace kerf {
namespace {

ToolTrace traced(const MotionList& program) {
  ToolTrace trace;
  for (const Motion& m : program.list())
    if (is_feed(m)) trace.add(m, true);
  return trace;
}

std::string shape_of(const MotionList& program, double top_mm = 0) {
  return traced(program).guess(top_mm).shape;
}

/// A pocket of 60 x 40 mm, to and fro, `step` mm from line to line.
MotionList rows(double step, double z = -2) {
  MotionList list;
  list.traverse({0, 0, 5}).feed({0, 0, z});
  bool there = false;
  for (double y = 0; y <= 40; y += step) {
    list.feed({there ? 60.0 : 0.0, y, z});
    there = !there;
    list.feed({there ? 60.0 : 0.0, y, z});
  }
  return list;
}

TEST(ToolTrace, KnowsHowFarPassesAreApart) {
  for (const double step : {0.5, 1.0, 2.0, 3.0}) {
    EXPECT_NEAR(traced(rows(step)).step_over_mm(), step, 0.35 * step) << step;
  }
}

TEST(ToolTrace, PassesOneOverTheOtherAreNoneSideBySide) {
  MotionList list;
  list.traverse({0, 0, 5});
  for (double z = -1; z >= -8; z -= 1) {
    list.feed({0, 0, z}).feed({100, 0, z}).feed({100, 80, z}).feed({0, 80, z}).feed({0, 0, z});
  }
  EXPECT_EQ(traced(list).step_over_mm(), 0);
  EXPECT_EQ(shape_of(list), "flat:4") << "3 % of the diagonal of 128 mm";
}

TEST(ToolTrace, PocketsGetTwiceTheWayFromPassToPass) {
  const Result<Cutter> cutter = parse_shape(shape_of(rows(3)));
  ASSERT_TRUE(cutter);
  EXPECT_GE(2 * cutter->radius_mm(), 5);
  EXPECT_LE(2 * cutter->radius_mm(), 8);
}

TEST(ToolTrace, HolesGetADrillThatLeavesAWeb) {
  MotionList holes;
  for (int i = 0; i < 5; ++i) holes.traverse({2.54 * i, 0, 2}).feed({2.54 * i, 0, -1.6});
  EXPECT_EQ(shape_of(holes), "drill:1:118");
  MotionList close;
  for (int i = 0; i < 5; ++i) close.traverse({1.0 * i, 0, 2}).feed({1.0 * i, 0, -1.6});
  EXPECT_EQ(shape_of(close), "drill:0.5:118") << "0.6 of the way from hole to hole at most";
}

TEST(ToolTrace, ShallowLinesGetAVBit) {
  EXPECT_EQ(shape_of(MotionList().at({0, 0, -0.3}).feed({30, 0, -0.3}).feed({30, 30, -0.3})),
            "vee:3:60");
  EXPECT_EQ(shape_of(MotionList().at({0, 0, -0.1}).feed({30, 0, -0.1}).feed({30, 30, -0.1})),
            "vee:3:60:0.2");
  EXPECT_EQ(shape_of(MotionList().at({0, 0, -3}).feed({30, 0, -3}).feed({30, 30, -3})).substr(0, 4),
            "flat");
}

TEST(ToolTrace, WhereZFollowsThePartPassesAreABallsAndLinesAVBits) {
  MotionList surface;
  for (double y = 0; y <= 40; y += 0.5) {
    surface.traverse({0, y, 5}).feed({0, y, -1});
    for (double x = 2; x <= 60; x += 2) surface.feed({x, y, -5 - 4 * std::sin(0.1 * x + 0.05 * y)});
  }
  EXPECT_EQ(shape_of(surface).substr(0, 5), "ball:");
  MotionList letters;
  letters.at({0, 0, -0.1});
  for (double x = 2; x <= 60; x += 2) letters.feed({x, 0, -1 - std::sin(0.2 * x)});
  EXPECT_EQ(shape_of(letters), "vee:3:60");
}

TEST(ToolTrace, LinesOfADrawingAreNotMilledAway) {
  MotionList list;
  for (int row = 0; row < 30; ++row) {
    for (int column = 0; column < 30; ++column) {
      const double x = 3.0 * column, y = 3.0 * row;
      list.traverse({x, y, 2}).feed({x, y, -1}).feed({x + 2.5, y, -1});
      list.feed({x + 2.5, y + 2.5, -1}).traverse({x + 2.5, y + 2.5, 2});
    }
  }
  EXPECT_EQ(shape_of(list), "vee:3:60");
}

TEST(ToolTrace, ABoredCircleLeavesNoCore) {
  MotionList list;
  list.at({21.8, 0, -1}).arc({21.8, 0, -2}, {20, 0, 0}, {0, 0, 1}, 2 * kPi);
  list.feed({60, 0, -2});
  // 3 % of the size is 1.2 mm, so 1.5; the circle of radius 1.8 wants 3.6.
  EXPECT_EQ(shape_of(list), "flat:1.5") << "more than twice as wide is no bore";
  list.at({21, 0, -1}).arc({21, 0, -2}, {20, 0, 0}, {0, 0, 1}, 2 * kPi);
  EXPECT_EQ(shape_of(list), "flat:2");
}

TEST(ToolTrace, EveryGuessIsAShape) {
  for (const double scale : {1e-4, 0.01, 1.0, 100.0, 1e5}) {
    MotionList list;
    list.at({0, 0, -scale}).feed({scale, 0, -scale}).feed({scale, scale, -2 * scale});
    const std::string shape = shape_of(list);
    EXPECT_TRUE(parse_shape(shape)) << shape;
  }
  EXPECT_TRUE(parse_shape(ToolTrace().guess(0).shape));
}

std::string trigger_of(const MotionList& program) {
  BeamWatch watch;
  for (const Motion& m : program.list()) watch.add(m);
  const auto guess = watch.guess(false);
  return guess ? guess->trigger : "none";
}

TEST(BeamWatch, SpindleThatIsOnWhereItFeedsIsABeam) {
  MotionList list;
  for (int i = 0; i < 3; ++i) {
    list.spindle(false).traverse({0, 10.0 * i, 3}).spindle(true).feed({50, 10.0 * i, 3});
  }
  EXPECT_EQ(trigger_of(list), "m3");
}

TEST(BeamWatch, MillsAreNone) {
  MotionList mill;
  mill.spindle(true);
  for (int i = 0; i < 3; ++i) {
    mill.traverse({0, 10.0 * i, 3}).feed({0, 10.0 * i, -2}).feed({50, 10.0 * i, -2});
    mill.traverse({50, 10.0 * i, 3});
  }
  EXPECT_EQ(trigger_of(mill), "none");
  MotionList single;
  single.traverse({0, 0, 3}).spindle(true).feed({0, 0, -2}).feed({50, 0, -2});
  single.traverse({50, 0, 3}).spindle(false).traverse({0, 0, 3});
  EXPECT_EQ(trigger_of(single), "none") << "started once, and Z comes down";
}

TEST(BeamWatch, NothingThatTurnsIsASheet) {
  MotionList list;
  for (int i = 0; i < 3; ++i) {
    list.spindle(false).traverse({0, 10.0 * i, 3}).turned({10.0 * i, 0, 0});
    list.spindle(true).feed({50, 10.0 * i, 3});
    list.last().from_abc_deg = {10.0 * i - 10, 0, 0};
  }
  EXPECT_EQ(trigger_of(list), "none");
}

TEST(BeamWatch, AnOutputMayBeTheBeam) {
  MotionList list;
  for (int i = 0; i < 3; ++i) {
    list.output(2, false).traverse({0, 10.0 * i, 0}).output(2, true).feed({50, 10.0 * i, 0});
  }
  EXPECT_EQ(trigger_of(list), "m62:2");
}

TEST(BlankGuessSkin, LiesOverTheOnlyLevel) {
  BlankGuess guess(5);
  const MotionList list =
      MotionList().traverse({0, 0, 5}).traverse({10, 10, 5}).feed({10, 10, 0}).feed({60, 10, 0});
  for (const Motion& m : list.list()) guess.add(m, 1);
  EXPECT_EQ(guess.blank().bounds_mm(), (Box{{4, 4, -5}, {66, 16, 0.5}}));
}

TEST(BlankGuessSteps, TheFirstLevelCutsAsDeepAsTheOthers) {
  BlankGuess guess(5);
  MotionList list;
  list.traverse({0, 0, 25}).traverse({10, 10, 25});
  for (const double z : {18.0, 16.0, 14.0}) list.feed({10, 10, z}).feed({60, 10, z});
  for (const Motion& m : list.list()) guess.add(m, 1);
  EXPECT_EQ(guess.blank().bounds_mm().max.z, 20);
}

TEST(StockSpec, IsWhatStockTakes) {
  for (const char* spec : {"box:-5,-5.5,-10:105,65,0.5", "sheet:0,0:600,400:3",
                           "cylinder:0,0,-60:0:40", "cylinder:-8,1,0:28:40.5:x"}) {
    const Result<Blank> blank = parse_blank(spec);
    ASSERT_TRUE(blank);
    EXPECT_EQ(stock_spec(*blank), spec);
  }
  EXPECT_EQ(stock_spec(*parse_blank("tube:0,0,0:10:5:2")), "");
}

TEST(GuessText, EndsWithTheCommandToCopy) {
  const std::string command = "kerf run part.ngc --stock box:0,0,-5:10,10,0";
  const std::vector<GuessRow> rows{{"blank", "--stock", "box:0,0,-5:10,10,0", "the feed moves"},
                                   {"tool", "", "flat:3", "before the first tool change"}};
  EXPECT_EQ(guess_text(rows, command),
            "guessed   blank   box:0,0,-5:10,10,0 (the feed moves)\n"
            "          tool    flat:3 (before the first tool change)\n"
            "          correct what is wrong, and run it again:\n"
            "          kerf run part.ngc --stock box:0,0,-5:10,10,0\n");
  EXPECT_EQ(guess_text({}, command), "");
}

TEST(GuessRows, AreTheSameInInches) {
  const std::vector<GuessRow> rows{
      {"blank", "--stock", "box:-5,0,-8:46,25.4,0", "the feed moves plus 5 mm"},
      {"beam", "--beam", "m3", ""},
      {"kerf", "--kerf", "1.5", "nothing says how wide"},
      {"tool 2", "--tool", "2=drill:3.175:118", "the nearest holes are 12.7 mm apart"},
      {"tool", "", "vee:12.7:60:0.2", "before the first tool change"}};
  const std::vector<GuessRow> inch = rows_in(rows, LengthUnit::kInch);
  EXPECT_EQ(inch[0].value, "box:-0.1969,0,-0.315:1.811,1,0");
  EXPECT_EQ(inch[0].reason, "the feed moves plus 0.197 in");
  EXPECT_EQ(inch[1].value, "m3");
  EXPECT_EQ(inch[2].value, "0.059055");
  EXPECT_EQ(inch[3].value, "2=drill:0.125:118");
  EXPECT_EQ(inch[3].reason, "the nearest holes are 0.5 in apart");
  EXPECT_EQ(inch[4].value, "vee:0.5:60:0.007874");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows_in(rows, LengthUnit::kMm)[i].value, rows[i].value);
  }
}

TEST(BeamWatch, AnAnalogOutputMayBeTheBeam) {
  MotionList list;
  for (int i = 0; i < 3; ++i) {
    list.analog(1, 0).traverse({0, 10.0 * i, 0}).analog(1, 80).feed({50, 10.0 * i, 0});
  }
  EXPECT_EQ(trigger_of(list), "m67:1");
  MotionList powers;
  for (int i = 0; i < 3; ++i) {
    powers.traverse({0, 10.0 * i, 0}).analog(0, 20 + 20.0 * i).feed({50, 10.0 * i, 0});
  }
  EXPECT_EQ(trigger_of(powers), "m67:0+feed");
  MotionList constant;
  constant.analog(0, 50);
  for (int i = 0; i < 3; ++i) constant.traverse({0, 10.0 * i, 0}).feed({50, 10.0 * i, 0});
  EXPECT_EQ(trigger_of(constant), "feed") << "an output that never changes says nothing";
}

TEST(ToolTrace, WhatIsNeverFedSidewaysInTheBlankDrills) {
  ToolTrace trace;
  const MotionList drilled = MotionList()
                                 .traverse({10, 10, 1})
                                 .feed({10, 10, -2})
                                 .feed({10, 10, 1})
                                 .feed({30, 10, 1})
                                 .feed({30, 10, -2});
  for (const Motion& m : drilled.list()) {
    if (m.kind == MotionKind::kFeed) trace.add(m, true);
  }
  EXPECT_TRUE(trace.only_plunges(0));
  EXPECT_EQ(trace.guess(0).shape.substr(0, 6), "drill:");
  EXPECT_FALSE(trace.only_plunges(1)) << "it is fed along the top";
  EXPECT_FALSE(trace.only_plunges(-2)) << "it never comes down to that";
  const MotionList slot = MotionList().traverse({30, 10, -2}).feed({40, 10, -2});
  trace.add(slot.list().back(), true);
  EXPECT_FALSE(trace.only_plunges(0));
}

}  // namespace
}  // namespace kerf
