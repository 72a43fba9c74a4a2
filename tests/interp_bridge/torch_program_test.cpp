// Torch programs to motions, by kerf-interp and, where it can, by the text of rs274.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "interp_bridge/beam_trigger.h"
#include "tests/interp_bridge/program_test_support.h"

namespace kerf {
namespace {

constexpr const char* kFeedOfMaterial = "F#<_hal[plasmac.cut-feed-rate]>\n";

struct TorchRunResult : ProgramRun {
  std::vector<TorchMaterial> materials;
  bool qtplasmac = false;

  const TorchMaterial& material(std::size_t motion) const {
    return materials.at(motions.at(motion).torch.material);
  }
};

class TorchProgram : public ::testing::Test {
 protected:
  TorchRunResult run(const std::string& text, bool by_text = false) {
    options_.path = folder_.write("part.ngc", text);
    return run_file(by_text);
  }
  TorchRunResult run_file(bool by_text = false) {
    options_.interpreter = by_text ? InterpreterChoice::kText : InterpreterChoice::kBridge;
    options_.kerf_interp_path = KERF_INTERP_EXECUTABLE;
    TorchRunResult result;
    const auto program = Program::open(options_, result.diagnostics);
    if (program == nullptr) return result;
    result.opened = true;
    result.qtplasmac = program->is_qtplasmac();
    const MotionSink sink = [&](std::span<const Motion> batch) {
      for (const Motion& motion : batch) {
        EXPECT_LT(motion.torch.material, program->materials().size());
        result.motions.push_back(motion);
      }
      return true;
    };
    result.summary = program->run(sink, {}, result.diagnostics);
    result.materials = program->materials();
    return result;
  }
  /// The same on both interpreters.
  void both(const std::string& text, const std::function<void(const TorchRunResult&)>& expect) {
    for (const bool by_text : {false, true}) {
      SCOPED_TRACE(by_text ? "text" : "bridge");
      expect(run(text, by_text));
    }
  }

  TestFolder folder_;
  ProgramOptions options_;
};

TEST_F(TorchProgram, OutputsTakeEffectWithTheNextMove) {
  both(
      "G21 G0 X0 Y0\nM62 P2\nM67 E3 Q60\nG4 P0.1\nG1 X1 F100\nM63 P2\nM64 P63\nG4 P0.1\nG0 X2\n"
      "M65 P63\nM68 E0 Q2.5\nG4 P0\nM2\n",
      [](const TorchRunResult& run) {
        ASSERT_EQ(run.messages(), "");
        ASSERT_EQ(run.motions.size(), 7U);
        const auto torch = [&](std::size_t i) { return run.motions[i].torch; };
        EXPECT_EQ(torch(0), TorchState{});
        EXPECT_EQ(torch(1), TorchState{}) << "a dwell is no move";
        EXPECT_FALSE(torch(2).thc_enabled());
        EXPECT_EQ(torch(2).velocity_percent(), 60);
        EXPECT_TRUE(torch(3).output(2) && torch(3).output(63)) << "M64 at once";
        EXPECT_FALSE(torch(4).output(2));
        EXPECT_FALSE(torch(5).output(63));
        EXPECT_EQ(torch(5).analog[0], 2.5F);
        EXPECT_FALSE(run.qtplasmac);
      });
}

TEST_F(TorchProgram, SpindlesAreTools) {
  options_.torch.qtplasmac = QtPlasmacChoice::kOn;
  const TorchRunResult run = this->run(
      "G21 G0 X0 Y0\nM3 $0 S1\nG1 X1 F100\nM5 $0\nG0 X2\nM3 $1 S1\nG1 X3\nM5 $1\nM3 $2 S1\nG1 X4\n"
      "M5 $-1\nG0 X5\nM2\n");
  using Tool = TorchTool;
  const std::vector<Tool> expected = {Tool::kNone,     Tool::kPlasma, Tool::kNone, Tool::kScribe,
                                      Tool::kSpotting, Tool::kNone,   Tool::kNone};
  ASSERT_EQ(run.motions.size(), expected.size()) << run.messages();
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(torch_tool(run.motions[i].torch), expected[i]) << i;
  }
  options_.torch.qtplasmac = QtPlasmacChoice::kAuto;
  EXPECT_TRUE(has_error(this->run("M3 $1 S1\nM2\n").diagnostics)) << "others have one spindle";
}

TEST_F(TorchProgram, AdaptiveFeed) {
  both("G21 G0 X0 Y0\nM52 P1\nG1 X6 F100\nM52 P0\nG1 X7\nM2\n", [](const TorchRunResult& run) {
    ASSERT_EQ(run.messages(), "");
    ASSERT_EQ(run.motions.size(), 4U);
    EXPECT_TRUE(run.motions[1].torch.adaptive_feed);
    EXPECT_FALSE(run.motions[2].torch.adaptive_feed);
  });
}

TEST_F(TorchProgram, PinsWithoutAnyFileAreQtPlasmacsOwn) {
  const TorchRunResult run = this->run(std::string("G21 G64 P0.1\n") + kFeedOfMaterial +
                                       "G0 X0 Y0\nG1 X#<_hal[plasmac.float-switch-travel]>\n"
                                       "G1 X#<_hal[qtplasmac.kerf_width-f]>\nM2\n");
  EXPECT_EQ(run.messages(),
            options_.path +
                ":2: note: no file tells of the material; QtPlasmaC's own default is taken (4000 "
                "mm/min, kerf 1 mm, cut at 1 mm, pierced at 3 mm for 0 s)\n   hint: QtPlasmaC "
                "keeps its materials in MACHINE_material.cfg beside the INI\n");
  ASSERT_EQ(run.motions.size(), 4U);
  EXPECT_TRUE(run.qtplasmac);
  EXPECT_EQ(run.motions[1].feed_mm_per_min, 4000);
  EXPECT_EQ(run.motions[1].to_mm.x, 1.5);
  EXPECT_EQ(run.motions[2].to_mm.x, 1);
}

TEST_F(TorchProgram, FeedAndKerfAreConvertedToTheProgramsUnit) {
  const std::string text = std::string("G20 G64 P0.1\n") + kFeedOfMaterial +
                           "G0 X0 Y0\nG1 X#<_hal[qtplasmac.kerf_width-f]>\n"
                           "G1 X#<_hal[plasmac.float-switch-travel]>\nM2\n";
  const TorchRunResult run = this->run(text);
  ASSERT_EQ(run.motions.size(), 4U);
  EXPECT_NEAR(run.motions[1].feed_mm_per_min, 4000, 1e-9);
  EXPECT_NEAR(run.motions[1].to_mm.x, 1, 1e-12);
  EXPECT_NEAR(run.motions[2].to_mm.x, 1.5 * 25.4, 1e-12) << "as it stands on the pin";
  options_.machine.inch_machine = true;
  const TorchRunResult inch = this->run(text);
  ASSERT_EQ(inch.motions.size(), 4U);
  EXPECT_NEAR(inch.motions[1].feed_mm_per_min, 4000, 1e-9);
  EXPECT_NEAR(inch.motions[2].to_mm.x, 1.5, 1e-12);
  // The filter has written the conversion into the text.
  options_.machine.inch_machine = false;
  const TorchRunResult filtered = this->run(
      "G20 G64 P0.1\nF[#<_hal[plasmac.cut-feed-rate]>*0.03937]\nG0 X0 Y0\nG1 X1\nM2\n"
      ";qtplasmac filtered G-code file\n");
  ASSERT_EQ(filtered.motions.size(), 3U);
  EXPECT_NEAR(filtered.motions[1].feed_mm_per_min, 4000 * 0.03937 * 25.4, 1e-9);
}

TEST_F(TorchProgram, GivenPinsComeFirst) {
  options_.torch.hal_values = {{"plasmac.cut-feed-rate", 777}, {"my.pin", 5}};
  const TorchRunResult run =
      this->run(std::string(kFeedOfMaterial) + "G0 X0 Y0\nG1 X#<_hal[my.pin]>\nM2\n");
  ASSERT_EQ(run.motions.size(), 3U);
  EXPECT_EQ(run.motions[1].feed_mm_per_min, 777);
  EXPECT_EQ(run.motions[1].to_mm.x, 5);
  options_.torch.hal_values.clear();
  const TorchRunResult unknown = this->run("G0 X0 Y0\nG1 X#<_hal[my.pin]> F1\nM2\n");
  EXPECT_NE(unknown.messages().find("my.pin"), std::string::npos);
  EXPECT_TRUE(has_error(unknown.diagnostics));
}

TEST_F(TorchProgram, TheTextInterpreterSaysThatItCannot) {
  EXPECT_EQ(this->run(std::string("G21\n\n") + kFeedOfMaterial + "M2\n", true).messages(),
            folder_.path("part.ngc") +
                ":3: error: Named parameter #<_hal[plasmac.cut-feed-rate]> not defined\n"
                "     3 | F#<_hal[plasmac.cut-feed-rate]>\n   hint: a dry run has no HAL; of its "
                "pins kerf-interp (--interp bridge) knows those of QtPlasmaC, and those that "
                "--hal PIN=VALUE names; rs274 none\n");
  EXPECT_EQ(this->run("G21\nM190 P1\nM2\n", true).messages(),
            folder_.path("part.ngc") +
                ":2: error: Unknown m code used: M190\n     2 | M190 P1\n   hint: kerf-interp "
                "(--interp bridge) takes it as QtPlasmaC's change of material\n");
}

TEST_F(TorchProgram, MaterialsOfAFileByM190) {
  options_.torch.materials_path = folder_.write(
      "m.cfg",
      "[MATERIAL_NUMBER_3]\nNAME=three\nKERF_WIDTH=1.5\nPIERCE_HEIGHT=3\nPIERCE_DELAY=0.4\n"
      "CUT_HEIGHT=1.2\nCUT_SPEED=1234\n");
  const TorchRunResult run =
      this->run(std::string("G21 G64 P0.1\nG0 X0 Y0\nM190 P3\nM66 P3 L3 Q1\n") + kFeedOfMaterial +
                "M3 $0 S1\nG1 X1\nM5 $0\nM190 P-1\n" + kFeedOfMaterial + "G1 X2\nM190 P8\n" +
                kFeedOfMaterial + "G1 X3\nM159 P1\nM2\n");
  EXPECT_EQ(
      run.messages(),
      options_.path +
          ":12: warning: M190 P8: there is no material 8; the default's values are taken "
          "(4000 mm/min, kerf 1 mm, cut at 1 mm, pierced at 3 mm for 0 s)\n   hint: QtPlasmaC "
          "keeps its materials in MACHINE_material.cfg beside the INI\n");
  ASSERT_EQ(run.motions.size(), 5U);
  EXPECT_EQ(run.material(1).number, 3);
  EXPECT_EQ(run.material(1).name, "three");
  EXPECT_EQ(run.material(1).pierce_delay_s, 0.4);
  EXPECT_EQ(run.motions[1].feed_mm_per_min, 1234);
  EXPECT_EQ(run.material(2).number, 0);
  EXPECT_EQ(run.motions[2].feed_mm_per_min, 4000);
  EXPECT_EQ(run.material(3).number, 8);
  ASSERT_EQ(run.summary.notes.size(), 1U);
  EXPECT_EQ(run.summary.notes[0].text, "M159 P1");
  options_.torch.materials_path = folder_.path("none.cfg");
  EXPECT_EQ(this->run("M2\n").messages(), "kerf: error: cannot read " + folder_.path("none.cfg") +
                                              ": No such file or directory\n");
}

TEST_F(TorchProgram, FilesBesideTheIni) {
  options_.machine.ini_path = folder_.write(
      "table.ini", "[EMC]\nMACHINE = table\n[DISPLAY]\nDISPLAY = qtvcp qtplasmac\n[RS274NGC]\n");
  folder_.write("table_material.cfg",
                "[MATERIAL_NUMBER_1]\nKERF_WIDTH=2\nPIERCE_HEIGHT=3\nPIERCE_DELAY=0.5\n"
                "CUT_HEIGHT=1\nCUT_SPEED=999\n");
  folder_.write("table.prefs",
                "[DEFAULT MATERIAL]\nCut feed rate = 3333\n[PLASMA_PARAMETERS]\n"
                "Float Switch Travel = 2.5\n");
  const TorchRunResult run = this->run(std::string("G21\nG0 X0 Y0\n") + kFeedOfMaterial +
                                       "G1 X#<_hal[plasmac.float-switch-travel]>\nM190 P1\n" +
                                       kFeedOfMaterial + "G1 X5\nM2\n");
  EXPECT_EQ(run.messages(), "");
  ASSERT_EQ(run.motions.size(), 4U);
  EXPECT_EQ(run.motions[1].feed_mm_per_min, 3333);
  EXPECT_EQ(run.motions[1].to_mm.x, 2.5);
  EXPECT_EQ(run.motions[2].feed_mm_per_min, 999);
  // The INI alone makes it a QtPlasmaC program, with its filter's G64.
  const TorchRunResult plain = this->run("G21\nG0 X0 Y0\nG1 X1 F100\nM2\n");
  EXPECT_TRUE(plain.qtplasmac);
  EXPECT_FLOAT_EQ(plain.motions.at(1).blend_tolerance_mm, 0.1F);
  EXPECT_FLOAT_EQ(
      this->run("G21 G64 P1\nG0 X0 Y0\nG1 X1 F100\nM2\n").motions.at(1).blend_tolerance_mm, 1.0F);
  options_.torch.qtplasmac = QtPlasmacChoice::kOff;
  EXPECT_EQ(this->run("G21\nG0 X0 Y0\nG1 X1 F100\nM2\n").motions.at(1).blend_tolerance_mm, 0);
}

TEST_F(TorchProgram, MaterialComments) {
  const std::string material = "(o=0, na=Steel 3mm, ph=3.0, pd=0.1, ch=1.5, fr=3000, kw=1.2)\n";
  both("G21\nG64 P0.1\n" + material + "G0 X0 Y0\nF3000\nM3 $0 S1\nG1 X1\nM5 $0\nM2\n",
       [](const TorchRunResult& run) {
         EXPECT_EQ(run.messages(), "");
         ASSERT_EQ(run.motions.size(), 3U);
         EXPECT_EQ(run.material(1).name, "Steel 3mm");
         EXPECT_EQ(run.material(1).kerf_width_mm, 1.2);
         EXPECT_EQ(run.material(1).pierce_delay_s, 0.1);
       });
  // And the interpreter has them too; (o=1) needs an M190.
  const TorchRunResult run =
      this->run("G20\nG64 P0.1\n(o=0, ph=0.1, pd=0.1, ch=0.1, fr=100, kw=0.05)\n" +
                std::string(kFeedOfMaterial) +
                "G0 X0 Y0\nG1 X1\n(o=1, nu=5, na=five, ph=0.1, pd=0, ch=0.1, fr=200)\n" +
                kFeedOfMaterial + "G1 X2\nM190 P5\n" + kFeedOfMaterial + "G1 X3\nM2\n");
  EXPECT_EQ(run.messages(), "");
  ASSERT_EQ(run.motions.size(), 5U);
  EXPECT_NEAR(run.motions[1].feed_mm_per_min, 2540, 1e-9);
  EXPECT_NEAR(run.motions[2].feed_mm_per_min, 2540, 1e-9);
  EXPECT_NEAR(run.motions[3].feed_mm_per_min, 5080, 1e-9);
  EXPECT_EQ(run.material(3).name, "five");
}

TEST_F(TorchProgram, HolesAreSlowedAndRunOn) {
  both(
      "#<holes>=4\nG21 G64 P0.1\nG0 X20 Y10\nM3 $0 S1\nG3 I-5 F1000\nM5 $0\nG0 X50 Y0\nM3 $0 S1\n"
      "G1 X60\nG2 X70 I5\nG1 X80\nG2 I20\nM5 $0\nM2\n",
      [](const TorchRunResult& run) {
        ASSERT_EQ(run.motions.size(), 9U);
        const std::vector<Motion>& m = run.motions;
        EXPECT_EQ(m[1].torch.velocity_percent(), 60);
        EXPECT_EQ(torch_tool(m[1].torch), TorchTool::kPlasma);
        // 4 mm more, on the same circle, with the torch out.
        EXPECT_TRUE(m[2].torch.overburn);
        EXPECT_EQ(torch_tool(m[2].torch), TorchTool::kNone);
        EXPECT_EQ(m[2].source.line, 5U);
        EXPECT_NEAR(m[2].arc.sweep_rad * 5.25, 4, 1e-9) << "a quarter of the kerf counts";
        EXPECT_NEAR(glm::length(m[2].to_mm - Vec3(15, 10, 0)), 5, 1e-9);
        EXPECT_NEAR(std::atan2(m[2].to_mm.y - 10, m[2].to_mm.x - 15), 4 / 5.25, 1e-9);
        EXPECT_EQ(m[3].from_mm, m[2].to_mm);
        EXPECT_EQ(m[3].to_mm, Vec3(50, 0, 0));
        EXPECT_TRUE(m[3].torch.torch_enabled()) << "M5 gives it back";
        EXPECT_EQ(m[3].torch.velocity_percent(), 100);
        EXPECT_EQ(m[4].torch.velocity_percent(), 100);
        EXPECT_EQ(m[5].torch.velocity_percent(), 60) << "an arc";
        EXPECT_EQ(m[6].torch.velocity_percent(), 100);
        EXPECT_EQ(m[7].torch.velocity_percent(), 100) << "40 mm is no hole";
      });
}

TEST_F(TorchProgram, HoleLimitsAndModes) {
  const auto circle = [&](const std::string& modes, const std::string& unit = "G21") {
    const TorchRunResult run = this->run(
        modes + unit + " G64 P0.1\nG0 X2 Y2\nM3 $0 S1\nG2 I1 F100\nM5 $0\nG0 X0 Y0\nM2\n");
    return std::pair(run.motions.size(), run.motions.at(1).torch.velocity_percent());
  };
  using Pair = std::pair<std::size_t, double>;
  EXPECT_EQ(circle(""), Pair(4, 100));
  EXPECT_EQ(circle("#<holes>=0\n"), Pair(4, 100));
  EXPECT_EQ(circle("#<holes>=1\n"), Pair(4, 60));
  EXPECT_EQ(circle("#<holes>=2\n#<h_velocity>=30\n"), Pair(5, 30));
  EXPECT_EQ(circle("#<holes>=2\n#<oclength>=0\n"), Pair(4, 60));
  EXPECT_EQ(circle("#<holes>=2\n#<h_diameter>=2.5\n"), Pair(5, 60)) << "half of a kerf of 1 counts";
  EXPECT_EQ(circle("#<holes>=2\n#<h_diameter>=2.4\n"), Pair(4, 100));
  EXPECT_EQ(circle("#<holes>=2\n", "G20"), Pair(4, 100)) << "2 in is no hole";
  const TorchRunResult compensated = this->run(
      "#<holes>=2\nG21 G64 P0.1 F100\nG0 X1 Y1\nM3 $0 S1\nG41.1 D0.1\nG1 X5 Y1\nG1 X10\nG2 J-5\nG1 "
      "X15\nG40\n"
      "M5 $0\nM2\n");
  EXPECT_FALSE(has_error(compensated.diagnostics)) << compensated.messages();
  for (const Motion& motion : compensated.motions) {
    EXPECT_EQ(motion.torch.velocity_percent(), 100);
    EXPECT_FALSE(motion.torch.overburn);
  }
}

TEST_F(TorchProgram, AnArcBehindAnOverburnBeginsAtTheCirclesEnd) {
  const TorchRunResult run = this->run(
      "#<holes>=2\nG21 G64 P0.1\nG0 X20 Y10\nM3 $0 S1\nG3 I-5 F1000\nG3 X10 I-5\nM5 $0\nM2\n");
  ASSERT_EQ(run.motions.size(), 6U);
  EXPECT_EQ(run.motions[3].kind, MotionKind::kFeed);
  EXPECT_EQ(run.motions[3].to_mm, Vec3(20, 10, 0));
  EXPECT_EQ(run.motions[4].from_mm, Vec3(20, 10, 0));
  EXPECT_NEAR(run.motions[4].arc.sweep_rad, kPi, 1e-9);
}

TEST_F(TorchProgram, OnlyPierces) {
  both(
      "#<pierce-only>=1\nG21 G64 P0.1\nG0 X1 Y1\nM3 $0 S1\nG1 X5 F100\nG3 X9 I2\nM5 $0\nG0 X20\n"
      "M3 $0 S1\nG2 I3\nM5 $0\nM2\n",
      [](const TorchRunResult& run) {
        ASSERT_EQ(run.motions.size(), 5U);
        const std::vector<Motion>& m = run.motions;
        for (const std::size_t pierce : {1U, 3U}) {
          EXPECT_EQ(m[pierce].kind, MotionKind::kFeed);
          EXPECT_EQ(m[pierce].from_mm, m[pierce].to_mm);
          EXPECT_EQ(torch_tool(m[pierce].torch), TorchTool::kPlasma);
        }
        EXPECT_EQ(m[2].from_mm, Vec3(1, 1, 0));
        EXPECT_EQ(m[2].to_mm, Vec3(20, 1, 0));
      });
}

// ---- Samples
// ------------------------------------------------------------------------------------

struct Sample {
  const char* name;
  const char* trigger;
  double cut_mm;  ///< way with the beam on, in XY
  int pierces;
  const char* error;  ///< in what LinuxCNC says to it; "": none
};

struct Cut {
  double length_mm = 0;
  int pierces = 0;
};

Cut cut_of(const TorchRunResult& run, const BeamTrigger& trigger) {
  Cut cut;
  bool was_on = false;
  for (const Motion& m : run.motions) {
    const bool on = trigger.on(m);
    if (on && !was_on) ++cut.pierces;
    was_on = on;
    if (!on || !m.start_known) continue;
    const Vec2 way(m.to_mm.x - m.from_mm.x, m.to_mm.y - m.from_mm.y);
    const Vec2 radius(m.from_mm.x - m.arc.center_mm.x, m.from_mm.y - m.arc.center_mm.y);
    cut.length_mm += m.kind == MotionKind::kArc ? glm::length(radius) * std::abs(m.arc.sweep_rad)
                                                : glm::length(way);
  }
  return cut;
}

TEST_F(TorchProgram, SamplesOfTheSharedData) {
  if (shared_data().empty()) GTEST_SKIP() << "KERF_SHARED_DATA is not set";
  static const std::vector<Sample> kSamples = {
      {"CAMotics__la_peinture.gc", "laser", 20294.0, 19779, ""},
      {"CNCLib__Examples_BlumeDesLebens.nc", "m3+z<0", 6837.4, 151, ""},
      {"FluidNC__raster_tree.nc", "laser", 17985.0, 1084, ""},
      {"Projects_DIY__Birthchart.ngc", "m3", 0.0, 1, ":19: error: bad number format"},
      {"cinva_ram__combined_lid_wing_and_opening_catch_x2.gcode", "m3", 4314.5, 29, ""},
      {"cinva_ram__inkscape_combined_lid_wing_and_opening_catch_x2.ngc", "m3", 1173.3, 2,
       ":254: error: Unclosed comment found"},
      {"cinva_ram__length_side_x2.ngc", "m3", 2318.2, 11, ""},
      {"cnc-router-machine__puzzle01.gcode", "m3+z<0", 620.8, 1, ""},
      {"linuxcnc__metric_air_scribe.ngc", "m3:1", 136.1, 8, ""},
      {"linuxcnc__metric_circles.ngc", "plasmac", 942.5, 3, ""},
      {"linuxcnc__metric_material_change.ngc", "plasmac", 400.0, 4, ""},
      {"linuxcnc__metric_pipe.ngc", "plasmac", 1031.8, 2, ""},
      {"linuxcnc__metric_wrench.ngc", "plasmac", 408.6, 2, ""},
  };
  for (const Sample& sample : kSamples) {
    SCOPED_TRACE(sample.name);
    options_.path = (shared_data() / "nc/sheet" / sample.name).string();
    const TorchRunResult run = run_file();
    const auto trigger = BeamTrigger::parse(sample.trigger);
    ASSERT_TRUE(run.opened && trigger);
    EXPECT_EQ(has_error(run.diagnostics), *sample.error != 0) << run.messages();
    EXPECT_NE(run.messages().find(sample.error), std::string::npos) << run.messages();
    const Cut cut = cut_of(run, *trigger);
    EXPECT_NEAR(cut.length_mm, sample.cut_mm, 0.051);
    EXPECT_EQ(cut.pierces, sample.pierces);
  }
}

/// Those that LinuxCNC brings along.
TEST_F(TorchProgram, SamplesOfLinuxcnc) {
  const std::filesystem::path folder = "/usr/share/linuxcnc/ncfiles/plasmac";
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << folder << " is not there";
  const auto trigger = BeamTrigger::parse("m3");
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path().string());
    options_.path = entry.path().string();
    const TorchRunResult run = run_file();
    EXPECT_TRUE(run.opened && run.qtplasmac && run.summary.has_program_end);
    EXPECT_FALSE(has_error(run.diagnostics)) << run.messages();
    EXPECT_GT(cut_of(run, *trigger).length_mm, 10);
    ++count;
  }
  EXPECT_GE(count, 10);
}

}  // namespace
}  // namespace kerf
