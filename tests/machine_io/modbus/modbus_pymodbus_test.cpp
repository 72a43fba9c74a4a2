// An independent Modbus server: python3-pymodbus of Debian.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <string>
#include <vector>

#include "machine_io/modbus/modbus_source.h"
#include "tests/machine_io/modbus/pseudo_terminal.h"

namespace kerf {
namespace {

using std::chrono::milliseconds;
using Next = PositionSource::Next;

constexpr const char* kPython = "/usr/bin/python3";

/// A child whose standard output is read line by line; killed at the end.
class Child {
 public:
  explicit Child(const std::vector<std::string>& words) {
    int out[2];
    if (pipe2(out, O_CLOEXEC) != 0) return;
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
    if (posix_spawn(&pid_, words[0].c_str(), &actions, nullptr, arguments.data(), environ) != 0) {
      pid_ = -1;
    }
    posix_spawn_file_actions_destroy(&actions);
    close(out[1]);
    out_ = out[0];
  }
  ~Child() {
    if (pid_ > 0) kill(pid_, SIGKILL);
    if (pid_ > 0) waitpid(pid_, nullptr, 0);
    close(out_);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// The next line of its output; empty at its end or after 30 s.
  std::string line() {
    std::string text;
    for (;;) {
      pollfd asked{out_, POLLIN, 0};
      char c = 0;
      if (poll(&asked, 1, 30000) <= 0 || read(out_, &c, 1) != 1) return {};
      if (c == '\n') return text;
      text += c;
    }
  }
  int wait() {
    int status = -1;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return status;
  }

 private:
  pid_t pid_ = -1;
  int out_ = -1;
};

bool has_pymodbus(const char* modules) {
  if (access(kPython, X_OK) != 0) return false;
  Child child({kPython, "-c", std::string("import ") + modules});
  return child.wait() == 0;
}

struct Layout {
  int address;
  ModbusType type;
  WordOrder order;
  double scale;
  double tolerance;
};

constexpr std::array<double, 3> kPositions{123.456, -7.25, 0.001};
constexpr Layout kLayouts[] = {{0, ModbusType::kFloat32, WordOrder::kAbcd, 1, 1e-5},
                               {6, ModbusType::kFloat32, WordOrder::kCdab, 1, 1e-5},
                               {12, ModbusType::kFloat32, WordOrder::kBadc, 1, 1e-5},
                               {18, ModbusType::kFloat32, WordOrder::kDcba, 1, 1e-5},
                               {24, ModbusType::kInt32, WordOrder::kAbcd, 0.001, 1e-12},
                               {30, ModbusType::kInt32, WordOrder::kCdab, 0.001, 1e-12}};

/// Reads every layout from the server that `settings` names, once per table.
void read_all_layouts(ModbusSettings settings) {
  settings.timeout_ms = 2000;
  settings.tool = ModbusRegister{46, ModbusTable::kHolding, ModbusType::kUint16};
  settings.line = ModbusRegister{47, ModbusTable::kInput, ModbusType::kUint16};
  settings.axes[3] = ModbusRegister{36, ModbusTable::kHolding, ModbusType::kFloat64};
  settings.axes[4] =
      ModbusRegister{40, ModbusTable::kInput, ModbusType::kFloat64, WordOrder::kDcba};
  settings.axes[5] = ModbusRegister{44, ModbusTable::kHolding, ModbusType::kInt16};
  settings.axes[6] = ModbusRegister{45, ModbusTable::kInput, ModbusType::kUint16};
  for (const ModbusTable table : {ModbusTable::kHolding, ModbusTable::kInput}) {
    for (const Layout& layout : kLayouts) {
      for (int axis = 0; axis < 3; ++axis) {
        settings.axes[static_cast<std::size_t>(axis)] = ModbusRegister{
            layout.address + 2 * axis, table, layout.type, layout.order, layout.scale, 0};
      }
      ModbusSource source(settings);
      AxisSample sample;
      ASSERT_EQ(source.next(sample, milliseconds(5000)), Next::kSample) << source.status().trouble;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(sample.position[axis], kPositions[axis], layout.tolerance);
      }
      EXPECT_EQ(sample.position[3], 123.456);
      EXPECT_EQ(sample.position[4], 123.456);
      EXPECT_EQ(sample.position[5], -1234);
      EXPECT_EQ(sample.position[6], 54321);
      EXPECT_EQ(sample.tool, 7);
      EXPECT_EQ(sample.line, 321);
      EXPECT_EQ(sample.known, 0x7f);
    }
  }
}

TEST(ModbusPymodbus, tcp_reads_every_type_and_order) {
  if (!has_pymodbus("pymodbus.server, serial_asyncio")) {
    GTEST_SKIP() << "needs the packages python3-pymodbus and python3-serial-asyncio";
  }
  Child server({kPython, KERF_PYMODBUS_SERVER, "tcp"});
  const std::string line = server.line();
  ASSERT_EQ(line.substr(0, 5), "port ");
  ModbusSettings settings;
  settings.host = "127.0.0.1";
  settings.port = std::stoi(line.substr(5));
  read_all_layouts(settings);
}

TEST(ModbusPymodbus, rtu_reads_every_type_and_order) {
  if (!has_pymodbus("pymodbus.server, serial_asyncio")) {
    GTEST_SKIP() << "needs the packages python3-pymodbus and python3-serial-asyncio";
  }
  const SerialCable cable;
  Child server({kPython, KERF_PYMODBUS_SERVER, "rtu", cable.end_a()});
  ASSERT_EQ(server.line(), "ready");
  ModbusSettings settings;
  settings.rtu = true;
  settings.device = cable.end_b();
  settings.baud = 115200;
  read_all_layouts(settings);
}

TEST(ModbusPymodbus, refuses_registers_that_it_has_not) {
  if (!has_pymodbus("pymodbus.server, serial_asyncio")) {
    GTEST_SKIP() << "needs the packages python3-pymodbus and python3-serial-asyncio";
  }
  Child server({kPython, KERF_PYMODBUS_SERVER, "tcp"});
  const std::string line = server.line();
  ASSERT_EQ(line.substr(0, 5), "port ");
  ModbusSettings settings;
  settings.host = "127.0.0.1";
  settings.port = std::stoi(line.substr(5));
  settings.timeout_ms = 2000;
  settings.axes[0] = ModbusRegister{47};
  ModbusSource source(settings);
  AxisSample sample;
  EXPECT_EQ(source.next(sample, milliseconds(5000)), Next::kNothing);
  EXPECT_EQ(source.status().trouble,
            "holding 47..48: the device answers with exception 2 (Illegal data address)");
}

}  // namespace
}  // namespace kerf
