// The group source: each type with its values and faults.
#include <gtest/gtest.h>

#include "tests/twin/config/config_support.h"

namespace kerf {
namespace {

template <class Settings>
const Settings& settings_of(const ReadText& read) {
  static const Settings none{};
  if (!read.config || !std::holds_alternative<Settings>(read.config->source)) {
    ADD_FAILURE() << read.said();
    return none;
  }
  return std::get<Settings>(read.config->source);
}

// ---- common

TEST(ConfigSource, CommonKeys) {
  const ReadText read(
      "source:\n  type: hal\n  stale_after_ms: 250\n  lost_after_ms: 1000\n  gap: ignore\n"
      "  frame: machine\n  coordinates: joints\n");
  ASSERT_TRUE(read.config) << read.said();
  EXPECT_EQ(read.config->common.stale_after_s, 0.25);
  EXPECT_EQ(read.config->common.lost_after_s, 1.0);
  EXPECT_EQ(read.config->common.gap, GapPolicy::kIgnore);
  EXPECT_EQ(read.config->common.frame, CoordinateFrame::kMachine);
  EXPECT_EQ(read.config->common.coordinates, CoordinateKind::kJoints);
}

TEST(ConfigSource, TypeIsNeeded) {
  EXPECT_EQ(said_of("source:\n  gap: cut\n"),
            "1:1: source: type is missing; must be one of modbus, can, hal, log, mtconnect\n");
  EXPECT_EQ(said_of("source:\n  type: modbuss\n  poll_hz: 3\n"),
            "2:9: source.type: 'modbuss' is not allowed; must be one of modbus, can, hal, log, "
            "mtconnect (did "
            "you mean modbus?)\n");
}

TEST(ConfigSource, LostComesAfterStale) {
  EXPECT_EQ(said_of("source:\n  type: hal\n  stale_after_ms: 500\n  lost_after_ms: 500\n"),
            "4:18: source.lost_after_ms: 500 is not allowed; must be above stale_after_ms, which "
            "is 500 (ms)\n");
  EXPECT_EQ(said_of("source:\n  type: hal\n  stale_after_ms: 3000\n"),
            "3:19: source.stale_after_ms: 3000 is not allowed; must be below lost_after_ms, which "
            "is 2000 (ms)\n");
}

TEST(ConfigSource, KeysOfOtherTypes) {
  EXPECT_EQ(said_of("source:\n  type: hal\n  poll_hz: 5\n  dbc: a\n  map: {X: {}}\n"),
            "3:3: source.poll_hz: is a key of sources of type modbus; this one is hal\n"
            "4:3: source.dbc: is a key of sources of type can and log; this one is hal\n"
            "5:9: source.map.X: is read from LinuxCNC's own pin; only load is chosen here\n");
}

// ---- modbus

const std::string kTcp = "source:\n  type: modbus\n  tcp: plc:1502\n";

TEST(ConfigModbus, ValuesArrive) {
  const ReadText read(kTcp +
                      "  unit: 3\n  poll_hz: 25.5\n  timeout_ms: 99\n  max_gap: 0\n"
                      "  map:\n"
                      "    X: {register: 4, table: input, type: int32, word_order: cdab, scale: "
                      "0.001, offset: -5, min: -10, max: 400, max_speed: 500}\n"
                      "    tool: {register: 0x10, type: uint16}\n"
                      "    line: {register: 17, type: uint32}\n"
                      "    spindle: {register: 19, type: int16}\n"
                      "    tool_offset_z: {register: 20}\n"
                      "    counter: {register: 22, type: uint16}\n");
  const auto& s = settings_of<ModbusSettings>(read);
  EXPECT_FALSE(s.rtu);
  EXPECT_EQ(s.host, "plc");
  EXPECT_EQ(s.port, 1502);
  EXPECT_EQ(s.unit, 3);
  EXPECT_EQ(s.poll_hz, 25.5);
  EXPECT_EQ(s.timeout_ms, 99);
  EXPECT_EQ(s.max_gap, 0);
  ASSERT_TRUE(s.axes[0]);
  EXPECT_EQ(s.axes[0]->address, 4);
  EXPECT_EQ(s.axes[0]->table, ModbusTable::kInput);
  EXPECT_EQ(s.axes[0]->type, ModbusType::kInt32);
  EXPECT_EQ(s.axes[0]->order, WordOrder::kCdab);
  EXPECT_EQ(s.axes[0]->scale, 0.001);
  EXPECT_EQ(s.axes[0]->offset, -5);
  EXPECT_EQ(s.ranges[0].min, -10);
  EXPECT_EQ(s.ranges[0].max, 400);
  EXPECT_EQ(s.ranges[0].max_speed_per_s, 500);
  EXPECT_FALSE(s.axes[1]);
  EXPECT_EQ(s.tool->address, 16);
  EXPECT_EQ(s.line->type, ModbusType::kUint32);
  EXPECT_EQ(s.spindle->address, 19);
  EXPECT_EQ(s.tool_offset_z->type, ModbusType::kFloat32);
  EXPECT_EQ(s.counter->address, 22);
}

TEST(ConfigModbus, Rtu) {
  const ReadText read(
      "source:\n  type: modbus\n  rtu: {device: /dev/ttyUSB0, baud: 115200, parity: even, "
      "data_bits: 8, stop_bits: 2}\n  map: {Z: {register: 1}}\n");
  const auto& s = settings_of<ModbusSettings>(read);
  EXPECT_TRUE(s.rtu);
  EXPECT_EQ(s.device, "/dev/ttyUSB0");
  EXPECT_EQ(s.baud, 115200);
  EXPECT_EQ(s.parity, 'E');
  EXPECT_EQ(s.stop_bits, 2);
  EXPECT_TRUE(s.axes[2]);
}

TEST(ConfigModbus, AddressForms) {
  const auto host_port = [](const std::string& tcp) {
    const ReadText read("source:\n  type: modbus\n  tcp: '" + tcp +
                        "'\n  map: {X: {register: 0}}\n");
    if (!read.config) return read.said();
    const auto& s = std::get<ModbusSettings>(read.config->source);
    return fmt::format("{} {}", s.host, s.port);
  };
  EXPECT_EQ(host_port("10.0.0.1"), "10.0.0.1 502");
  EXPECT_EQ(host_port("10.0.0.1:1502"), "10.0.0.1 1502");
  EXPECT_EQ(host_port("[::1]:5"), "::1 5");
  EXPECT_EQ(host_port("[::1]"), "::1 502");
  const std::string wrong = "is not allowed; must be HOST:PORT, HOST or [IPv6]:PORT";
  EXPECT_EQ(host_port("::1"), "3:8: source.tcp: '::1' " + wrong +
                                  " (an IPv6 address stands in brackets: [::1]:502)\n");
  EXPECT_EQ(host_port("[::1"), "3:8: source.tcp: '[::1' " + wrong + " (']' is missing)\n");
  EXPECT_EQ(host_port("[::1]5"), "3:8: source.tcp: '[::1]5' " + wrong + " (':' must follow ']')\n");
  EXPECT_EQ(host_port(":502"), "3:8: source.tcp: ':502' " + wrong + " (as in 192.168.1.7:502)\n");
  for (const char* const port : {"0", "65536", "x", "", "99999999999"}) {
    EXPECT_EQ(host_port("h:" + std::string(port)),
              fmt::format("3:8: source.tcp: 'h:{}' {} (the port is a whole number, 1 to 65535)\n",
                          port, wrong));
  }
}

TEST(ConfigModbus, WhatIsMissingOrTooMuch) {
  EXPECT_EQ(said_of("source:\n  type: modbus\n"),
            "1:1: source: tcp is missing; must be HOST:PORT, or rtu: with a device instead\n"
            "1:1: source: map is missing; must be a group with at least one axis (as in X: "
            "{register: 0})\n");
  EXPECT_EQ(said_of(kTcp + "  rtu: {device: a}\n  map: {X: {register: 0}}\n"),
            "4:3: source.rtu: has no place beside tcp; must be one of both\n");
  EXPECT_EQ(said_of("source:\n  type: modbus\n  rtu: {baud: 9600}\n  map: {X: {register: 0}}\n"),
            "3:3: source.rtu: device is missing; must be the path of a serial line (as in "
            "/dev/ttyUSB0)\n");
  EXPECT_EQ(said_of(kTcp + "  map: {tool: {register: 0}}\n"),
            "4:3: source.map: no axis is given; at least one of X to W is needed\n");
  EXPECT_EQ(said_of(kTcp + "  map: {X: {scale: 2}}\n"),
            "4:9: source.map.X: register is missing; must be a whole number, 0 to 65535\n");
}

TEST(ConfigModbus, WhatDoesNotGoTogether) {
  EXPECT_EQ(said_of("source:\n"
                    "  type: modbus\n"
                    "  rtu: {device: a, baud: 12345}\n"
                    "  unit: 0\n"
                    "  map:\n"
                    "    X: {register: 65535, type: int32}\n"
                    "    Y: {register: 0, scale: 0}\n"
                    "    Z: {register: 2, min: 5, max: 5}\n"
                    "    counter: {register: 4}\n"),
            "3:26: source.rtu.baud: 12345 is not allowed; must be one of 110, 300, 600, 1200, "
            "2400, 4800, 9600, 19200, 38400, 57600, 115200, 230400, 460800, 500000, 576000, "
            "921600, 1000000\n"
            "4:9: source.unit: 0 is not allowed; must be 1 to 247 for rtu\n"
            "6:19: source.map.X.register: 65535 is not allowed; must be 0 to 65534 for int32\n"
            "7:29: source.map.Y.scale: 0 is not allowed; must be a number other than 0\n"
            "8:27: source.map.Z.min: 5 is not allowed; must be below max, which is 5\n"
            "9:5: source.map.counter: type: float32 is not allowed; must be int16, uint16, int32 "
            "or uint32\n");
}

TEST(ConfigModbus, ItemsOfTheMap) {
  EXPECT_EQ(said_of(kTcp + "  map:\n    X: {register: 0}\n    Q: {register: 0}\n"),
            "6:5: source.map.Q: unknown key (here may be: A, B, C, J0, J1, J2, J3, J4, J5, J6, J7, "
            "J8, U, V, W, X, Y, Z, counter, counter_begun, line, load, spindle, tool, "
            "tool_offset_z, trigger)\n");
  EXPECT_EQ(said_of(kTcp + "  map:\n    x: {register: 0}\n"),
            "5:5: source.map.x: unknown key (did you mean X?)\n");
  EXPECT_EQ(said_of(kTcp + "  map:\n    X: {regster: 0}\n"),
            "5:9: source.map.X.regster: unknown key (did you mean register?)\n"
            "5:5: source.map.X: register is missing; must be a whole number, 0 to 65535\n");
  EXPECT_EQ(said_of(kTcp + "  map:\n    X: {register: 0}\n    tool: {register: 3, min: 0}\n"),
            "6:25: source.map.tool.min: only axes have this key\n");
  EXPECT_EQ(said_of(kTcp + "  map:\n    X: {register: 0, id: 3}\n"),
            "5:22: source.map.X.id: is a key of sources of type can and log; this one is modbus\n");
}

TEST(ConfigModbus, Joints) {
  const ReadText read(kTcp +
                      "  coordinates: joints\n  map: {J0: {register: 0}, J2: {register: 2}}\n");
  const auto& s = settings_of<ModbusSettings>(read);
  EXPECT_TRUE(s.axes[0]);
  EXPECT_TRUE(s.axes[2]);
  EXPECT_EQ(
      said_of(kTcp + "  coordinates: joints\n  map: {J0: {register: 0}, X: {register: 2}}\n"),
      "5:28: source.map.X: an axis, but source.coordinates is joints (joints are J0 to J8)\n");
  EXPECT_EQ(said_of(kTcp + "  map: {J0: {register: 0}, X: {register: 2}}\n"),
            "4:9: source.map.J0: a joint, but source.coordinates is axes (joints need "
            "`coordinates: joints`)\n");
  // A fault that the source finds is told in the user's own words.
  EXPECT_EQ(said_of(kTcp + "  coordinates: joints\n  map: {J1: {register: 0, scale: 0}}\n"),
            "5:34: source.map.J1.scale: 0 is not allowed; must be a number other than 0\n");
}

TEST(ConfigModbus, InchesBecomeMmWhereTheyAreLengths) {
  const ReadText read(
      kTcp +
      "  units: inch\n  map:\n"
      "    X: {register: 0, scale: 0.5, offset: 2, min: -1, max: 10, max_speed: 3}\n"
      "    A: {register: 2, scale: 0.5, offset: 2, min: -1}\n"
      "    U: {register: 4}\n"
      "    spindle: {register: 6}\n"
      "    tool_offset_z: {register: 8}\n");
  const auto& s = settings_of<ModbusSettings>(read);
  EXPECT_EQ(s.axes[0]->scale, 0.5 * 25.4);
  EXPECT_EQ(s.axes[0]->offset, 2 * 25.4);
  EXPECT_EQ(s.ranges[0].min, -25.4);
  EXPECT_EQ(s.ranges[0].max, 254);
  EXPECT_EQ(s.ranges[0].max_speed_per_s, 3 * 25.4);
  EXPECT_EQ(s.axes[3]->scale, 0.5);
  EXPECT_EQ(s.axes[3]->offset, 2);
  EXPECT_EQ(s.ranges[3].min, -1);
  EXPECT_EQ(s.ranges[3].max_speed_per_s, ModbusAxisRange{}.max_speed_per_s);
  EXPECT_EQ(s.axes[6]->scale, 25.4);
  EXPECT_EQ(s.spindle->scale, 1);
  EXPECT_EQ(s.tool_offset_z->scale, 25.4);

  const ReadText joints("machine: {joints: XAZ}\n" + kTcp +
                        "  units: inch\n  coordinates: joints\n  map: {J0: {register: 0}, J1: "
                        "{register: 2}, J2: {register: 4}}\n");
  const auto& j = settings_of<ModbusSettings>(joints);
  EXPECT_EQ(j.axes[0]->scale, 25.4);
  EXPECT_EQ(j.axes[1]->scale, 1);
  EXPECT_EQ(j.axes[2]->scale, 25.4);
}

// ---- can

const std::string kCan = "source:\n  type: can\n  interface: can0\n";

TEST(ConfigCan, ValuesArrive) {
  const ReadText read(kCan +
                      "  receive_buffer_bytes: 65536\n  gather_ms: 5\n"
                      "  map:\n"
                      "    X: {id: 0x18FF1234, extended: yes, byte: 2, type: int16, endian: big, "
                      "scale: 0.01, offset: 3, max_age_ms: 0}\n"
                      "    Y: {id: 385, bit: 12, length: 20, type: uint, mux: {byte: 0, length: 4, "
                      "endian: big, value: 3}}\n"
                      "    Z: {id: 0x182, type: float64}\n"
                      "    tool: {id: 0x183, type: uint8}\n");
  const auto& options = settings_of<CanSourceOptions>(read);
  EXPECT_EQ(options.interface, "can0");
  EXPECT_EQ(options.receive_buffer_bytes, 65536);
  EXPECT_EQ(options.map.gather_ms, 5);
  const CanSignal& x = *options.map.axes[0];
  EXPECT_EQ(x.id, 0x18FF1234U);
  EXPECT_TRUE(x.extended);
  EXPECT_EQ(x.bits.start_bit, 23);
  EXPECT_EQ(x.bits.length, 16);
  EXPECT_EQ(x.bits.endian, CanEndian::kBig);
  EXPECT_EQ(x.type, CanType::kSigned);
  EXPECT_EQ(x.scale, 0.01);
  EXPECT_EQ(x.offset, 3);
  EXPECT_EQ(x.max_age_ms, 0);
  const CanSignal& y = *options.map.axes[1];
  EXPECT_EQ(y.bits.start_bit, 12);
  EXPECT_EQ(y.bits.length, 20);
  EXPECT_EQ(y.type, CanType::kUnsigned);
  ASSERT_TRUE(y.mux);
  EXPECT_EQ(y.mux->bits.start_bit, 7);
  EXPECT_EQ(y.mux->bits.length, 4);
  EXPECT_EQ(y.mux->value, 3U);
  EXPECT_EQ(options.map.axes[2]->type, CanType::kFloat64);
  EXPECT_EQ(options.map.axes[2]->bits.length, 64);
  EXPECT_EQ(options.map.tool->bits.length, 8);
}

TEST(ConfigCan, RangesAndTheSync) {
  const ReadText read(kCan +
                      "  units: inch\n  sync_id: 0x81\n  stale_after_ms: 250\n  map:\n"
                      "    X: {preset: cia402, node: 1, scale: 1, min: -1, max: 2, max_speed: 10}\n"
                      "    A: {preset: cia402, node: 2, scale: 1, max: 90, max_age_ms: 0}\n"
                      "    tool: {id: 5, type: uint8}\n");
  const auto& map = settings_of<CanSourceOptions>(read).map;
  EXPECT_EQ(map.sync_id, 0x81);
  EXPECT_EQ(map.ranges[0].min, -25.4);
  EXPECT_EQ(map.ranges[0].max, 50.8);
  EXPECT_EQ(map.ranges[0].max_speed_per_s, 254);
  EXPECT_EQ(map.ranges[3].max, 90);
  EXPECT_FALSE(map.ranges[3].min);
  // Each item by itself, where its key says nothing.
  EXPECT_EQ(map.axes[0]->max_age_ms, 250);
  EXPECT_EQ(map.axes[3]->max_age_ms, 0);
  EXPECT_EQ(map.tool->max_age_ms, 250);

  const ReadText plain(kCan + "  map:\n    X: {preset: cia402, node: 1, scale: 1}\n");
  EXPECT_EQ(settings_of<CanSourceOptions>(plain).map.sync_id, 0x80);
  EXPECT_EQ(settings_of<CanSourceOptions>(plain).map.axes[0]->max_age_ms, 500);
  EXPECT_EQ(said_of(kCan + "  map:\n    X: {preset: cia402, node: 1, scale: 1, min: 5, max: 5}\n"),
            "5:57: source.map.X.max: 5 is not allowed; must be above min 5\n");
}

TEST(ConfigCan, Presets) {
  const ReadText read(kCan +
                      "  units: inch\n  map:\n"
                      "    X: {preset: cia402, node: 2, scale: 0.5, offset: 1}\n"
                      "    A: {preset: odrive, node: 3, scale: 360, max_age_ms: 50}\n");
  const auto& map = settings_of<CanSourceOptions>(read).map;
  EXPECT_EQ(map.axes[0]->id, 0x382U);
  EXPECT_EQ(map.axes[0]->bits.start_bit, 16);
  EXPECT_EQ(map.axes[0]->scale, 0.5 * 25.4);
  EXPECT_EQ(map.axes[0]->offset, 25.4);
  EXPECT_EQ(map.axes[3]->id, 3U << 5U | 9U);
  EXPECT_EQ(map.axes[3]->type, CanType::kFloat32);
  EXPECT_EQ(map.axes[3]->scale, 360);
  EXPECT_EQ(map.axes[3]->max_age_ms, 50);

  EXPECT_EQ(said_of(kCan + "  map:\n    X: {preset: cia402}\n"),
            "5:5: source.map.X: node is missing; must be the drive's node id, 1 to 127\n"
            "5:5: source.map.X: scale is missing; must be mm or degrees per count\n");
  EXPECT_EQ(said_of(kCan + "  map:\n    X: {preset: cia402, node: 0, scale: 1}\n"
                           "    Y: {preset: odrive, node: 64, scale: 1}\n"),
            "5:31: source.map.X.node: 0 is not allowed; must be 1 to 127 for cia402\n"
            "6:31: source.map.Y.node: 64 is not allowed; must be 0 to 63 for odrive\n");
  EXPECT_EQ(said_of(kCan + "  map:\n    X: {preset: cia402, node: 1, scale: 1, id: 3, type: "
                           "int8}\n"),
            "5:44: source.map.X.id: has no place beside preset\n"
            "5:51: source.map.X.type: has no place beside preset\n");
  EXPECT_EQ(said_of(kCan + "  map:\n    X: {id: 1}\n    tool: {preset: odrive, node: 1, scale: "
                           "1}\n"),
            "6:12: source.map.tool.preset: only axes have this key\n"
            "6:28: source.map.tool.node: only axes have this key\n");
}

TEST(ConfigCan, Faults) {
  EXPECT_EQ(said_of("source:\n  type: can\n"),
            "1:1: source: interface is missing; must be the name of a CAN interface (as in can0)\n"
            "1:1: source: map is missing; must be a group with at least one axis (as in X: {id: "
            "0x181, type: int32})\n");
  EXPECT_EQ(said_of("source:\n  type: can\n  interface: a/b\n  map: {X: {id: 1}}\n"),
            "3:14: source.interface: 'a/b' is not allowed; must be the name of a network "
            "interface, 1 to 15 bytes\n");
  EXPECT_EQ(
      said_of(kCan + "  map:\n    X: {id: 0x1000}\n    Y: {id: 0x181, extended: maybe}\n"
                     "    Z: {id: 1, byte: 1, bit: 3}\n    A: {id: 2, type: uint}\n"
                     "    B: {id: 3, type: int16, length: 12}\n"
                     "    C: {id: 4, node: 3}\n    U: {id: 5, mux: {byte: 1}}\n"
                     "    V: {id: 6, max_age_ms: 0.5}\n    W: {id: 7, byte: 63}\n"),
      "5:13: source.map.X.id: 0x1000 is not allowed; must be 0 to 0x7FF, or say that it is "
      "extended\n"
      "6:30: source.map.Y.extended: 'maybe' is not allowed; must be yes or no\n"
      "7:25: source.map.Z.bit: has no place beside byte\n"
      "8:5: source.map.A: length is missing; must be 1 to 64 (bits), as uint has no length "
      "of its own\n"
      "9:37: source.map.B.length: 12 is not allowed; int16 has 16 bits\n"
      "10:16: source.map.C.node: is for a preset, and there is none\n"
      "11:16: source.map.U.mux: value is missing; must be the number that the bits must "
      "hold\n"
      "12:28: source.map.V.max_age_ms: 0.5 is not allowed; must be 1 to 3600000, or 0 for "
      "never too old\n"
      "13:5: source.map.W: 32 bits from bit 504 on end in byte 66; a frame has at most bytes 0 to "
      "63\n");
  EXPECT_EQ(said_of(kCan + "  map:\n    X: {id: 1}\n    counter: {id: 2}\n"),
            "6:5: source.map.counter: only a modbus source has a counter (a CAN drive that is "
            "silent is found by max_age_ms)\n");
  EXPECT_EQ(said_of(kCan + "  map:\n    X: {id: 1}\n    Y: {id: 1}\n"),
            "6:5: source.map.Y: reads the same bits of frame 0x001 as map.X\n");
}

TEST(ConfigCan, JointsHaveTheirOwnNames) {
  const ReadText read(kCan + "  coordinates: joints\n  map: {J1: {id: 1}}\n");
  const auto& map = settings_of<CanSourceOptions>(read).map;
  EXPECT_TRUE(map.axes[1]);
  EXPECT_EQ(map.axis_keys[1], "J1");
}

// ---- hal

TEST(ConfigHal, ValuesArrive) {
  const ReadText read(
      "source:\n  type: hal\n  rate_hz: 250\n  kerf_hal_path: bin/kerf-hal\n  units: inch\n");
  const auto& s = settings_of<HalSettings>(read);
  EXPECT_EQ(s.rate_hz, 250);
  EXPECT_EQ(s.kerf_hal_path, "dir/bin/kerf-hal");
  EXPECT_EQ(s.mm_per_unit, 25.4);
  EXPECT_EQ(settings_of<HalSettings>(ReadText("source: {type: hal, kerf_hal_path: kerf-hal}\n"))
                .kerf_hal_path,
            "kerf-hal");
}

TEST(ConfigHal, Faults) {
  EXPECT_EQ(
      said_of("source:\n  type: hal\n  coordinates: axes\n  frame: workpiece\n"),
      "3:16: source.coordinates: axes is not allowed; must be joints: that is what HAL has\n"
      "4:10: source.frame: workpiece is not allowed; must be machine: that is what HAL has\n");
}

// ---- the spindle's load

TEST(ConfigLoad, ComesFromARegisterAFrameOrAPin) {
  const auto modbus = settings_of<ModbusSettings>(
      ReadText(kTcp + "  map:\n    X: {register: 0}\n    load: {register: 20, type: uint16, scale: "
                      "0.1, unit: percent-torque}\n"));
  ASSERT_TRUE(modbus.load);
  EXPECT_EQ(modbus.load->address, 20);
  EXPECT_EQ(modbus.load->scale, 0.1);
  EXPECT_EQ(modbus.load_unit, LoadUnit::kPercentOfTorque);
  // A length it is not, whatever the lengths are in.
  const auto can = settings_of<CanSourceOptions>(
      ReadText("source: {type: can, interface: can0, units: inch, map: {X: {id: 1}, load: {id: 2, "
               "scale: 0.5, unit: kW}}}\n"));
  ASSERT_TRUE(can.map.load);
  EXPECT_EQ(can.map.load->scale, 0.5);
  EXPECT_EQ(can.map.load_unit, LoadUnit::kKilowatts);
  const auto hal = settings_of<HalSettings>(
      ReadText("source: {type: hal, map: {load: {pin: vfd.amps, unit: A, scale: 2}}}\n"));
  ASSERT_TRUE(hal.load);
  EXPECT_EQ(hal.load->pin, "vfd.amps");
  EXPECT_EQ(hal.load->unit, LoadUnit::kAmperes);
  EXPECT_EQ(hal.load->scale, 2);
  const auto log = settings_of<LogSettings>(ReadText(
      "source: {type: log, file: a, map: {load: {pin: Spindle Load, unit: Nm, offset: -1}}}\n"));
  ASSERT_TRUE(log.load);
  EXPECT_FALSE(log.can_map);
  EXPECT_EQ(log.load->column, "Spindle Load");
  EXPECT_EQ(log.load->unit, LoadUnit::kNewtonMetres);
  EXPECT_EQ(log.load->offset, -1);
}

TEST(ConfigLoad, IsPrintedAsItIsRead) {
  for (const std::string& text :
       {kTcp + "  map:\n    X: {register: 0}\n    load: {register: 20, unit: kW}\n",
        std::string("source: {type: hal, map: {load: {pin: vfd.amps, unit: A, scale: 2}}}\n")}) {
    const ReadText read(text);
    ASSERT_TRUE(read.config) << read.said();
    const std::string printed = effective_yaml(*read.config);
    const ReadText again(printed);
    ASSERT_TRUE(again.config) << again.said() << printed;
    EXPECT_EQ(effective_yaml(*again.config), printed);
    EXPECT_NE(printed.find("load: {"), std::string::npos) << printed;
  }
}

TEST(ConfigLoad, Faults) {
  EXPECT_EQ(
      said_of(kTcp + "  map:\n    X: {register: 0}\n    load: {register: 20}\n"),
      "6:5: source.map.load: unit is missing; must be one of percent, percent-torque, kW, Nm, "
      "A (percent: of the rated power, as most drives tell it)\n");
  EXPECT_EQ(said_of(kTcp + "  map:\n    X: {register: 0, unit: kW}\n"),
            "5:22: source.map.X.unit: only load has this key\n");
  EXPECT_EQ(said_of("source: {type: hal, map: {load: {unit: kw}}}\n"),
            "1:40: source.map.load.unit: 'kw' is not allowed; must be one of percent, "
            "percent-torque, kW, Nm, A (did you mean kW?)\n"
            "1:27: source.map.load: pin is missing; must be the name of a HAL pin (as in "
            "vfd.load-percentage)\n");
}

// ---- log

TEST(ConfigLog, ValuesArrive) {
  const ReadText read(
      "source:\n  type: log\n  file: run.log\n  period_s: 0.002\n  units: inch\n"
      "  pins: [joint.0.pos-fb, '', 12]\n");
  const auto& s = settings_of<LogSettings>(read);
  EXPECT_EQ(s.path, "dir/run.log");
  EXPECT_EQ(s.format, LogFormat::kHalsampler);
  EXPECT_EQ(s.period_s, 0.002);
  EXPECT_EQ(s.unit, LogUnit::kInch);
  EXPECT_EQ(s.pins, (std::vector<std::string>{"joint.0.pos-fb", "", "12"}));
  EXPECT_EQ(settings_of<LogSettings>(ReadText("source: {type: log, file: '-'}\n")).path, "-");
}

TEST(ConfigLog, MapMeansCandump) {
  const ReadText read(
      "source:\n  type: log\n  file: a\n  interface: can1\n  units: inch\n  gather_ms: 7\n"
      "  map: {X: {id: 1, scale: 2}}\n");
  const auto& s = settings_of<LogSettings>(read);
  EXPECT_EQ(s.format, LogFormat::kCandump);
  EXPECT_EQ(s.can_interface, "can1");
  ASSERT_TRUE(s.can_map);
  EXPECT_EQ(s.can_map->axes[0]->scale, 2 * 25.4);
  EXPECT_EQ(s.can_map->gather_ms, 7);
  EXPECT_EQ(s.unit, LogUnit::kMm);
}

TEST(ConfigLog, Faults) {
  EXPECT_EQ(said_of("source:\n  type: log\n"),
            "1:1: source: file is missing; must be the path of a log, or '-' for standard input\n");
  const std::string log = "source:\n  type: log\n  file: a\n";
  EXPECT_EQ(said_of(log + "  pins: [a]\n  pins_file: b\n"),
            "5:3: source.pins_file: has no place beside pins; must be one of both\n");
  EXPECT_EQ(said_of(log + "  pins: []\n"),
            "4:9: source.pins: an empty list is not allowed; must be the pins of a sampler\n");
  EXPECT_EQ(said_of(log + "  pins: a\n"),
            "4:9: source.pins: 'a' is not allowed; must be a list of texts\n");
  EXPECT_EQ(said_of(log + "  pins: [a, [b], ]\n"),
            "4:13: source.pins[2]: a list is not allowed; must be a text\n");
  EXPECT_EQ(said_of(log + "  channel: 1\n  period_s: 1\n"),
            "4:3: source.channel: is for pins_file, and there is none\n"
            "5:3: source.period_s: is for halsampler, which needs pins or pins_file\n");
  EXPECT_EQ(said_of(log + "  gather_ms: 3\n  interface: can0\n  dbc: a.dbc\n"),
            "4:3: source.gather_ms: is for candump, which needs a map\n"
            "5:3: source.interface: is for candump, which needs a map\n"
            "6:3: source.dbc: is for candump, which needs a map\n");
  EXPECT_EQ(said_of(log + "  format: halsampler\n"),
            "1:1: source: pins: none; halsampler needs the HAL pins in the order of the columns\n");
  EXPECT_EQ(said_of(log + "  format: candump\n"),
            "1:1: source: map: none; candump needs the id, byte and type of each position\n");
  EXPECT_EQ(said_of(log + "  format: csv\n  pins: [a]\n"),
            "5:3: source.pins: only for halsampler; other formats name their columns\n");
  EXPECT_EQ(said_of(log + "  format: csv\n  map: {X: {id: 1}}\n"),
            "5:3: source.map: only for candump; other formats name their columns\n");
}

}  // namespace
}  // namespace kerf
