// What is said of texts that are no configuration at all, and of files that cannot be read.
#include <gtest/gtest.h>

#include "tests/twin/config/config_support.h"

namespace kerf {
namespace {

TEST(ConfigText, FaultHasPlaceExcerptCaretAndHint) {
  const ReadText read("stock:\n  cell_mm: 0\n");
  ASSERT_EQ(read.diagnostics.size(), 1U);
  EXPECT_EQ(to_string(read.diagnostics[0]),
            "dir/m.yaml:2:12: error: stock.cell_mm: 0 is not allowed; must be above 0 and at most "
            "1000 (mm)\n"
            "     2 |   cell_mm: 0\n"
            "       |            ^\n"
            "   hint: 0.05 to 0.2 suits most parts\n");
}

TEST(ConfigText, AllFaultsInTheOrderOfLines) {
  EXPECT_EQ(said_of("sorce: {}\n"
                    "source:\n"
                    "  type: modbus\n"
                    "  poll_hz: fast\n"
                    "stock:\n"
                    "  margin_mm: -1\n"
                    "machine:\n"
                    "  tool: 0.5\n"),
            "1:1: sorce: unknown key (did you mean source?)\n"
            "2:1: source: tcp is missing; must be HOST:PORT, or rtu: with a device instead\n"
            "2:1: source: map is missing; must be a group with at least one axis (as in X: "
            "{register: 0})\n"
            "4:12: source.poll_hz: 'fast' is not allowed; must be 0.1 to 2000 (polls/s) (20 to 100 "
            "suits most machines)\n"
            "6:14: stock.margin_mm: -1 is not allowed; must be 0 to 10000 (mm)\n"
            "8:9: machine.tool: 0.5 is not allowed; must be a whole number, 1 to 99999\n");
}

TEST(ConfigText, SyntaxInPlainWords) {
  EXPECT_EQ(said_of("stock:\n\tcell_mm: 1\n  \tmargin_mm: 2\n"),
            "2:1: a tab indents this line (YAML indents with blanks only)\n"
            "3:3: a tab indents this line (YAML indents with blanks only)\n");
  EXPECT_EQ(said_of("stock: {cell_mm: 1\n"), "2:1: '{' without '}'\n");
  EXPECT_EQ(said_of("stock: [1\n"), "2:1: '[' without ']'\n");
  EXPECT_EQ(said_of("stock:\n  cell_mm: 1\n margin_mm: 3\n"),
            "3:2: keys of one group must begin in the same column, and each needs a ':' and a "
            "blank\n");
  EXPECT_EQ(said_of("stock:\n  cell_mm: 1\n    margin_mm: 3\n"),
            "3:14: a ':' cannot stand here: a line begins farther right than the one above, or a "
            "text with ': ' in it lacks its quotes\n");
  EXPECT_EQ(said_of("machine: {ini: a}}\n"), "1:18: this is no YAML: illegal flow end\n");
  EXPECT_EQ(said_of("machine:\n  ini: 'x\n"), "2:8: this quote does not end in its line\n");
  EXPECT_EQ(said_of("machine:\n  ini: \"x\\\"\n"), "2:8: this quote does not end in its line\n");
  EXPECT_EQ(said_of("machine:\n  ini: 'it''s'\n"), "read\n");
}

TEST(ConfigText, NoAnchorsAliasesTagsFurtherDocuments) {
  EXPECT_EQ(said_of("a: &x [1]\nb: [*x, *x]\n"),
            "1:4: anchors ('&') are not allowed (write the value out)\n");
  EXPECT_EQ(said_of("a: *x\n"), "1:4: this is no YAML: the referenced anchor is not defined\n");
  EXPECT_EQ(said_of("machine: &m {ini: *m}\n"),
            "1:10: anchors ('&') are not allowed (write the value out)\n");
  EXPECT_EQ(said_of("stock: {cell_mm: !!float 3}\n"),
            "1:18: tags are not allowed; 'tag:yaml.org,2002:float' found\n");
  EXPECT_EQ(said_of("stock: {}\n---\nstock: {}\n"),
            "2:1: a second document ('---') is not allowed\n");
}

TEST(ConfigText, NoConfiguration) {
  EXPECT_EQ(said_of("hello\n"),
            "1:1: a single value found; a configuration is keys with values ('source: ...')\n");
  EXPECT_EQ(said_of("- a\n"),
            "1:1: a list found; a configuration is keys with values ('source: ...')\n");
  EXPECT_EQ(said_of("stock:\n  ? [a]\n  : 1\n"), "2:5: a key is a word; a list found\n");
  EXPECT_EQ(said_of("stock:\n  ~: 1\n"), "2:3: a key is a word; nothing found\n");
  EXPECT_EQ(said_of("stock: # \xff\n"), "1:10: byte 0xFF is not UTF-8 (save the file as UTF-8)\n");
  EXPECT_EQ(said_of("stock: # \xc3\n"), "1:10: byte 0xC3 is not UTF-8 (save the file as UTF-8)\n");
  EXPECT_EQ(said_of(std::string_view("st\0ck", 5)),
            "1:3: a zero byte: this is no text file (a configuration is a YAML text in UTF-8)\n");
  std::string deep = "machine: ";
  for (int i = 0; i < 100; ++i) deep += "{a: ";
  EXPECT_NE(said_of(deep).find("nested deeper than 16 levels"), std::string::npos);
  // The library has a limit of its own; ours comes first.
  EXPECT_NE(said_of(std::string(100'000, '[')), "read\n");
}

TEST(ConfigText, DuplicateKeysNameTheFirst) {
  EXPECT_EQ(said_of("stock:\n  cell_mm: 1\n  cell_mm: 2\nstock:\n  margin_mm: 2\n"),
            "3:3: stock.cell_mm: given twice; the first is in line 2\n"
            "4:1: stock: given twice; the first is in line 1\n");
}

TEST(ConfigText, LineEndsMarksAndCommentsAreWelcome) {
  const ReadText read("\xEF\xBB\xBF# mine\r\nstock:\r\n  cell_mm: 0.25\r\n");
  ASSERT_TRUE(read.config) << read.said();
  EXPECT_EQ(read.config->stock.cell_mm, 0.25);
  EXPECT_TRUE(ReadText("# nothing\n").config);
  EXPECT_TRUE(ReadText("stock:\nmachine: ~\n").config);
}

TEST(ConfigText, LongLinesAreCut) {
  const ReadText read("stock:\n  cell_mm: " + std::string(5000, '9') + "x\n");
  ASSERT_EQ(read.diagnostics.size(), 1U);
  EXPECT_LT(to_string(read.diagnostics[0]).size(), 1200U);
}

TEST(ConfigFile, WhatCannotBeRead) {
  const ConfigFolder folder;
  const auto said = [&](const std::string& path) {
    Diagnostics diagnostics;
    EXPECT_FALSE(read_config(path, {}, diagnostics));
    return diagnostics.size() == 1 ? to_string(diagnostics[0]) : "not one diagnostic";
  };
  EXPECT_EQ(said(folder.path("none.yaml")),
            folder.path("none.yaml") +
                ": error: cannot read the configuration: No such file or directory\n");
  EXPECT_EQ(said(folder.path()),
            folder.path() + ": error: is a folder; a configuration is a file\n");
  const std::string empty = folder.write("empty.yaml", " \n\n");
  EXPECT_EQ(said(empty),
            empty + ": error: is empty\n   hint: `kerf config schema` lists every key there is\n");
  const std::string huge = folder.write("huge.yaml", std::string(kMaxConfig_bytes + 1, '#'));
  EXPECT_EQ(said(huge), huge +
                            ": error: larger than 1048576 bytes, which no configuration is\n"
                            "   hint: is it a log or a program?\n");
  const std::string full = folder.write("full.yaml", std::string(kMaxConfig_bytes, '#'));
  Diagnostics diagnostics;
  EXPECT_TRUE(read_config(full, {}, diagnostics));
}

TEST(ConfigSet, OverridesAddsAndNamesItself) {
  const std::string text = "stock:\n  cell_mm: 0.1\nsource:\n";
  const ReadText read(text, {"stock.cell_mm=0.2", "machine.work_offset.x=5", "tools.3=flat:6",
                             "source.type=hal", "source.rate_hz=500", "stock.cell_mm=0.3"});
  ASSERT_TRUE(read.config) << read.said();
  EXPECT_EQ(read.config->stock.cell_mm, 0.3);
  EXPECT_EQ(read.config->machine.work_offset->g5x_mm.x, 5);
  EXPECT_EQ(read.config->tools.at(0).tool, 3);
  EXPECT_EQ(std::get<HalSettings>(read.config->source).rate_hz, 500);
}

TEST(ConfigSet, Faults) {
  EXPECT_EQ(said_of("", {"foo", "=3", ".a=3", "a..b=3"}),
            "--set foo: must be KEY=VALUE (as in --set source.poll_hz=100)\n"
            "--set =3: must be KEY=VALUE (as in --set source.poll_hz=100)\n"
            "--set .a=3: must be KEY=VALUE (as in --set source.poll_hz=100)\n"
            "--set a..b=3: must be KEY=VALUE (as in --set source.poll_hz=100)\n");
  EXPECT_EQ(said_of("stock:\n  cell_mm: 1\n", {"stock.cell_mm=x", "stock.cel_mm=1"}),
            "--set stock.cell_mm: 'x' is not allowed; must be above 0 and at most 1000 (mm) (0.05 "
            "to 0.2 suits most parts)\n"
            "--set stock.cel_mm: unknown key (did you mean cell_mm?)\n");
  EXPECT_EQ(said_of("stock:\n  cell_mm: 1\n", {"stock=3", "stock.cell_mm.x=1"}),
            "--set stock: a group of keys in the file; only a single value can be set\n"
            "--set stock.cell_mm.x: stock.cell_mm is a single value here, so there is no x below "
            "it\n");
  EXPECT_EQ(said_of("", {"stock.cell_mm=\xff"}), "--set value: not UTF-8\n");
  EXPECT_EQ(said_of("", {"source.poll_hz=5"}),
            "--set source: type is missing; must be one of modbus, can, hal, log, mtconnect\n");
}

}  // namespace
}  // namespace kerf
