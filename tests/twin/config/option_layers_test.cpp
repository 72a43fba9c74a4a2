// Who is heard of those who say something about an option: one test a rule. And what the setting
// table must be for that.
#include "twin/config/option_layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "tests/twin/config/config_support.h"
#include "twin/config/live_config.h"

namespace kerf {
namespace {

class OptionLayersTest : public testing::Test {
 protected:
  /// "command line: 0.5"
  std::string heard(std::string_view option, Command command = kShadow) const {
    const OptionLayers layers{command, &written_, &config_, ini_};
    const ChosenValue value = choose(layers, option);
    constexpr const char* kNames[] = {"nobody", "default", "INI", "configuration", "command line"};
    return std::string(kNames[static_cast<int>(value.from)]) + ": " + value.text;
  }

  WrittenOptions written_;
  SaidTexts config_;
  SaidTexts ini_;
};

TEST_F(OptionLayersTest, WhatNobodySaysIsTheDefaultOfTheTable) {
  EXPECT_EQ(heard("--margin"), "default: 5");
}

TEST_F(OptionLayersTest, WithoutADefaultItIsNothing) { EXPECT_EQ(heard("--cell"), "nobody: "); }

TEST_F(OptionLayersTest, TheIniGoesBeforeTheDefault) {
  ini_["--margin"] = "7";
  EXPECT_EQ(heard("--margin"), "INI: 7");
}

TEST_F(OptionLayersTest, TheConfigurationGoesBeforeTheIni) {
  ini_["--tool-table"] = "of_ini.tbl";
  config_["machine.tool_table"] = "of_config.tbl";
  EXPECT_EQ(heard("--tool-table"), "configuration: of_config.tbl");
}

TEST_F(OptionLayersTest, TheCommandLineGoesBeforeAll) {
  ini_["--tool-table"] = "of_ini.tbl";
  config_["machine.tool_table"] = "of_config.tbl";
  written_.set("--tool-table", "mine.tbl");
  EXPECT_EQ(heard("--tool-table"), "command line: mine.tbl");
}

TEST_F(OptionLayersTest, AnEmptyTextOfTheCommandLineIsNone) {
  config_["stock.cell_mm"] = "0.2";
  written_.set("--cell", "");
  EXPECT_EQ(heard("--cell"), "configuration: 0.2");
}

TEST_F(OptionLayersTest, AFlagSaysWhatItStandsFor) {
  config_["machine.as_mill"] = "no";
  EXPECT_EQ(heard("--as-mill"), "configuration: no");
  written_.set_flag("--as-mill");
  EXPECT_EQ(heard("--as-mill"), "command line: yes");
  config_["view.window"] = "yes";
  EXPECT_EQ(heard("--no-view"), "configuration: yes");
  written_.set_flag("--no-view");
  EXPECT_EQ(heard("--no-view"), "command line: no");
}

TEST_F(OptionLayersTest, ListsAreHeardAsAWhole) {
  config_["tools.NUMBER"] = "";
  EXPECT_EQ(heard("--tool"), "configuration: ");
  written_.add("--tool", "1=flat:6");
  written_.add("--tool", "2=ball:4");
  EXPECT_EQ(heard("--tool"), "command line: 1=flat:6");
}

TEST_F(OptionLayersTest, AKeyCountsForItsCommandsAlone) {
  config_["follow.path"] = "planned";
  EXPECT_EQ(heard("--path", kShadow), "configuration: planned");
  EXPECT_EQ(heard("--path", kReplay), "configuration: planned");
  EXPECT_EQ(heard("--path", kRun), "nobody: ");
}

TEST_F(OptionLayersTest, OneOptionMayBeAnotherThingForAnotherCommand) {
  EXPECT_EQ(heard("--speed", kReplay), "default: 1");
  EXPECT_EQ(heard("--speed", kView), "nobody: ");
}

TEST_F(OptionLayersTest, WhoAsksForAPunchWantsNoBeamOfTheConfiguration) {
  config_["beam.kerf_mm"] = "1.2";
  config_["beam.qtplasmac"] = "on";
  config_["beam.density_kg_per_m3"] = "2700";
  EXPECT_EQ(heard("--kerf"), "configuration: 1.2");
  written_.set("--turret", "press.yaml");
  EXPECT_EQ(heard("--kerf"), "nobody: ");
  EXPECT_EQ(heard("--qtplasmac"), "nobody: ");
  EXPECT_EQ(heard("--density"), "configuration: 2700") << "parts weigh the same";
}

TEST_F(OptionLayersTest, WhoAsksForABeamWantsNoPunchOfTheConfiguration) {
  config_["turret"] = "press.yaml";
  EXPECT_EQ(heard("--turret"), "configuration: press.yaml");
  written_.set("--qtplasmac", "on");
  EXPECT_EQ(heard("--turret"), "configuration: press.yaml") << "how a program is read is no beam";
  written_.set("--slats", "50");
  EXPECT_EQ(heard("--turret"), "nobody: ");
}

TEST_F(OptionLayersTest, WithoutACommandLineOrAConfigurationTheOthersAreHeard) {
  EXPECT_EQ(choose({kRun, nullptr, nullptr, {}}, "--margin").text, "5");
}

/// What the layers hear of a configuration.
TEST(SaidTexts, AreThoseOfKeysThatAreOptions) {
  Diagnostics diagnostics;
  const auto config = parse_config(
      "machine: {ini: mill.ini, tool_table: /t/tool.tbl, as_mill: true, tool: 3}\n"
      "stock: {cell_mm: 5e-1, blank: 'box:0,0,0:1,1,1'}\n"
      "tools: {1: flat:6}\n"
      "view: {window: off}\n",
      "dir/mill.yaml", {"machine.work_offset.x=5", "beam.materials=m.cfg"}, diagnostics);
  ASSERT_TRUE(config);
  const SaidTexts wanted{{"machine.ini", "dir/mill.ini"},
                         {"machine.tool_table", "/t/tool.tbl"},
                         {"machine.as_mill", "yes"},
                         {"machine.work_offset", ""},
                         {"stock.cell_mm", "0.5"},
                         {"stock.blank", "box:0,0,0:1,1,1"},
                         {"tools.NUMBER", ""},
                         {"beam.materials", "m.cfg"},
                         {"view.window", "no"}};
  EXPECT_EQ(config->said, wanted);
}

TEST(SettingTable, HasARowForEachOptionOfACommandAndNoMore) {
  std::set<std::pair<std::string, int>> seen;
  for (const Setting& row : setting_table()) {
    EXPECT_FALSE(row.key.empty() && row.option.empty());
    for (const CommandRow& command : command_table()) {
      if ((row.commands & command.command) == 0) continue;
      EXPECT_TRUE(seen.emplace(row.option, command.command).second)
          << "kerf " << command.name << ' ' << row.option << " has two rows";
    }
  }
  EXPECT_TRUE(seen.contains({"--cell", kRun}));
}

TEST(SettingTable, OptionsSayWhatTheyTakeAndWhatFor) {
  for (const Setting& row : setting_table()) {
    if (row.option.empty()) continue;
    const std::string name(row.option);
    EXPECT_NE(row.commands, 0) << name;
    EXPECT_STRNE(row.help, "") << name;
    const bool named = *row.value_name != 0;
    EXPECT_NE(named || row.is_positional(), !row.flag.empty()) << name;
    EXPECT_EQ(row.type == KeyType::kYesNo, !row.flag.empty()) << name;
    const bool tells_default = std::string_view(row.help).find("{}") != std::string_view::npos;
    EXPECT_TRUE(!tells_default || !row.fallback.empty()) << name;
    if (row.key.empty()) {
      const bool number = row.type == KeyType::kNumber || row.type == KeyType::kWhole;
      EXPECT_EQ(row.least < row.most, number) << name;
      EXPECT_EQ(*row.unit != 0, number) << name;
    }
    EXPECT_TRUE(row.type != KeyType::kWord || !row.words.empty()) << name;
    for (const std::string& rival : parts_of(row.yields_to)) {
      EXPECT_EQ(setting_of(rival, kRun).option, rival) << name;
    }
  }
}

/// A default that the table has is one that the option could have.
TEST(SettingTable, DefaultsAreAllowed) {
  for (const Setting& row : setting_table()) {
    if (row.fallback.empty()) continue;
    const std::string name = std::string(row.key) + ' ' + std::string(row.option);
    if (row.type == KeyType::kNumber || row.type == KeyType::kWhole) {
      const double value = std::stod(std::string(row.fallback));
      EXPECT_TRUE(value >= row.least && value <= row.most) << name;
    }
    const std::vector<std::string> words = parts_of(row.words);
    if (row.type == KeyType::kWord) {
      EXPECT_EQ(std::count(words.begin(), words.end(), row.fallback), 1) << name;
    }
  }
}

}  // namespace
}  // namespace kerf
