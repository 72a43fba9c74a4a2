// `kerf run` from the outside: exit codes, outputs, summary. Saved listings need no LinuxCNC.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

/// A slot of 20 mm, 1 mm deep, along X by tool 1; `tail` follows before the end.
std::string listing_text(const std::string& tail = "") {
  return "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
         "    2 N1     SELECT_TOOL(1)\n"
         "    3 N1     CHANGE_TOOL(1)\n"
         "    4 N2     SET_SPINDLE_SPEED(0, 1000.0000)\n"
         "    5 N2     START_SPINDLE_CLOCKWISE(0)\n"
         "    6 N3     STRAIGHT_TRAVERSE(0.0000, 0.0000, 5.0000, 0.0000, 0.0000, 0.0000)\n"
         "    7 N4     SET_FEED_RATE(300.0000)\n"
         "    8 N4     STRAIGHT_FEED(0.0000, 0.0000, -1.0000, 0.0000, 0.0000, 0.0000)\n"
         "    9 N5     STRAIGHT_FEED(20.0000, 0.0000, -1.0000, 0.0000, 0.0000, 0.0000)\n" +
         tail +
         "   11 N7     STRAIGHT_TRAVERSE(20.0000, 0.0000, 5.0000, 0.0000, 0.0000, 0.0000)\n"
         "   12 N8     PROGRAM_END()\n";
}

const std::string kRapidAcross =
    "   10 N6     STRAIGHT_TRAVERSE(20.0000, 10.0000, -1.0000, 0.0000, 0.0000, 0.0000)\n";

class RunCommand : public testing::Test {
 protected:
  KerfResult run(std::vector<std::string> arguments, const std::string& input = "") {
    arguments.insert(arguments.begin(), "run");
    KerfCall call;
    call.arguments = std::move(arguments);
    call.folder = folder_.path();
    call.input = input;
    return run_kerf(call);
  }
  Json json(const std::string& name) {
    return Json::parse(read_file(folder_.file(name)), nullptr, false);
  }
  std::vector<std::string> slot(std::vector<std::string> more) {
    folder_.write("slot.canon", listing_text());
    std::vector<std::string> all = {
        "slot.canon", "--stock", "box:-5,-5,-5:25,15,0", "--tool", "1=flat:6", "--cell", "0.1"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  TestFolder folder_;
};

TEST_F(RunCommand, CleanRunLeavesItsOutputsAndExitCodeZero) {
  const KerfResult result =
      run(slot({"--json", "r.json", "--stl", "p.stl", "--ply", "p.ply", "--state", "p.kerf"}));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(listing(folder_.path()), "p.kerf p.ply p.stl r.json slot.canon");
  const Json report = json("r.json");
  EXPECT_EQ(report["schema"], "kerf-report/1");
  EXPECT_EQ(report["partial"], false);
  EXPECT_EQ(report["program"]["interpreter"], "canon");
  EXPECT_EQ(report["program"]["canonical_commands"]["STRAIGHT_FEED"], 2);
  // A slot of 6 mm with round ends, 1 mm deep: within half a cell along its outline.
  const double outline = 40 + 3.14159265 * 6;
  EXPECT_NEAR(report["stock"]["removed_mm3"].get<double>(), 20 * 6 + 3.14159265 * 9,
              outline * 0.05);
  EXPECT_EQ(report["tools"][0]["shape"], "flat:6");
  EXPECT_NEAR(report["motion"]["feed_mm"].get<double>(), 26, 1e-6);
  EXPECT_EQ(result.out.rfind("verdict   slot.canon: no findings\n", 0), 0U) << result.out;
}

TEST_F(RunCommand, UntilALineIsAPartOfTheProgramAndNoFinding) {
  const KerfResult result = run(slot({"--until-line", "4", "--json", "r.json"}));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "") << "that the end was not reached is what was asked for";
  const Json report = json("r.json");
  EXPECT_EQ(report["partial"], false);
  EXPECT_EQ(report["program"]["until_line"], 4);
  EXPECT_EQ(report["motion"]["moves"], 2);
  EXPECT_NEAR(report["stock"]["removed_mm3"].get<double>(), 3.14159265 * 9, 1);
  EXPECT_NE(result.out.find("lines     run until line 4\n"), std::string::npos) << result.out;
}

TEST_F(RunCommand, FromALineTheSameWorkpieceAndAReportOfTheRest) {
  folder_.write("rapid.canon", listing_text(kRapidAcross));
  const std::vector<std::string> common = {
      "rapid.canon", "--stock", "box:-5,-5,-5:25,15,0", "--tool", "1=flat:6", "--cell", "0.1"};
  std::vector<std::string> whole = common, late = common, later = common;
  whole.insert(whole.end(), {"--json", "whole.json"});
  late.insert(late.end(), {"--json", "late.json", "--from-line", "5"});
  later.insert(later.end(), {"--json", "later.json", "--from-line", "7"});
  EXPECT_EQ(run(whole).exit_code, 1);
  EXPECT_EQ(run(late).exit_code, 1);
  EXPECT_EQ(run(later).exit_code, 0) << "the rapid through the part lies before";
  const Json all = json("whole.json"), rest = json("late.json"), end = json("later.json");
  EXPECT_EQ(all["stock"], rest["stock"]);
  EXPECT_EQ(all["stock"], end["stock"]);
  EXPECT_EQ(all["findings"], rest["findings"]) << "the clock runs from the program's start";
  EXPECT_EQ(rest["program"]["from_line"], 5);
  EXPECT_EQ(rest["motion"]["moves"], 3);
  EXPECT_NEAR(rest["motion"]["feed_mm"].get<double>(), 20, 1e-6);
  EXPECT_LT(rest["tools"][0]["removed_mm3"], all["tools"][0]["removed_mm3"]);
  EXPECT_EQ(end["findings_total"], 0);
  EXPECT_EQ(end["motion"]["feed_moves"], 0);
}

TEST_F(RunCommand, FromALineThatIsNotReached) {
  const KerfResult result = run(slot({"--from-line", "90"}));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(
      result.err,
      "slot.canon: warning: line-not-reached: --from-line: the program runs no move of line 90 "
      "or beyond; nothing is reported\n");
  EXPECT_EQ(run(slot({"--from-line", "9", "--until-line", "8"})).err,
            "kerf: error: --from-line: 9 lies beyond --until-line 8\n");
}

TEST_F(RunCommand, DrawsAPicture) {
  KerfCall call;
  call.arguments = slot({"--png", "slot.png"});
  call.arguments.insert(call.arguments.begin(), "run");
  call.folder = folder_.path();
  const KerfResult result = run_kerf(call);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(read_file(folder_.file("slot.png")).substr(0, 8), "\x89PNG\r\n\x1a\n");
}

TEST_F(RunCommand, FindingsAreSaidAndGiveExitCodeOne) {
  folder_.write("slot.canon", listing_text(kRapidAcross));
  const KerfResult result =
      run({"slot.canon", "--stock", "box:-5,-5,-5:25,15,0", "--tool", "1=flat:6", "--cell", "0.1"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err.substr(0, result.err.find(" at X")),
            "slot.canon:6: error: rapid-contact: traverse touches the workpiece, 1.00 mm deep");
  EXPECT_EQ(result.out.rfind("verdict   slot.canon: 1 error\nerrors    1 rapid-contact\n", 0), 0U);
}

TEST_F(RunCommand, DrawsEachFinding) {
  folder_.write("rapid.canon", listing_text(kRapidAcross));
  std::vector<std::string> arguments = {"rapid.canon", "--stock",       "box:-5,-5,-5:25,15,0",
                                        "--tool",      "1=flat:6",      "--cell",
                                        "0.1",         "--json",        "r.json",
                                        "--quiet",     "--finding-png", "shots/all"};
  EXPECT_EQ(run(arguments).exit_code, 1);
  EXPECT_EQ(listing(folder_.file("shots/all")), "01-rapid-contact-line-6.png");
  EXPECT_EQ(read_file(folder_.file("shots/all/01-rapid-contact-line-6.png")).substr(0, 4),
            "\x89PNG");
  EXPECT_EQ(json("r.json")["findings"][0]["bodies"], Json({"cutter", "workpiece"}));
  // Nothing is found, and nothing drawn.
  EXPECT_EQ(run(slot({"--finding-png", "none", "--quiet"})).exit_code, 0);
  EXPECT_EQ(listing(folder_.file("none")), "");
}

TEST_F(RunCommand, FindingsAreDrawnIntoAFolderOrNotAtAll) {
  const KerfResult no_folder = run(slot({"--finding-png", "slot.canon/shots"}));
  EXPECT_EQ(no_folder.exit_code, 4);
  EXPECT_EQ(no_folder.err.rfind("kerf: error: --finding-png: slot.canon/shots: ", 0), 0U)
      << no_folder.err;
  EXPECT_EQ(no_folder.out, "") << "before a minute of cutting";
  std::vector<std::string> standard_input = slot({"--finding-png", "shots"});
  standard_input[0] = "-";
  const KerfResult once = run(standard_input, listing_text());
  EXPECT_EQ(once.exit_code, 2);
  EXPECT_NE(once.err.find("--finding-png"), std::string::npos) << once.err;
  std::vector<std::string> two = slot({"--finding-png", "shots"});
  two.insert(two.begin(), "slot.canon");
  EXPECT_EQ(run(two).exit_code, 2);
}

TEST_F(RunCommand, DrawsWhatALogMeets) {
  std::string log =
      "# kerf-recording/1\n# units: mm\n# coordinates: axes workpiece\n"
      "t_host,t_device,x,y,z,tool,line,spindle_rpm\n";
  double t_s = 1000;
  const auto go = [&](double x_mm, double z_mm) {
    log += fmt::format("{:.3f},,{:.3f},5,{:.3f},1,0,8000\n", t_s += 0.01, x_mm, z_mm);
  };
  for (int i = 0; i <= 60; ++i) go(-10, 5 - 0.1 * i);
  for (int i = 0; i <= 150; ++i) go(-10 + 0.2 * i, -1);
  folder_.write("log.csv", log);
  KerfCall call;
  call.folder = folder_.path();
  call.arguments = {"replay",        "log.csv",
                    "--stock",       "box:-5,-5,-5:25,15,0",
                    "--tool",        "1=flat:6",
                    "--cell",        "0.1",
                    "--fixture",     "clamp=box:18.5,0,0:25,10,4",
                    "--speed",       "max",
                    "--no-view",     "--quiet",
                    "--finding-png", "shots"};
  const KerfResult result = run_kerf(call);
  EXPECT_NE(result.err.find("fixture 'clamp'"), std::string::npos) << result.err;
  EXPECT_EQ(listing(folder_.file("shots")), "01-fixture-contact.png");
}

TEST_F(RunCommand, ReportOnStdoutSendsTheSummaryToStderr) {
  const KerfResult result = run(slot({"--json", "-"}));
  EXPECT_FALSE(Json::parse(result.out, nullptr, false).is_discarded());
  EXPECT_EQ(result.err.rfind("verdict   slot.canon", 0), 0U) << result.err;
}

TEST_F(RunCommand, QuietSaysNothingOfACleanRun) {
  const KerfResult result = run(slot({"--quiet"}));
  EXPECT_EQ(result.out + result.err, "");
}

TEST_F(RunCommand, StdinGivesTheSameWorkpieceAsTheFile) {
  std::vector<std::string> arguments = slot({"--json", "file.json"});
  run(arguments);
  arguments[0] = "-";
  arguments.back() = "stdin.json";
  const KerfResult result = run(arguments, listing_text());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json("file.json")["stock"]["digest"], json("stdin.json")["stock"]["digest"]);
}

TEST_F(RunCommand, ThreadsAndKernelsGiveTheSameDigest) {
  run(slot({"--json", "a.json", "--threads", "1", "--kernel", "scalar"}));
  run(slot({"--json", "b.json", "--threads", "3"}));
  EXPECT_EQ(json("a.json")["stock"]["digest"], json("b.json")["stock"]["digest"]);
}

TEST_F(RunCommand, GuessedBlankIsNamedForFilesAndStdin) {
  folder_.write("slot.canon", listing_text());
  const std::string guess =
      ": warning: stock-guessed: no blank is given or written in the program; assumed: box 36 x 16 "
      "x 6 mm, X-8..28 Y-8..8 Z-6..0 (the feed moves plus 5 mm; --stock SPEC says better)\n";
  const KerfResult file = run({"slot.canon", "--tool", "1=flat:6", "--cell", "0.1"});
  EXPECT_EQ(file.exit_code, 0);
  EXPECT_EQ(file.err, "slot.canon" + guess);
  const KerfResult input = run({"-", "--tool", "1=flat:6", "--cell", "0.1"}, listing_text());
  EXPECT_EQ(input.exit_code, 0);
  EXPECT_EQ(input.err.substr(input.err.find(": warning")), guess);
}

TEST_F(RunCommand, LongProgramWithoutBlankIsReadTwiceFromStdinToo) {
  std::string tail;
  for (int i = 0; i < 500'100; ++i) {
    tail += i % 2 == 0
                ? "   10 N6     STRAIGHT_FEED(0.0000, 0.0000, -1.0000, 0.0000, 0.0000, 0.0000)\n"
                : "   10 N6     STRAIGHT_FEED(20.0000, 0.0000, -1.0000, 0.0000, 0.0000, 0.0000)\n";
  }
  folder_.write("long.canon", listing_text(tail));
  const KerfResult file =
      run({"long.canon", "--tool", "1=flat:6", "--cell", "0.5", "--json", "r.json"});
  EXPECT_EQ(file.exit_code, 0) << file.err;
  EXPECT_EQ(json("r.json")["motion"]["moves"], 500'104);
  EXPECT_EQ(json("r.json")["stock"]["origin"], "guessed");
  const KerfResult input =
      run({"-", "--tool", "1=flat:6", "--cell", "0.5", "--json", "s.json"}, listing_text(tail));
  EXPECT_EQ(input.exit_code, 0) << input.err;
  EXPECT_EQ(json("s.json")["motion"]["moves"], 500'104);
  EXPECT_EQ(json("s.json")["stock"]["digest"], json("r.json")["stock"]["digest"]);
}

/// Of a torch, whose spindle goes with the cuts.
std::string torch_listing() {
  std::string text = "    1 N1     USE_LENGTH_UNITS(CANON_UNITS_MM)\n";
  for (const char* const y : {"10", "20"}) {
    text += fmt::format("    2 N2     STRAIGHT_TRAVERSE(10.0, {}.0, 0.0, 0.0, 0.0, 0.0)\n", y);
    text += "    3 N3     START_SPINDLE_CLOCKWISE(0)\n    4 N4     SET_FEED_RATE(1000.0)\n";
    text += fmt::format("    5 N5     STRAIGHT_FEED(50.0, {}.0, 0.0, 0.0, 0.0, 0.0)\n", y);
    text += "    6 N6     STOP_SPINDLE_TURNING(0)\n";
  }
  return text + "    7 N7     PROGRAM_END()\n";
}

TEST_F(RunCommand, OfAListingOnStdinTheSameIsGuessedAsOfAFile) {
  for (const std::string& text : {torch_listing(), listing_text()}) {
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{}, {"--stock", "box:-5,-5,-5:60,30,5"}}) {
      folder_.write("a.canon", text);
      std::vector<std::string> file{"a.canon", "--json", "file.json"};
      std::vector<std::string> input{"-", "--json", "stdin.json"};
      file.insert(file.end(), more.begin(), more.end());
      input.insert(input.end(), more.begin(), more.end());
      EXPECT_EQ(run(file).exit_code, 0);
      EXPECT_EQ(run(input, text).exit_code, 0);
      EXPECT_EQ(json("stdin.json")["guessed"], json("file.json")["guessed"]);
      EXPECT_EQ(json("stdin.json")["stock"]["digest"], json("file.json")["stock"]["digest"]);
      EXPECT_FALSE(json("file.json")["guessed"].is_null());
    }
  }
  run({"-", "--json", "torch.json"}, torch_listing());
  EXPECT_EQ(json("torch.json")["stock"]["model"], "sheet");
}

TEST_F(RunCommand, LengthsInInchesCutTheSameAsInMm) {
  folder_.write("slot.canon", listing_text(kRapidAcross));
  const std::vector<std::string> common{"slot.canon", "--mesh-tolerance", "0"};
  std::vector<std::string> mm{"--stock", "box:-5.08,-5.08,-7.62:25.4,15.24,0",
                              "--tool",  "1=flat:6.35",
                              "--cell",  "0.127",
                              "--below", "2.54",
                              "--json",  "mm.json"};
  std::vector<std::string> inch{"--units", "inch",        "--stock", "box:-0.2,-0.2,-0.3:1,0.6,0",
                                "--tool",  "1=flat:0.25", "--cell",  "0.005",
                                "--below", "0.1",         "--json",  "inch.json"};
  mm.insert(mm.begin(), common.begin(), common.end());
  inch.insert(inch.begin(), common.begin(), common.end());
  const KerfResult in_mm = run(mm), in_inch = run(inch);
  EXPECT_EQ(in_mm.exit_code, 1);
  EXPECT_EQ(in_inch.exit_code, 1) << in_inch.err;
  Json a = json("mm.json"), b = json("inch.json");
  for (Json* report : {&a, &b}) {
    report->erase("timing_s");
    report->erase("peak_rss_mb");
  }
  EXPECT_EQ(a, b) << "a report is mm, findings and all";
  EXPECT_NE(in_mm.err.find("1.00 mm deep"), std::string::npos) << in_mm.err;
  EXPECT_NE(in_inch.err.find("0.039 in deep"), std::string::npos) << in_inch.err;
  EXPECT_NE(in_inch.out.find("box 1.2 x 0.8 x 0.3 in"), std::string::npos) << in_inch.out;
}

TEST_F(RunCommand, WhatInchesMayBeIsToldInInches) {
  const KerfResult cell = run(slot({"--units", "inch", "--below", "50"}));
  EXPECT_EQ(cell.exit_code, 2);
  EXPECT_NE(
      cell.err.find("--below: 50 is not allowed; must be at least 0 and at most 39.3701 (in)"),
      std::string::npos)
      << cell.err;
  const KerfResult unit = run(slot({"--units", "furlong"}));
  EXPECT_EQ(unit.exit_code, 2);
  EXPECT_EQ(unit.err, "kerf: error: --units: 'furlong' is not allowed; must be mm or inch\n");
}

TEST_F(RunCommand, SavedWorkpieceGoesOnInItsModel) {
  for (const std::string model : {"zmap", "mmap", "octree"}) {
    run(slot({"--state", "first.kerf", "--json", "first.json", "--model", model}));
    const KerfResult result = run({"slot.canon", "--tool", "1=flat:6", "--stock",
                                   "state:first.kerf", "--json", "again.json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const nlohmann::json first = json("first.json")["stock"], again = json("again.json")["stock"];
    EXPECT_EQ(again["model"], model);
    EXPECT_EQ(again["digest"], first["digest"]) << "the slot is cut already";
    EXPECT_NEAR(json("again.json")["tools"][0]["removed_mm3"], 0.0, 1e-9) << model;
  }
  const KerfResult other =
      run({"slot.canon", "--tool", "1=flat:6", "--stock", "state:first.kerf", "--model", "zmap"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_EQ(other.err,
            "kerf: error: first.kerf: a workpiece saved as octree; the model zmap is asked for\n"
            "   hint: --stock with the blank's shape, or --model octree\n");
}

TEST_F(RunCommand, ToolTableDescribesTools) {
  folder_.write("slot.canon", listing_text());
  folder_.write("tool.tbl", "T1 P1 D6 ;6 mm ball nose\n");
  const KerfResult result = run({"slot.canon", "--stock", "box:-5,-5,-5:25,15,0", "--tool-table",
                                 "tool.tbl", "--json", "r.json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json("r.json")["tools"][0]["shape"], "ball:6");
}

TEST_F(RunCommand, SplinesThatTheListingLacksGiveExitCodeThree) {
  folder_.write("spline.canon", listing_text("   10 N6     NURBS_FEED(4, ...)\n"));
  const KerfResult result =
      run({"spline.canon", "--stock", "box:-5,-5,-5:25,15,0", "--tool", "1=flat:6"});
  EXPECT_EQ(result.exit_code, 3) << result.err;
}

TEST_F(RunCommand, HelpHasExamplesAndExitCodes) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, std::vector<std::string>{"run", "--help"}}) {
    KerfCall call;
    call.arguments = arguments;
    const KerfResult result = run_kerf(call);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.out.find("kerf run part.ngc --stock"), std::string::npos);
    EXPECT_NE(result.out.find("  4  file, interpreter or device failure"), std::string::npos);
  }
}

}  // namespace
}  // namespace kerf
