// The groups machine, tools, stock and follow, and what all keys have in common.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/twin/config/config_support.h"
#include "twin/config/key_table.h"

namespace kerf {
namespace {

TEST(ConfigKeys, EmptyIsAllDefaults) {
  const ReadText read("");
  ASSERT_TRUE(read.config);
  EXPECT_EQ(effective_yaml(*read.config), effective_yaml(LiveConfig{}));
  EXPECT_TRUE(std::holds_alternative<std::monostate>(read.config->source));
}

TEST(ConfigKeys, WhatHoldsAWorkpieceThatTurns) {
  const ReadText read(
      "machine: {chuck: '160:80:120:25', tailstock: '40:75:at=-3', spindle_max_rpm: 4000}\n");
  ASSERT_TRUE(read.config) << read.said();
  const ConfigMachine& machine = read.config->machine;
  ASSERT_TRUE(machine.holding.chuck && machine.holding.chuck->jaws);
  EXPECT_EQ(machine.holding.chuck->jaws->diameter_mm, 120);
  ASSERT_TRUE(machine.holding.tailstock);
  EXPECT_EQ(machine.holding.tailstock->angle_deg, 75);
  EXPECT_EQ(machine.holding.tailstock->point_mm, -3);
  EXPECT_EQ(machine.spindle_max_rpm, 4000);
  const ReadText faulty("machine: {chuck: '160', tailstock: '40:5', spindle_max_rpm: 0}\n");
  EXPECT_FALSE(faulty.config);
  EXPECT_NE(faulty.said().find("the form is D:L"), std::string::npos) << faulty.said();
  EXPECT_NE(faulty.said().find("from 10 to 170"), std::string::npos);
  EXPECT_NE(faulty.said().find("spindle_max_rpm"), std::string::npos);
}

TEST(ConfigKeys, ValuesArrive) {
  const ReadText read(
      "machine:\n"
      "  ini: mill.ini\n"
      "  tool_table: /etc/tool.tbl\n"
      "  joints: xyyz\n"
      "  work_offset: {x: 1, y: -2.5, z: 1e1, rotation: 90}\n"
      "  tool_length: table\n"
      "  tool: 7\n"
      "  max_speed_mm_per_min: 6000\n"
      "  max_acceleration_mm_per_s2: 900\n"
      "tools:\n"
      "  1: flat:6\n"
      "  12: 'ball:4:flute=10'\n"
      "stock:\n"
      "  blank: cylinder:0,0,-10:0:50\n"
      "  cell_mm: .5\n"
      "  margin_mm: 0\n"
      "  below_mm: 0.5\n"
      "follow:\n"
      "  program: ../part.ngc\n"
      "  path: planned\n"
      "  off_path_mm: 0.1\n"
      "  look_ahead_s: 0\n");
  ASSERT_TRUE(read.config) << read.said();
  const LiveConfig& config = *read.config;
  EXPECT_EQ(config.machine.ini, "dir/mill.ini");
  EXPECT_EQ(config.machine.tool_table, "/etc/tool.tbl");
  EXPECT_EQ(config.machine.joints, "XYYZ");
  EXPECT_EQ(config.machine.work_offset->g5x_mm, Vec3(1, -2.5, 10));
  EXPECT_EQ(config.machine.work_offset->rotation_deg, 90);
  EXPECT_EQ(config.machine.tool_length, ToolLengthFrom::kTable);
  EXPECT_EQ(config.machine.tool, 7);
  EXPECT_EQ(config.machine.max_mm_per_s2, 900);
  EXPECT_EQ(config.machine.max_mm_per_min, 6000);
  ASSERT_EQ(config.tools.size(), 2U);
  EXPECT_EQ(config.tools[1].tool, 12);
  EXPECT_EQ(config.tools[1].cutter.spec(), "ball:4:flute=10");
  ASSERT_TRUE(config.stock.blank);
  EXPECT_EQ(config.stock.blank->bodies.at(0).diameter_mm, 50);
  EXPECT_EQ(config.stock.cell_mm, 0.5);
  EXPECT_EQ(config.stock.margin_mm, 0);
  EXPECT_EQ(config.stock.below_mm, 0.5);
  EXPECT_EQ(config.follow.program, "dir/../part.ngc");
  EXPECT_EQ(config.follow.planned_path, true);
  EXPECT_EQ(config.follow.options.tolerance_mm, 0.1);
  EXPECT_EQ(config.follow.look_ahead_s, 0);
}

TEST(ConfigKeys, PathsOfSetsAreRelativeToTheCurrentFolder) {
  const ReadText read("machine:\n  ini: a.ini\nstock:\n  blank: state:part.state\n",
                      {"machine.tool_table=b.tbl"});
  ASSERT_TRUE(read.config) << read.said();
  EXPECT_EQ(read.config->machine.ini, "dir/a.ini");
  EXPECT_EQ(read.config->machine.tool_table, "b.tbl");
  EXPECT_EQ(read.config->stock.blank->state_file, "dir/part.state");
}

TEST(ConfigKeys, DrawingsOfSheetsLieBesideTheFile) {
  const ReadText drawn("stock:\n  blank: 'sheet: plate.dxf:3'\n");
  ASSERT_TRUE(drawn.config) << drawn.said();
  EXPECT_EQ(drawn.config->stock.blank->sheet->file, "dir/plate.dxf");
  EXPECT_EQ(drawn.config->stock.blank->sheet->thickness_mm, 3);
  const ReadText plain("stock:\n  blank: sheet:0,0:100,50:3\n  model: sheet\n");
  ASSERT_TRUE(plain.config) << plain.said();
  EXPECT_EQ(plain.config->stock.blank->sheet->high_mm, Vec2(100, 50));
  EXPECT_EQ(plain.config->stock.model, StockKind::kSheet);
}

TEST(ConfigKeys, TheBeamOfASheet) {
  const ReadText read(
      "beam:\n  trigger: m3 + feed\n  kerf_mm: 1.5\n  pierce_mm: 3\n  slats_mm: 80\n"
      "  density_kg_per_m3: 2700\n  qtplasmac: off\n  materials: shop.cfg\n");
  ASSERT_TRUE(read.config) << read.said();
  const ConfigBeam& beam = read.config->beam;
  EXPECT_EQ(beam.trigger, "m3 + feed");
  EXPECT_EQ(beam.kerf_mm, 1.5);
  EXPECT_EQ(beam.pierce_mm, 3);
  EXPECT_EQ(beam.slats_mm, 80);
  EXPECT_EQ(beam.density_kg_per_m3, 2700);
  EXPECT_EQ(beam.qtplasmac, "off");
  EXPECT_EQ(beam.materials, "dir/shop.cfg");
  // Printed, it is the same; what is not given is not printed.
  const ReadText again(effective_yaml(*read.config));
  ASSERT_TRUE(again.config) << again.said();
  EXPECT_EQ(again.config->beam.trigger, beam.trigger);
  EXPECT_EQ(again.config->beam.density_kg_per_m3, beam.density_kg_per_m3);
  EXPECT_EQ(again.config->beam.materials, "dir/dir/shop.cfg") << "relative to that file, too";
  EXPECT_EQ(effective_yaml(LiveConfig{}).find("beam"), std::string::npos);
}

TEST(ConfigKeys, ToolLibrariesAreFilesBesideIt) {
  const ReadText read("tool_libraries: [shop.json, /abs/shop.fctl, 7=bit.fctb]\n");
  ASSERT_TRUE(read.config) << read.said();
  EXPECT_EQ(read.config->tool_libraries,
            (std::vector<std::string>{"dir/shop.json", "/abs/shop.fctl", "7=dir/bit.fctb"}));
  EXPECT_NE(effective_yaml(*read.config).find("\ntool_libraries:\n  - dir/shop.json\n"),
            std::string::npos);
  EXPECT_EQ(said_of("tool_libraries: shop.json\n"),
            "1:17: tool_libraries: 'shop.json' is not allowed; must be a list of texts\n");
}

TEST(ConfigKeys, ATurretInsteadOfABeam) {
  const ReadText read("turret: press.yaml\nbeam: {density_kg_per_m3: 2700}\n");
  ASSERT_TRUE(read.config) << read.said();
  EXPECT_EQ(read.config->turret, "dir/press.yaml");
  EXPECT_NE(effective_yaml(*read.config).find("\nturret: dir/press.yaml\n"), std::string::npos);
  EXPECT_EQ(effective_yaml(LiveConfig{}).find("turret"), std::string::npos);
  EXPECT_EQ(ReadText("", {"turret=p.yaml"}).config->turret, "p.yaml");
  EXPECT_EQ(said_of("turret: press.yaml\nbeam:\n  trigger: m3\n  kerf_mm: 1\n"),
            "3:3: beam.trigger: is for torches, lasers and jets; turret punches\n"
            "4:3: beam.kerf_mm: is for torches, lasers and jets; turret punches\n");
  EXPECT_EQ(said_of("turret: {stations: 3}\n"),
            "1:9: turret: a group of keys is not allowed; must be a path\n");
}

TEST(ConfigKeys, WhatABeamIsNot) {
  const std::string said =
      said_of("beam:\n  trigger: m99\n  kerf_mm: 0\n  qtplasmac: maybe\n  kerf: 1\n");
  EXPECT_NE(said.find("beam.trigger: beam trigger 'm99': 'm99' is none"), std::string::npos)
      << said;
  EXPECT_NE(said.find("beam.kerf_mm: 0"), std::string::npos) << said;
  EXPECT_NE(said.find("beam.qtplasmac: 'maybe'"), std::string::npos) << said;
  EXPECT_NE(said.find("beam.kerf"), std::string::npos) << said;
}

TEST(ConfigKeys, ProfilesLieBesideTheFile) {
  const ConfigFolder folder;
  folder.write("rounder.txt", "line 3 0\nline 3 10\n");
  Diagnostics diagnostics;
  const auto config = read_config(
      folder.write("m.yaml", "tools: {2: 'profile: rounder.txt:flute=10'}\n"), {}, diagnostics);
  ASSERT_TRUE(config) << (diagnostics.empty() ? "" : to_string(diagnostics[0]));
  EXPECT_EQ(config->tools.at(0).cutter.spec(),
            "profile:" + folder.path("rounder.txt") + ":flute=10");
}

TEST(ConfigKeys, WrongKinds) {
  EXPECT_EQ(said_of("stock: 5\n"
                    "tools: [a]\n"
                    "machine:\n"
                    "  joints: [X]\n"
                    "  ini:\n"
                    "  tool: {a: 1}\n"
                    "  tool_table: ''\n"),
            "1:8: stock: '5' is not allowed; must be a group of keys below it\n"
            "2:8: tools: a list is not allowed; must be a group of keys below it\n"
            "4:11: machine.joints: a list is not allowed; must be a text\n"
            "5:3: machine.ini: has no value; must be a path\n"
            "6:9: machine.tool: a group of keys is not allowed; must be a whole number, 1 to "
            "99999\n"
            "7:15: machine.tool_table: '' is not allowed; must be a path\n");
}

TEST(ConfigKeys, UnknownKeys) {
  EXPECT_EQ(said_of("Stock: {}\n"), "1:1: Stock: unknown key (did you mean stock?)\n");
  EXPECT_EQ(
      said_of("stock:\n  zoom: 1\n"),
      "2:3: stock.zoom: unknown key (here may be: below_mm, blank, cell_mm, margin_mm, model)\n");
  EXPECT_EQ(said_of("machine:\n  work_offset: {x: 1, p: 2}\n"),
            "2:23: machine.work_offset.p: unknown key (here may be: a, b, c, rotation, u, v, w, x, "
            "y, z)\n");
  EXPECT_EQ(said_of("tools: {one: flat:6}\n"),
            "1:9: tools.one: is no tool number; must be a whole number, 1 to 99999 (as in 3: "
            "flat:6)\n");
}

TEST(ConfigKeys, Numbers) {
  const auto said = [](const std::string& value) {
    return said_of("stock: {margin_mm: " + value + "}\n");
  };
  EXPECT_EQ(said("'0,5'"),
            "1:20: stock.margin_mm: '0,5' is not allowed; must be 0 to 10000 (mm) (the decimal "
            "sign is a point)\n");
  for (const char* const bad : {".nan", ".inf", "nan", "inf", "1e999", "1 mm", "0x10", "--1", "+-1",
                                "'-'", "1e", "''", "1_000"}) {
    EXPECT_NE(said(bad), "read\n") << bad;
  }
  for (const char* const good : {"1", "+1", "1.", ".5", "1e2", "'3'", "1.5E+2", "-0"}) {
    EXPECT_EQ(said(good), "read\n") << good;
  }
  EXPECT_EQ(said("-0.001"),
            "1:20: stock.margin_mm: -0.001 is not allowed; must be 0 to 10000 (mm)\n");
  EXPECT_EQ(said("10000.1"),
            "1:20: stock.margin_mm: 10000.1 is not allowed; must be 0 to 10000 (mm)\n");
}

TEST(ConfigKeys, Joints) {
  EXPECT_EQ(said_of("machine: {joints: XQ}\n"),
            "1:19: machine.joints: 'XQ' is not allowed; must be 1 to 9 letters of XYZABCUVW, one a "
            "joint (XYZ: joint 0 moves X, joint 1 Y, joint 2 Z)\n");
  EXPECT_NE(said_of("machine: {joints: XYZABCUVWX}\n"), "read\n");
}

TEST(ConfigKeys, Words) {
  EXPECT_EQ(said_of("machine: {tool_length: tabel}\n"),
            "1:24: machine.tool_length: 'tabel' is not allowed; must be one of auto, source, "
            "program, table, none (did you mean table?)\n");
  EXPECT_EQ(said_of("follow: {path: no}\n"),
            "1:16: follow.path: 'no' is not allowed; must be one of programmed, planned\n");
}

TEST(ConfigKeys, ModelsAreThoseThereAre) {
  std::string words = "auto";
  for (const StockModelRow& row : stock_models()) words.append("|").append(row.name);
  for (const Setting& key : key_table()) {
    if (key.key != "stock.model") continue;
    EXPECT_EQ(key.words, words);
  }
}

TEST(ConfigKeys, Tools) {
  EXPECT_EQ(said_of("tools:\n"
                    "  0: flat:6\n"
                    "  1: flat:6\n"
                    "  01: flat:7\n"
                    "  2: lollipop:6:3\n"
                    "stock: {model: zmap}\n"),
            "2:6: tools.0: 'flat:6': tool 0 is the empty spindle; numbers begin at 1\n"
            "4:7: tools.01: 'flat:7': tool 1 is given twice\n"
            "5:6: tools.2: 'lollipop:6:3': lollipop:6:3 cuts below itself (its neck is thinner "
            "than its head); a Z-map cannot hold undercuts\n");
  EXPECT_EQ(said_of("tools:\n  2: lollipop:6:3\n"), "read\n");
  EXPECT_NE(said_of("tools:\n  3: flatt:6\n").find("2:6: tools.3: 'flatt:6': "), std::string::npos);
  EXPECT_NE(said_of("tools:\n  3: profile:none\n").find("dir/none"), std::string::npos);
}

TEST(ConfigKeys, BlankNamesWhatIsWrong) {
  EXPECT_EQ(said_of("stock:\n  blank: box:0,0\n"),
            "2:10: stock.blank: box:0,0: the form is box:x0,y0,z0:x1,y1,z1\n");
}

TEST(KeyTable, IsWhatSchemaShowsAndConsistent) {
  const std::string schema = schema_text();
  std::vector<std::string> seen;
  for (const Setting& spec : key_table()) {
    const std::string path(spec.key);
    EXPECT_STRNE(spec.purpose, "") << path;
    EXPECT_NE(schema.find(spec.purpose), std::string::npos) << path;
    const bool number = spec.type == KeyType::kNumber || spec.type == KeyType::kWhole;
    EXPECT_EQ(spec.least < spec.most, number) << path;
    EXPECT_EQ(!spec.words.empty(), spec.type == KeyType::kWord) << path;
    // A group before its keys.
    const std::size_t dot = path.rfind('.');
    if (dot != path.npos) {
      EXPECT_NE(std::find(seen.begin(), seen.end(), path.substr(0, dot)), seen.end()) << path;
    }
    seen.push_back(path);
  }
  EXPECT_NE(schema.find("  poll_hz: NUMBER                            # [modbus] how often all "
                        "registers are read\n"
                        "                                             #   0.1 to 2000 (polls/s); "
                        "default 50\n"),
            std::string::npos);
}

/// The least that a source of each type needs.
std::string minimal(SourceMask type, const std::string& item = {}) {
  const std::string map = "  map:\n    X: {";
  const std::string more = item.empty() ? "" : ", " + item;
  switch (type) {
    case kForModbus:
      return "source:\n  type: modbus\n  rtu: {device: /dev/ttyS0}\n" + map + "register: 0" + more +
             "}\n";
    case kForCan:
      return "source:\n  type: can\n  interface: can0\n" + map + "id: 0x181" + more + "}\n";
    case kForHal:
      return "source:\n  type: hal\n";
    default:
      return "source:\n  type: log\n  file: a.log\n" + map + "id: 0x181" + more + "}\n";
  }
}

/// A default that the table tells is the one that counts.
TEST(KeyTable, DefaultsAreTrue) {
  int checked = 0;
  for (const Setting& spec : key_table()) {
    if (spec.fallback.empty() || spec.key.find(".mux.") != spec.key.npos) continue;
    // Of a list, which no --set reaches.
    if (spec.key.starts_with("machine.links.") || spec.key.starts_with("fixtures.")) continue;
    for (const SourceMask type : {kForModbus, kForCan, kForHal, kForLog}) {
      if ((spec.sources & type) == 0) continue;
      // Keys of their own formats, which a map excludes.
      if (type == kForLog && (spec.key == "source.format" || spec.key == "source.period_s" ||
                              spec.key == "source.channel")) {
        continue;
      }
      const std::string fallback(spec.fallback);
      std::string path(spec.key);
      std::string item;
      std::vector<std::string> sets;
      constexpr std::string_view kItem = "source.map.ITEM.";
      if (path.starts_with(kItem)) {
        item = path.substr(kItem.size()) + ": " + fallback;
      } else {
        sets.push_back(path + "=" + fallback);
      }
      if (path.starts_with("machine.work_offset.")) continue;  // there or not is a difference
      const ReadText without(minimal(type));
      const ReadText with(minimal(type, item), sets);
      ASSERT_TRUE(without.config) << without.said();
      ASSERT_TRUE(with.config) << path << "\n" << with.said();
      EXPECT_EQ(effective_yaml(*without.config), effective_yaml(*with.config)) << path;
      ++checked;
    }
  }
  EXPECT_GT(checked, 40);
}

}  // namespace
}  // namespace kerf
