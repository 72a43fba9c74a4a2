// Turned parts that are drawn, saved, and turned on: the whole way, as commands.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

/// Cuts along the axis at these radii, each from Z2 to Z-20; listing of an interpreter.
std::string passes(const std::vector<double>& radii) {
  std::string text =
      "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
      "    2 N1     SELECT_PLANE(CANON_PLANE_XZ)\n"
      "    3 N1     CHANGE_TOOL(1)\n"
      "    4 N1     SET_SPINDLE_SPEED(0, 1000.0000)\n"
      "    5 N1     START_SPINDLE_CLOCKWISE(0)\n"
      "    6 N1     SET_FEED_RATE(600.0000)\n";
  int number = 7, line = 2;
  const auto add = [&](const std::string& call, double x, double z) {
    text += fmt::format("{:>5} N{:<5} {}({:.4f}, 0.0000, {:.4f}, 0.0000, 0.0000, 0.0000)\n",
                        number++, line++, call, x, z);
  };
  for (const double r : radii) {
    add("STRAIGHT_TRAVERSE", r, 2);
    add("STRAIGHT_FEED", r, -20);
    add("STRAIGHT_FEED", 30, -20);
    add("STRAIGHT_TRAVERSE", 30, 2);
  }
  return text + fmt::format("{:>5} N{:<5} PROGRAM_END()\n", number, line);
}

class TurnedReuse : public testing::Test {
 protected:
  KerfResult cut(const std::string& program, const std::string& stock,
                 std::vector<std::string> more = {}) {
    KerfCall call;
    call.arguments = {"run",     program,      "--model",
                      "turning", "--stock",    stock,
                      "--quiet", "--tool",     "1=turn:0.4:2:85:30",
                      "--json",  "report.json"};
    call.arguments.insert(call.arguments.end(), more.begin(), more.end());
    call.folder = folder_.path();
    return run_kerf(call);
  }
  Json stock_report() {
    return Json::parse(read_file(folder_.file("report.json")), nullptr, false)["stock"];
  }
  TestFolder folder_;
};

TEST_F(TurnedReuse, a_saved_part_is_turned_on_as_if_it_had_never_been_saved) {
  folder_.write("first.canon", passes({19}));
  folder_.write("second.canon", passes({18, 17}));
  folder_.write("both.canon", passes({19, 18, 17}));
  const std::string bar = "cylinder:0,0,-60:0:40";
  KerfResult result = cut("both.canon", bar);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json whole = stock_report();
  result = cut("first.canon", bar, {"--state", "part.state"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  result = cut("second.canon", "state:part.state");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(stock_report()["digest"], whole["digest"]);
  EXPECT_EQ(stock_report()["blank_mm3"], whole["blank_mm3"]);
  EXPECT_EQ(stock_report()["remaining_mm3"], whole["remaining_mm3"]);
}

TEST_F(TurnedReuse, a_saved_part_is_turned_about) {
  folder_.write("first.canon", passes({19}));
  folder_.write("second.canon", passes({18}));
  KerfResult result = cut("first.canon", "cylinder:0,0,-60:0:40", {"--state", "part.state"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const double removed = stock_report()["removed_mm3"].get<double>();
  const double remaining = stock_report()["remaining_mm3"].get<double>();
  // What was at Z-60 is the face at Z0: the other end, which is still as it was.
  result = cut("first.canon", "state:part.state:flip=x:at=0,0,-60");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  // Of the whole blank, both sides.
  EXPECT_NEAR(stock_report()["removed_mm3"].get<double>(), 2 * removed, 0.01);
  EXPECT_NEAR(stock_report()["remaining_mm3"].get<double>(), remaining - removed, 0.01);
  result = cut("first.canon", "state:part.state:at=0,0,3000");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("part.state: at Z3000 it would lie beyond 2000 mm from Z0"),
            std::string::npos)
      << result.err;
}

/// A keyway by a driven tool along X, then a lathe again: as in one go.
TEST_F(TurnedReuse, a_milled_part_is_turned_on) {
  const auto keyway = [](int number, int line) {
    std::string text = fmt::format(
        "{:>5} N{:<5} CHANGE_TOOL(2)\n{:>5} N{:<5} SET_SPINDLE_SPEED(0, 3000.0000)\n"
        "{:>5} N{:<5} START_SPINDLE_CLOCKWISE(0)\n",
        number, line, number + 1, line, number + 2, line);
    number += 3;
    const auto add = [&](const std::string& call, double x, double z) {
      text += fmt::format("{:>5} N{:<5} {}({:.4f}, 0.0000, {:.4f}, 0.0000, 0.0000, 0.0000)\n",
                          number++, ++line, call, x, z);
    };
    add("STRAIGHT_TRAVERSE", 30, 8);
    add("STRAIGHT_TRAVERSE", 14, 8);
    add("STRAIGHT_FEED", 14, -12);
    add("STRAIGHT_FEED", 30, -12);
    return text + fmt::format("{:>5} N{:<5} PROGRAM_END()\n", number, ++line);
  };
  const auto without_end = [](std::string text) {
    return text.substr(0, text.rfind('\n', text.size() - 2) + 1);
  };
  const std::string first = passes({19});
  const int lines = static_cast<int>(std::count(first.begin(), first.end(), '\n'));
  const std::string milled = without_end(first) + keyway(lines, lines);
  folder_.write("milled.canon", milled);
  folder_.write("second.canon", passes({18, 17}));
  const std::vector<std::string> mill{"--tool", "2=flat:6:live=x"};
  const auto with = [&mill](std::vector<std::string> more) {
    more.insert(more.end(), mill.begin(), mill.end());
    return more;
  };
  KerfResult result = cut("milled.canon", "cylinder:0,0,-60:0:40", with({"--state", "part.state"}));
  ASSERT_LE(result.exit_code, 1) << result.err;
  const Json before = stock_report();
  result = cut("second.canon", "state:part.state", with({"--state", "again.state"}));
  ASSERT_LE(result.exit_code, 1) << result.err;
  const Json after = stock_report();
  EXPECT_EQ(after["model"], "turning");
  EXPECT_EQ(after["blank_mm3"], before["blank_mm3"]);
  // Turning from 19 to 17 takes the ring off, but for the keyway, which is 6 wide and ends with the
  // mill's round. Its bottom is at 14, so all of the ring is open there.
  const double ring = kPi * (19 * 19 - 17 * 17) * 20;
  const double taken = before["remaining_mm3"].get<double>() - after["remaining_mm3"].get<double>();
  EXPECT_LT(taken, ring - 6 * 2 * 12);
  EXPECT_GT(taken, ring - 6 * 2.2 * 15.5);
  // It is not turned about.
  result = cut("second.canon", "state:part.state:flip=x", mill);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err,
            "kerf: error: part.state: flip= and at= are for parts that are turned; this one has "
            "been milled as well\n");
}

TEST_F(TurnedReuse, a_drawn_part_is_a_blank_again) {
  folder_.write("first.canon", passes({19, 18}));
  folder_.write("second.canon", passes({18}));
  KerfResult result =
      cut("first.canon", "cylinder:0,0,-60:0:40", {"--dxf", "part.dxf", "--svg", "part.svg"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const double remaining = stock_report()["remaining_mm3"].get<double>();
  for (const char* const drawing : {"profile:part.dxf", "profile:part.svg"}) {
    result = cut("second.canon", drawing);
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 1) << result.err;
    EXPECT_NEAR(stock_report()["blank_mm3"].get<double>() / remaining, 1, 1e-6) << drawing;
    EXPECT_NEAR(stock_report()["removed_mm3"].get<double>(), 0, 0.01) << drawing;
  }
}

TEST_F(TurnedReuse, a_hexagonal_bar_is_turned_round) {
  folder_.write("round.canon", passes({19, 17}));
  const KerfResult result = cut("round.canon", "hex:0,0,-60:0:36");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const double bar_mm2 = 36 * 36 * std::sqrt(3.0) / 2;
  EXPECT_NEAR(stock_report()["blank_mm3"].get<double>(), bar_mm2 * 60, 0.01);
  // Round over 20 mm but for the corner that the nose of 0.4 mm leaves, and its front flank.
  const double round = bar_mm2 * 40 + kPi * 17 * 17 * 20;
  EXPECT_NEAR(stock_report()["remaining_mm3"].get<double>() / round, 1, 2e-3);
}

TEST_F(TurnedReuse, what_does_not_turn_is_told) {
  folder_.write("part.canon", passes({19}));
  KerfResult result = cut("part.canon", "cylinder:3,0,-60:0:40");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("its axis is at X3 Y0; on a lathe it turns about X0 Y0"),
            std::string::npos)
      << result.err;
  result = cut("part.canon", "profile:none.dxf");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.err.find("none.dxf: No such file"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace kerf
