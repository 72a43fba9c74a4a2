// kerf run --enter --at live: where a machine stands that answers on Modbus.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/machine_io/simulator/machine_process.h"
#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

constexpr const char* kConfig =
    "source:\n"
    "  type: modbus\n"
    "  tcp: 127.0.0.1:PORT\n"
    "  poll_hz: 100\n"
    "  frame: workpiece\n"
    "  coordinates: axes\n"
    "  map:\n"
    "    X: {register: 0, type: int32, word_order: cdab, scale: 0.001}\n"
    "    Y: {register: 2, type: int32, word_order: cdab, scale: 0.001}\n"
    "    Z: {register: 4, type: int32, word_order: cdab, scale: 0.001}\n"
    "    tool: {register: 12, type: uint16}\n";

/// Where it broke off: beside the block, and below its top.
constexpr const char* kBrokenOff =
    "G21 G90\n"
    "T1 M6\n"
    "G0 X-10 Y-10 Z5\n"
    "G0 Z-5\n"
    "M2\n";

constexpr const char* kProgram =
    "G21 G90 G17\n"
    "T1 M6\n"
    "S3000 M3\n"
    "G0 X10 Y20 Z5\n"
    "G1 Z-2 F300\n"
    "G1 X50\n"
    "G1 Y30\n"
    "G0 Z5\n"
    "M30\n";

KerfResult entered(const TestFolder& folder, const std::string& port) {
  std::string config = kConfig;
  config.replace(config.find("PORT"), 4, port);
  KerfCall call;
  call.arguments = {"run",
                    folder.write("part.ngc", kProgram),
                    "--stock",
                    "box:0,0,-20:60,40,0",
                    "--cell",
                    "0.5",
                    "--tool",
                    "1=flat:10",
                    "-c",
                    folder.write("machine.yaml", config),
                    "--enter",
                    "--from-line",
                    "6",
                    "--at",
                    "live",
                    "--json",
                    folder.file("report.json")};
  return run_kerf(call);
}

TEST(LivePlace, IsThatOfTheMachineOnModbus) {
  const TestFolder folder;
  const std::string program = folder.write("broken.ngc", kBrokenOff);
  MachineProcess machine(
      {program, "--modbus-tcp", "127.0.0.1:0", "--frame", "workpiece", "--hold"});
  const std::string listening = machine.wait_line("listening");
  ASSERT_NE(listening, "") << machine.err();
  ASSERT_NE(machine.wait_line("finished"), "");
  const KerfResult result = entered(folder, listening.substr(listening.rfind(':') + 1));
  // As tests/truth/entry/straight_through: through 5 mm of block in line 7.
  EXPECT_EQ(result.exit_code, 1) << result.err;
  const Json report = Json::parse(read_file(folder.file("report.json")));
  const Json& entry = report["entry"];
  EXPECT_NEAR(entry["at_mm"][0].get<double>(), -10, 0.0011);
  EXPECT_NEAR(entry["at_mm"][1].get<double>(), -10, 0.0011);
  EXPECT_NEAR(entry["at_mm"][2].get<double>(), -5, 0.0011);
  EXPECT_EQ(entry["live"]["tool"], 1);
  EXPECT_LE(entry["live"]["age_s"].get<double>(), 0.5);
  EXPECT_EQ(entry["drive"]["clear"], false);
  EXPECT_NE(result.out.find("the machine stands at X-10.00 Y-10.00 Z-5.00 mm"), std::string::npos)
      << result.out;
}

TEST(LivePlace, OfNobodyWhoAnswersIsAFault) {
  const TestFolder folder;
  // Port 1 of this computer is nobody's.
  const KerfResult result = entered(folder, "1");
  EXPECT_EQ(result.exit_code, 4) << result.err;
  EXPECT_NE(result.err.find("--at live: no position of"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("has come within 10 s"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace kerf
