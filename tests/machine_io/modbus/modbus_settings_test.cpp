#include "machine_io/modbus/modbus_settings.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kerf {
namespace {

using Texts = std::vector<std::string>;

ModbusSettings good_tcp() {
  ModbusSettings settings;
  settings.host = "plc.local";
  settings.axes[0] = ModbusRegister{};
  return settings;
}

ModbusSettings good_rtu() {
  ModbusSettings settings = good_tcp();
  settings.rtu = true;
  settings.device = "/dev/ttyUSB0";
  return settings;
}

TEST(ModbusSettings, good_ones_have_no_fault) {
  EXPECT_EQ(validate(good_tcp()), Texts{});
  EXPECT_EQ(validate(good_rtu()), Texts{});
}

TEST(ModbusSettings, all_faults_are_named_at_once) {
  ModbusSettings settings;
  settings.port = 0;
  settings.unit = 300;
  settings.poll_hz = std::nan("");
  settings.timeout_ms = 0;
  settings.max_gap = 124;
  EXPECT_EQ(validate(settings), (Texts{"tcp.host: '' is not allowed; must be a name or an address",
                                       "tcp.port: 0 is not allowed; must be 1 to 65535",
                                       "unit: 300 is not allowed; must be 0 to 255",
                                       "poll_hz: nan is not allowed; must be 0.1 to 2000 (polls/s)",
                                       "timeout_ms: 0 is not allowed; must be 1 to 60000 (ms)",
                                       "max_gap: 124 is not allowed; must be 0 to 123 (registers)",
                                       "map: no axis is given; at least one of X to W is needed"}));
}

TEST(ModbusSettings, faults_of_a_serial_line) {
  ModbusSettings settings = good_rtu();
  settings.device.clear();
  settings.baud = 12345;
  settings.parity = 'x';
  settings.data_bits = 9;
  settings.stop_bits = 0;
  settings.unit = 0;
  EXPECT_EQ(
      validate(settings),
      (Texts{"rtu.device: '' is not allowed; must be the path of a serial line",
             "rtu.baud: 12345 is not allowed; must be one of 110, 300, 600, 1200, 2400, 4800, "
             "9600, 19200, 38400, 57600, 115200, 230400, 460800, 500000, 576000, 921600, "
             "1000000",
             "rtu.parity: x is not allowed; must be N, E or O",
             "rtu.data_bits: 9 is not allowed; must be 7 or 8",
             "rtu.stop_bits: 0 is not allowed; must be 1 or 2",
             "unit: 0 is not allowed; must be 1 to 247 for rtu"}));
}

TEST(ModbusSettings, faults_of_registers_and_ranges) {
  ModbusSettings settings = good_tcp();
  settings.axes[1] =
      ModbusRegister{65535, ModbusTable::kInput, ModbusType::kFloat32, WordOrder::kAbcd, 0, 0};
  settings.ranges[1].min = 10;
  settings.ranges[1].max = 10;
  settings.ranges[0].max = HUGE_VAL;
  settings.ranges[0].max_speed_per_s = 0;
  settings.counter = ModbusRegister{};
  settings.line = ModbusRegister{-1, ModbusTable::kInput, ModbusType::kUint16};
  settings.line->offset = std::nan("");
  EXPECT_EQ(validate(settings),
            (Texts{"map.X.max: inf is not allowed; must be a number",
                   "map.X.max_speed: 0 is not allowed; must be above 0 (mm/s or deg/s)",
                   "map.Y.register: 65535 is not allowed; must be 0 to 65534 for float32",
                   "map.Y.scale: 0 is not allowed; must be a number other than 0",
                   "map.Y.min: 10 is not allowed; must be below max, which is 10",
                   "map.line.register: -1 is not allowed; must be 0 to 65535 for uint16",
                   "map.line.offset: nan is not allowed; must be a number",
                   "map.counter.type: float32 is not allowed; must be int16, uint16, int32 or "
                   "uint32"}));
}

}  // namespace
}  // namespace kerf
