// The lines that `kerf setup` puts into an INI, and takes out again.

#include "twin/cli/screen_setup.h"

#include <gtest/gtest.h>

#include <string>

namespace kerf {
namespace {

constexpr const char* kAxis =
    "[EMC]\nMACHINE = mill\n\n[DISPLAY]\nDISPLAY = axis\nCYCLE_TIME = 0.1\n\n# tasks\n[TASK]\n"
    "TASK = milltask\n";

std::string with(const std::string& text, Diagnostics* told = nullptr) {
  Diagnostics diagnostics;
  const std::optional<IniChange> change = with_tab(text, "machines/mill.ini", "kerf", diagnostics);
  if (told != nullptr) *told = diagnostics;
  return change ? change->text : "";
}

std::string without(const std::string& text) {
  Diagnostics diagnostics;
  const std::optional<IniChange> change = without_tab(text, "mill.ini", diagnostics);
  return change ? change->text : "";
}

std::string refusal(const std::string& text) {
  Diagnostics told;
  EXPECT_EQ(with(text, &told), "");
  return told.empty() ? "" : to_string(told.front());
}

TEST(ScreenSetup, AxisGetsATabAtTheEndOfItsSection) {
  EXPECT_EQ(with(kAxis),
            "[EMC]\nMACHINE = mill\n\n[DISPLAY]\nDISPLAY = axis\nCYCLE_TIME = 0.1\n"
            "# kerf setup: begin\nEMBED_TAB_NAME = kerf\n"
            "EMBED_TAB_COMMAND = kerf shadow --set source.type=hal --ini mill.ini -x {XID}\n"
            "# kerf setup: end\n\n# tasks\n[TASK]\nTASK = milltask\n");
}

TEST(ScreenSetup, GmoccapyAndQtDragonAreToldWhere) {
  const std::string gmoccapy = with("[DISPLAY]\nDISPLAY = gmoccapy -d\n");
  EXPECT_NE(gmoccapy.find("\nEMBED_TAB_LOCATION = ntb_preview\n"), std::string::npos) << gmoccapy;
  const std::string qt = with("[DISPLAY]\nDISPLAY = qtvcp -d qtdragon_hd\n");
  EXPECT_NE(qt.find("\nEMBED_TAB_LOCATION = stackedWidget_mainTab\n"), std::string::npos) << qt;
}

TEST(ScreenSetup, TwiceIsOnceAndUndoneIsAsBefore) {
  for (const std::string& text :
       {std::string(kAxis), std::string("[DISPLAY]\r\nDISPLAY = axis\r\n\r\n[TASK]\r\n"),
        std::string("[DISPLAY]\nDISPLAY = /usr/bin/gmoccapy\n")}) {
    const std::string once = with(text);
    ASSERT_NE(once, "");
    EXPECT_EQ(with(once), once);
    EXPECT_EQ(without(once), text);
    EXPECT_EQ(without(text), text);
  }
}

TEST(ScreenSetup, LinesOfAnOlderKerfAreReplacedWhereTheyAre) {
  const std::string old =
      "[DISPLAY]\nDISPLAY = axis\n# kerf setup: begin\nEMBED_TAB_NAME = twin\n"
      "EMBED_TAB_COMMAND = kerf shadow -x {XID}\n# kerf setup: end\nCYCLE_TIME = 0.1\n";
  EXPECT_EQ(with(old),
            "[DISPLAY]\nDISPLAY = axis\n# kerf setup: begin\nEMBED_TAB_NAME = kerf\n"
            "EMBED_TAB_COMMAND = kerf shadow --set source.type=hal --ini mill.ini -x {XID}\n"
            "# kerf setup: end\nCYCLE_TIME = 0.1\n");
}

TEST(ScreenSetup, TheDiffHasThreeLinesAround) {
  Diagnostics diagnostics;
  const std::optional<IniChange> change = with_tab(kAxis, "mill.ini", "kerf", diagnostics);
  ASSERT_TRUE(change);
  EXPECT_EQ(unified_diff(kAxis, *change, "mill.ini"),
            "--- mill.ini\n+++ mill.ini\n@@ -4,6 +4,10 @@\n [DISPLAY]\n DISPLAY = axis\n"
            " CYCLE_TIME = 0.1\n+# kerf setup: begin\n+EMBED_TAB_NAME = kerf\n"
            "+EMBED_TAB_COMMAND = kerf shadow --set source.type=hal --ini mill.ini -x {XID}\n"
            "+# kerf setup: end\n \n # tasks\n [TASK]\n");
}

TEST(ScreenSetup, WhatItDoesNotUnderstandIsRefused) {
  EXPECT_NE(refusal("[DISPLAY]\nDISPLAY = touchy\n")
                .find("mill.ini:2: error: the screen 'touchy' is none that kerf knows"),
            std::string::npos);
  EXPECT_NE(refusal("[EMC]\nMACHINE = mill\n").find("[DISPLAY]DISPLAY is not in this file"),
            std::string::npos);
  // Two names, one command: the screen would mix them up.
  EXPECT_NE(refusal("[DISPLAY]\nDISPLAY = axis\nEMBED_TAB_NAME = a\nEMBED_TAB_NAME = b\n"
                    "EMBED_TAB_COMMAND = x\n")
                .find("the tabs do not come out even: 2 EMBED_TAB_NAME, 1 EMBED_TAB_COMMAND"),
            std::string::npos);
  EXPECT_NE(refusal("[DISPLAY]\nDISPLAY = axis\nEMBED_TAB_NAME = a\n"
                    "EMBED_TAB_COMMAND = kerf shadow -x {XID}\n")
                .find("there is a tab with kerf already"),
            std::string::npos);
  EXPECT_NE(
      refusal("[DISPLAY]\nDISPLAY = axis\n# kerf setup: begin\n").find("are not there once each"),
      std::string::npos);
  EXPECT_NE(refusal("[DISPLAY]\nDISPLAY = axis\nGEOMETRY = XYZ \\\n")
                .find("the end of [DISPLAY] is not clear"),
            std::string::npos);
}

/// A tab of others, with all of its lines, is no trouble.
TEST(ScreenSetup, TabsOfOthersStay) {
  const std::string text =
      "[DISPLAY]\nDISPLAY = gmoccapy\nEMBED_TAB_NAME = a\nEMBED_TAB_LOCATION = ntb_user_tabs\n"
      "EMBED_TAB_COMMAND = gladevcp -x {XID} a.ui\n";
  const std::string changed = with(text);
  EXPECT_EQ(changed.substr(0, text.size()), text);
  EXPECT_EQ(without(changed), text);
}

}  // namespace
}  // namespace kerf
