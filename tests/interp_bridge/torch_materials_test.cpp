// QtPlasmaC's materials: file, prefs, comments; what a program's text says; beam triggers.
#include <gtest/gtest.h>

#include "interp_bridge/beam_trigger.h"
#include "interp_bridge/torch_setup.h"

namespace kerf {
namespace {

std::string all_of(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) text += to_string(diagnostic);
  return text;
}

std::vector<TorchMaterial> read(std::string_view text, Diagnostics& diagnostics,
                                double unit_mm = 1) {
  std::vector<TorchMaterial> rows;
  parse_material_file(text, "mill_material.cfg", unit_mm, rows, diagnostics);
  return rows;
}

TEST(MaterialFile, AsQtPlasmacWritesIt) {
  Diagnostics diagnostics;
  const auto rows = read(
      "# plasmac material file\n#[MATERIAL_NUMBER_9]\n\n[MATERIAL_NUMBER_1]\n"
      "NAME               = 3 mm mild steel\nKERF_WIDTH         = 1.4\nTHC                = 1\n"
      "PIERCE_HEIGHT      = 3.8\nPIERCE_DELAY       = 0.4\nPUDDLE_JUMP_HEIGHT = 120\n"
      "PUDDLE_JUMP_DELAY  = 0.1\nCUT_HEIGHT         = 1.5\nCUT_SPEED          = 2600\n"
      "CUT_AMPS           = 45\nCUT_VOLTS          = 110\nPAUSE_AT_END       = 0.2\n"
      "GAS_PRESSURE       = 5\nCUT_MODE           = 2\n\n"
      "[MATERIAL_NUMBER_20]\nPIERCE_HEIGHT=4\nPIERCE_DELAY=0\nCUT_HEIGHT=2\nCUT_SPEED=1000\n"
      "KERF_WIDTH=\n",
      diagnostics);
  EXPECT_EQ(all_of(diagnostics), "");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0], TorchMaterial{});
  const TorchMaterial expected{
      1, "3 mm mild steel", 1.4, 3.8, 0.4, 120, 0.1, 1.5, 2600, 45, 110, 0.2, 5, 2};
  EXPECT_EQ(rows[1], expected);
  EXPECT_EQ(rows[2].number, 20);
  EXPECT_EQ(rows[2].kerf_width_mm, 0) << "what is missing is 0, as QtPlasmaC has it";
  EXPECT_EQ(rows[2].feed_mm_per_min, 1000);
}

TEST(MaterialFile, InInches) {
  Diagnostics diagnostics;
  const auto rows = read(
      "[MATERIAL_NUMBER_1]\nKERF_WIDTH=0.1\nPIERCE_HEIGHT=0.2\nPIERCE_DELAY=3\nCUT_HEIGHT=1\n"
      "CUT_SPEED=100\n",
      diagnostics, 25.4);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_DOUBLE_EQ(rows[1].kerf_width_mm, 2.54);
  EXPECT_DOUBLE_EQ(rows[1].feed_mm_per_min, 2540);
  EXPECT_DOUBLE_EQ(rows[1].pierce_delay_s, 3);
}

TEST(MaterialFile, TheUnitOfAnotherMachineIsDoubtedOnce) {
  const auto file = [](const char* height) {
    std::string text;
    for (int number = 1; number <= 2; ++number) {
      text += "[MATERIAL_NUMBER_" + std::to_string(number) + "]\nPIERCE_HEIGHT = " + height +
              "\nPIERCE_DELAY=0.4\nCUT_HEIGHT=0.06\nCUT_SPEED=100\n";
    }
    return text;
  };
  const auto said = [&](const char* height, double unit_mm) {
    Diagnostics diagnostics;
    read(file(height), diagnostics, unit_mm);
    return all_of(diagnostics);
  };
  EXPECT_EQ(said("0.15", 1),
            "mill_material.cfg:2:1: warning: material 1 is pierced from 0.15 mm: this looks like "
            "inches in a file that is read in mm, the unit of the machine ([TRAJ]LINEAR_UNITS of "
            "its INI; mm without one)\n"
            "     2 | PIERCE_HEIGHT = 0.15\n       | ^\n");
  EXPECT_NE(said("3.8", 25.4)
                .find("material 1 is pierced from 96.5 mm: this looks like mm in a "
                      "file that is read in inches"),
            std::string::npos);
  EXPECT_EQ(said("0.15", 25.4), "");
  EXPECT_EQ(said("3.8", 1), "");
  EXPECT_EQ(said("0", 1), "") << "not entered";
}

TEST(MaterialFile, FaultsAreSaidWithTheirPlace) {
  Diagnostics diagnostics;
  const auto rows = read(
      "CUT_SPEED = 5\n[MATERIAL_NUMBER_1000000]\n[MATERIAL_NUMBER_x]\n[MATERIAL_NUMBER_2]\n"
      "CUT_SPEED = fast\nCUT_HEIGHT = nan\nPIERCE_HEIGHT = 1\n",
      diagnostics);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[1].feed_mm_per_min, 0);
  EXPECT_EQ(all_of(diagnostics),
            "mill_material.cfg:2: warning: [MATERIAL_NUMBER_1000000] is passed over; a material is "
            "[MATERIAL_NUMBER_0] to [MATERIAL_NUMBER_999999]\n"
            "mill_material.cfg:3: warning: [MATERIAL_NUMBER_x] is passed over; a material is "
            "[MATERIAL_NUMBER_0] to [MATERIAL_NUMBER_999999]\n"
            "mill_material.cfg:5:13: warning: CUT_SPEED: 'fast' is not a number\n"
            "     5 | CUT_SPEED = fast\n       |             ^\n"
            "mill_material.cfg:6:14: warning: CUT_HEIGHT: 'nan' is not a number\n"
            "     6 | CUT_HEIGHT = nan\n       |              ^\n"
            "mill_material.cfg:7: warning: material 2 has no PIERCE_DELAY; 0 is taken\n");
}

TEST(MaterialFile, PrefsHoldTheDefaultAndThePins) {
  Diagnostics diagnostics;
  TorchMaterial material;
  std::map<std::string, double> pins;
  parse_plasma_prefs(
      "[DEFAULT MATERIAL]\nKerf width = 0.05\nCut feed rate = 100\n[PLASMA_PARAMETERS]\n"
      "Float Switch Travel = 0.06\n[OTHER]\nKerf width = 9\n",
      "p.prefs", 25.4, material, pins, diagnostics);
  EXPECT_EQ(all_of(diagnostics), "");
  EXPECT_DOUBLE_EQ(material.kerf_width_mm, 1.27);
  EXPECT_DOUBLE_EQ(material.feed_mm_per_min, 2540);
  EXPECT_EQ(pins, (std::map<std::string, double>{{"plasmac.float-switch-travel", 0.06}}));
}

TEST(MaterialTable, CommentsMakeAndChangeMaterials) {
  MaterialTable table;
  using Edit = MaterialTable::Edit;
  EXPECT_EQ(table.edit("a comment", 1), Edit::kNone);
  EXPECT_EQ(table.edit("o=0, na=Steel 3mm, ph=3.0, pd=0.1, ch=1.5, fr=3000, kw=1.2", 1),
            Edit::kDone);
  EXPECT_EQ(table.current_index(), 1U);
  EXPECT_EQ(table.current().number, 1'000'000);
  EXPECT_EQ(table.current().name, "Steel 3mm");
  EXPECT_EQ(table.current().feed_mm_per_min, 3000);
  EXPECT_EQ(table.current().kerf_width_mm, 1.2);
  EXPECT_EQ(table.current().cut_amps, 15) << "what the filter takes for what is not said";

  EXPECT_EQ(table.edit("o=1, nu=7, na=a, ph=1, pd=2, ch=3, fr=4", 25.4), Edit::kDone);
  EXPECT_EQ(table.current_index(), 1U) << "a new material is not in force";
  EXPECT_TRUE(table.select(7));
  EXPECT_DOUBLE_EQ(table.current().feed_mm_per_min, 101.6);
  EXPECT_EQ(table.edit("o=2, nu=7, na=a, ph=1, pd=2, ch=3, fr=9", 1), Edit::kDone);
  EXPECT_EQ(table.current().feed_mm_per_min, 9) << "a change of the one in force";
  EXPECT_DOUBLE_EQ(table.rows()[2].feed_mm_per_min, 101.6) << "a row keeps its values";

  EXPECT_TRUE(table.select(-1));
  EXPECT_EQ(table.current_index(), 0U);
  EXPECT_FALSE(table.select(55));
  EXPECT_EQ(table.current().number, 55);
  EXPECT_EQ(table.current().feed_mm_per_min, 4000);
  EXPECT_TRUE(table.select(55));
}

TEST(MaterialTable, CommentsThatSayTooLittle) {
  MaterialTable table;
  using Edit = MaterialTable::Edit;
  EXPECT_EQ(table.edit("o=0, pd=0.5", 1), Edit::kIncomplete);
  EXPECT_EQ(table.complaint(), "ph, ch, fr");
  EXPECT_EQ(table.current().pierce_delay_s, 0.5);
  EXPECT_EQ(table.current().kerf_width_mm, 1) << "the default's";
  for (const char* text :
       {"o=3, ph=1", "o=", "o=0, ph=1e999", "o=0, fr=nan", "o=0, fr=0x",
        "o=1, na=b, ph=1, pd=1, ch=1, fr=1", "o=1, nu=1000000, na=x", "o=1, nu=1.5"}) {
    EXPECT_EQ(table.edit(text, 1), Edit::kMalformed) << text;
  }
  EXPECT_EQ(table.rows().size(), 2U) << "nothing was changed";
}

TEST(MaterialTable, EndlessChangesStayWithinBounds) {
  MaterialTable table;
  for (int i = 0; i < 70'000; ++i) table.edit("o=0, ph=1, pd=1, ch=1, fr=1", 1);
  EXPECT_EQ(table.rows().size(), MaterialTable::kMaxRows);
  EXPECT_EQ(table.current().number, 1'069'999);
}

TorchText scan(std::string_view text, std::size_t piece = 1'000'000) {
  TorchTextScanner scanner;
  while (!text.empty()) {
    std::size_t end = text.find('\n', std::min(piece, text.size()) - 1);
    end = end == text.npos ? text.size() : end + 1;
    scanner.add(text.substr(0, end));
    text.remove_prefix(end);
  }
  return scanner.take();
}

TEST(TorchText, TellsQtPlasmacPrograms) {
  EXPECT_FALSE(scan("G21\n(tool o=0)\n#<feed> = 3\nG1 (o=0, but not first) X1\n").is_qtplasmac);
  EXPECT_TRUE(scan("G21\nn10 (o=0, ph=1)\n").is_qtplasmac);
  EXPECT_TRUE(scan("F#<_HAL[qtplasmac.cut_feed_rate-f]>\n").is_qtplasmac);
  EXPECT_FALSE(scan("\nF#<_hal[motion.x]>\n").is_qtplasmac);
  for (const char* const torch :
       {"#<holes>=4\nM3 $0 S1\n", "m3s1\n#<holes>=4\n", "#<oclength>=3\nN20 S1 M03\n",
        "M190 P2\nG0 X1\nM3 S1 (torch)\n", "#<pierce-only>=1\nm190 p1 \n"}) {
    EXPECT_TRUE(scan(torch).is_qtplasmac) << torch;
    EXPECT_TRUE(scan(torch, 1).is_qtplasmac) << torch;
  }
  for (const char* const mill :
       {"#<holes>=4\nM3 S8000\n", "#<holes>=4\n#<h_diameter>=6\nM3 S1000\n", "M3 $0 S1\n",
        "M190 P2\nM3 S800\n", "#<holes>=4\n(M3 S1)\nM30 S1\n", "#<holes>=4\n;M190 P1\nM190\n",
        "#<holes>=4\nM3 S1.5\nM33 $1\n"}) {
    EXPECT_FALSE(scan(mill).is_qtplasmac) << mill;
  }
  EXPECT_EQ(scan("\nF#<_hal[motion.x]>\n").hal_line, 2U);
  EXPECT_EQ(scan("G0\n\nF#<_hal[plasmac.x]>\nG0\n", 1).hal_line, 3U);
}

TEST(TorchText, ModesHoldFromTheirLineOn) {
  for (const std::size_t piece : {1U, 7U, 1'000'000U}) {
    const TorchText text = scan(
        "G21\n#<holes> = 4 (with overburn)\nG0\n  N30 #<H_Diameter>=20;mm\n#<h_velocity>=50\n"
        "#<oclength>=0\n#<other>=1\n#<holes>=[1+1]\nG1 X#<holes>\n#<holes>=0\n#<pierce-only>=1\n"
        "M3 $0 S1\n",
        piece);
    EXPECT_TRUE(text.is_qtplasmac);
    ASSERT_EQ(text.changes.size(), 6U);
    EXPECT_EQ(text.modes_at(1), FilterModes{});
    EXPECT_EQ(text.modes_at(2), (FilterModes{true, true, true, false, -1, 60, -1}));
    EXPECT_EQ(text.modes_at(4), (FilterModes{true, true, true, false, 20, 60, -1}));
    EXPECT_EQ(text.modes_at(9), (FilterModes{true, true, true, false, 20, 50, 0}));
    EXPECT_EQ(text.modes_at(10), (FilterModes{false, false, false, false, 20, 50, 0}));
    EXPECT_EQ(text.modes_at(999), (FilterModes{false, false, false, true, 20, 50, 0}));
  }
}

TEST(TorchText, WhatHasBeenFilteredIsNotFilteredAgain) {
  const TorchText text = scan("#<holes>=4\nM3 $0 S1\nG0 X1\n;qtplasmac filtered G-code file\n");
  EXPECT_TRUE(text.is_qtplasmac);
  EXPECT_TRUE(text.is_filtered);
  EXPECT_TRUE(text.changes.empty());
  EXPECT_TRUE(scan(";conversational block\n#<holes>=4\n").changes.empty());
}

bool is_on(const char* trigger, const Motion& motion) {
  const auto parsed = BeamTrigger::parse(trigger);
  EXPECT_TRUE(parsed) << trigger;
  return parsed && parsed->on(motion);
}

TEST(BeamTrigger, Conditions) {
  Motion motion;
  motion.kind = MotionKind::kFeed;
  EXPECT_FALSE(BeamTrigger().on(motion));
  motion.torch.spindles_on = 2;
  EXPECT_TRUE(BeamTrigger().on(motion));
  EXPECT_TRUE(is_on("m3", motion));
  EXPECT_TRUE(is_on("M3 : 1", motion));
  EXPECT_FALSE(is_on("m3:0", motion));
  EXPECT_FALSE(is_on("plasmac", motion));
  motion.torch.spindles_on = 1;
  EXPECT_TRUE(is_on("plasmac", motion));
  motion.torch.outputs = 8;
  EXPECT_FALSE(is_on("plasmac", motion));
  EXPECT_TRUE(is_on("m62:3", motion));
  EXPECT_FALSE(is_on("m64:2", motion));
  motion.torch.outputs = std::uint64_t{1} << 63;
  EXPECT_TRUE(is_on("m62:63", motion));
  EXPECT_FALSE(is_on("laser", motion)) << "S0";
  motion.spindle_rpm = 3;
  EXPECT_TRUE(is_on("laser", motion));
  motion.kind = MotionKind::kTraverse;
  EXPECT_FALSE(is_on("laser", motion));
  EXPECT_TRUE(is_on("m3+!feed", motion));
  EXPECT_FALSE(is_on("m67:1", motion));
  motion.torch.analog[1] = 0.5F;
  EXPECT_TRUE(is_on("m68:1", motion));
  EXPECT_FALSE(is_on("m7", motion) || is_on("m8", motion) || is_on("m4", motion));
  motion.mist = motion.flood = true;
  motion.spindle = SpindleState::kCounterclockwise;
  EXPECT_TRUE(is_on("m7+m8+m4+s", motion));
  motion.from_mm.z = -1;
  motion.to_mm.z = 0.5;
  EXPECT_TRUE(is_on("z<0.5", motion));
  EXPECT_FALSE(is_on("z<0.4", motion)) << "both ends";
}

TEST(BeamTrigger, WhatIsNone) {
  for (const char* text :
       {"", "+", "m3+", "m5", "m3:8", "m3:", "m3:-1", "m62", "m62:64", "m67:4", "m7:0", "z<",
        "z<nan", "z<1e9", "z<1x", "!!m3", "plasmac+s", "s+s+s+s+s+s+s+s+s+s+s+s+s+s+s+s+s"}) {
    EXPECT_FALSE(BeamTrigger::parse(text)) << text;
  }
  EXPECT_FALSE(BeamTrigger::parse(std::string(100'000, 's')));
  EXPECT_EQ(BeamTrigger::parse("m3+m99").error(),
            "beam trigger 'm3+m99': 'm99' is none; allowed are m3, m3:0 to m3:7, m4, m7, m8, "
            "m62:0 to m62:63, m67:0 to m67:3, s, feed and z<LEVEL in mm, joined by + and inverted "
            "by !; or plasmac, laser");
}

TEST(TorchState, VelocityPercentAndTool) {
  TorchState torch;
  EXPECT_EQ(torch.velocity_percent(), 100);
  for (const auto& [given, taken] :
       {std::pair{9.0F, 100.0}, {10.0F, 10.0}, {60.0F, 60.0}, {100.0F, 100.0}, {150.0F, 100.0}}) {
    torch.analog[3] = given;
    EXPECT_EQ(torch.velocity_percent(), taken);
  }
  EXPECT_EQ(torch_tool(torch), TorchTool::kNone);
  torch.spindles_on = 4;
  EXPECT_EQ(torch_tool(torch), TorchTool::kSpotting);
  torch.spindles_on = 3;
  EXPECT_EQ(torch_tool(torch), TorchTool::kPlasma);
  torch.outputs = 8;
  EXPECT_EQ(torch_tool(torch), TorchTool::kScribe);
  EXPECT_TRUE(torch.thc_enabled());
  EXPECT_FALSE(torch.torch_enabled());
}

}  // namespace
}  // namespace kerf
