// What kerf-machine says to arguments that it cannot use.
#include <gtest/gtest.h>

#include "tests/base/temporary_folder.h"
#include "tests/machine_io/simulator/machine_process.h"

namespace kerf {
namespace {

struct Answer {
  int exit_code = -1;
  std::string err;
};

Answer run(std::vector<std::string> arguments) {
  MachineProcess machine(arguments);
  const int code = machine.finish();
  EXPECT_EQ(machine.out(), "");
  return {code, machine.err()};
}

class MachineArgumentsTest : public testing::Test {
 protected:
  MachineArgumentsTest() { write_file(program, "G21 G90\nG0 X0 Y0 Z5\nG1 X9 F100\nM2\n"); }
  /// One fault, one text.
  void expect_usage(std::vector<std::string> arguments, const std::string& text) const {
    arguments.insert(arguments.begin(), program);
    const Answer answer = run(arguments);
    EXPECT_EQ(answer.exit_code, 2);
    EXPECT_EQ(answer.err, text);
  }
  TemporaryFolder folder;
  std::string program = folder / "part.ngc";
};

TEST_F(MachineArgumentsTest, EachFaultHasItsText) {
  const std::string tcp = "--modbus-tcp";
  const std::string free_port = "127.0.0.1:0";
  expect_usage({},
               "kerf: error: no way out for the positions: one of --modbus-tcp, --modbus-rtu "
               "and --can is needed\n   hint: kerf machine part.ngc --modbus-tcp 127.0.0.1:0\n");
  for (const std::string wrong : {"127.0.0.1", ":502", "host:", "host:65536", "host:x", "::1:5"}) {
    expect_usage({tcp, wrong}, "kerf: error: --modbus-tcp: '" + wrong +
                                   "' is not HOST:PORT with a port from 0 (choose one) to 65535\n"
                                   "   hint: 127.0.0.1:0, or [::1]:1502\n");
  }
  expect_usage(
      {tcp, free_port, "--rate", "0"},
      "kerf: error: --rate: 0 is not allowed; must be at least 1 and at most 10000 (Hz)\n");
  expect_usage({tcp, free_port, "--speed", "fast"},
               "kerf: error: --speed: 'fast' is not a number; must be at least 0.001 and at most "
               "1000 (times)\n");
  expect_usage({tcp, free_port, "--link", "/tmp/x"},
               "kerf: error: --link: only with --modbus-rtu\n");
  expect_usage({tcp, free_port, "--baud", "9600"}, "kerf: error: --baud: only with --modbus-rtu\n");
  expect_usage({tcp, free_port, "--can-layout", "odrive"},
               "kerf: error: --can-layout: only with --can\n");
  expect_usage({"--can", "can0", "--can-layout", "j1939"},
               "kerf: error: --can-layout: 'j1939' is no layout; allowed: cia402, odrive\n");
  expect_usage({"--can", "can0", "--fault", "delay:5"},
               "kerf: error: --fault: delay is a fault of answers, and CAN frames are none\n");
  expect_usage({tcp, free_port, "--fault", "smoke"},
               "kerf: error: --fault: 'smoke' is no fault; allowed: drop, delay, garbage, "
               "exception, restart, nan, freeze, jump\n");
  expect_usage({tcp, free_port, "--frame", "tool"},
               "kerf: error: --frame: 'tool' is no frame; allowed: machine, workpiece\n");
  expect_usage({"--can", "can0", "--wait-for-reader"},
               "kerf: error: --wait-for-reader: not with --can: who reads frames does not ask for "
               "them\n");
  expect_usage({tcp, free_port, "--sped", "2"},
               "kerf: error: unknown option --sped; did you mean --speed?\n"
               "   hint: kerf-machine --help lists what there is\n");
}

TEST_F(MachineArgumentsTest, AllFaultsAreToldAtOnce) {
  const Answer answer = run({program, "--modbus-rtu", "--unit", "0", "--rate", "x"});
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_NE(answer.err.find("--unit: 0 is not allowed"), std::string::npos);
  EXPECT_NE(answer.err.find("--rate: 'x' is not a number"), std::string::npos);
}

TEST_F(MachineArgumentsTest, WhatCannotBeUsedIsExitCode4) {
  const auto error = [&](std::vector<std::string> arguments) {
    const Answer answer = run(std::move(arguments));
    EXPECT_EQ(answer.exit_code, 4);
    return answer.err;
  };
  EXPECT_NE(error({folder / "none.ngc", "--modbus-tcp", "127.0.0.1:0"}).find("none.ngc"),
            std::string::npos);
  EXPECT_EQ(error({program, "--modbus-tcp", "192.0.2.1:1502"}),
            "kerf: error: listening on 192.0.2.1:1502: Cannot assign requested address\n");
  EXPECT_EQ(error({program, "--modbus-rtu", "--link", program}),
            "kerf: error: " + program + " exists and is no symbolic link\n");
  EXPECT_EQ(error({program, "--can", "kerfnone0"}).substr(0, 31),
            "kerf: error: opening kerfnone0:");
}

TEST_F(MachineArgumentsTest, AProgramThatFailsStopsTheMachineThere) {
  write_file(program, "G21 G90\nG0 X0 Y0 Z5\nG1 X9 F10000\nG1 X\nM2\n");
  MachineProcess machine({program, "--modbus-tcp", "127.0.0.1:0", "--speed", "20"});
  EXPECT_EQ(machine.finish(), 4);
  EXPECT_NE(machine.out().find("\nfinished after "), std::string::npos);
  EXPECT_NE(machine.err().find(program + ":4"), std::string::npos) << machine.err();
}

}  // namespace
}  // namespace kerf
