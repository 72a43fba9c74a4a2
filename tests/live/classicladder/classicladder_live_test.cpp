// A real headless LinuxCNC with the files of configs/linuxcnc runs a program, a Modbus client polls
// it, and every register is held against HAL's own log of the servo cycle that the register image
// is of. Skipped where LinuxCNC, Xvfb or namespaces of one's own are missing.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "tests/live/classicladder/linuxcnc_session.h"

namespace kerf {
namespace {

constexpr int kUmPerMm = 1000;
/// Lines that number their 16 bit register more than full.
constexpr int kEmptyLines = 66000;

/// Positions on both sides of 0 and of +-65.536 mm, where the upper word changes.
std::string long_program() {
  return "G21 G90 G17 G61 G54\n"
         "T1 M6\n"
         "G43 S1000 M3\n"
         "G0 X-100 Y-60 Z5\n"
         "G1 Z-1 F1200\n"
         "G1 X80 Y40 F5000\n"
         "G2 X60 Y20 I-20 J0\n"
         "G0 Z60\n"
         "T3 M6\n"
         "G43 S40000 M4\n"
         "G1 X-90 Y85 F6000\n" +
         std::string(kEmptyLines, '\n') +
         "G1 X0 Y-80\n"
         "G0 X-100 Y60 Z5\n"
         "M5\n"
         "M2\n";
}

/// A machine that already uses some of the pins and the component scale.
constexpr const char* kBusyMachine =
    "hal loadrt scale count=1\n"
    "hal net x-position joint.0.pos-fb => scale.0.in\n"
    "hal net y-position joint.1.pos-fb\n"
    "hal net tool-in-spindle iocontrol.0.tool-number\n"
    "hal net spindle-command spindle.0.speed-out\n";

/// Behind ClassicLadder in the thread, so that a line of the log is one register image.
constexpr const char* kSampler =
    "hal loadrt sampler depth=16000 cfg=fffffsss\n"
    "hal net x-position sampler.0.pin.0\n"
    "hal net y-position sampler.0.pin.1\n"
    "hal net kerf-joint-2-pos-fb sampler.0.pin.2\n"
    "hal net kerf-motion-tooloffset-z sampler.0.pin.3\n"
    "hal net spindle-command sampler.0.pin.4\n"
    "hal net tool-in-spindle sampler.0.pin.5\n"
    "hal net kerf-motion-program-line sampler.0.pin.6\n"
    "hal net kerf-scan sampler.0.pin.7\n"
    "hal addf sampler.0 servo-thread\n";

/// One session for all tests of this suite: each looks at another side of it.
class ClassicLadderLive : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    missing_ = LinuxCncSession::missing();
    if (!missing_.empty()) return;
    LinuxCncSession::Plan plan;
    plan.program = long_program();
    plan.before = kBusyMachine;
    plan.after = kSampler;
    plan.at_ready =
        "halsampler -t -c 0 samples.txt </dev/null >/dev/null 2>&1 & echo $! >sampler.pid";
    plan.at_end = "halcmd -s show sig >sigs.txt; kill $(cat sampler.pid)";
    session_ = std::make_unique<LinuxCncSession>(plan);
    polls_ = session_->polls();
    cycles_ = session_->cycles(lost_);
    // 65 s until the counter comes round: longer than the session.
    for (const LoggedCycle& cycle : cycles_) {
      if (cycle.scan != 0) cycle_of_scan_[cycle.scan] = &cycle;
    }
  }
  static void TearDownTestSuite() { session_.reset(); }

  void SetUp() override {
    if (!missing_.empty()) GTEST_SKIP() << missing_;
    ASSERT_EQ(session_->status(), 0) << session_->said();
    ASSERT_FALSE(polls_.empty()) << session_->said();
    ASSERT_FALSE(cycles_.empty()) << session_->said();
    ASSERT_EQ(lost_, 0);
  }

  static inline std::string missing_;
  static inline std::unique_ptr<LinuxCncSession> session_;
  static inline std::vector<ServedRegisters> polls_;
  static inline std::vector<LoggedCycle> cycles_;
  static inline int lost_ = 0;
  static inline std::map<int, const LoggedCycle*> cycle_of_scan_;
};

double worst_mm(const ServedRegisters& poll, const LoggedCycle& cycle) {
  double worst = std::abs(poll.tool_offset_um / 1e3 - cycle.tool_offset);
  for (std::size_t i = 0; i < 3; ++i) {
    worst = std::max(worst, std::abs(poll.position_um[i] / 1e3 - cycle.joint[i]));
  }
  return worst;
}

bool has_equal_numbers(const ServedRegisters& poll, const LoggedCycle& cycle) {
  return poll.tool == cycle.tool && poll.line == cycle.line &&
         poll.line_low_word == cycle.line % 65536 && poll.spindle_rpm == cycle.spindle_rpm;
}

TEST_F(ClassicLadderLive, EveryPollIsOneServoCycle) {
  // A fraction of 0.001 mm is cut off, and the log has six decimals.
  constexpr double kTolerance_mm = 0.001 + 1e-6;
  // The two scan counters find nearly all answers that begin in one cycle and end in the next; not
  // those of a server that the computer put aside before it came to the first counter.
  constexpr double kMixed = 0.01;
  int compared = 0;
  int mixed = 0;
  double worst = 0;
  for (const ServedRegisters& poll : polls_) {
    const auto found = cycle_of_scan_.find(poll.scan);
    if (found == cycle_of_scan_.end()) continue;
    ++compared;
    const double distance = worst_mm(poll, *found->second);
    if (distance > kTolerance_mm || !has_equal_numbers(poll, *found->second)) {
      ++mixed;
    } else {
      worst = std::max(worst, distance);
    }
  }
  RecordProperty("compared", compared);
  RecordProperty("mixed", mixed);
  RecordProperty("refused", session_->times("refused"));
  RecordProperty("worst_mm", std::to_string(worst));
  EXPECT_GT(compared, 300);
  EXPECT_LE(mixed, compared * kMixed) << "of " << compared;
}

TEST_F(ClassicLadderLive, TheWholeProgramIsSeen) {
  std::set<int> tools;
  std::set<int> lines;
  std::set<int> speeds;
  std::set<int> offsets_um;
  std::array<std::int32_t, 3> least{};
  std::array<std::int32_t, 3> most{};
  for (const ServedRegisters& poll : polls_) {
    tools.insert(poll.tool);
    lines.insert(poll.line);
    speeds.insert(poll.spindle_rpm);
    offsets_um.insert(poll.tool_offset_um);
    for (std::size_t i = 0; i < 3; ++i) {
      least[i] = std::min(least[i], poll.position_um[i]);
      most[i] = std::max(most[i], poll.position_um[i]);
    }
  }
  EXPECT_EQ(tools, (std::set<int>{0, 1, 3}));
  EXPECT_EQ(speeds, (std::set<int>{-40000, 0, 1000}));
  EXPECT_EQ(offsets_um, (std::set<int>{0, 35000, 41250}));
  for (const int line : {0, 4, 6, 7, 11, kEmptyLines + 12, kEmptyLines + 13}) {
    EXPECT_TRUE(lines.contains(line)) << line;
  }
  // Corners of the program plus G54 of mill3.var, less what the machine moves within one poll.
  EXPECT_LT(least[0], -79 * kUmPerMm);
  EXPECT_GT(most[0], 99 * kUmPerMm);
  EXPECT_LT(least[1], -88 * kUmPerMm);
  EXPECT_GT(most[1], 73 * kUmPerMm);
}

TEST_F(ClassicLadderLive, TheCounterCountsEveryCycle) {
  int steps = 0;
  int missed = 0;
  for (std::size_t i = 1; i < cycles_.size(); ++i) {
    if (cycles_[i - 1].scan == 0) continue;
    ++steps;
    if (cycles_[i].scan != (cycles_[i - 1].scan + 1) % 65536) ++missed;
  }
  EXPECT_GT(steps, 5000);
  EXPECT_EQ(missed, 0);
}

TEST_F(ClassicLadderLive, SignalsOfTheMachineAreJoined) {
  const std::string signals = session_->file("sigs.txt");
  std::map<std::string, std::string> pins_of;
  std::istringstream lines(signals);
  std::string line;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string type, value, name, rest;
    words >> type >> value >> name;
    std::getline(words, rest);
    pins_of[name] = rest + ' ';
  }
  const std::map<std::string, std::vector<std::string>> wanted{
      {"x-position", {"joint.0.pos-fb", "scale.0.in", "kerf-um-x.in0"}},
      {"y-position", {"joint.1.pos-fb", "kerf-um-y.in0"}},
      {"kerf-joint-2-pos-fb", {"joint.2.pos-fb", "kerf-um-z.in0"}},
      {"tool-in-spindle", {"iocontrol.0.tool-number", "classicladder.0.s32in-00"}},
      {"spindle-command", {"spindle.0.speed-out", "classicladder.0.floatin-04"}},
      {"Xpos", {"joint.0.motor-pos-cmd", "joint.0.motor-pos-fb"}}};
  for (const auto& [name, pins] : wanted) {
    for (const std::string& pin : pins) {
      EXPECT_NE(pins_of[name].find(" " + pin + " "), std::string::npos) << pin << '\n' << signals;
    }
  }
}

constexpr const char* kShortProgram =
    "G21 G90 G54\n"
    "G0 X-100 Y-30 Z70\n"
    "M2\n";

/// Nothing of the HAL that is read here is in use already; and the second start finds no port, lock
/// or display left over from the first.
TEST(ClassicLadderStart, InchesAndTwice) {
  const std::string missing = LinuxCncSession::missing();
  if (!missing.empty()) GTEST_SKIP() << missing;
  LinuxCncSession::Plan plan;
  plan.program = kShortProgram;
  plan.before = "set ::TRAJ(LINEAR_UNITS) inch";
  plan.sessions = 2;
  plan.at_end =
      "for j in 0 1 2; do halcmd getp joint.$j.pos-fb; done >joints.txt; "
      "ps -e -o comm= | sort | uniq -c >processes.txt; "
      // Until positions have been polled while the machine stands.
      "n=$(wc -l <polls.txt); "
      "timeout 20 bash -c \"until [ \\$(wc -l <polls.txt) -gt $((n + 3)) ]; do sleep 0.02; done\"";
  const LinuxCncSession session(plan);
  ASSERT_EQ(session.status(), 0) << session.said();
  EXPECT_EQ(session.times("connected"), 2) << session.said();
  const std::vector<ServedRegisters> polls = session.polls();
  ASSERT_FALSE(polls.empty()) << session.said();
  std::istringstream joints(session.file("joints.txt"));
  for (std::size_t i = 0; i < 3; ++i) {
    double inches = NAN;
    ASSERT_TRUE(joints >> inches);
    EXPECT_NE(inches, 0.0);
    EXPECT_NEAR(polls.back().position_um[i], inches * 25400, 1.0);
  }
  const std::string processes = session.file("processes.txt");
  for (const char* name : {" 1 Xvfb\n", " 1 classicladder\n", " 1 kerf_ladder\n"}) {
    EXPECT_NE(processes.find(name), std::string::npos) << processes;
  }
}

TEST(ClassicLadderStart, AMachineWithALadderOfItsOwnIsToldSo) {
  const std::string missing = LinuxCncSession::missing();
  if (!missing.empty()) GTEST_SKIP() << missing;
  LinuxCncSession::Plan plan;
  plan.program = kShortProgram;
  plan.before = "hal loadrt classicladder_rt";
  const LinuxCncSession session(plan);
  EXPECT_NE(session.status(), 0);
  EXPECT_NE(session.said().find("kerf_positions.tcl: this machine runs ClassicLadder already"),
            std::string::npos)
      << session.said();
}

/// What kerf_positions.tcl makes of an INI: "joints um" or the message.
std::string made_of(const std::string& ini) {
  std::string output;
  shell("printf '%s' '" + ini +
            "proc hal args {}\n"
            "namespace eval tp {proc passnumber {} {return 0}}\n"
            "source " LINUXCNC_CONFIGS
            "/kerf_positions.tcl\n"
            "proc kerf::fail {text} {puts $text; exit}\n"
            "puts \"[kerf::joints]; [kerf::um_per_unit]\"\n' | tclsh",
        output);
  return output;
}

TEST(ClassicLadderSettings, JointsAndUnitsOfTheIni) {
  std::string ignored;
  if (shell("command -v tclsh", ignored) != 0) GTEST_SKIP() << "package tcl is not installed";
  const std::string mm = "set TRAJ(LINEAR_UNITS) mm\n";
  const std::map<std::string, std::string> wanted{
      {mm + "set KINS(KINEMATICS) trivkins\nset TRAJ(COORDINATES) {X Y Z}\n", "0 1 2; 1000.0\n"},
      {mm + "set KINS(KINEMATICS) {trivkins coordinates=XYYZ kinstype=BOTH}\n", "0 1 3; 1000.0\n"},
      {mm + "set KINS(KINEMATICS) trivkins\nset TRAJ(COORDINATES) {X Z}\n", "0 - 1; 1000.0\n"},
      {mm + "set KINS(KINEMATICS) genhexkins\n",
       "kinematics \"genhexkins\": say in the INI which joints are to be served: "
       "[KERF]JOINTS = 0 1 2\n"},
      {mm + "set KINS(KINEMATICS) 5axiskins\nset KERF(JOINTS) {2 1 0}\n", "2 1 0; 1000.0\n"},
      {mm + "set KERF(JOINTS) {0 1}\n",
       "[KERF]JOINTS: \"0 1\" found; must be the joints of X Y Z, as in \"0 1 2\" or \"0 - 1\"\n"},
      {"set TRAJ(LINEAR_UNITS) inch\n", "0 1 2; 25400.0\n"},
      {"set TRAJ(LINEAR_UNITS) 0.03937007874015748\n", "0 1 2; 25400.0\n"},
      {"set TRAJ(LINEAR_UNITS) inch\nset KERF(UM_PER_UNIT) 1000\n", "0 1 2; 1000\n"},
      {"set TRAJ(LINEAR_UNITS) inch\nset KERF(UM_PER_UNIT) 0\n",
       "[KERF]UM_PER_UNIT: \"0\" found; must be above 0: 1000 for mm, 25400 for inches\n"},
      {"set TRAJ(LINEAR_UNITS) cubit\n",
       "[TRAJ]LINEAR_UNITS: \"cubit\" found; give [KERF]UM_PER_UNIT = 1000 (mm) or 25400 "
       "(inches)\n"}};
  for (const auto& [ini, made] : wanted) EXPECT_EQ(made_of(ini), made) << ini;
}

TEST(ClassicLadderFile, IsWhatItsGeneratorWrites) {
  std::string output;
  EXPECT_EQ(
      shell(LINUXCNC_CONFIGS "/make_ladder.py | cmp - " LINUXCNC_CONFIGS "/kerf_positions.clp 2>&1",
            output),
      0)
      << output;
}

}  // namespace
}  // namespace kerf
