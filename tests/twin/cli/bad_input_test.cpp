// Bad input, each with its exact text and exit code, through the executable.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

constexpr const char* kPart =
    "G21 G90\nT1 M6\nS1000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F300\nG1 X20\nG0 Z5\nM5\nM2\n";
/// The same as rs274 prints it: runs without LinuxCNC.
constexpr const char* kListing =
    "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
    "    2 N1     SELECT_TOOL(1)\n"
    "    3 N1     CHANGE_TOOL(1)\n"
    "    4 N2     SET_SPINDLE_SPEED(0, 1000.0000)\n"
    "    5 N2     START_SPINDLE_CLOCKWISE(0)\n"
    "    6 N3     STRAIGHT_TRAVERSE(0.0000, 0.0000, 5.0000, 0.0000, 0.0000, 0.0000)\n"
    "    7 N4     SET_FEED_RATE(300.0000)\n"
    "    8 N4     STRAIGHT_FEED(0.0000, 0.0000, -1.0000, 0.0000, 0.0000, 0.0000)\n"
    "    9 N5     STRAIGHT_FEED(20.0000, 0.0000, -1.0000, 0.0000, 0.0000, 0.0000)\n"
    "   10 N6     STRAIGHT_TRAVERSE(20.0000, 0.0000, 5.0000, 0.0000, 0.0000, 0.0000)\n"
    "   11 N7     PROGRAM_END()\n";

class BadInput : public testing::Test {
 protected:
  BadInput() {
    folder_.write("part.ngc", kPart);
    folder_.write("part.canon", kListing);
  }
  KerfResult run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "run");
    return kerf(std::move(arguments));
  }
  KerfResult kerf(std::vector<std::string> arguments) {
    KerfCall call;
    call.arguments = std::move(arguments);
    call.folder = folder_.path();
    return run_kerf(call);
  }
  void expect(const KerfResult& result, int exit_code, const std::string& err) {
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_EQ(result.err, err);
    EXPECT_EQ(result.out, "");
  }

  TestFolder folder_;
  const std::string box_ = "box:-5,-5,-5:25,15,0";
};

TEST_F(BadInput, MissingProgram) {
  expect(run({"nix.ngc"}), 4, "nix.ngc: error: cannot be read: No such file or directory\n");
  expect(run({}), 2,
         "kerf: error: PROGRAM is required\n   hint: kerf run --help lists what there is\n");
}

TEST_F(BadInput, OptionsWithoutTheirValues) {
  const std::string hint = "\n   hint: kerf run --help lists what there is\n";
  expect(run({"part.ngc", "--png"}), 2, "kerf: error: --png: a value must follow" + hint);
  expect(run({"part.ngc", "--png", "--quiet"}), 2,
         "kerf: error: --png: a value must follow, not the option --quiet\n");
  EXPECT_FALSE(std::filesystem::exists(folder_.path() + "/--quiet"));
  expect(run({"part.ngc", "--cell", "1", "--cell", "2"}), 2,
         "kerf: error: --cell is given more than once" + hint);
  expect(run({"part.ngc", "--quiet=no"}), 2, "kerf: error: --quiet takes no value" + hint);
}

TEST_F(BadInput, OptionsThatWouldDoNothing) {
  const std::string hint = "   hint: --stock sheet:x0,y0:x1,y1:THICKNESS is one\n";
  expect(run({"part.ngc", "--stock", box_, "--kerf", "3", "--density", "2700"}), 2,
         "kerf: error: --kerf: is for sheets, and the blank is none; leave it out\n" + hint +
             "kerf: error: --density: is for sheets, and the blank is none; leave it out\n" + hint);
  expect(kerf({"view", "part.ngc", "--stock", box_, "--slats", "30", "--png", "p.png"}), 2,
         "kerf: error: --slats: is for sheets, and the blank is none; leave it out\n" + hint);
}

/// What was typed is told as it was typed, whatever its units.
TEST_F(BadInput, WrongValuesAreToldInTheirOwnUnits) {
  expect(run({"part.ngc", "--units", "inch", "--tool", "1=flat:80"}), 2,
         "kerf: error: --tool: tool 1: flat:80: diameter D: 80 is not allowed; must be from "
         "3.937e-05 to 39.37 (in)\n");
  expect(run({"part.ngc", "--units", "inch", "--tool", "1=flat:6", "--tool", "1=ball:6"}), 2,
         "kerf: error: --tool: '1=ball:6': tool 1 is given twice\n");
  expect(run({"part.ngc", "--units", "inch", "--work-offset", "1,2"}), 2,
         "kerf: error: --work-offset: '1,2' is not allowed; must be X,Y,Z (in), each from -39370.1 "
         "to 39370.1\n   hint: as in --work-offset 150,60,-180: the work zero in machine "
         "coordinates\n");
}

TEST_F(BadInput, FolderAsProgram) {
  expect(run({"."}), 4, ".: error: is a folder; a program is an NC file or a canonical listing\n");
}

TEST_F(BadInput, BinaryFile) {
  folder_.write("binary.ngc", std::string("G21\nab\0c\n", 9));
  expect(
      run({"binary.ngc"}), 4,
      "binary.ngc:2: error: is not text: it holds a NUL byte\n   hint: a program is plain text\n");
}

TEST_F(BadInput, EmptyFile) {
  folder_.write("empty.ngc", "");
  expect(run({"empty.ngc"}), 4, "empty.ngc: error: is empty\n");
}

TEST_F(BadInput, UnknownOption) {
  expect(run({"part.canon", "--stcok", box_}), 2,
         "kerf: error: unknown option --stcok; did you mean --stock?\n"
         "   hint: kerf run --help lists what there is\n");
  expect(run({"--stcok", box_}), 2,
         "kerf: error: unknown option --stcok; did you mean --stock?\n"
         "   hint: kerf run --help lists what there is\n");
  expect(
      run({"part.canon", "--postscript=part.ps"}), 2,
      "kerf: error: unknown option --postscript\n   hint: kerf run --help lists what there is\n");
}

TEST_F(BadInput, UnknownCommandAndExtraArguments) {
  expect(kerf({"rnu", "part.canon"}), 2,
         "kerf: error: unknown command 'rnu'; did you mean run?\n   hint: kerf --help lists what "
         "there is\n");
  expect(kerf({"canon", "part.canon", "other.canon"}), 2,
         "kerf: error: 'other.canon': one argument too many\n"
         "   hint: kerf canon --help lists what there is\n");
  expect(run({"part.canon", "--stock", ""}), 2, "kerf: error: --stock: the value is empty\n");
}

TEST_F(BadInput, StockWithoutOrWithNegativeSize) {
  expect(run({"part.canon", "--stock", "box:0,0,-5:0,10,0"}), 2,
         "kerf: error: --stock: box:0,0,-5:0,10,0: X runs from 0 to 0; the second must be at least "
         "0.001 mm above the first\n");
  expect(run({"part.canon", "--stock", "box:0,0,-5:10,-10,0"}), 2,
         "kerf: error: --stock: box:0,0,-5:10,-10,0: Y runs from 0 to -10; the second must be at "
         "least 0.001 mm above the first\n");
}

TEST_F(BadInput, CellLargerThanTheStockOrTooSmall) {
  expect(run({"part.canon", "--stock", box_, "--cell", "50"}), 2,
         "kerf: error: --cell: cell size 50 mm exceeds the blank, which is 30 x 20 mm; 0.05 to 0.2 "
         "mm suits most parts\n");
  expect(
      run({"part.canon", "--stock", box_, "--cell", "0.0001"}), 2,
      "kerf: error: --cell: cell size 0.0001 mm makes 300000 x 200000 cells and would take 240.0 "
      "GB of memory; at most 4.3 GB are allowed\n");
  expect(run({"part.canon", "--stock", box_, "--cell", "-1"}), 2,
         "kerf: error: --cell: -1 is not allowed; must be above 0 and at most 1000 (mm)\n");
}

TEST_F(BadInput, UnknownShapeAndToolZero) {
  expect(
      run({"part.canon", "--tool", "1=flet:6", "--tool", "0=flat:6"}), 2,
      "kerf: error: --tool: tool 1: flet:6: unknown shape 'flet'; did you mean 'flat'? Shapes: "
      "flat, ball, bull, vee, taper, drill, lollipop, tslot, dovetail, kerf, "
      "profile; to turn with: turn, iso, groove, part, facegroove, thread, bore\n"
      "kerf: error: --tool: '0=flat:6': tool 0 is the empty spindle; numbers begin at 1\n"
      "   hint: --tool 1=SHAPE, if it is the only --tool, is what is in the spindle of a program "
      "that changes no tool\n");
}

TEST_F(BadInput, CutterWithAHollowBottom) {
  folder_.write("cup.profile", "start 0 1\nline 4 0\nline 5 0\nline 5 10\n");
  expect(
      run({"part.canon", "--tool", "1=profile:cup.profile"}), 2,
      "kerf: error: --tool: '1=profile:cup.profile': profile:cup.profile has a hollow bottom (its "
      "profile falls from radius 0 outward); an octree cannot cut with it\n");
}

TEST_F(BadInput, InterpreterNotInstalled) {
  KerfCall call;
  call.arguments = {"run", "part.ngc", "--interp", "text"};
  call.folder = folder_.path();
  call.environment["PATH"] = folder_.path();
  expect(run_kerf(call), 4,
         "kerf: error: LinuxCNC's interpreter was not found: no executable rs274 in PATH\n"
         "   hint: sudo apt install --no-remove linuxcnc-uspace\n");
}

TEST_F(BadInput, MissingToolTable) {
  expect(run({"part.canon", "--tool-table", "nix.tbl"}), 4,
         "kerf: error: cannot read nix.tbl: No such file or directory\n");
}

TEST_F(BadInput, OutputPlacesAreRefusedBeforeTheRun) {
  expect(run({"part.canon", "--stl", "nix/part.stl"}), 4,
         "kerf: error: --stl: cannot write nix/part.stl: folder nix: No such file or directory\n");
}

TEST_F(BadInput, DiskFullWhileWritingTheStl) {
  const KerfResult result = run({"part.canon", "--stock", box_, "--tool", "1=flat:6", "--quiet",
                                 "--stl", "/dev/full", "--json", "part.json"});
  expect(result, 4, "kerf: error: writing /dev/full: No space left on device\n");
  EXPECT_TRUE(file_exists(folder_.file("part.json"))) << "the other outputs are written";
}

TEST_F(BadInput, ADeviceIsWrittenAsItIs) {
  const KerfResult result = run({"part.canon", "--stock", box_, "--tool", "1=flat:6", "--quiet",
                                 "--stl", "/dev/null", "--json", "/dev/stderr"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("kerf-report/1"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(BadInput, FileThatGetsTooLargeLeavesTheOldOneAlone) {
  folder_.write("part.stl", "old");
  KerfCall call;
  call.arguments = {"run",      "part.canon", "--stock", box_,      "--tool",
                    "1=flat:6", "--quiet",    "--stl",   "part.stl"};
  call.folder = folder_.path();
  call.file_size_limit = 2000;
  expect(run_kerf(call), 4, "kerf: error: writing part.stl: File too large\n");
  EXPECT_EQ(read_file(folder_.file("part.stl")), "old");
  EXPECT_EQ(listing(folder_.path()), "part.canon part.ngc part.stl");
}

TEST_F(BadInput, StdinThatIsNeitherListingNorProgram) {
  KerfCall call;
  call.arguments = {"run", "-", "--stock", box_, "--quiet"};
  call.input = "Dear machine,\nplease mill this.\n";
  const KerfResult result = run_kerf(call);
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.err.find("no line of it is a canonical command of rs274"), std::string::npos)
      << result.err;
}

TEST_F(BadInput, SavedWorkpieceThatIsNone) {
  expect(run({"part.canon", "--stock", "state:part.ngc"}), 4,
         "kerf: error: part.ngc: not a saved workpiece (it must begin with \"kerf-state/1\")\n");
}

}  // namespace
}  // namespace kerf
