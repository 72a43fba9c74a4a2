// kerf shadow beside a simulated press, kerf replay of what was recorded there, kerf run.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/machine_io/simulator/machine_process.h"
#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

/// Two holes, a nibbled row, another station; the ram is down for 0.2 s each time.
constexpr const char* kProgram =
    "G21 G90 G94 G17\n"
    "T1 M6 S100\n"
    "G0 X10 Y10 Z5\n"
    "G0 X20 Y20\n"
    "M3\n"
    "G4 P0.2\n"
    "M5\n"
    "G0 X50 Y20\n"
    "M3\n"
    "G4 P0.2\n"
    "M5\n"
    "G0 X20 Y50\n"
    "F3000\n"
    "M3\n"
    "G4 P0.2\n"
    "G1 X50\n"
    "G4 P0.2\n"
    "M5\n"
    "T2 M6\n"
    "G0 X80 Y30\n"
    "M3\n"
    "G4 P0.2\n"
    "M5\n"
    "G0 X10 Y10\n"
    "M2\n";

constexpr const char* kTurret =
    "stations: {1: round:8, 2: square:10}\n"
    "punch: {trigger: m3, nibble: {pitch: 3}}\n"
    "times: {stroke: 0.1, rate: {3: 150}, turret: {places: 4, step: 0.5, lock: 1}}\n";

constexpr const char* kConfig =
    "turret: press.yaml\n"
    "stock: {blank: 'sheet:0,0:100,60:2'}\n"
    "source:\n"
    "  type: modbus\n"
    "  tcp: 127.0.0.1:PORT\n"
    "  poll_hz: 200\n"
    "  frame: workpiece\n"
    "  coordinates: axes\n"
    "  map:\n"
    "    X: {register: 0, type: int32, word_order: cdab, scale: 0.001}\n"
    "    Y: {register: 2, type: int32, word_order: cdab, scale: 0.001}\n"
    "    Z: {register: 4, type: int32, word_order: cdab, scale: 0.001}\n"
    "    tool: {register: 12, type: uint16}\n"
    "    trigger: {register: 16, type: int16}\n";

class PunchCommand : public ::testing::Test {
 protected:
  PunchCommand() {
    folder_.write("panel.ngc", kProgram);
    folder_.write("press.yaml", kTurret);
  }
  KerfResult kerf(std::vector<std::string> arguments) {
    KerfCall call;
    call.arguments = std::move(arguments);
    call.folder = folder_.path();
    return run_kerf(call);
  }
  Json report(const std::string& name) {
    return Json::parse(read_file(folder_.file(name)), nullptr, false);
  }
  /// Lines that the shadow has told so far.
  std::size_t events() const {
    const std::string text = read_file(folder_.file("live.events"));
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }
  TestFolder folder_;
};

TEST_F(PunchCommand, BesideTheMachineAndOfItsRecordingTheSheetIsThatOfTheDryRun) {
  const KerfResult dry = kerf({"run", "panel.ngc", "--set", "turret=press.yaml", "--stock",
                               "sheet:0,0:100,60:2", "--json", "dry.json"});
  ASSERT_EQ(dry.exit_code, 0) << dry.err;
  const Json plan = report("dry.json");
  EXPECT_EQ(plan["sheet"]["punch"]["hits"], 2 + 11 + 1);
  // 3 mm take 0.4 s by the table, less the way; changes from station 1 to 2.
  EXPECT_GT(plan["motion"]["held_s"]["strokes"], 4 * 0.1 + 10 * 0.1);
  EXPECT_LT(plan["motion"]["held_s"]["strokes"], 4 * 0.1 + 10 * 0.4);
  EXPECT_NEAR(plan["motion"]["held_s"]["turret"], 1 + 1.5, 1e-6);
  EXPECT_NE(dry.out.find(", of that strokes "), std::string::npos) << dry.out;

  MachineProcess machine({folder_.file("panel.ngc"), "--modbus-tcp", "127.0.0.1:0", "--frame",
                          "workpiece", "--hold", "--wait-for-reader", "--start-delay", "1"});
  const std::string listening = machine.wait_line("listening");
  ASSERT_NE(listening, "") << machine.err();
  std::string config = kConfig;
  config.replace(config.find("PORT"), 4, listening.substr(listening.rfind(':') + 1));
  folder_.write("machine.yaml", config);
  KerfCall call;
  call.folder = folder_.path();
  call.arguments = {"shadow",    "-c",       "machine.yaml", "--program", "panel.ngc",
                    "--record",  "run.csv",  "--json",       "live.json", "--quiet",
                    "--no-view", "--events", "live.events"};
  RunningKerf kerf_shadow(call);
  ASSERT_NE(machine.wait_line("finished"), "");
  const std::size_t seen = events();
  ASSERT_TRUE(kerf_shadow.wait_until([&] { return events() > seen + 3; }));
  kerf_shadow.send(SIGINT);
  const KerfResult shadow = kerf_shadow.finish();
  EXPECT_EQ(shadow.exit_code, 0) << shadow.err;
  EXPECT_EQ(report("live.json")["stock"]["digest"], plan["stock"]["digest"]);
  EXPECT_EQ(report("live.json")["sheet"]["punch"]["hits"], 14);
  EXPECT_NE(read_file(folder_.file("run.csv")).find("spindle_rpm,trigger\n"), std::string::npos);

  const KerfResult replay =
      kerf({"replay", "run.csv", "-c", "machine.yaml", "--program", "panel.ngc", "--speed", "max",
            "--json", "replay.json", "--quiet"});
  EXPECT_EQ(replay.exit_code, 0) << replay.err;
  EXPECT_EQ(report("replay.json")["stock"]["digest"], plan["stock"]["digest"]);
  // Without the program: as the trigger came on.
  const KerfResult alone = kerf({"replay", "run.csv", "-c", "machine.yaml", "--speed", "max",
                                 "--json", "alone.json", "--quiet"});
  EXPECT_EQ(alone.exit_code, 0) << alone.err;
  const Json json = report("alone.json");
  EXPECT_EQ(json["sheet"]["punch"]["hits"], 14);
  // Places of samples are whole micrometres.
  EXPECT_NEAR(json["sheet"]["kerf_mm2"], plan["sheet"]["kerf_mm2"], 2);
}

TEST_F(PunchCommand, WhatHasNoPlaceBesideAPressIsRefused) {
  folder_.write("log.csv", "t,x,y,z\n0,1,1,1\n1,2,2,2\n");
  const KerfResult box = kerf({"replay", "log.csv", "--turret", "press.yaml", "--speed", "max",
                               "--stock", "box:0,0,0:10,10,10"});
  EXPECT_EQ(box.exit_code, 2);
  EXPECT_NE(box.err.find("error: --turret: only a sheet can be punched; the blank is "),
            std::string::npos)
      << box.err;
  const std::vector<std::string> sheet{"replay",     "log.csv", "--turret",
                                       "press.yaml", "--stock", "sheet:0,0:10,10:1"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), sheet.begin(), sheet.end());
    const KerfResult result = kerf(more);
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  };
  EXPECT_EQ(with({"--kerf", "1"}),
            "kerf: error: --kerf: is for torches, lasers and jets; --turret punches\n");
  EXPECT_EQ(
      with({"--path", "planned"}),
      "kerf: error: --path: planned is for cutting; a punch strikes where the program says\n");
  EXPECT_EQ(with({"--set", "follow.path=planned"}),
            "kerf: error: follow.path: planned is for cutting; a punch strikes where the program "
            "says\n");
}

}  // namespace
}  // namespace kerf
