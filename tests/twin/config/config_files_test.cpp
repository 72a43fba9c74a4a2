// Files beside the configuration, the examples in configs/, and printing.
#include <gtest/gtest.h>

#include "tests/twin/config/config_support.h"

namespace kerf {
namespace {

constexpr const char* kDbc =
    "BO_ 385 DriveX: 8 Drive\n"
    " SG_ Status : 0|16@1+ (1,0) [0|0] \"\" Host\n"
    " SG_ Position : 16|32@1- (0.001,5) [0|0] \"mm\" Host\n"
    "BO_ 386 DriveY: 8 Drive\n"
    " SG_ Position : 16|32@1- (0.002,0) [0|0] \"mm\" Host\n";

/// What is said of a file in the folder, with the folder's name left away.
std::string said_in(const ConfigFolder& folder, std::string_view text) {
  Diagnostics diagnostics;
  const bool read = read_config(folder.write("m.yaml", text), {}, diagnostics).has_value();
  std::string out = read ? "read\n" : "";
  for (const Diagnostic& one : diagnostics) {
    out += one.file.substr(std::min(folder.path().size() + 1, one.file.size()));
    out +=
        fmt::format(":{}:{}: {}: {}\n", one.line, one.column, to_string(one.severity), one.message);
  }
  for (std::size_t at = out.find(folder.path() + "/"); at != out.npos;
       at = out.find(folder.path() + "/")) {
    out.erase(at, folder.path().size() + 1);
  }
  return out;
}

TEST(ConfigMeshes, OutsideOfTheFolderIsNotedOnce) {
  const ConfigFolder folder;
  const std::string fixtures =
      "fixtures:\n"
      "  - {shape: \"stl:inside/a.stl\"}\n"
      "  - {shape: \"stl:inside/../b.stl:inch\"}\n"
      "  - {shape: \"stl:../c.stl\"}\n"
      "  - {shape: \"obj:/elsewhere/d.obj\"}\n";
  const std::string said = said_in(folder, fixtures);
  EXPECT_EQ(
      said,
      "read\n"
      "m.yaml:4:13: note: fixtures[3].shape: '../c.stl' lies outside of this file's folder: who "
      "copies that has no such mesh\n");
  EXPECT_EQ(said_in(folder, "fixtures:\n  - {shape: \"box:0,0,0:1,1,1\"}\n"), "read\n");
  EXPECT_EQ(said_in(folder, "fixtures:\n  - {shape: \"stl:" + folder.path() + "/a.stl\"}\n"),
            "read\n");
  const std::string links =
      "machine:\n"
      "  kinematics: links\n"
      "  workpiece_on: table\n"
      "  tool_on: head\n"
      "  links:\n"
      "    - {name: table, axis: X, direction: \"-1,0,0\"}\n"
      "    - {name: saddle, axis: Y}\n"
      "    - {name: head, parent: saddle, axis: Z, stl: ../head.stl}\n";
  EXPECT_EQ(said_in(folder, links).find("read\nm.yaml:8:"), 0U) << said_in(folder, links);
}

TEST(ConfigDbc, SignalsByName) {
  const ConfigFolder folder;
  folder.write("bus.dbc", kDbc);
  Diagnostics diagnostics;
  const auto config =
      read_config(folder.write("m.yaml",
                               "source:\n  type: can\n  interface: can0\n  dbc: bus.dbc\n  map:\n"
                               "    X: {signal: DriveX.Position, scale: -1, offset: 2}\n"
                               "    Y: {signal: DriveY.Position, max_age_ms: 20}\n"
                               "    tool: {signal: Status}\n"),
                  {}, diagnostics);
  ASSERT_TRUE(config) << (diagnostics.empty() ? "" : diagnostics[0].message);
  const CanMap& map = std::get<CanSourceOptions>(config->source).map;
  EXPECT_EQ(map.axes[0]->id, 385U);
  EXPECT_EQ(map.axes[0]->bits.start_bit, 16);
  EXPECT_EQ(map.axes[0]->scale, -0.001);
  EXPECT_EQ(map.axes[0]->offset, -3);
  EXPECT_EQ(map.axes[1]->scale, 0.002);
  EXPECT_EQ(map.axes[1]->max_age_ms, 20);
  EXPECT_EQ(map.tool->bits.length, 16);
}

TEST(ConfigDbc, Faults) {
  const ConfigFolder folder;
  folder.write("bus.dbc", kDbc);
  const std::string can = "source:\n  type: can\n  interface: can0\n";
  EXPECT_NE(said_in(folder, can + "  dbc: bus.dbc\n  map: {X: {signal: Speed}}\n")
                .find("m.yaml:5:21: error: source.map.X.signal: "),
            std::string::npos);
  EXPECT_NE(said_in(folder, can + "  dbc: bus.dbc\n  map: {X: {signal: Position}}\n")
                .find("m.yaml:5:21: error: source.map.X.signal: "),
            std::string::npos);
  EXPECT_EQ(said_in(folder, can + "  map: {X: {signal: Position}}\n"),
            "m.yaml:4:21: error: source.map.X.signal: needs a DBC file, and source.dbc names "
            "none\n");
  EXPECT_EQ(said_in(folder, can + "  dbc: bus.dbc\n  map: {X: {id: 1}}\n"),
            "m.yaml:4:3: error: source.dbc: no key of the map has a signal of it\n");
  EXPECT_EQ(said_in(folder, can + "  dbc: bus.dbc\n  map: {X: {signal: DriveX.Position, id: 1, "
                                  "node: 2}}\n"),
            "m.yaml:5:38: error: source.map.X.id: has no place beside signal\n"
            "m.yaml:5:45: error: source.map.X.node: has no place beside signal\n");
  const std::string none =
      said_in(folder, can + "  dbc: none.dbc\n  map: {X: {signal: a}, Y: {signal: b}}\n");
  EXPECT_EQ(none.find("none.dbc:0:0: error: "), 0U) << none;
  EXPECT_EQ(std::count(none.begin(), none.end(), '\n'), 1) << none;
}

TEST(ConfigDbc, UnitsThatAreNotWhatTheyAreTakenFor) {
  const ConfigFolder folder;
  folder.write("bus.dbc",
               "BO_ 1 P: 8 D\n SG_ Mm : 0|16@1- (1,0) [0|0] \"mm\" H\n"
               " SG_ Metre : 16|16@1- (1,0) [0|0] \"m\" H\n"
               " SG_ Radian : 32|16@1- (1,0) [0|0] \"rad\" H\n"
               " SG_ Odd : 48|16@1- (1,0) [0|0] \"furlong\" H\n");
  const std::string can = "source:\n  type: can\n  interface: can0\n  dbc: bus.dbc\n";
  EXPECT_EQ(said_in(folder, can + "  map: {X: {signal: Metre}, A: {signal: Radian}, Y: {signal: "
                                  "Mm}, Z: {signal: Odd}}\n"),
            "m.yaml:5:21: error: source.map.X.signal: Metre is in m, which is taken for mm\n"
            "m.yaml:5:41: error: source.map.A.signal: Radian is in rad, which is taken for "
            "degrees\n");
  EXPECT_EQ(said_in(folder, can + "  units: inch\n  map: {X: {signal: Mm}}\n"),
            "m.yaml:6:21: error: source.map.X.signal: Mm is in mm, which is taken for inch\n");
  EXPECT_EQ(said_in(folder, can + "  map: {X: {signal: Metre, scale: 1000}, tool: {signal: "
                                  "Radian}}\n"),
            "read\n");
}

TEST(ConfigDbc, FaultsElsewhereInTheFileAreWarnings) {
  const ConfigFolder folder;
  folder.write("bus.dbc", std::string(kDbc) + " SG_ Broken : 16|\n");
  const std::string said = said_in(folder,
                                   "source:\n  type: can\n  interface: can0\n  dbc: bus.dbc\n"
                                   "  map: {X: {signal: DriveX.Position}}\n");
  EXPECT_EQ(said.find("read\nbus.dbc:6:"), 0U) << said;
  EXPECT_NE(said.find("warning"), std::string::npos) << said;
}

TEST(ConfigPins, FromTheFileThatSetTheSamplerUp) {
  const ConfigFolder folder;
  folder.write("s.hal",
               "loadrt sampler depth=1000 cfg=ff\n"
               "net jx joint.0.pos-fb => sampler.0.pin.0\n"
               "net jy joint.1.pos-fb => sampler.0.pin.1\n");
  const std::string log = "source:\n  type: log\n  file: a.log\n  pins_file: s.hal\n";
  Diagnostics diagnostics;
  const auto config = read_config(folder.write("m.yaml", log), {}, diagnostics);
  ASSERT_TRUE(config) << (diagnostics.empty() ? "" : diagnostics[0].message);
  const auto& settings = std::get<LogSettings>(config->source);
  EXPECT_EQ(settings.pins, (std::vector<std::string>{"joint.0.pos-fb", "joint.1.pos-fb"}));
  EXPECT_EQ(settings.path, folder.path("a.log"));

  const std::string other = said_in(folder, log + "  channel: 1\n");
  EXPECT_EQ(other.find("s.hal:"), 0U) << other;
  EXPECT_EQ(std::count(other.begin(), other.end(), '\n'), 1) << other;
  EXPECT_EQ(said_in(folder, "source:\n  type: log\n  file: a\n  pins_file: none.hal\n"),
            "none.hal:0:0: error: the file cannot be read\n");
}

TEST(ConfigExamples, AreReadWithoutAWord) {
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(KERF_CONFIGS_FOLDER)) {
    if (entry.path().extension() != ".yaml") continue;
    if (entry.path().parent_path().filename() == "punch") continue;  // turrets: turret_test.cpp
    if (entry.path().filename() == "materials.yaml") continue;       // material_reader_test.cpp
    Diagnostics diagnostics;
    const auto config = read_config(entry.path().string(), {}, diagnostics);
    for (const Diagnostic& one : diagnostics) ADD_FAILURE() << to_string(one);
    ASSERT_TRUE(config) << entry.path();
    // An example shows a source, or the machine that is drawn.
    const MachineChoice& drawn = config->machine.drawn;
    EXPECT_TRUE(!std::holds_alternative<std::monostate>(config->source) || drawn.kind ||
                drawn.links)
        << entry.path();
    ++files;
  }
  EXPECT_GE(files, 6);
}

/// Reads, prints, reads again, prints again.
void expect_round_trip(std::string_view text) {
  const ReadText first(text);
  ASSERT_TRUE(first.config) << first.said();
  const std::string printed = effective_yaml(*first.config);
  Diagnostics diagnostics;
  const auto second = parse_config(printed, "", {}, diagnostics);
  for (const Diagnostic& one : diagnostics) ADD_FAILURE() << to_string(one) << printed;
  ASSERT_TRUE(second);
  EXPECT_EQ(effective_yaml(*second), printed);
}

TEST(ConfigPrint, ReadsTheSameAgain) {
  expect_round_trip("");
  expect_round_trip(
      "machine:\n  ini: 'odd \"name\\: # x'\n  tool_table: \"tab\\there \\u00e4\"\n  joints: XYYZ\n"
      "  work_offset: {x: 0.1, y: 1e-7, rotation: -12.345678901234567}\n  tool_length: none\n"
      "  tool: 4\n  max_speed_mm_per_min: 123.4\n  max_acceleration_mm_per_s2: 777\n"
      "tools: {1: 'flat:6', 7: 'bull:10:2:flute=22:shank=10:holder=32x20+40x25'}\n"
      "stock: {blank: 'box:0,0,0:1,1,1+box:2,2,0:3,3,1', cell_mm: 0.05, margin_mm: 2.5}\n"
      "follow: {program: null.ngc, path: programmed, off_path_mm: 0.3, look_ahead_s: 2.25}\n");
  expect_round_trip("machine: {ini: 'null', tool_table: '~'}\n");
  expect_round_trip(
      "machine: {chuck: '160:80:120:25:bore=30:at=-40', tailstock: '40:75', "
      "spindle_max_rpm: 4000}\n");
  expect_round_trip(
      "source:\n  type: modbus\n  tcp: '[::1]:7'\n  units: inch\n  stale_after_ms: 33.3\n"
      "  lost_after_ms: 77.7\n  gap: cut\n  frame: workpiece\n  map:\n"
      "    X: {register: 3, table: input, type: float64, word_order: badc, scale: 0.1, offset: 7, "
      "min: -3, max: 3}\n    counter: {register: 9, type: int16}\n    line: {register: 11}\n");
  expect_round_trip(
      "source:\n  type: modbus\n  rtu: {device: /dev/x y, parity: odd}\n  coordinates: joints\n"
      "  map: {J8: {register: 0}}\n");
  expect_round_trip(
      "source:\n  type: can\n  interface: vcan0\n  units: inch\n  sync_id: -1\n  map:\n"
      "    X: {preset: cia402, node: 1, scale: 0.001, min: -3, max: 4.5, max_speed: 7}\n    Y: "
      "{id: 5, type: uint, length: 12, bit: "
      "3, mux: {bit: 7, length: 8, endian: big, value: 200}, endian: big}\n"
      "    Z: {id: 0x1FFFFFFF, extended: yes, type: float32, endian: big, byte: 4}\n"
      "    spindle: {id: 6, type: int16, byte: 2, max_age_ms: 0}\n");
  expect_round_trip("source: {type: hal, units: inch, rate_hz: 33, kerf_hal_path: /x/kerf-hal}\n");
  expect_round_trip(
      "source: {type: log, file: '-', units: inch, pins: ['', 'signal a', joint.0.pos-fb]}\n");
  expect_round_trip(
      "source: {type: log, file: x.log, units: inch, interface: can0, map: {A: {id: 1, byte: "
      "4}}}\n");
  expect_round_trip("source: {type: log, file: x.csv, format: csv, coordinates: axes}\n");
}

TEST(ConfigPrint, ExamplesReadTheSameAgain) {
  for (const auto& entry : std::filesystem::directory_iterator(KERF_CONFIGS_FOLDER)) {
    if (entry.path().extension() != ".yaml") continue;
    if (entry.path().filename() == "materials.yaml") continue;
    std::ifstream in(entry.path());
    expect_round_trip(std::string{std::istreambuf_iterator<char>(in), {}});
  }
}

}  // namespace
}  // namespace kerf
