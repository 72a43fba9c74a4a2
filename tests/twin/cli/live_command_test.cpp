// kerf shadow beside the simulated machine, and kerf replay of what was recorded there.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <csignal>
#include <sstream>

#include "tests/machine_io/simulator/machine_process.h"
#include "tests/twin/cli/kerf_process.h"
#include "tests/twin/cli/stl_text.h"
#include "tests/twin/cli/watched_program.h"

namespace kerf {
namespace {

constexpr const char* kConfig =
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
    "    line: {register: 13, type: uint32, word_order: cdab}\n"
    "    counter: {register: 15, type: uint16}\n"
    "    spindle: {register: 16, type: int16}\n";

std::string with_port(std::string text, const std::string& listening) {
  const std::string port = listening.substr(listening.rfind(':') + 1);
  return text.replace(text.find("PORT"), 4, port);
}

constexpr const char* kBlock = "box:-10,-10,-6:40,30,0";

std::vector<std::string> work_of(const std::string& program, const std::string& stock = kBlock) {
  return {"--program", program,  "--stock",       stock,    "--tool",
          "1=flat:6",  "--tool", "2=drill:5:118", "--cell", "0.1"};
}

std::vector<Json> events_of(const std::string& path) {
  std::vector<Json> out;
  std::istringstream text(read_file(path));
  for (std::string line; std::getline(text, line);) {
    const Json event = Json::parse(line, nullptr, false);
    if (!event.is_discarded()) out.push_back(event);
  }
  return out;
}

double removed_by_dry_run(const TestFolder& folder, const std::string& program) {
  KerfCall call;
  call.arguments = {"run",    program,    "--stock", "box:-10,-10,-6:40,30,0",
                    "--tool", "1=flat:6", "--tool",  "2=drill:5:118",
                    "--cell", "0.1",      "--json",  folder.file("dry.json"),
                    "--quiet"};
  EXPECT_EQ(run_kerf(call).exit_code, 0);
  return Json::parse(read_file(folder.file("dry.json")))["stock"]["removed_mm3"];
}

/// A simulated machine with a program, and a kerf that watches it.
class Shadow : public ::testing::Test {
 protected:
  /// Both run; the machine has been seen.
  void start(const std::string& program_text, const std::vector<std::string>& more = {},
             const std::vector<std::string>& machine_options = {},
             const std::string& stock = kBlock) {
    program_ = folder_.write("part.ngc", program_text);
    std::vector<std::string> arguments = {
        program_, "--modbus-tcp",      "127.0.0.1:0",   "--frame", "workpiece",
        "--hold", "--wait-for-reader", "--start-delay", "1"};
    arguments.insert(arguments.end(), machine_options.begin(), machine_options.end());
    machine_ = std::make_unique<MachineProcess>(arguments);
    const std::string listening = machine_->wait_line("listening");
    ASSERT_NE(listening, "") << machine_->err();
    KerfCall call;
    config_ = folder_.write("machine.yaml", with_port(kConfig, listening));
    call.arguments = {"shadow",
                      "-c",
                      config_,
                      "--events",
                      folder_.file("events"),
                      "--record",
                      folder_.file("run.csv"),
                      "--json",
                      folder_.file("live.json")};
    const std::vector<std::string> work = work_of(program_, stock);
    call.arguments.insert(call.arguments.end(), work.begin(), work.end());
    call.arguments.insert(call.arguments.end(), more.begin(), more.end());
    kerf_ = std::make_unique<RunningKerf>(call);
    ASSERT_TRUE(kerf_->wait_until([&] { return is_told("\"state\":\"live\""); }));
  }
  bool is_told(const std::string& text) const {
    return read_file(folder_.file("events")).find(text) != std::string::npos;
  }
  /// The machine has come to the end of its program, and kerf has seen that.
  void wait_for_end() {
    ASSERT_NE(machine_->wait_line("finished"), "");
    const std::size_t seen = events_of(folder_.file("events")).size();
    ASSERT_TRUE(
        kerf_->wait_until([&] { return events_of(folder_.file("events")).size() > seen + 3; }));
  }
  Json finish(int expected_exit) {
    kerf_->send(SIGINT);
    result_ = kerf_->finish();
    EXPECT_EQ(result_.exit_code, expected_exit) << result_.err;
    return Json::parse(read_file(folder_.file("live.json")), nullptr, false);
  }
  KerfResult replay(const std::vector<std::string>& more, const std::string& stock = kBlock) {
    KerfCall call;
    call.arguments = {"replay", folder_.file("run.csv"),   "--speed", "max",
                      "--json", folder_.file("again.json")};
    const std::vector<std::string> work = work_of(program_, stock);
    call.arguments.insert(call.arguments.end(), work.begin(), work.end());
    call.arguments.insert(call.arguments.end(), more.begin(), more.end());
    return run_kerf(call);
  }

  TestFolder folder_;
  std::string program_;
  std::string config_;
  std::unique_ptr<MachineProcess> machine_;
  std::unique_ptr<RunningKerf> kerf_;
  KerfResult result_;
};

TEST_F(Shadow, TheWorkpieceIsThatOfTheDryRunAndTheRecordingGivesItAgain) {
  start(kWatchedProgram);
  wait_for_end();
  const Json report = finish(0);
  const double wanted = removed_by_dry_run(folder_, program_);
  const double removed = report["stock"]["removed_mm3"];
  EXPECT_NEAR(removed, wanted, 0.005 * wanted);
  EXPECT_EQ(report["findings"].size(), 0U) << report["findings"];
  const Json& live = report["live"];
  EXPECT_EQ(live["errors"], 0);
  EXPECT_EQ(live["dropped"], 0);
  EXPECT_EQ(live["off_path"], 0);
  EXPECT_GE(live["tool_changes"], 1);
  EXPECT_LT(live["age_ms"]["median"], 20);
  EXPECT_NE(result_.out.find("modbus tcp 127.0.0.1"), std::string::npos);
  // Where it was, and what was left, while it ran.
  bool on_line_5 = false;
  for (const Json& event : events_of(folder_.file("events"))) {
    if (event["event"] != "status" || !event["on_path"]) continue;
    on_line_5 |= event["line"] == 5 && event["remaining_s"].is_number();
  }
  EXPECT_TRUE(on_line_5);

  const KerfResult again = replay({});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  const Json second = Json::parse(read_file(folder_.file("again.json")));
  EXPECT_NEAR(second["stock"]["removed_mm3"], removed, 0.001 * removed);
  EXPECT_EQ(second["live"]["samples"], live["samples"]);
}

/// Beside the machine, in a replay of it, and as a box: the same workpiece of the same positions.
TEST_F(Shadow, ABlankFromAMeshIsCutLikeAnyOther) {
  const std::string mesh =
      "stl:" + folder_.write("block.stl", stl_box({-10, -10, -6}, {40, 30, 0}));
  start(kWatchedProgram, {}, {}, mesh);
  wait_for_end();
  const Json report = finish(0);
  const double wanted = removed_by_dry_run(folder_, program_);
  EXPECT_NEAR(report["stock"]["removed_mm3"], wanted, 0.005 * wanted);
  EXPECT_EQ(report["findings"].size(), 0U) << report["findings"];
  std::string digest;
  for (const std::string& stock : {mesh, std::string(kBlock)}) {
    const KerfResult again = replay({}, stock);
    EXPECT_EQ(again.exit_code, 0) << again.err;
    const std::string now = Json::parse(read_file(folder_.file("again.json")))["stock"]["digest"];
    if (digest.empty()) digest = now;
    EXPECT_EQ(now, digest) << stock;
  }
}

TEST_F(Shadow, ACollisionIsToldBeforeItHappens) {
  std::string text = kWatchedProgram;
  text.replace(text.find("G0 Z5\nM5"), 5, "G0 X30\nG0 Z5");
  start(text, {"--look-ahead", "10"});
  wait_for_end();
  const Json report = finish(1);
  ASSERT_FALSE(report["findings"].empty());
  EXPECT_EQ(report["findings"][0]["id"], "rapid-contact");
  int ahead = -1, happened = -1, at = 0;
  for (const Json& event : events_of(folder_.file("events"))) {
    ++at;
    if (event["event"] == "ahead" && ahead < 0) {
      ahead = at;
      EXPECT_EQ(event["id"], "rapid-contact");
      EXPECT_EQ(event["line"], 12);
      EXPECT_GT(event["in_s"], 0.5);
    }
    if (event["event"] == "finding" && happened < 0) happened = at;
  }
  EXPECT_GT(ahead, 0);
  EXPECT_GT(happened, ahead);
  EXPECT_NE(result_.err.find("part.ngc:12: error: in "), std::string::npos) << result_.err;
  EXPECT_EQ(report["live"]["warnings_ahead"], 1);
}

TEST_F(Shadow, AMachineThatFreezesIsStaleAndTheGapIsMarked) {
  start(kWatchedProgram, {}, {"--fault", "drop:2:1"});
  ASSERT_TRUE(kerf_->wait_until([&] { return is_told("\"state\":\"stale\""); }));
  wait_for_end();
  const Json report = finish(3);
  EXPECT_TRUE(is_told("\"id\":\"source-gap\""));
  EXPECT_GE(report["live"]["gaps"], 1);
  EXPECT_NE(result_.err.find("kerf: stale"), std::string::npos) << result_.err;
}

TEST_F(Shadow, KilledItLeavesARecordingThatReplays) {
  start(kWatchedProgram);
  ASSERT_TRUE(kerf_->wait_until([&] { return is_told("\"line\":6"); }));
  const std::vector<Json> events = events_of(folder_.file("events"));
  const int samples_told = events.back()["samples"];
  kerf_->send(SIGKILL);
  EXPECT_EQ(kerf_->finish().exit_code, 128 + SIGKILL);
  const KerfResult again = replay({});
  EXPECT_NE(again.err.find("cut off"), std::string::npos) << again.err;
  const Json report = Json::parse(read_file(folder_.file("again.json")));
  // At 200 samples a second a second is 200; the events are up to 0.1 s old, too.
  EXPECT_GT(report["live"]["samples"], samples_told - 200);
}

TEST_F(Shadow, ADiskThatIsFullEndsTheRecordingNotTheWatch) {
  program_ = folder_.write("part.ngc", kWatchedProgram);
  MachineProcess machine({program_, "--modbus-tcp", "127.0.0.1:0", "--frame", "workpiece", "--hold",
                          "--wait-for-reader", "--start-delay", "1"});
  KerfCall call;
  config_ = folder_.write("machine.yaml", with_port(kConfig, machine.wait_line("listening")));
  call.arguments = {"shadow", "-c", config_, "--record", folder_.file("run.csv")};
  const std::vector<std::string> work = work_of(program_);
  call.arguments.insert(call.arguments.end(), work.begin(), work.end());
  call.file_size_limit = 8192;
  RunningKerf kerf(call);
  EXPECT_TRUE(kerf.wait_until([&] {
    return kerf.err().find("run.csv: File too large") != std::string::npos;
  })) << kerf.err();
  kerf.send(SIGINT);
  const KerfResult result = kerf.finish();
  EXPECT_EQ(result.exit_code, 4) << result.err;
  EXPECT_NE(result.out.find(" samples in "), std::string::npos) << result.out;
  const std::string recorded = read_file(folder_.file("run.csv"));
  EXPECT_LE(recorded.size(), 8192U);
  EXPECT_EQ(recorded.back(), '\n');
}

TEST(LiveCommand, FaultsOfTheCommandLineComeAtOnce) {
  const TestFolder folder;
  KerfCall call;
  call.arguments = {"replay",       folder.file("none.csv"),
                    "--speed",      "0",
                    "--gap",        "jump",
                    "--look-ahead", "-1",
                    "--off-path",   "x",
                    "--for",        "0"};
  const KerfResult result = run_kerf(call);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err,
            "kerf: error: --off-path: 'x' is not a number; must be above 0 and at most 1000 (mm)\n"
            "kerf: error: --look-ahead: -1 is not allowed; must be at least 0 and at most 3600 "
            "(s)\n"
            "kerf: error: --gap: 'jump' is no policy; allowed: mark, cut, ignore\n"
            "kerf: error: --for: 0 is not allowed; must be above 0 and at most 1e+09 (s)\n"
            "kerf: error: --speed: 0 is not allowed; must be above 0 and at most 1e+06 (times real "
            "time)\n");
}

TEST(LiveCommand, WhatCannotBeReadOrIsNotGivenIsSaid) {
  const TestFolder folder;
  KerfCall call;
  call.arguments = {"replay", folder.file("none.csv"), "--stock", "box:0,0,0:9,9,9"};
  KerfResult result = run_kerf(call);
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.err.find("none.csv: "), std::string::npos) << result.err;

  const std::string log = folder.write("run.csv", "t_s,x_mm,y_mm,z_mm\n0,1,2,3\n1,2,3,4\n");
  call.arguments = {"replay", log};
  result = run_kerf(call);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("no blank is given"), std::string::npos) << result.err;

  call.arguments = {"shadow", "--stock", "box:0,0,0:9,9,9"};
  result = run_kerf(call);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("source"), std::string::npos) << result.err;

  call.arguments = {"shadow",
                    "--set",
                    "source.type=modbus",
                    "--set",
                    "source.tcp=127.0.0.1:1",
                    "--set",
                    "source.map.X.register=0",
                    "--stock",
                    "box:0,0,0:9,9,9",
                    "--record",
                    log,
                    "--for",
                    "0.2"};
  result = run_kerf(call);
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.err.find("run.csv"), std::string::npos) << result.err;
  EXPECT_EQ(read_file(log), "t_s,x_mm,y_mm,z_mm\n0,1,2,3\n1,2,3,4\n") << "never overwritten";
}

TEST(LiveCommand, AServerThatIsNotThereIsWaitedForAndNamed) {
  KerfCall call;
  call.arguments = {"shadow",
                    "--set",
                    "source.type=modbus",
                    "--set",
                    "source.tcp=127.0.0.1:1",
                    "--set",
                    "source.map.X.register=0",
                    "--stock",
                    "box:0,0,0:9,9,9",
                    "--for",
                    "0.5"};
  const KerfResult result = run_kerf(call);
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.err.find("127.0.0.1:1: Connection refused"), std::string::npos) << result.err;
}

TEST(LiveCommand, CsvOfAnotherProgramIsReplayed) {
  const TestFolder folder;
  const std::string log = folder.write(
      "run.csv", "t_s;x_mm;y_mm;z_mm;tool\r\n0;5;5;1;1\r\n0.1;5;5;-1;1\r\n0.2;15;5;-1;1\r\n");
  KerfCall call;
  call.arguments = {"replay",  log,        "--stock", "box:0,0,-5:20,10,0",
                    "--tool",  "1=flat:4", "--cell",  "0.05",
                    "--speed", "max",      "--json",  "-"};
  const KerfResult result = run_kerf(call);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NEAR(Json::parse(result.out)["stock"]["removed_mm3"], 52.566, 0.1);
  EXPECT_NE(result.err.find("where the workpiece lies in the machine is not known"),
            std::string::npos);
}

TEST(ConfigCommand, ChecksPrintsAndLists) {
  const TestFolder folder;
  KerfCall call;
  call.arguments = {"config", "schema"};
  EXPECT_NE(run_kerf(call).out.find("poll_hz"), std::string::npos);
  const std::string bad = folder.write("bad.yaml", "source:\n  type: modbas\n  pol_hz: 5\n");
  call.arguments = {"config", "check", bad};
  const KerfResult result = run_kerf(call);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("bad.yaml:2:9: error:"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("bad.yaml:3:3: error:"), std::string::npos) << result.err;
  call.arguments = {"config", "print", "--set", "source.type=hal"};
  EXPECT_NE(run_kerf(call).out.find("type: hal"), std::string::npos);
  call.arguments = {"config", "chek", bad};
  EXPECT_EQ(run_kerf(call).exit_code, 2);
}

TEST(MachineCommand, StartsTheSimulatedMachine) {
  KerfCall call;
  call.arguments = {"machine", "--help"};
  const KerfResult result = run_kerf(call);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("--modbus-tcp"), std::string::npos);
}

}  // namespace
}  // namespace kerf
