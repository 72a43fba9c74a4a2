// Sheets that are saved, cut on, and cut beside a machine: the whole way, as commands.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

/// Across the sheet along X, at each of these Y, 10 mm a second; listing of an interpreter.
std::string slots(const std::vector<double>& ys) {
  std::string text =
      "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
      "    2 N1     SELECT_TOOL(1)\n"
      "    3 N1     CHANGE_TOOL(1)\n";
  int number = 4, line = 2;
  const auto add = [&](const std::string& call) {
    text += fmt::format("{:>5} N{:<5} {}\n", number++, line, call);
  };
  for (const double y : ys) {
    add(fmt::format("STRAIGHT_TRAVERSE(-5.0000, {:.4f}, 1.0000, 0.0000, 0.0000, 0.0000)", y));
    ++line;
    add("SET_SPINDLE_SPEED(0, 1000.0000)");
    add("START_SPINDLE_CLOCKWISE(0)");
    add("SET_FEED_RATE(600.0000)");
    ++line;
    add(fmt::format("STRAIGHT_FEED(55.0000, {:.4f}, 1.0000, 0.0000, 0.0000, 0.0000)", y));
    ++line;
    add("STOP_SPINDLE_TURNING(0)");
  }
  add("PROGRAM_END()");
  return text;
}

class SheetReuse : public testing::Test {
 protected:
  KerfResult run(std::vector<std::string> arguments) {
    KerfCall call;
    call.arguments = std::move(arguments);
    call.folder = folder_.path();
    return run_kerf(call);
  }
  Json report(const std::string& name) {
    return Json::parse(read_file(folder_.file(name)), nullptr, false);
  }
  TestFolder folder_;
};

TEST_F(SheetReuse, ASavedSheetIsCutOnAsIfItHadNeverBeenSaved) {
  folder_.write("first.canon", slots({10}));
  folder_.write("second.canon", slots({20, 30}));
  folder_.write("both.canon", slots({10, 20, 30}));
  const std::vector<std::string> tool = {"--tool", "1=kerf:2"};
  const auto with = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), tool.begin(), tool.end());
    return run(std::move(arguments));
  };
  const std::string sheet = "sheet:0,0:50,50:2";
  EXPECT_EQ(with({"run", "both.canon", "--stock", sheet, "--json", "both.json"}).exit_code, 0);
  EXPECT_EQ(with({"run", "first.canon", "--stock", sheet, "--state", "a.state"}).exit_code, 0);
  const KerfResult second =
      with({"run", "second.canon", "--stock", "state:a.state", "--json", "second.json"});
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_EQ(report("second.json")["stock"]["digest"], report("both.json")["stock"]["digest"]);
  EXPECT_EQ(report("second.json")["stock"]["removed_mm3"],
            report("both.json")["stock"]["removed_mm3"]);
  const Json parts = report("second.json")["sheet"]["parts"];
  const Json all = report("both.json")["sheet"]["parts"];
  ASSERT_EQ(all.size(), 3U);
  ASSERT_EQ(parts.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(parts[i]["number"], all[i]["number"]);
    EXPECT_EQ(parts[i]["area_mm2"], all[i]["area_mm2"]);
    EXPECT_EQ(parts[i]["file"], i == 0 ? "first.canon" : "second.canon");
  }
  EXPECT_EQ(parts[0]["line"], all[0]["line"]);
  EXPECT_NE(second.out.find("free since line 4 of first.canon"), std::string::npos) << second.out;
}

TEST_F(SheetReuse, WhatWasFreeWhenItWasSavedIsInTheWayStill) {
  folder_.write("first.canon", slots({10}));
  folder_.write("second.canon", slots({5}));
  ASSERT_EQ(run({"run", "first.canon", "--stock", "sheet:0,0:50,50:2", "--tool", "1=kerf:2",
                 "--state", "a.state"})
                .exit_code,
            0);
  const KerfResult second =
      run({"run", "second.canon", "--stock", "state:a.state", "--tool", "1=kerf:2"});
  EXPECT_NE(second.err.find("crosses-part: cuts into piece 1, which is free since line 4 of "
                            "first.canon and may have tipped"),
            std::string::npos)
      << second.err;
}

TEST_F(SheetReuse, AStateThatCannotBeUsedIsOneError) {
  folder_.write("slot.canon", slots({10}));
  ASSERT_EQ(run({"run", "slot.canon", "--stock", "sheet:0,0:50,50:2", "--tool", "1=kerf:2",
                 "--state", "a.state"})
                .exit_code,
            0);
  folder_.write("cut.state", read_file(folder_.file("a.state")).substr(0, 400));
  const auto cut_from = [&](const std::string& stock, const std::string& model) {
    return run(
        {"run", "slot.canon", "--stock", stock, "--model", model, "--tool", "1=kerf:2", "--quiet"});
  };
  const KerfResult damaged = cut_from("state:cut.state", "auto");
  EXPECT_EQ(damaged.exit_code, 4);
  EXPECT_EQ(damaged.err,
            "kerf: error: cut.state: the checksum does not match: the file is damaged or cut "
            "short\n");
  const KerfResult other = cut_from("state:a.state", "zmap");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_EQ(other.err,
            "kerf: error: --model zmap: the blank is a sheet (workpiece saved in a.state); allowed "
            "for it: sheet, auto\n");
}

TEST_F(SheetReuse, AReplayedProgramLeavesTheSheetOfTheDryRun) {
  folder_.write("slots.canon", slots({10, 30}));
  std::string log = "time_s,x_mm,y_mm,z_mm\n";
  double t = 0;
  const auto at = [&](double x, double y) {
    log += fmt::format("{:.3f},{:.4f},{:.4f},1\n", t, x, y);
    t += 0.05;
  };
  for (const double y : {10.0, 30.0}) {
    for (int i = 0; i <= 120; ++i) at(-5 + 0.5 * i, y);
    for (int i = 1; i <= 20 && y < 30; ++i) at(55 - 3 * i, y + i);
  }
  folder_.write("run.csv", log);
  folder_.write("log.yaml",
                "source:\n  type: log\n  file: run.csv\n  coordinates: axes\n  frame: workpiece\n"
                "beam: {kerf_mm: 2}\n");
  const std::string sheet = "sheet:0,0:50,50:2";
  ASSERT_EQ(
      run({"run", "slots.canon", "--stock", sheet, "--kerf", "2", "--json", "dry.json"}).exit_code,
      0);
  const KerfResult replayed =
      run({"replay", "run.csv", "-c", "log.yaml", "--program", "slots.canon", "--stock", sheet,
           "--speed", "max", "--no-view", "--json", "log.json", "--dxf", "rest.dxf"});
  ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
  const Json dry = report("dry.json"), live = report("log.json");
  ASSERT_EQ(live["sheet"]["parts"].size(), dry["sheet"]["parts"].size()) << replayed.out;
  // Each end of a sample's share of the way is round: 5 um on the perimeter of the cuts, 240 mm.
  EXPECT_NEAR(live["stock"]["removed_mm3"].get<double>(), dry["stock"]["removed_mm3"].get<double>(),
              2 * 0.005 * 240);
  EXPECT_FALSE(read_file(folder_.file("rest.dxf")).empty());
}

TEST_F(SheetReuse, OutlinesAreOfSheetsAlone) {
  folder_.write("run.csv", "time_s,x_mm,y_mm,z_mm\n0,0,0,0\n");
  const KerfResult result = run({"replay", "run.csv", "--stock", "box:0,0,-5:10,10,0", "--no-view",
                                 "--speed", "max", "--dxf", "rest.dxf"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err.substr(0, result.err.find('\n')),
            "kerf: error: --dxf: only a sheet or a turned part has outlines to write");
}

}  // namespace
}  // namespace kerf
