// `kerf run` on sheets: blanks, torches, what comes out.
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

/// As QtPlasmaC's samples: a hole of 10 mm and, round it, a square of 40 mm; kerf 2 mm.
constexpr const char* kPlate =
    "G21\n"
    "(o=0, na=Steel 3mm, ph=3, pd=0.4, ch=1.5, fr=3000, kw=2)\n"
    "G64 P0.1\n"
    "F#<_hal[plasmac.cut-feed-rate]>\n"
    "G0 X50 Y50\n"
    "M3 $0 S1\n"
    "G1 X55\n"
    "G3 I-5\n"
    "M5 $0\n"
    "G0 X27 Y30\n"
    "M3 $0 S1\n"
    "G1 X30\n"
    "X70\n"
    "Y70\n"
    "X30\n"
    "Y30\n"
    "M5 $0\n"
    "G0 X0 Y0\n"
    "M2\n";

class SheetCommand : public testing::Test {
 protected:
  KerfResult run(std::vector<std::string> arguments, const std::string& command = "run") {
    arguments.insert(arguments.begin(), command);
    KerfCall call;
    call.arguments = std::move(arguments);
    call.folder = folder_.path();
    return run_kerf(call);
  }
  /// One move along X at Y10 by tool 1, listing of an interpreter: no LinuxCNC is needed.
  std::string slot() {
    return folder_.write(
        "slot.canon",
        "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
        "    2 N1     SELECT_TOOL(1)\n"
        "    3 N1     CHANGE_TOOL(1)\n"
        "    4 N3     STRAIGHT_TRAVERSE(-5.0000, 10.0000, 1.0000, 0.0000, 0.0000, 0.0000)\n"
        "    5 N4     SET_SPINDLE_SPEED(0, 1.0000)\n"
        "    6 N4     START_SPINDLE_CLOCKWISE(0)\n"
        "    7 N5     SET_FEED_RATE(600.0000)\n"
        "    8 N5     STRAIGHT_FEED(55.0000, 10.0000, 1.0000, 0.0000, 0.0000, 0.0000)\n"
        "    9 N6     STOP_SPINDLE_TURNING(0)\n"
        "   10 N7     STOP_SPINDLE_TURNING(0)\n"
        "   11 N7     PROGRAM_END()\n");
  }
  Json report(const std::string& name) {
    return Json::parse(read_file(folder_.file(name)), nullptr, false);
  }
  void expect_refused(const KerfResult& result, int code, const std::string& error) {
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_EQ(result.err, error);
    EXPECT_EQ(result.out, "");
  }
  TestFolder folder_;
};

TEST_F(SheetCommand, QtPlasmacProgramLeavesItsPart) {
  folder_.write("plate.ngc", kPlate);
  const KerfResult result =
      run({"plate.ngc", "--stock", "sheet:0,0:100,100:3", "--density", "8000", "--json", "r.json",
           "--dxf", "rest.dxf", "--svg", "rest.svg", "--stl", "rest.stl", "--pierce", "2"});
  if (result.exit_code == 4 && result.err.find("rs274") != std::string::npos) {
    GTEST_SKIP() << "no interpreter";
  }
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(listing(folder_.path()),
            "plate.ngc r.json rest-part-2.dxf rest-part-2.svg rest.dxf rest.stl rest.svg");
  const Json json = report("r.json");
  EXPECT_EQ(json["stock"]["model"], "sheet");
  const Json& sheet = json["sheet"];
  EXPECT_EQ(sheet["pierces"], 2);
  ASSERT_EQ(sheet["parts"].size(), 1U);
  const Json& part = sheet["parts"][0];
  const double hole = 3.14159265 * 6 * 6;
  EXPECT_NEAR(part["area_mm2"], 38 * 38 - hole, 0.1);
  EXPECT_NEAR(part["weight_kg"], (38 * 38 - hole) * 3 * 8e-6, 1e-5);
  EXPECT_EQ(part["line"], 16);
  EXPECT_EQ(part["file"], "plate.ngc");
  ASSERT_EQ(sheet["slugs"].size(), 1U);
  EXPECT_EQ(sheet["slugs"][0]["line"], 8);
  EXPECT_NEAR(sheet["yield"], (38 * 38 - hole) / 10000, 1e-5);
  EXPECT_GT(sheet["beam_s"], 0.8);
  EXPECT_NEAR(json["motion"]["held_s"]["pierces"], 2 * 0.4, 1e-6);
  EXPECT_NE(result.out.find(", of that piercing 0.8 s ("), std::string::npos) << result.out;
  EXPECT_EQ(json["tools"][0]["shape"], "kerf:2");
  EXPECT_NE(result.out.find("1 part, 13.31 cm2"), std::string::npos) << result.out;
  // What is left is a blank of its own.
  slot();
  const KerfResult again =
      run({"slot.canon", "--stock", "sheet:rest.dxf:3", "--kerf", "1", "--json", "a.json"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NEAR(report("a.json")["sheet"]["blank_mm2"], sheet["remaining_mm2"], 0.01);
}

TEST_F(SheetCommand, KerfsComeFromTheToolAndTheOption) {
  const std::string stock = "sheet:0,0:50,20:2";
  slot();
  ASSERT_EQ(
      run({"slot.canon", "--stock", stock, "--tool", "1=kerf:2", "--json", "t.json"}).exit_code, 0);
  // Across the whole sheet: in two.
  const Json sheet = report("t.json")["sheet"];
  EXPECT_NEAR(sheet["kerf_mm2"], 50 * 2, 1e-6);
  EXPECT_NEAR(sheet["cut_mm"], 60, 1e-6);
  ASSERT_EQ(run({"slot.canon", "--stock", stock, "--kerf", "1", "--json", "k.json"}).exit_code, 0);
  EXPECT_NEAR(report("k.json")["sheet"]["kerf_mm2"], 50, 1e-6);
  const KerfResult unknown = run({"slot.canon", "--stock", stock, "--quiet"});
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_NE(unknown.err.find("tool-undefined: the width of the kerf is not known; the moves of "
                             "tool 1 do not cut (--kerf LENGTH, or --tool N=kerf:WIDTH)"),
            std::string::npos)
      << unknown.err;
  const KerfResult dark =
      run({"slot.canon", "--stock", stock, "--kerf", "1", "--beam", "m8", "--json", "d.json"});
  EXPECT_EQ(report("d.json")["sheet"]["cut_mm"], 0);
  EXPECT_NE(dark.err.find("warning: no-beam: "), std::string::npos) << dark.err;
}

TEST_F(SheetCommand, DrawnOutlinesAreBlanks) {
  slot();
  folder_.write("l.svg",
                "<svg xmlns='http://www.w3.org/2000/svg' width='50mm' height='20mm' "
                "viewBox='0 0 50 20'><path d='M0 0H50V10H20V20H0Z'/></svg>");
  ASSERT_EQ(
      run({"slot.canon", "--stock", "sheet:l.svg:2", "--kerf", "1", "--json", "r.json"}).exit_code,
      0);
  EXPECT_NEAR(report("r.json")["sheet"]["blank_mm2"], 50 * 10 + 20 * 10, 1e-6);
}

TEST_F(SheetCommand, FaultsOfOutlinesAreTold) {
  slot();
  expect_refused(run({"slot.canon", "--stock", "sheet:none.dxf:2", "--kerf", "1"}), 4,
                 "kerf: error: --stock: none.dxf: No such file or directory\n");
  folder_.write("open.svg", "<svg><path d='M0 0H50V10'/></svg>");
  const KerfResult open = run({"slot.canon", "--stock", "sheet:open.svg:2", "--kerf", "1"});
  EXPECT_EQ(open.exit_code, 4);
  EXPECT_EQ(open.err.substr(0, 37), "kerf: error: --stock: open.svg:1: pat") << open.err;
  folder_.write("eight.svg", "<svg><path d='M0 0L50 10L50 0L0 10Z'/></svg>");
  expect_refused(run({"slot.canon", "--stock", "sheet:eight.svg:2", "--kerf", "1"}), 4,
                 "kerf: error: --stock: eight.svg: ring 1 (line 1) crosses itself at X25 Y-5\n");
  expect_refused(run({"slot.canon", "--stock", "sheet:0,0:10,10:0"}), 2,
                 "kerf: error: --stock: sheet:0,0:10,10:0: thickness: 0 is not allowed; must be "
                 "from 0.001 to 1000 (mm)\n");
}

TEST_F(SheetCommand, FaultsOfOptionsAreTold) {
  slot();
  const std::string stock = "sheet:0,0:10,10:1";
  expect_refused(
      run({"slot.canon", "--stock", stock, "--kerf", "0", "--pierce", "-1", "--slats", "x",
           "--beam", "m99", "--qtplasmac", "perhaps", "--hal", "pin"}),
      2,
      "kerf: error: --beam: beam trigger 'm99': 'm99' is none; allowed are m3, m3:0 to "
      "m3:7, m4, m7, m8, m62:0 to m62:63, m67:0 to m67:3, s, feed and z<LEVEL in mm, "
      "joined by + and inverted by !; or plasmac, laser\n"
      "kerf: error: --kerf: 0 is not allowed; must be at least 0.01 and at most 100 (mm)\n"
      "kerf: error: --pierce: -1 is not allowed; must be at least 0.01 and at most 100 (mm)\n"
      "kerf: error: --slats: 'x' is not a number; must be at least 1 and at most 10000 (mm)\n"
      "kerf: error: --qtplasmac: 'perhaps' is not allowed; must be auto, on or off\n"
      "kerf: error: --hal: 'pin' is not PIN=VALUE\n");
  expect_refused(run({"slot.canon", "--stock", stock, "--model", "zmap"}), 2,
                 "kerf: error: --model zmap: the blank is a sheet (sheet 10 x 10 x 1 mm, X0..10 "
                 "Y0..10 Z-1..0); allowed for it: sheet, auto\n");
  expect_refused(run({"slot.canon", "--stock", "box:0,0,0:1,1,1", "--model", "sheet"}), 2,
                 "kerf: error: --model sheet: the blank is not a sheet (box 1 x 1 x 1 mm, X0..1 "
                 "Y0..1 Z0..1); --stock sheet:x0,y0:x1,y1:THICKNESS is one\n");
  expect_refused(run({"slot.canon", "--model", "sheet"}), 2,
                 "kerf: error: --model sheet: there is no sheet\n"
                 "   hint: --stock sheet:x0,y0:x1,y1:THICKNESS gives one\n");
  expect_refused(run({"slot.canon", "--stock", stock, "--cell", "0.1"}), 2,
                 "kerf: error: --cell: a sheet has no cells; leave it out\n");
  expect_refused(run({"slot.canon", "--stock", "box:0,0,0:1,1,1", "--svg", "a.svg"}), 2,
                 "kerf: error: --svg: only a sheet or a turned part has outlines to write\n"
                 "   hint: --stock sheet:x0,y0:x1,y1:THICKNESS cuts from one\n");
}

/// M2 stops the spindle before it ends the program: whether the program did is seen all the same.
TEST_F(SheetCommand, BeamThatTheProgramNeverTurnsOffIsFound) {
  const std::string head =
      "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
      "    2 N1     STRAIGHT_TRAVERSE(5.0000, 10.0000, 1.0000, 0.0000, 0.0000, 0.0000)\n"
      "    3 N2     START_SPINDLE_CLOCKWISE(0)\n"
      "    4 N3     SET_FEED_RATE(600.0000)\n"
      "    5 N3     STRAIGHT_FEED(15.0000, 10.0000, 1.0000, 0.0000, 0.0000, 0.0000)\n";
  const std::string off = "    6 N4     STOP_SPINDLE_TURNING(0)\n";
  const std::string end = off +
                          "    7 N4     SET_SPINDLE_MODE(0 0.0000)\n"
                          "    8 N5     PROGRAM_END()\n";
  const auto findings = [&](const std::string& text) {
    folder_.write("end.canon", text);
    const KerfResult result =
        run({"end.canon", "--stock", "sheet:0,0:50,20:2", "--kerf", "1", "--json", "e.json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    std::string ids;
    const Json json = report("e.json");
    for (const Json& finding : json["findings"]) {
      if (finding["id"] != "over-feed") ids += finding["id"].get<std::string>() + " ";
    }
    return ids;
  };
  EXPECT_EQ(findings(head + end), "torch-left-on ");
  EXPECT_EQ(findings(head + off + end), "");
}

TEST_F(SheetCommand, TheViewDrawsIt) {
  slot();
  const std::string stock = "sheet:0,0:50,20:2";
  const KerfResult drawn = run(
      {"slot.canon", "--stock", stock, "--kerf", "1", "--png", "v.png", "--at-line", "5"}, "view");
  if (drawn.err.find("OpenGL") != std::string::npos) GTEST_SKIP() << drawn.err;
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_TRUE(file_exists(folder_.file("v.png")));
  const KerfResult rays = run(
      {"slot.canon", "--stock", stock, "--kerf", "1", "--png", "r.png", "--draw", "csg"}, "view");
  expect_refused(rays, 2, "kerf: error: --draw: a sheet is drawn by mesh alone\n");
}

constexpr const char* kTurret =
    "stations:\n"
    "  1: {punch: round:10, name: hole}\n"
    "  2: {punch: rectangle:30:5, index: true}\n"
    "punch: {trigger: m3}\n"
    "clamps:\n"
    "  - {x: 10, y: -30, width: 20, depth: 35}\n";

/// A listing, so that no LinuxCNC is needed: one hole by M3 and M5 with nothing between them.
constexpr const char* kHole =
    "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
    "    2 N1     SELECT_TOOL(1)\n"
    "    3 N1     CHANGE_TOOL(1)\n"
    "    4 N2     STRAIGHT_TRAVERSE(50.0000, 50.0000, 5.0000, 0.0000, 0.0000, 0.0000)\n"
    "    5 N3     SET_SPINDLE_SPEED(0, 1.0000)\n"
    "    6 N4     START_SPINDLE_CLOCKWISE(0)\n"
    "    7 N5     STOP_SPINDLE_TURNING(0)\n"
    "    8 N6     STRAIGHT_TRAVERSE(0.0000, 0.0000, 5.0000, 0.0000, 0.0000, 0.0000)\n"
    "    9 N7     PROGRAM_END()\n";

TEST_F(SheetCommand, PunchedSheetsAreReported) {
  folder_.write("press.yaml", kTurret);
  folder_.write("hole.canon", kHole);
  const KerfResult result =
      run({"hole.canon", "--stock", "sheet:0,0:100,100:2", "--turret", "press.yaml", "--json",
           "r.json", "--svg", "rest.svg", "--dxf", "rest.dxf"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json sheet = report("r.json")["sheet"];
  EXPECT_EQ(sheet.count("cut_mm"), 0U);
  EXPECT_EQ(sheet["punch"]["hits"], 1);
  EXPECT_EQ(sheet["punch"]["nibbled_mm"], 0);
  EXPECT_EQ(sheet["punch"]["stations"],
            Json::parse(R"([{"station":1,"name":"hole","shape":"round:10","hits":1}])"));
  EXPECT_NEAR(sheet["kerf_mm2"], 3.14159265 * 25, 0.02);
  EXPECT_EQ(report("r.json")["tools"][0]["shape"], "punch:round:10");
  EXPECT_NE(result.out.find("sheet     1 hit\n"
                            "          station 1   round:10, 1 hit (hole)\n"),
            std::string::npos)
      << result.out;
  EXPECT_EQ(listing(folder_.path()), "hole.canon press.yaml r.json rest.dxf rest.svg");
  // What is left is a blank of its own.
  const KerfResult again = run({"hole.canon", "--stock", "sheet:rest.dxf:2", "--turret",
                                "press.yaml", "--json", "a.json", "--quiet"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(report("a.json")["findings"][0]["id"], "hit-in-air") << again.out;
}

TEST_F(SheetCommand, PunchProgramsOfEveryTriggerByTheInterpreter) {
  const std::vector<std::array<std::string, 3>> cases{
      {"m3", "G0 X50 Y50 Z5\nS1\nM3\nM5\nG0 X70\nM3 G4 P0.1\nM5\n", "2"},
      {"m64:0", "G0 X50 Y50 Z5\nM64 P0\nM65 P0\nG0 X70\nM64 P0\nM65 P0\n", "2"},
      {"m62:0", "G0 X50 Y50 Z5\nM62 P0\nG0 X70\nM63 P0\nG0 X80\n", "1"},
      {"m101", "G0 X50 Y50 Z5\nM101\nG0 X70\nM101\nG91 G0 X10\nM101\n", "3"},
      {"g81", "G0 X50 Y50 Z5\nF500\nG98 G81 X50 Y50 Z-1 R1\nX65\nX80\nG80\n", "3"},
      {"z<0", "G0 X50 Y50 Z5\nF500\nG81 X50 Y50 Z-1 R1 L3\nG80\nG1 Z-0.5\nG0 Z5\n", "4"},
  };
  for (const auto& [trigger, program, hits] : cases) {
    folder_.write("press.yaml", "stations: {1: round:6}\npunch: {trigger: '" + trigger + "'}\n");
    folder_.write("part.ngc", "G21 G90\nT1 M6\n" + program + "M2\n");
    const KerfResult result = run({"part.ngc", "--stock", "sheet:0,0:100,100:2", "--turret",
                                   "press.yaml", "--json", "r.json", "--interp", "bridge"});
    if (result.exit_code == 4 && result.err.find("kerf-interp") != std::string::npos) {
      GTEST_SKIP() << "no interpreter";
    }
    EXPECT_LE(result.exit_code, 1) << trigger << ": " << result.err;
    EXPECT_EQ(report("r.json")["sheet"]["punch"]["hits"], std::stoi(hits)) << trigger;
    EXPECT_EQ(result.err.find("not-simulated"), std::string::npos) << result.err;
  }
}

TEST_F(SheetCommand, FaultsOfPunchingAreTold) {
  folder_.write("hole.canon", kHole);
  folder_.write("press.yaml", "stations: {1: round:6}\npunch: {trigger: m99}\n");
  const std::string stock = "sheet:0,0:100,100:2";
  const KerfResult fault = run({"hole.canon", "--stock", stock, "--turret", "press.yaml"});
  EXPECT_EQ(fault.exit_code, 2);
  EXPECT_EQ(fault.err.find("press.yaml:2:18: error: punch.trigger: 'm99' is no trigger"), 0U)
      << fault.err;
  folder_.write("press.yaml", kTurret);
  expect_refused(run({"hole.canon", "--stock", "box:0,0,-5:9,9,0", "--turret", "press.yaml"}), 2,
                 "kerf: error: --turret: only a sheet can be punched; the blank is box 9 x 9 x 5 "
                 "mm, X0..9 Y0..9 Z-5..0\n"
                 "   hint: --stock sheet:x0,y0:x1,y1:THICKNESS gives a sheet\n");
  expect_refused(run({"hole.canon", "--stock", stock, "--turret", "press.yaml", "--kerf", "1"}), 2,
                 "kerf: error: --kerf: is for torches, lasers and jets; --turret punches\n");
  expect_refused(
      run({"hole.canon", "--stock", stock, "--turret", "press.yaml", "--path", "planned"}), 2,
      "kerf: error: --path: planned is for cutting; a punch strikes where the program says\n");
}

}  // namespace
}  // namespace kerf
