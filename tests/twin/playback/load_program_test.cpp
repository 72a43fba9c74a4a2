// A program loaded to be played against the dry run of the same program.
#include "twin/playback/load_program.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "tests/interp_bridge/program_test_support.h"
#include "twin/findings/finding_json.h"
#include "twin/machine/kinematics/machine_kinematics.h"
#include "twin/playback/load_record.h"
#include "twin/session/session.h"

namespace kerf {
namespace {

constexpr std::chrono::seconds kLong{60};

/// Lines of a saved listing, numbered as rs274 does; the second number is the program's line.
std::string listing(const std::vector<std::pair<int, std::string>>& commands) {
  std::string text = "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n";
  int number = 2;
  for (const auto& [line, command] : commands) {
    text += fmt::format("{:5} N{:<6} {}\n", number++, line, command);
  }
  return text;
}

std::string to(const char* command, double x, double y, double z) {
  return fmt::format("{}({:.4f}, {:.4f}, {:.4f}, 0.0000, 0.0000, 0.0000)", command, x, y, z);
}

/// Slots in rows, a tool change in the middle, rapids through the block in lines 11 and 31.
std::string slots() {
  std::vector<std::pair<int, std::string>> commands;
  const auto tool = [&](int line, int number) {
    commands.emplace_back(line, fmt::format("SELECT_TOOL({})", number));
    commands.emplace_back(line, fmt::format("CHANGE_TOOL({})", number));
    commands.emplace_back(line, "START_SPINDLE_CLOCKWISE(0)");
    commands.emplace_back(line, "SET_FEED_RATE(600.0000)");
  };
  const auto row = [&](int line, double y, double z) {
    commands.emplace_back(line, to("STRAIGHT_TRAVERSE", -5, y, 5));
    commands.emplace_back(line + 1, to("STRAIGHT_FEED", -5, y, z));
    commands.emplace_back(line + 2, to("STRAIGHT_FEED", 45, y, z));
    commands.emplace_back(line + 3, to("STRAIGHT_FEED", 45, y, 5));
  };
  tool(1, 1);
  row(2, 5, -1);
  row(6, 12, -2);
  commands.emplace_back(10, to("STRAIGHT_TRAVERSE", -5, 20, 5));
  commands.emplace_back(11, to("STRAIGHT_TRAVERSE", 20, 20, -1));
  commands.emplace_back(12, to("STRAIGHT_TRAVERSE", 20, 20, 5));
  tool(20, 2);
  row(21, 28, -3);
  row(25, 35, -1.5);
  commands.emplace_back(30, to("STRAIGHT_TRAVERSE", 30, 20, 5));
  commands.emplace_back(31, to("STRAIGHT_TRAVERSE", 30, 20, -1));
  commands.emplace_back(32, to("STRAIGHT_TRAVERSE", 30, 20, 5));
  commands.emplace_back(33, "PROGRAM_END()");
  return listing(commands);
}

class LoadProgram : public testing::Test {
 protected:
  LoadProgram() {
    options_.stock.cell_mm = 0.2;
    options_.tools.push_back(std::move(parse_tool_argument("1=ball:6").value()));
    options_.tools.push_back(std::move(parse_tool_argument("2=bull:4:1").value()));
  }

  void write(const std::string& text) { options_.program.path = folder_.write("part.canon", text); }
  void give_blank() { options_.blank = parse_blank("box:0,0,-10:40,40,0").value(); }

  std::unique_ptr<LoadedProgram> load(const LoadControl& control = {}) {
    Outcome outcome = Outcome::kUsageError;
    auto loaded = load_program(options_, control, diagnostics_, outcome);
    outcome_ = outcome;
    if (loaded && loaded->outcome != outcome) ADD_FAILURE() << "two outcomes";
    return loaded;
  }

  static std::vector<std::string> sorted(const std::vector<Finding>& findings,
                                         const std::vector<std::string>& files) {
    std::vector<std::string> lines;
    for (const Finding& finding : findings) lines.push_back(finding_json(finding, files).dump());
    std::sort(lines.begin(), lines.end());
    return lines;
  }

  /// Session and Player must end with the same workpiece, findings, times and verdict.
  void expect_as_session(bool findings_too = true) {
    Diagnostics said;
    Outcome opened = Outcome::kFailed;
    const std::unique_ptr<Session> session = Session::open(options_, said, opened);
    ASSERT_TRUE(session);
    if (options_.cutting.is_wanted()) session->log_engagement(false);
    const Outcome ran = session->run({}, said);
    const Report& report = session->report();

    std::unique_ptr<LoadedProgram> loaded = load();
    ASSERT_TRUE(loaded);
    EXPECT_EQ(loaded->outcome, ran);
    EXPECT_EQ(loaded->partial_reason, report.partial_reason);
    EXPECT_EQ(loaded->time_model, report.time_model);
    EXPECT_EQ(loaded->blank.origin, report.stock->origin);
    EXPECT_EQ(loaded->blank.description, report.stock->description);
    // Who shows it wants both.
    if (!loaded->player.blank->sheet()) loaded->player.blank->keep_cut_ids(true);
    loaded->player.measures_loads = options_.cutting.is_wanted();
    Player player(std::move(loaded->player), {});
    ASSERT_TRUE(player.wait(player.play(std::numeric_limits<double>::infinity()), kLong));
    loads_ = player.loads();
    uses_ = report.tools;
    const auto end = player.state();
    EXPECT_EQ(end->stop, PlayerStop::kProgramEnd);
    EXPECT_EQ(end->stock->digest(), report.stock->digest);
    if (findings_too) {
      EXPECT_EQ(sorted(*end->findings, player.track().files()),
                sorted(report.findings.kept(), report.program.files));
    }
    compared_findings_ = report.findings.kept().size();
    compared_ids_.clear();
    for (const Finding& finding : report.findings.kept()) compared_ids_.insert(finding.id);
  }
  /// A program of which the dry run finds this trouble, programmed and as the machine runs it.
  void expect_as_session_with(FindingId id) {
    for (const bool planned : {false, true}) {
      SCOPED_TRACE(fmt::format("{}, planned {}", to_string(id), planned));
      options_.timeline.planner.with_path = planned;
      expect_as_session();
      EXPECT_TRUE(compared_ids_.contains(id));
    }
  }

  TestFolder folder_;
  SessionOptions options_;
  Diagnostics diagnostics_;
  Outcome outcome_ = Outcome::kUsageError;
  std::size_t compared_findings_ = 0;
  std::shared_ptr<const LoadRecord> loads_;
  std::vector<ToolUse> uses_;
  std::set<FindingId> compared_ids_;
};

/// Rows on four sides of a bar that a table turns about X, and one while it turns.
std::string turned_rows() {
  std::vector<std::pair<int, std::string>> commands = {{1, "SELECT_TOOL(1)"},
                                                       {1, "CHANGE_TOOL(1)"},
                                                       {1, "START_SPINDLE_CLOCKWISE(0)"},
                                                       {1, "SET_FEED_RATE(600.0000)"}};
  const auto turned = [](const char* command, double x, double z, double a) {
    return fmt::format("{}({:.4f}, 0.0000, {:.4f}, {:.4f}, 0.0000, 0.0000)", command, x, z, a);
  };
  for (int side = 0; side < 4; ++side) {
    commands.emplace_back(10 * side + 2, turned("STRAIGHT_TRAVERSE", -5, 20, 90 * side));
    commands.emplace_back(10 * side + 3, turned("STRAIGHT_FEED", -5, 6, 90 * side));
    commands.emplace_back(10 * side + 4, turned("STRAIGHT_FEED", 25, 6, 90 * side));
    commands.emplace_back(10 * side + 5, turned("STRAIGHT_TRAVERSE", 25, 20, 90 * side));
  }
  commands.emplace_back(50, turned("STRAIGHT_FEED", 10, 7, 270));
  commands.emplace_back(51, turned("STRAIGHT_FEED", 15, 7, 400));
  commands.emplace_back(52, turned("STRAIGHT_TRAVERSE", 15, 20, 400));
  commands.emplace_back(53, "PROGRAM_END()");
  return listing(commands);
}

TEST_F(LoadProgram, WhereATableTurnsThePlayerEndsAsTheDryRunDoes) {
  write(turned_rows());
  options_.stock.cell_mm = 0.5;
  options_.timeline.kinematics = std::make_shared<const MachineKinematics>(
      known_machine("trivkins", "XYZABC", {}, {}).value());
  options_.blank = parse_blank("box:0,-8,-8:20,8,8").value();
  expect_as_session();
  options_.blank.reset();
  expect_as_session();
}

TEST_F(LoadProgram, OfASheetItEndsAsTheDryRunDoes) {
  write(slots());
  options_.blank = parse_blank("sheet:-3,0:40,40:2").value();
  options_.stock.cell_mm = 0;
  options_.beam.trigger = BeamTrigger::parse("m3+z<0").value();
  options_.beam.pierce_mm = 7;
  options_.beam.slats_mm = 100;
  expect_as_session();
  EXPECT_EQ(compared_findings_, 5U) << "four strips, and the cut into one of them";
  options_.timeline.planner.with_path = true;
  expect_as_session();
  const std::unique_ptr<LoadedProgram> loaded = load();
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->cuts, nullptr);
  ASSERT_EQ(loaded->tools.size(), 2U);
  EXPECT_EQ(loaded->tools[1].shape, "bull:4:1");
}

TEST_F(LoadProgram, EndsAsADryRunDoes) {
  write(slots());
  give_blank();
  expect_as_session();
  EXPECT_EQ(compared_findings_, 3U) << "two rapids, and a spindle that no S word makes turn";
}

/// Slots and half slots at S2000, F600, by tools with teeth, in a material of the spindle's limits:
/// what is told of forces needs how tools are engaged, and that which move has cut each cell.
TEST_F(LoadProgram, OfForcesItTellsWhatADryRunDoes) {
  std::vector<std::pair<int, std::string>> commands{{1, "SELECT_TOOL(1)"},
                                                    {1, "CHANGE_TOOL(1)"},
                                                    {1, "SET_SPINDLE_SPEED(0, 2000.0000)"},
                                                    {1, "START_SPINDLE_CLOCKWISE(0)"},
                                                    {1, "SET_FEED_RATE(600.0000)"}};
  for (int row = 0; row < 6; ++row) {
    const double y = 6 + 3.5 * row;
    commands.emplace_back(10 * row + 2, to("STRAIGHT_TRAVERSE", -6, y, 5));
    commands.emplace_back(10 * row + 3, to("STRAIGHT_TRAVERSE", -6, y, -3));
    commands.emplace_back(10 * row + 4, to("STRAIGHT_FEED", 20, y, -3));
    commands.emplace_back(10 * row + 5, to("STRAIGHT_FEED", 30, y + 1, -3));
    commands.emplace_back(10 * row + 6, to("STRAIGHT_FEED", 46, y, -3));
    commands.emplace_back(10 * row + 7, to("STRAIGHT_TRAVERSE", 46, y, 5));
  }
  commands.emplace_back(90, "PROGRAM_END()");
  write(listing(commands));
  give_blank();
  options_.tools.clear();
  options_.tools.push_back(
      std::move(parse_tool_argument("1=flat:6:teeth=3:flute=10:holder=20x30:stickout=30").value()));
  Material steel;
  steel.name = "steel";
  steel.kc11_n_per_mm2 = {1400, 2000, 3000};
  steel.mc = 0.2;
  options_.cutting.material = steel;
  options_.cutting.spindle_power_kw = 0.2;
  options_.cutting.most_bend_mm = 0.005;
  options_.cutting.wants_climb = true;
  for (const bool planned : {false, true}) {
    options_.timeline.planner.with_path = planned;
    expect_as_session();
    for (const FindingId id : {FindingId::kOverPower, FindingId::kDeflection})
      EXPECT_TRUE(compared_ids_.contains(id)) << planned;
    ASSERT_TRUE(loads_);
    ASSERT_EQ(uses_.size(), 1u);
    ASSERT_TRUE(uses_[0].loads);
    const ToolLoads& told = *uses_[0].loads;
    const auto most = [&](LoadKind kind) {
      const std::vector<float> values = loads_->by_motion(kind);
      return values.empty() ? 0.0
                            : static_cast<double>(*std::max_element(values.begin(), values.end()));
    };
    EXPECT_NEAR(most(LoadKind::kForce), told.force_n.most(), 1e-4 * told.force_n.most());
    EXPECT_NEAR(most(LoadKind::kPower), told.power_kw.most(), 1e-4 * told.power_kw.most());
    EXPECT_NEAR(most(LoadKind::kChip), told.chip_mm.most(), 1e-6);
    EXPECT_NEAR(most(LoadKind::kBend), told.bend_mm.most(), 1e-4 * told.bend_mm.most());
    // A slot first; then 3.5 of the diameter's 6 mm, from which the angle follows.
    EXPECT_NEAR(most(LoadKind::kAngle), 180, 1);
    const std::vector<float> angles = loads_->by_motion(LoadKind::kAngle);
    EXPECT_GT(std::count_if(angles.begin(), angles.end(),
                            [](float angle) { return std::abs(angle - 99.6f) < 8; }),
              3)
        << "acos(1 - 3.5 / 3) = 99.6 degrees";
    EXPECT_TRUE(std::any_of(angles.begin(), angles.end(), [](float angle) { return angle == 0; }));
  }
}

/// Its sound twin: nothing is measured where nobody has asked for it.
TEST_F(LoadProgram, WithoutAMaterialNothingIsMeasured) {
  write(slots());
  give_blank();
  expect_as_session();
  EXPECT_FALSE(loads_);
}

TEST_F(LoadProgram, WithAGuessedBlankToo) {
  write(slots());
  expect_as_session();
  EXPECT_EQ(compared_findings_, 4U) << "the guess itself, two rapids, and the speed never said";
}

TEST_F(LoadProgram, WithABlankAndToolsOfComments) {
  write(
      "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
      "    2 N..... COMMENT(\"STOCK/BLOCK,50,40,10,5,0,10\")\n"
      "    3 N..... COMMENT(\"T1 D=6. CR=3. - ZMIN=-2. - ball end mill\")\n" +
      slots());
  options_.tools.clear();
  expect_as_session();
  EXPECT_GE(compared_findings_, 1U) << "tool 2 is not known";
}

TEST_F(LoadProgram, PartsOfAProgramAsADryRunTakesThem) {
  write(slots());
  for (const LineRange lines : {LineRange{12, 0}, LineRange{0, 21}, LineRange{7, 27},
                                LineRange{11, 11}, LineRange{40, 0}, LineRange{0, 1}}) {
    for (const bool given : {false, true}) {
      SCOPED_TRACE(fmt::format("{} to {}, blank {}", lines.from, lines.until, given));
      options_.lines = lines;
      options_.blank.reset();
      if (given) give_blank();
      expect_as_session();
    }
  }
}

/// Tool 1 turns at a speed that is said, and goes down to the middle of the block.
std::vector<std::pair<int, std::string>> in_the_block() {
  return {{1, "SELECT_TOOL(1)"},
          {1, "CHANGE_TOOL(1)"},
          {2, "SET_SPINDLE_SPEED(0, 8000.0000)"},
          {2, "START_SPINDLE_CLOCKWISE(0)"},
          {2, "SET_FEED_RATE(600.0000)"},
          {3, to("STRAIGHT_TRAVERSE", 20, 20, 5)},
          {4, to("STRAIGHT_FEED", 20, 20, -2)}};
}

/// What lies in the order of a program's words, and what it does as a whole.
TEST_F(LoadProgram, TroublesOfAWholeProgramAsADryRunFindsThem) {
  give_blank();
  auto commands = in_the_block();
  commands.emplace_back(5, "SELECT_TOOL(2)");
  commands.emplace_back(6, to("STRAIGHT_FEED", 25, 20, -2));
  commands.emplace_back(7, to("STRAIGHT_TRAVERSE", 25, 20, 5));
  commands.emplace_back(8, "PROGRAM_END()");
  write(listing(commands));
  expect_as_session_with(FindingId::kToolNotChanged);

  commands = in_the_block();
  commands.emplace_back(5, "PROGRAM_STOP()");
  commands.emplace_back(6, to("STRAIGHT_TRAVERSE", 20, 20, 5));
  commands.emplace_back(7, "PROGRAM_END()");
  write(listing(commands));
  expect_as_session_with(FindingId::kStopInPart);

  commands = in_the_block();
  commands.emplace_back(5, to("STRAIGHT_FEED", 30, 20, -2));
  commands.emplace_back(6, to("STRAIGHT_TRAVERSE", 30, 20, 5));
  commands.emplace_back(7, "PROGRAM_END()");
  write(listing(commands));
  options_.tools.clear();
  options_.tools.push_back(std::move(parse_tool_argument("1=drill:6:118").value()));
  expect_as_session_with(FindingId::kDrillSideways);
}

#ifdef KERF_INTERP_EXECUTABLE
/// The slot is cut before the probe comes, its floor becomes Z0, and the rapid of line 16 goes 1 mm
/// below it.
TEST_F(LoadProgram, WhatAProbeMeetsAsADryRunHasIt) {
  give_blank();
  options_.program.path = folder_.write("part.ngc",
                                        "G21 G90 G17 G54\nT1 M6\nS8000 M3\nG0 X20 Y20 Z5\n"
                                        "G1 Z-3 F600\nG1 X30\nG0 Z5\nM5\nT2 M6\nG0 X25 Y20\n"
                                        "G38.2 Z-8 F100\nG10 L20 P1 Z0\nG0 Z10\nS8000 M3\n"
                                        "G0 X25\nG0 Z-1\nG0 Z10\nM5\nM2\n");
  options_.program.interpreter = InterpreterChoice::kBridge;
  options_.program.kerf_interp_path = KERF_INTERP_EXECUTABLE;
  expect_as_session_with(FindingId::kRapidContact);
  EXPECT_FALSE(compared_ids_.contains(FindingId::kNotSimulated));
  // Of a guessed blank nobody knows before the program is read.
  options_.blank.reset();
  expect_as_session_with(FindingId::kNotSimulated);
}
#endif

TEST_F(LoadProgram, NothingCutAsADryRunFindsIt) {
  auto commands = in_the_block();
  commands.emplace_back(5, to("STRAIGHT_TRAVERSE", 20, 20, 5));
  commands.emplace_back(6, "PROGRAM_END()");
  write(listing(commands));
  options_.blank = parse_blank("box:0,0,-20:40,40,-10").value();
  expect_as_session_with(FindingId::kNothingCut);
  // Of a part of the program nobody can say that it ought to have cut.
  options_.lines = {1, 5};
  expect_as_session();
  EXPECT_FALSE(compared_ids_.contains(FindingId::kNothingCut));
  options_.lines = {};
  commands.erase(commands.begin() + 6);  // no feed move is left; the blank is guessed
  write(listing(commands));
  options_.blank.reset();
  expect_as_session_with(FindingId::kNothingCut);
  options_.program.path = folder_.write("empty.canon", listing({{1, "PROGRAM_END()"}}));
  give_blank();
  expect_as_session_with(FindingId::kNothingCut);
}

/// The spindle is told to turn before anybody has said how fast: a warning, which becomes an error
/// when an S word comes after all.
TEST_F(LoadProgram, ASpeedThatComesTooLateAsADryRunFindsIt) {
  give_blank();
  auto commands = in_the_block();
  commands.erase(commands.begin() + 2);
  commands.emplace_back(5, "SET_SPINDLE_SPEED(0, 8000.0000)");
  commands.emplace_back(6, to("STRAIGHT_FEED", 25, 20, -2));
  commands.emplace_back(7, to("STRAIGHT_TRAVERSE", 25, 20, 5));
  commands.emplace_back(8, "PROGRAM_END()");
  write(listing(commands));
  expect_as_session_with(FindingId::kSpindleOffContact);
}

/// Rows of short moves that turn: their corners are rounded under G64.
std::string corners() {
  std::vector<std::pair<int, std::string>> commands = {
      {1, "SELECT_TOOL(1)"},
      {1, "CHANGE_TOOL(1)"},
      {1, "START_SPINDLE_CLOCKWISE(0)"},
      {1, "SET_FEED_RATE(2400.0000)"},
      {1, "SET_MOTION_CONTROL_MODE(CANON_CONTINUOUS, 0.500000)"}};
  commands.emplace_back(2, to("STRAIGHT_TRAVERSE", 4, 4, 5));
  commands.emplace_back(3, to("STRAIGHT_FEED", 4, 4, -2));
  for (int i = 0; i < 8; ++i) {
    const double x = 4 + 4 * i;
    commands.emplace_back(4 + i, to("STRAIGHT_FEED", x, i % 2 == 0 ? 34 : 4, -2));
    commands.emplace_back(20 + i, to("STRAIGHT_FEED", x + 4, i % 2 == 0 ? 34 : 4, -2));
  }
  commands.emplace_back(40, to("STRAIGHT_TRAVERSE", 36, 4, 5));
  commands.emplace_back(41, "PROGRAM_END()");
  return listing(commands);
}

TEST_F(LoadProgram, ThePlannedPathIsCutAsADryRunCutsIt) {
  write(corners());
  give_blank();
  const auto programmed = load();
  ASSERT_TRUE(programmed);
  options_.timeline.planner.with_path = true;
  const auto planned = load();
  ASSERT_TRUE(planned);
  EXPECT_GT(planned->player.track->size(), programmed->player.track->size() + 10);
  EXPECT_NEAR(planned->player.track->duration_s(), programmed->player.track->duration_s(), 1e-6);
  expect_as_session();
  for (const LineRange lines : {LineRange{6, 0}, LineRange{22, 25}}) {
    options_.lines = lines;
    expect_as_session();
  }
}

TEST_F(LoadProgram, SaysWhereItsWindowBegins) {
  write(slots());
  give_blank();
  options_.lines = {12, 25};
  const auto loaded = load();
  ASSERT_TRUE(loaded);
  const ProgramTrack& track = *loaded->player.track;
  EXPECT_EQ(loaded->player.report_from, track.first_of_line({0, 12}));
  EXPECT_EQ(track.source(track.size() - 1).line, 25U);
}

TEST_F(LoadProgram, TellsFilesToolsAndBlank) {
  write(slots());
  give_blank();
  options_.program.tool_table_path =
      folder_.write("tool.tbl", "T1 P1 D6 Z20 ;the ball\nT2 P2 D4\n");
  options_.tools.erase(options_.tools.begin() + 1);
  const auto loaded = load();
  ASSERT_TRUE(loaded);
  ASSERT_EQ(loaded->files.size(), 1U);
  EXPECT_EQ(loaded->files[0], folder_.path("part.canon"));
  EXPECT_TRUE(std::filesystem::path(loaded->files[0]).is_absolute());
  ASSERT_EQ(loaded->tools.size(), 2U);
  EXPECT_EQ(loaded->tools[0].number, 1);
  EXPECT_EQ(loaded->tools[0].shape, "ball:6");
  EXPECT_EQ(loaded->tools[0].remark, "the ball");
  EXPECT_FALSE(loaded->tools[0].guessed);
  EXPECT_EQ(loaded->tools[1].number, 2);
  EXPECT_EQ(loaded->tools[1].shape, "flat:4");
  EXPECT_EQ(loaded->tools[1].origin, "diameter in line 2 of the tool table");
  EXPECT_TRUE(loaded->tools[1].guessed);
  EXPECT_EQ(loaded->blank.origin, "--stock");
  EXPECT_EQ(loaded->summary.interpreter, "canon");
  EXPECT_TRUE(loaded->work_offsets.empty());
}

TEST_F(LoadProgram, TellsTheWorkOffsetsOfTheMachine) {
  write(slots());
  give_blank();
  options_.program.machine.parameter_path =
      folder_.write("mill.var", "5220\t1\n5221\t1\n5222\t2\n5223\t-3\n5241\t10\n5250\t90\n");
  options_.program.machine.inch_machine = true;
  const auto loaded = load();
  ASSERT_TRUE(loaded);
  ASSERT_EQ(loaded->work_offsets.size(), 9U);
  EXPECT_EQ(loaded->work_offsets[0].name, "G54");
  EXPECT_DOUBLE_EQ(loaded->work_offsets[0].frame.g5x_mm.x, 25.4);
  EXPECT_DOUBLE_EQ(loaded->work_offsets[0].frame.g5x_mm.z, -76.2);
  EXPECT_EQ(loaded->work_offsets[1].name, "G55");
  EXPECT_EQ(loaded->work_offsets[1].frame.g5x_mm.x, 254.0);
  EXPECT_EQ(loaded->work_offsets[1].frame.rotation_deg, 90.0);
  EXPECT_EQ(loaded->work_offsets[8].name, "G59.3");
}

TEST_F(LoadProgram, WhatComesBeforeAnErrorCanBePlayed) {
  options_.program.path = folder_.write(
      "part.ngc", "G21 T1 M6 M3 S1000 F300\nG0 X-5 Y20 Z5\nG1 Z-1\nG1 X45\nG1 Q\nG1 X0\nM2\n");
  options_.program.interpreter = InterpreterChoice::kText;
  give_blank();
  auto loaded = load();
  if (!loaded) GTEST_SKIP() << "rs274 is not installed: " << to_string(diagnostics_.at(0));
  EXPECT_EQ(loaded->outcome, Outcome::kFailed);
  EXPECT_EQ(loaded->partial_reason, "the interpreter stopped at an error");
  const auto error =
      std::find_if(loaded->player.remarks.begin(), loaded->player.remarks.end(),
                   [](const Finding& f) { return f.id == FindingId::kInterpreterError; });
  ASSERT_NE(error, loaded->player.remarks.end());
  EXPECT_EQ(error->source.line, 5U);
  Player player(std::move(loaded->player), {});
  ASSERT_TRUE(player.wait(player.seek_end(), kLong));
  const auto end = player.state();
  EXPECT_EQ(end->tip_mm, Vec3(45, 20, -1));
  EXPECT_LT(end->stock->remaining_mm3(), end->stock->blank_mm3() - 100);
  ASSERT_TRUE(player.wait(player.seek_start(), kLong));
  // The error is listed, and to go to it is to go where the program stops.
  const auto& findings = *player.state()->findings;
  std::size_t number = 0;
  while (number < findings.size() && findings[number].id != FindingId::kInterpreterError) ++number;
  ASSERT_LT(number, findings.size());
  ASSERT_TRUE(player.wait(player.seek_finding_number(number), kLong));
  EXPECT_EQ(player.state()->place.motion, player.track().size());
}

TEST_F(LoadProgram, TellsHowFarItIsAndStopsWhenAsked) {
  std::vector<std::pair<int, std::string>> commands{{1, "SELECT_TOOL(1)"},
                                                    {1, "CHANGE_TOOL(1)"},
                                                    {2, "START_SPINDLE_CLOCKWISE(0)"},
                                                    {2, "SET_FEED_RATE(600.0000)"}};
  for (int i = 0; i < 200'000; ++i) {
    commands.emplace_back(3 + i, to("STRAIGHT_FEED", i % 40, 20, -1));
  }
  write(listing(commands));
  LoadControl control;
  std::size_t calls = 0, motions = 0;
  double fraction = 0;
  control.on_progress = [&](const LoadProgress& progress) {
    ++calls;
    EXPECT_GT(progress.motions, motions);
    EXPECT_GE(progress.fraction, fraction);
    EXPECT_LE(progress.fraction, 1);
    motions = progress.motions;
    fraction = progress.fraction;
  };
  const auto whole = load(control);
  for (const Diagnostic& d : diagnostics_) ADD_FAILURE() << to_string(d);
  ASSERT_TRUE(whole);
  EXPECT_GT(calls, 10U);
  EXPECT_EQ(motions, whole->player.track->size());

  std::stop_source source;
  control.stop = source.get_token();
  control.on_progress = [&](const LoadProgress&) { source.request_stop(); };
  const auto part = load(control);
  ASSERT_TRUE(part);
  EXPECT_EQ(part->outcome, Outcome::kInterrupted);
  EXPECT_FALSE(part->player.whole);
  EXPECT_GT(part->player.track->size(), 0U);
  EXPECT_LT(part->player.track->size(), whole->player.track->size() / 2);
}

TEST_F(LoadProgram, NothingToPlayIsNoProgram) {
  options_.program.path = folder_.path("missing.ngc");
  EXPECT_FALSE(load());
  EXPECT_EQ(outcome_, Outcome::kFailed);
  ASSERT_EQ(diagnostics_.size(), 1U);
  EXPECT_NE(diagnostics_[0].message.find("No such file"), std::string::npos);

  diagnostics_.clear();
  write(slots());
  options_.stock.kind = StockKind::kZmap;
  options_.blank = parse_blank("cylinder:0,0,-5:25:10:x").value();
  EXPECT_FALSE(load());
  EXPECT_EQ(outcome_, Outcome::kUsageError);
  ASSERT_EQ(diagnostics_.size(), 1U);
  EXPECT_EQ(diagnostics_[0].message,
            "--stock: a Z-map cannot hold a cylinder along x; its axis must be z");
}

}  // namespace
}  // namespace kerf
