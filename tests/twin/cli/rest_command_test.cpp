// --rest and --engagement: sections, pictures, and what is said where they make no sense.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

using Json = nlohmann::json;
using Texts = std::vector<std::string>;

/// Clears a pocket from 10, 10 to 50, 40, 4 mm deep, with a cutter of this diameter.
std::string pocket_listing(int tool, double diameter_mm) {
  std::string text;
  int line = 0;
  const auto add = [&](const std::string& call) {
    ++line;
    text += fmt::format("{0:>5} N{0:<5} {1}\n", line, call);
  };
  const auto to = [&](bool feeds, double x, double y, double z) {
    add(fmt::format("STRAIGHT_{}({:.4f}, {:.4f}, {:.4f}, 0.0000, 0.0000, 0.0000)",
                    feeds ? "FEED" : "TRAVERSE", x, y, z));
  };
  add("USE_LENGTH_UNITS(CANON_UNITS_MM)");
  add(fmt::format("SELECT_TOOL({})", tool));
  add(fmt::format("CHANGE_TOOL({})", tool));
  add("SET_SPINDLE_SPEED(0, 1000.0000)");
  add("START_SPINDLE_CLOCKWISE(0)");
  add("SET_FEED_RATE(600.0000)");
  to(false, 25, 25, 5);
  to(true, 25, 25, -4);
  to(true, 35, 25, -4);
  for (double in = 15 - diameter_mm / 3; in > diameter_mm / 2; in -= diameter_mm / 3) {
    const double far = std::max(in, diameter_mm / 2);
    for (const auto& [x, y] : {std::pair(50 - far, 10 + far), std::pair(10 + far, 10 + far),
                               std::pair(10 + far, 40 - far), std::pair(50 - far, 40 - far),
                               std::pair(50 - far, 10 + far)})
      to(true, x, y, -4);
  }
  const double last = diameter_mm / 2;
  for (const auto& [x, y] : {std::pair(50 - last, 10 + last), std::pair(10 + last, 10 + last),
                             std::pair(10 + last, 40 - last), std::pair(50 - last, 40 - last),
                             std::pair(50 - last, 10 + last)})
    to(true, x, y, -4);
  to(false, 25, 25, 5);
  add("STOP_SPINDLE_TURNING(0)");
  add("PROGRAM_END()");
  return text;
}

class RestCommand : public testing::Test {
 protected:
  RestCommand() {
    folder_.write("design.canon", pocket_listing(1, 2));
    folder_.write("part.canon", pocket_listing(2, 8));
  }
  KerfResult kerf(Texts arguments) const {
    KerfCall call;
    call.arguments = std::move(arguments);
    call.folder = folder_.path();
    return run_kerf(call);
  }
  KerfResult part(const Texts& more) const {
    Texts all{"run",    "part.canon", "--stock", "box:0,0,-10:60,50,0",
              "--tool", "2=flat:8",   "--tool",  "3=flat:3"};
    all.insert(all.end(), more.begin(), more.end());
    return kerf(std::move(all));
  }
  void make_design() const {
    const KerfResult made = kerf({"run", "design.canon", "--stock", "box:0,0,-10:60,50,0", "--tool",
                                  "1=flat:2", "--stl", "design.stl", "--quiet"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  Json report() const {
    return Json::parse(read_file(folder_.file("report.json")), nullptr, false);
  }
  TestFolder folder_;
};

TEST_F(RestCommand, WhatIsLeftByToolReach) {
  make_design();
  const KerfResult result = part({"--compare", "design.stl", "--rest", "0.25", "--rest-png",
                                  "rest.png", "--json", "report.json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("rest      "), std::string::npos) << result.out;
  // Tools may be there for what is left.
  EXPECT_EQ(result.err.find("tool-unused"), std::string::npos) << result.err;
  const Json rest = report()["rest"];
  EXPECT_EQ(rest["regions_total"], 4);
  // (1 - pi / 4) R^2 of R4, less that of the design's R1, less what is within 0.25 mm.
  const double each = (1 - std::numbers::pi / 4) * (16 - 1) * 4;
  EXPECT_LT(rest["volume_mm3"].get<double>(), 4 * each);
  EXPECT_GT(rest["volume_mm3"].get<double>(), 4 * (each - 0.25 * 2 * 4 * 4));
  ASSERT_EQ(rest["tools"].size(), 2u);
  EXPECT_EQ(rest["tools"][0]["tool"], 2);
  EXPECT_EQ(rest["tools"][0]["used"], true);
  EXPECT_EQ(rest["tools"][0]["clears"], 0);
  EXPECT_EQ(rest["tools"][1]["tool"], 3);
  EXPECT_EQ(rest["tools"][1]["used"], false);
  EXPECT_EQ(rest["tools"][1]["clears"], 4);
  EXPECT_EQ(read_file(folder_.file("rest.png")).substr(1, 3), "PNG");
}

TEST_F(RestCommand, HowToolsAreEngagedChangesNothingElse) {
  ASSERT_EQ(part({"--json", "report.json", "--quiet"}).exit_code, 0);
  const Json before = report();
  EXPECT_FALSE(before.contains("engagement"));
  ASSERT_EQ(part({"--json", "report.json", "--engagement-png", "map.png"}).exit_code, 0);
  const Json after = report();
  EXPECT_EQ(after["stock"]["digest"], before["stock"]["digest"]);
  EXPECT_EQ(after["tools"][0]["peak_mm3_per_s"], before["tools"][0]["peak_mm3_per_s"]);
  EXPECT_EQ(after["tools"][0]["cut_s"], before["tools"][0]["cut_s"]);
  const Json& engagement = after["engagement"];
  ASSERT_EQ(engagement["passes_total"], 1);
  const Json& pass = engagement["passes"][0];
  EXPECT_EQ(pass["tool"], 2);
  EXPECT_NEAR(pass["plunge_mm"].get<double>(), 4, 1e-6);
  EXPECT_NEAR(pass["ap_mm"]["most"].get<double>(), 4, 1e-3);
  // The first way is a slot.
  EXPECT_NEAR(pass["ae_mm"]["most"].get<double>(), 8, 0.1);
  EXPECT_GE(pass["full_slot_mm"].get<double>(), 9);
  // Of a pass by cells, of a tool by walls.
  EXPECT_NEAR(pass["removed_mm3"].get<double>(), before["tools"][0]["removed_mm3"].get<double>(),
              0.05);
  EXPECT_EQ(read_file(folder_.file("map.png")).substr(1, 3), "PNG");
}

TEST_F(RestCommand, BadInputIsTold) {
  make_design();
  const auto expect = [&](const Texts& more, int code, const std::string& words) {
    const KerfResult result = part(more);
    EXPECT_EQ(result.exit_code, code) << words;
    EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
  };
  expect({"--rest", "0.2"}, 2, "--rest: there is no --compare DESIGN.stl");
  expect({"--rest-png", "a.png"}, 2, "--rest-png: there is no --compare DESIGN.stl");
  expect({"--compare", "design.stl", "--rest-png", "a.png"}, 2,
         "--rest-png: there is no --rest LENGTH");
  expect({"--compare", "design.stl", "--rest", "0"}, 2, "--rest: 0 is not allowed");
  expect({"--compare", "design.stl", "--rest", "-1"}, 2, "--rest: -1 is not allowed");
  expect({"--compare", "design.stl", "--rest", "0.25", "--rest-png", "none/a.png"}, 4,
         "--rest-png: cannot write none/a.png");
  expect({"--engagement-png", "none/a.png"}, 4, "--engagement-png: cannot write none/a.png");
  expect({"--engagement-png", "a.png", "--png", "a.png"}, 2, "both write to a.png");
  EXPECT_FALSE(std::filesystem::exists(folder_.file("a.png")));
}

TEST_F(RestCommand, SheetsAreNotMeantWhichIsSaid) {
  Texts sheet{"run", "design.canon", "--stock",  "sheet:0,0:60,50:3", "--kerf",
              "1",   "--stl",        "sheet.stl"};
  ASSERT_EQ(kerf(sheet).exit_code, 0);
  Texts with = {"run",         "design.canon",
                "--stock",     "sheet:0,0:60,50:3",
                "--kerf",      "1",
                "--compare",   "sheet.stl",
                "--rest",      "0.2",
                "--json",      "report.json",
                "--engagement"};
  const KerfResult result = kerf(with);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("--rest: a sheet is cut through"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("--engagement: a sheet is cut by no milling tool"), std::string::npos);
  EXPECT_FALSE(report().contains("rest"));
}

}  // namespace
}  // namespace kerf
