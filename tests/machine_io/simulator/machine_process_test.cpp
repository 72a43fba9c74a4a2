// kerf-machine on the wire: what a Modbus client reads while a program runs.
#include "tests/machine_io/simulator/machine_process.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <map>
#include <set>
#include <thread>

#include "base/geometry.h"
#include "tests/base/temporary_folder.h"
#include "tests/machine_io/simulator/modbus_client.h"

namespace kerf {
namespace {

/// G61.1: the planned path is the programmed one.
constexpr const char* kProgram =
    "G21 G90 G17 G61.1 G54\n"
    "T3 M6\n"
    "S1200 M4\n"
    "G0 X0 Y0 Z5\n"
    "G1 Z-1 F600\n"
    "G1 X20 F1200\n"
    "G3 X30 Y10 I0 J10\n"
    "G1 Y30\n"
    "G0 Z5\n"
    "M5\n"
    "M2\n";

double distance_from_line(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const Vec3 v = p - a;
  const double square = d.x * d.x + d.y * d.y + d.z * d.z;
  const double t =
      std::clamp((v.x * d.x + v.y * d.y + v.z * d.z) / std::max(square, 1e-12), 0.0, 1.0);
  const Vec3 off = v - t * d;
  return std::hypot(off.x, off.y, off.z);
}

/// How far a point is from what a line of kProgram commands.
double distance_from_program(int line, const Vec3& p) {
  switch (line) {
    case 5:
      return distance_from_line(p, {0, 0, 5}, {0, 0, -1});
    case 6:
      return distance_from_line(p, {0, 0, -1}, {20, 0, -1});
    case 7:  // about 20, 10; from below to the right
      if (p.x < 20 - 1e-3 || p.y > 10 + 1e-3) return 1e9;
      return std::hypot(std::hypot(p.x - 20, p.y - 10) - 10, p.z + 1);
    case 8:
      return distance_from_line(p, {30, 10, -1}, {30, 30, -1});
    case 9:
      return distance_from_line(p, {30, 30, -1}, {30, 30, 5});
    default:
      return 1e9;
  }
}

/// Polls until the program is over and the machine stands at its end.
struct Seen {
  std::map<int, int> readings;  ///< by line
  double worst_mm = 0;          ///< distance from the path of the reported line
  double worst_float_mm = 0;    ///< between the integers and the floats of a reading
  std::set<int> tools;
  int least_rpm = 0;
};

Seen poll_to_end(ModbusClient& client) {
  Seen seen;
  const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  const Vec3 end{30, 30, 5};
  while (std::chrono::steady_clock::now() < limit) {
    if (client.read() != 0) {
      ADD_FAILURE() << modbus_strerror(errno);
      break;
    }
    const Vec3 p{client.position(0), client.position(1), client.position(2)};
    const int line = client.integer(kLineRegister);
    ++seen.readings[line];
    seen.tools.insert(client.registers[kToolRegister]);
    seen.least_rpm = std::min<int>(seen.least_rpm,
                                   static_cast<std::int16_t>(client.registers[kSpindleRegister]));
    if (line != 0) seen.worst_mm = std::max(seen.worst_mm, distance_from_program(line, p));
    for (std::size_t i = 0; i < 3; ++i) {
      const double value = modbus_get_float_abcd(&client.registers[kFloatRegister + 2 * i]);
      seen.worst_float_mm = std::max(seen.worst_float_mm, std::abs(value - p[static_cast<int>(i)]));
    }
    if (line == 0 && distance_from_line(p, end, end) < 1e-9) break;
  }
  return seen;
}

class Program {
 public:
  explicit Program(const char* text = kProgram) { write_file(path(), text); }
  std::string path() const { return folder_ / "part.ngc"; }
  std::string operator/(const std::string& name) const { return folder_ / name; }

 private:
  TemporaryFolder folder_;
};

void expect_program_seen(const Seen& seen, int readings_a_line) {
  // Half a thousandth is the rounding of the registers.
  EXPECT_LE(seen.worst_mm, 0.001);
  EXPECT_LE(seen.worst_float_mm, 0.000502);
  for (const int line : {5, 6, 7, 8, 9}) {
    EXPECT_GE(seen.readings.contains(line) ? seen.readings.at(line) : 0, readings_a_line) << line;
  }
  EXPECT_EQ(seen.tools, (std::set<int>{0, 3}));
  EXPECT_EQ(seen.least_rpm, -1200);
}

TEST(Machine, ServesTheProgramsPositionsOverTcp) {
  const Program program;
  MachineProcess machine(
      {program.path(), "--modbus-tcp", "127.0.0.1:0", "--start-delay", "0.3", "--hold"});
  ModbusClient client(machine.wait_line("listening modbus-tcp"));
  ASSERT_TRUE(client.connected());
  ASSERT_EQ(client.read(), 0);
  EXPECT_EQ(client.integer(4), 5000);  // the end of the first move: the start is not known
  EXPECT_EQ(client.registers[kToolRegister], 0);
  expect_program_seen(poll_to_end(client), 20);
  EXPECT_NE(machine.wait_line("finished after"), "");
  const std::uint16_t scan = client.registers[kScanRegister];
  while (client.registers[kScanRegister] == scan) ASSERT_EQ(client.read(), 0);
  machine.send(SIGTERM);
  EXPECT_EQ(machine.finish(), 0);
  EXPECT_EQ(machine.err(), "");
}

TEST(Machine, WaitsUntilItIsAsked) {
  const Program program;
  MachineProcess machine({program.path(), "--modbus-tcp", "127.0.0.1:0", "--wait-for-reader",
                          "--start-delay", "0.1", "--speed", "20"});
  ModbusClient client(machine.wait_line("listening modbus-tcp"));
  ASSERT_TRUE(client.connected());
  // Without waiting it would be over.
  std::this_thread::sleep_for(std::chrono::seconds(1));
  ASSERT_EQ(client.read(), 0);
  EXPECT_EQ(client.integer(4), 5000);
  EXPECT_EQ(client.registers[kToolRegister], 0);
  EXPECT_NE(machine.wait_line("finished after"), "");
  EXPECT_EQ(machine.finish(), 0);
}

TEST(Machine, TwentyTimesAsFastIsTheSamePath) {
  const Program program;
  const auto time_of = [&](const char* speed) {
    MachineProcess machine({program.path(), "--modbus-tcp", "127.0.0.1:0", "--start-delay", "0.2",
                            "--hold", "--speed", speed, "--rate", "5000"});
    ModbusClient client(machine.wait_line("listening modbus-tcp"));
    expect_program_seen(poll_to_end(client), 1);
    const double seconds = std::stod(machine.wait_line("finished after"));
    machine.send(SIGINT);
    EXPECT_EQ(machine.finish(), 0);
    return seconds;
  };
  const double slow = time_of("2");
  const double fast = time_of("20");
  EXPECT_NEAR(slow * 2, fast * 20, 0.05);
}

TEST(Machine, ServesRtuUnderALink) {
  const Program program;
  MachineProcess machine({program.path(), "--modbus-rtu", "--link", program / "ttyM", "--speed",
                          "2", "--start-delay", "0.3", "--hold", "--baud", "4000000"});
  EXPECT_TRUE(machine.wait_line("listening modbus-rtu").ends_with(" link " + program / "ttyM"));
  ModbusClient client(program / "ttyM");
  ASSERT_TRUE(client.connected());
  expect_program_seen(poll_to_end(client), 5);
  machine.send(SIGTERM);
  EXPECT_EQ(machine.finish(), 0);
  EXPECT_FALSE(std::filesystem::is_symlink(program / "ttyM"));
}

TEST(Machine, EndsWithTheProgramAndSaysSo) {
  const Program program;
  MachineProcess machine({program.path(), "--modbus-tcp", "127.0.0.1:0", "--speed", "20"});
  EXPECT_EQ(machine.finish(), 0);
  EXPECT_TRUE(machine.out().starts_with("listening modbus-tcp 127.0.0.1:"));
  EXPECT_NE(machine.out().find("\nstarted\n"), std::string::npos);
  EXPECT_NE(machine.out().find("\nfinished after "), std::string::npos);
}

TEST(Machine, RepeatsByWayOfASafeHeight) {
  const Program program("G21 G90 G61.1\nG0 X0 Y0 Z1\nG1 X10 F60000\nZ-5\nM2\n");
  MachineProcess machine({program.path(), "--modbus-tcp", "127.0.0.1:0", "--repeat", "--rate",
                          "2000", "--start-delay", "0.1"});
  ModbusClient client(machine.wait_line("listening modbus-tcp"));
  int rounds = 0;
  bool deep = false;
  while (rounds < 3) {
    ASSERT_EQ(client.read(), 0);
    const double x = client.position(0);
    const double z = client.position(2);
    if (z < 0.999) {
      EXPECT_NEAR(x, 10, 1e-9) << "below the start, but not where the program goes down";
    }
    if (z < -4.9) deep = true;
    if (deep && x < 0.5) {
      ++rounds;
      deep = false;
    }
  }
  machine.send(SIGTERM);
  EXPECT_EQ(machine.finish(), 0);
  EXPECT_NE(machine.out().find("\nstopped after "), std::string::npos);
}

TEST(Machine, TwoFaultsAtOnceAreSeenOnTheWire) {
  const Program program;
  MachineProcess machine({program.path(), "--modbus-tcp", "127.0.0.1:0", "--hold", "--fault",
                          "nan:0.4:0.2", "--fault", "freeze:0.4:0.2"});
  ModbusClient client(machine.wait_line("listening modbus-tcp"));
  // From 0.4 s on, at the machine's next turn: that may come late on a busy computer.
  for (const std::string name : {"nan", "freeze"}) {
    const std::string line = machine.wait_line("fault");
    double at_s = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), (name + " on at %lf s").c_str(), &at_s), 1) << line;
    EXPECT_GE(at_s, 0.4);
    EXPECT_LT(at_s, 0.6);
  }
  std::set<std::uint16_t> scans;
  std::uint16_t scan = 0;
  bool is_nan = true;
  while (is_nan) {
    ASSERT_EQ(client.read(), 0);
    is_nan = std::isnan(modbus_get_float_abcd(&client.registers[kFloatRegister]));
    EXPECT_EQ(client.integer(0) == std::numeric_limits<std::int32_t>::min(), is_nan);
    scan = client.registers[kScanRegister];
    if (is_nan) scans.insert(scan);
  }
  EXPECT_EQ(scans.size(), 1u);
  EXPECT_FALSE(scans.contains(scan));
  machine.send(SIGTERM);
  EXPECT_EQ(machine.finish(), 0);
}

TEST(Machine, RestartsOnThePortItHad) {
  const Program program;
  MachineProcess machine(
      {program.path(), "--modbus-tcp", "127.0.0.1:0", "--hold", "--fault", "restart:0.3:0.15"});
  const std::string address = machine.wait_line("listening modbus-tcp");
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(machine.wait_line("listening modbus-tcp"), address);
    ModbusClient client(address);
    ASSERT_TRUE(client.connected());
    EXPECT_EQ(client.read(), 0);
  }
  machine.send(SIGTERM);
  EXPECT_EQ(machine.finish(), 0);
}

TEST(Machine, TellsOfRequestsThatWouldWrite) {
  const Program program;
  MachineProcess machine({program.path(), "--modbus-tcp", "127.0.0.1:0", "--hold"});
  ModbusClient client(machine.wait_line("listening modbus-tcp"));
  EXPECT_EQ(modbus_write_register(client.context(), 0, 1), -1);
  machine.send(SIGTERM);
  EXPECT_EQ(machine.finish(), 0);
  EXPECT_NE(machine.out().find("\nrefused-requests 1\n"), std::string::npos);
}

TEST(Machine, MachineCoordinatesHoldOffsetAndToolLength) {
  const Program program(
      "G21 G90 G61.1\nG10 L2 P1 X100 Y50 Z-20 R90\nG10 L1 P3 Z40\nT3 M6\nG43\nG54\n"
      "G0 X0 Y0 Z5\nG1 X10 F600\nM2\n");
  const auto end_of = [&](const std::string& frame) {
    MachineProcess machine({program.path(), "--modbus-tcp", "127.0.0.1:0", "--hold", "--speed",
                            "100", "--frame", frame});
    ModbusClient client(machine.wait_line("listening modbus-tcp"));
    EXPECT_NE(machine.wait_line("finished after"), "");
    EXPECT_EQ(client.read(), 0);
    const Vec3 end{client.position(0), client.position(1),
                   client.position(2) - client.integer(kToolOffsetRegister) * 1e-3};
    machine.send(SIGTERM);
    EXPECT_EQ(machine.finish(), 0);
    return end;
  };
  // X of the program points along Y of the machine.
  EXPECT_NEAR(distance_from_line(end_of("machine"), {100, 60, -15}, {100, 60, -15}), 0, 1e-9);
}

}  // namespace
}  // namespace kerf
