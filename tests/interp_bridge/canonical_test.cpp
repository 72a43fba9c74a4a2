#include "interp_bridge/canonical.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

namespace kerf {
namespace {

CanonicalLine parse(std::string_view line) {
  CanonicalLine parsed;
  parse_canonical_line(line, parsed);
  return parsed;
}

TEST(Canonical, StraightFeedHasSixNumbers) {
  const CanonicalLine line =
      parse("   73 N100   STRAIGHT_FEED(10.0000, -0.5000, -1.2345, 0.0000, 90.0000, -0.0000)");
  ASSERT_EQ(line.kind, CanonicalLineKind::kCommand);
  EXPECT_EQ(line.command.name, CanonicalName::kStraightFeed);
  EXPECT_EQ(line.command.sequence, 73u);
  EXPECT_TRUE(line.command.has_n);
  EXPECT_EQ(line.command.n, 100u);
  ASSERT_EQ(line.command.argument_count, 6);
  EXPECT_EQ(line.command.number(0), 10.0);
  EXPECT_EQ(line.command.number(1), -0.5);
  EXPECT_EQ(line.command.number(2), -1.2345);
  EXPECT_EQ(line.command.number(4), 90.0);
  EXPECT_TRUE(std::signbit(line.command.number(5)));
}

TEST(Canonical, CoordinatesOfRecordsFitUpToAGreatNumber) {
  CanonicalCommand command;
  for (const CanonicalName name : {CanonicalName::kStraightFeed, CanonicalName::kStraightTraverse,
                                   CanonicalName::kStraightProbe}) {
    for (const std::uint8_t count : {std::uint8_t{6}, std::uint8_t{9}}) {
      command.name = name;
      command.argument_count = count;
      command.arguments.fill(-1e15);
      EXPECT_TRUE(canonical_arguments_fit(command));
      for (std::size_t i = 0; i < count; ++i) {
        for (const double wild : {1.1e15, -1.1e15, std::numeric_limits<double>::infinity(),
                                  std::numeric_limits<double>::quiet_NaN()}) {
          command.arguments[i] = wild;
          EXPECT_FALSE(canonical_arguments_fit(command)) << wild << " at " << i;
        }
        command.arguments[i] = 0;
      }
    }
    command.argument_count = 5;
    EXPECT_FALSE(canonical_arguments_fit(command)) << "one is missing";
  }
}

TEST(Canonical, NColumnForms) {
  const auto n = [](std::string_view head) {
    const CanonicalLine line = parse(std::string(head) + "FLOOD_ON()");
    EXPECT_EQ(line.kind, CanonicalLineKind::kCommand) << head;
    return line.command.has_n ? static_cast<long>(line.command.n) : -1;
  };
  EXPECT_EQ(n("   47 N..... "), -1);
  EXPECT_EQ(n("    7 N1     "), 1);
  EXPECT_EQ(n("   74 N0042  "), 42);
  EXPECT_EQ(n("   17 N      "), -1) << "the source had a blank behind its N";
  EXPECT_EQ(n("   11 N123456"), 123456) << "six digits are glued to the name";
  EXPECT_EQ(n("1000001 N99999999"), 99999999);
  EXPECT_EQ(n("    8 N100000002"), 100000002);
  EXPECT_EQ(n("    8 N12345678901234567890"), -1) << "too long for a number, but a command";
}

TEST(Canonical, ArgumentsEndAtTheLastParenthesis) {
  const CanonicalLine line = parse(R"(    7 N..... COMMENT("a (b), "c" ) d"))");
  ASSERT_EQ(line.kind, CanonicalLineKind::kCommand);
  EXPECT_EQ(line.command.text, R"(a (b), "c" ) d)");
}

TEST(Canonical, StringsAreRaw) {
  EXPECT_EQ(parse("    7 N..... MESSAGE(\"\")").command.text, "");
  EXPECT_EQ(parse("    7 N..... MESSAGE(\"\t\xff\xc3\xa4\")").command.text, "\t\xff\xc3\xa4");
  EXPECT_EQ(parse("    7 N..... COMMENT(\"\"\")").command.text, "\"");
  EXPECT_EQ(parse("    7 N..... COMMENT(\")").kind, CanonicalLineKind::kMalformed);
}

TEST(Canonical, SeparatorsDifferByCommand) {
  const CanonicalLine sync = parse("   97 N..... START_SPEED_FEED_SYNC(1.500000,0)");
  ASSERT_EQ(sync.kind, CanonicalLineKind::kCommand);
  EXPECT_EQ(sync.command.number(0), 1.5);
  const CanonicalLine mode =
      parse("  120 N..... SET_SPINDLE_MODE(0 1000000000000000019884624838656.0000)");
  ASSERT_EQ(mode.kind, CanonicalLineKind::kCommand);
  EXPECT_EQ(mode.command.number(1), 1000000000000000019884624838656.0);
  const CanonicalLine length = parse(
      "   39 N..... USE_TOOL_LENGTH_OFFSET(1.0000 2.0000 1270.0000, 4.0000 5.0000 6.0000, 7.0000 "
      "8.0000 9.0000)");
  ASSERT_EQ(length.kind, CanonicalLineKind::kCommand);
  EXPECT_EQ(length.command.number(2), 1270.0);
  EXPECT_EQ(length.command.number(8), 9.0);
  const CanonicalLine entry = parse(
      "  142 N..... SET_TOOL_TABLE_ENTRY(1, 1, 0.0000 0.0000 2.1654 0.0000 0.0000 0.0000 0.0000 "
      "0.0000 0.0000, 95.0000, 155.0000, 2)");
  ASSERT_EQ(entry.kind, CanonicalLineKind::kCommand);
  EXPECT_EQ(entry.command.argument_count, 14);
  EXPECT_EQ(entry.command.number(13), 2);
}

TEST(Canonical, DotInTheNameOfOneCommand) {
  const CanonicalLine line = parse("   70 N..... SPINDLE.3.WAIT_ORIENT_COMPLETE(10.0000)");
  ASSERT_EQ(line.kind, CanonicalLineKind::kCommand);
  EXPECT_EQ(line.command.name, CanonicalName::kWaitOrientComplete);
  EXPECT_EQ(line.command.spelling, "SPINDLE.3.WAIT_ORIENT_COMPLETE");
  EXPECT_EQ(parse("   70 N..... SPINDLE..WAIT_ORIENT_COMPLETE(1.0)").kind,
            CanonicalLineKind::kUnknown);
}

TEST(Canonical, FormsOfNewerVersions) {
  EXPECT_EQ(parse("   91 N..... NURBS_G5_FEED(4, ...)").command.name, CanonicalName::kNurbsFeed);
  const CanonicalLine g6 = parse("N..... saicanon NURBS_G6_FEED_(12, ...)");
  ASSERT_EQ(g6.kind, CanonicalLineKind::kCommand);
  EXPECT_EQ(g6.command.name, CanonicalName::kNurbsFeed);
  EXPECT_EQ(g6.command.number(0), 12);
  EXPECT_EQ(g6.command.sequence, 0u);
  const CanonicalLine change = parse("   38 N..... CHANGE_TOOL()");
  ASSERT_EQ(change.kind, CanonicalLineKind::kCommand);
  EXPECT_EQ(change.command.argument_count, 0);
  EXPECT_EQ(parse("   38 N..... SET_PLANNER_MODE(type=1, peak_scale=1.000000)").kind,
            CanonicalLineKind::kCommand);
}

TEST(Canonical, CarriageReturnIsDropped) {
  EXPECT_EQ(parse("   47 N..... FLOOD_ON()\r").kind, CanonicalLineKind::kCommand);
}

TEST(Canonical, EveryNameIsFoundAgain) {
  for (std::size_t i = 0; i < kCanonicalNameCount; ++i) {
    const auto name = static_cast<CanonicalName>(i);
    const CanonicalLine line =
        parse("    1 N..... " + std::string(canonical_spelling(name)) + "()");
    EXPECT_NE(line.kind, CanonicalLineKind::kUnknown) << canonical_spelling(name);
    EXPECT_EQ(line.command.name, name) << canonical_spelling(name);
  }
}

TEST(Canonical, ForeignLines) {
  for (const char* text : {"", "printed to stdout 0.000000", "PLUGIN_CALL(3)",
                           "File: t.tbl Unrecognized line skipped:", "12 N", "12", "N5 G1 X10",
                           "N123 G0(comment)", "  12 N.....", "G1 X1 (STRAIGHT_FEED(1))"}) {
    EXPECT_EQ(parse(text).kind, CanonicalLineKind::kForeign) << text;
  }
}

TEST(Canonical, UnknownCommand) {
  const CanonicalLine line = parse("   12 N..... WARP_FEED(1, 2)");
  EXPECT_EQ(line.kind, CanonicalLineKind::kUnknown);
  EXPECT_EQ(line.command.spelling, "WARP_FEED");
}

TEST(Canonical, MalformedArgumentsSayWhere) {
  const auto fault = [](const char* text) {
    const CanonicalLine line = parse(text);
    EXPECT_EQ(line.kind, CanonicalLineKind::kMalformed) << text;
    return std::to_string(line.column) + ": " + line.message;
  };
  EXPECT_EQ(fault("    8 N..... DWELL(x)"), "20: expected a number");
  EXPECT_EQ(fault("    8 N..... DWELL()"), "20: an argument is missing");
  EXPECT_EQ(fault("    8 N..... DWELL(1.0, 2)"), "23: more arguments than the command has");
  EXPECT_EQ(fault("    8 N..... DWELL(nan)"), "20: expected a number");
  EXPECT_EQ(fault("    8 N..... SELECT_TOOL(1.5)"), "27: more arguments than the command has");
  EXPECT_EQ(fault("    8 N..... SELECT_TOOL(99999999999)"), "26: expected a whole number");
  EXPECT_EQ(fault("    8 N..... STRAIGHT_FEED(1.0, 2.0, 3.0, 0.0, 0.0)"),
            "51: an argument is missing");
  EXPECT_EQ(fault("    8 N..... STRAIGHT_FEED(1.0 2.0 2e15 0 0 0)"),
            "36: a coordinate beyond 1e15 is not allowed");
  EXPECT_EQ(fault("    8 N..... STRAIGHT_FEED(1.0, 2.0"),
            "36: the closing parenthesis is missing; the listing may have been cut off");
  EXPECT_EQ(fault("    8 N..... USE_LENGTH_UNITS(CANON_UNITS_FEET)"),
            "31: expected CANON_UNITS_INCHES or CANON_UNITS_MM");
  EXPECT_EQ(fault("    8 N..... SELECT_PLANE(XY)"), "27: expected CANON_PLANE_XY, _YZ or _XZ");
}

TEST(Canonical, NumbersAreCorrectlyRounded) {
  std::mt19937_64 random(20240701);
  const auto check = [](const std::string& text) {
    const CanonicalLine line = parse("    1 N..... SET_FEED_RATE(" + text + ")");
    ASSERT_EQ(line.kind, CanonicalLineKind::kCommand) << text;
    EXPECT_EQ(line.command.number(0), std::strtod(text.c_str(), nullptr)) << text;
  };
  for (int i = 0; i < 20000; ++i) {
    std::string text = random() % 2 ? "-" : "";
    text += std::to_string(random() >> (random() % 64));
    text += '.';
    text += std::to_string(random() >> (random() % 64));
    check(text);
  }
  for (const char* text : {"0", ".5", "5.", "-.5", "+1.25", "9007199254740993", "1e30", "1.5E-3",
                           "123456789012345678901234567890.0000", "0.00000000000000000000001"}) {
    check(text);
  }
}

TEST(Canonical, ALineCutAtAnyByteIsNeverAWrongCommand) {
  const std::string whole =
      "   77 N12    ARC_FEED(20.0000, -10.0000, 10.0000, -10.0000, -1, -1.0000, 0.0000, 0.0000, "
      "0.0000)";
  ASSERT_EQ(parse(whole).kind, CanonicalLineKind::kCommand);
  for (std::size_t bytes = 0; bytes < whole.size(); ++bytes) {
    // A copy of its own size, so that a sanitizer sees a read past the end.
    const std::vector<char> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(bytes));
    const CanonicalLine line = parse({cut.data(), cut.size()});
    EXPECT_TRUE(line.kind == CanonicalLineKind::kForeign ||
                line.kind == CanonicalLineKind::kMalformed)
        << bytes;
  }
  EXPECT_EQ(parse(whole + whole).kind, CanonicalLineKind::kMalformed) << "glued lines";
}

TEST(Canonical, OnlyListingsLookCanonical) {
  EXPECT_TRUE(looks_canonical("    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)"));
  EXPECT_TRUE(looks_canonical("    1 N..... SOMETHING_NEW("));
  EXPECT_FALSE(looks_canonical("N10 G0 X1 (COMMENT)"));
  EXPECT_FALSE(looks_canonical("%"));
  EXPECT_FALSE(looks_canonical("(part 5)"));
}

}  // namespace
}  // namespace kerf
