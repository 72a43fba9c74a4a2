// A real headless LinuxCNC runs a program; HalSource reads it through the real kerf-hal. Skipped
// where LinuxCNC or namespaces of one's own are missing.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "machine_io/hal/hal_stream.h"

namespace kerf {
namespace {

using Point = std::array<double, 3>;

/// Exact stop (G61): the machine goes through every point of the path. Lines are numbered from 1.
constexpr const char* kProgram =
    "G21 G90 G17 G61 G54\n"  // 1
    "T1 M6\n"                // 2
    "G43 S1000 M3\n"         // 3
    "G0 X0 Y0 Z5\n"          // 4
    "G1 Z-1 F1200\n"         // 5
    "G1 X20 F3000\n"         // 6
    "G1 Y10\n"               // 7
    "G2 X0 Y10 I-10 J0\n"    // 8, half a circle of radius 10 round X10 Y10
    "G1 X0 Y0\n"             // 9
    "G0 Z5\n"                // 10
    "M5\n"
    "M2\n";

/// G54 of mill3.var and the length of tool 1 of mill3.tbl.
constexpr Point kWork{20, -10, -40};
constexpr double kToolLength = 35;

/// Rounding of LinuxCNC's simulated steps and of its arcs; the path itself is exact.
constexpr double kPathTolerance_mm = 0.002;

/// What the machine goes in a servo cycle of 1 ms at F3000. The servo thread of a simulation has no
/// real-time priority: a busy computer may hold it up between two joints, and a reading then mixes
/// two successive cycles (machine_io/hal/README.md). Rare, and never farther off than this.
constexpr double kCycle_mm = 0.05;
constexpr double kMixedShare = 0.002;

double distance(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

double distance_to_line(const Point& p, const Point& a, const Point& b) {
  const Point d{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const double along = (p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1] + (p[2] - a[2]) * d[2];
  const double t = std::clamp(along / (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), 0.0, 1.0);
  return distance(p, {a[0] + t * d[0], a[1] + t * d[1], a[2] + t * d[2]});
}

/// The half circle of line 8: clockwise from X20 Y10 by way of X10 Y0 to X0 Y10.
double distance_to_arc(const Point& p) {
  const double y = std::min(p[1], 10.0);
  const double angle = std::atan2(y - 10, p[0] - 10);
  return distance(p, {10 + 10 * std::cos(angle), 10 + 10 * std::sin(angle), -1});
}

/// The corners of the program, in G54.
const std::map<int, std::pair<Point, Point>> kLines{{5, {{0, 0, 5}, {0, 0, -1}}},
                                                    {6, {{0, 0, -1}, {20, 0, -1}}},
                                                    {7, {{20, 0, -1}, {20, 10, -1}}},
                                                    {9, {{0, 10, -1}, {0, 0, -1}}},
                                                    {10, {{0, 0, -1}, {0, 0, 5}}}};

double distance_to_move(const Point& p, int line) {
  if (line == 8) return distance_to_arc(p);
  const auto move = kLines.find(line);
  return move == kLines.end() ? NAN : distance_to_line(p, move->second.first, move->second.second);
}

double distance_to_path(const Point& p) {
  double nearest = distance_to_arc(p);
  for (const auto& [line, ends] : kLines) {
    nearest = std::min(nearest, distance_to_line(p, ends.first, ends.second));
  }
  return nearest;
}

struct Sample {
  std::int64_t host_ns = 0;
  std::int64_t device_ns = 0;
  int known = 0;
  int tool = 0;
  int line = 0;
  double tool_offset = NAN;
  double spindle = NAN;
  Point joint{};
  double load = NAN;

  Point tip() const {
    return {joint[0] - kWork[0], joint[1] - kWork[1], joint[2] - kWork[2] - tool_offset};
  }
};

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<Sample> samples_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<Sample> samples;
  Sample s;
  while (file >> s.host_ns >> s.device_ns >> s.known >> s.tool >> s.line >> s.tool_offset >>
         s.spindle >> s.joint[0] >> s.joint[1] >> s.joint[2] >> s.load) {
    samples.push_back(s);
  }
  return samples;
}

/// The exit status, and stdout in `output`.
int shell(const std::string& command, std::string& output) {
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return -1;
  std::array<char, 512> part{};
  while (std::fgets(part.data(), part.size(), pipe) != nullptr) output += part.data();
  const int status = pclose(pipe);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Two sessions of LinuxCNC, read by one HalSource that is there before the first and after the
/// last. Run once for all tests of this file: each looks at another side of it.
class HalLive : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (shell(std::string(RUN_LINUXCNC) + " --check", missing_) != 0) return;
    missing_.clear();
    std::string pattern = (std::filesystem::temp_directory_path() / "hal_live.XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    const std::filesystem::path run = folder_ / "run";
    std::ofstream(folder_ / "program.ngc") << kProgram;
    // While the machine stands at the program's end, and its pins say so: HAL as it is, a second
    // kerf-hal, and HAL with its threads stopped, until HalSource has come back from that.
    const std::string at_end =
        "timeout 20 bash -c 'until halcmd getp halui.program.is-idle | grep -q TRUE; do "
        "sleep 0.02; done'; "
        "halcmd -s show pin >pins.txt; halcmd -s show sig >sigs.txt; " KERF_HAL
        " --rate 100 2>second.txt | head -c " +
        std::to_string(sizeof(HalSampleRecord)) +
        " >second.bin; "
        "halcmd stop; " KERF_HAL
        " 2>still.txt >still.bin; echo $? >>still.txt; "
        "timeout 20 bash -c 'while halcmd -s list comp | grep -q kerf-hal; do sleep 0.02; done'; "
        "halcmd start; "
        "timeout 20 bash -c 'until halcmd -s list comp | grep -q kerf-hal; do sleep 0.02; done'";
    setenv("KERF_LIVE_AT_END", at_end.c_str(), 1);
    status_ = shell(std::string(RUN_LINUXCNC) +
                        " --sessions 2 --beside '" HAL_PROBE " " KERF_HAL " 500 probe' " +
                        (folder_ / "program.ngc").string() + " " + run.string() + " 2>&1",
                    output_);
    samples_ = samples_of(run / "probe.csv");
  }
  static void TearDownTestSuite() {
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }

  void SetUp() override {
    if (!missing_.empty()) GTEST_SKIP() << missing_;
    ASSERT_EQ(status_, 0) << output_ << text_of(folder_ / "run/linuxcnc.log");
    ASSERT_FALSE(samples_.empty()) << output_;
  }

  std::string file(const char* name) const { return text_of(folder_ / "run" / name); }

  static inline std::string missing_;
  static inline std::filesystem::path folder_;
  static inline std::string output_;
  static inline int status_ = -1;
  static inline std::vector<Sample> samples_;
};

TEST_F(HalLive, PositionsLieOnTheProgrammedPath) {
  std::map<int, int> samples_of_line;
  double worst = 0;
  int read = 0;
  int mixed = 0;
  for (const Sample& sample : samples_) {
    if (sample.line < 5 || sample.line > 10) continue;
    ++samples_of_line[sample.line];
    const double away = distance_to_path(sample.tip());
    EXPECT_LT(away, kCycle_mm);
    ++read;
    if (away < kPathTolerance_mm) {
      worst = std::max(worst, away);
    } else {
      ++mixed;
    }
    EXPECT_EQ(sample.known, 0b111);
    EXPECT_EQ(sample.tool, 1);
    EXPECT_EQ(sample.tool_offset, kToolLength);
    EXPECT_EQ(sample.spindle, 1000);
  }
  RecordProperty("worst_mm", std::to_string(worst));
  RecordProperty("mixed", mixed);
  EXPECT_LE(mixed, 1 + kMixedShare * read);
  for (int line = 5; line <= 10; ++line) EXPECT_GT(samples_of_line[line], 50) << "line " << line;
}

/// The probe has the pin of a joint for a drive's load, by twice its number and one. It is read
/// after the joints: where the servo thread comes between the two, it is that of the next cycle.
TEST_F(HalLive, TheLoadIsThatOfItsPin) {
  double lowest = 1e9, highest = -1e9;
  int later = 0;
  for (const Sample& sample : samples_) {
    ASSERT_TRUE(std::isfinite(sample.load));
    if (!(std::abs(sample.load - (2 * sample.joint[2] + 1)) <= 1e-9)) ++later;
    lowest = std::min(lowest, sample.load), highest = std::max(highest, sample.load);
  }
  RecordProperty("later", later);
  EXPECT_LE(later, 1 + kMixedShare * static_cast<double>(samples_.size()));
  EXPECT_GT(highest - lowest, 10) << "it moved";
}

TEST_F(HalLive, EveryCornerIsReached) {
  std::vector<Point> corners{{20, 10, -1}, {10, 0, -1}};
  for (const auto& [line, ends] : kLines) corners.push_back(ends.second);
  for (const Point& corner : corners) {
    double nearest = INFINITY;
    for (const Sample& sample : samples_) {
      nearest = std::min(nearest, distance(sample.tip(), corner));
    }
    // A sample every 2 ms at 50 mm/s on the arc: at most 0.05 mm from its lowest point.
    EXPECT_LT(nearest, 0.06) << corner[0] << ' ' << corner[1] << ' ' << corner[2];
  }
}

TEST_F(HalLive, TheLineIsThatOfTheMove) {
  int lines = 0;
  int elsewhere = 0;
  for (const Sample& sample : samples_) {
    if (sample.line < 5 || sample.line > 10) continue;
    ++lines;
    if (!(distance_to_move(sample.tip(), sample.line) < kPathTolerance_mm)) ++elsewhere;
  }
  // Line and position are written at different moments of a servo cycle.
  EXPECT_LE(elsewhere, lines / 100) << "of " << lines;
}

TEST_F(HalLive, TimesGrowAndClocksAgree) {
  std::size_t disordered = 0;
  double most_ms = 0;
  for (std::size_t i = 1; i < samples_.size(); ++i) {
    if (samples_[i].device_ns <= samples_[i - 1].device_ns) ++disordered;
    const std::int64_t host = samples_[i].host_ns - samples_[i - 1].host_ns;
    const std::int64_t device = samples_[i].device_ns - samples_[i - 1].device_ns;
    most_ms = std::max(most_ms, std::abs(static_cast<double>(host - device)) * 1e-6);
  }
  EXPECT_EQ(disordered, 0u);
  EXPECT_LT(most_ms, 50.0);
}

TEST_F(HalLive, OutlivesLinuxCncAndComesBack) {
  const std::string states = file("probe.states");
  EXPECT_EQ(states.rfind("0 no LinuxCNC runs on this computer\n", 0), 0u) << states;
  EXPECT_NE(states.find("\n0 LinuxCNC has ended (it asked kerf-hal to end)\n"), std::string::npos)
      << states;
  std::istringstream last(states.substr(states.rfind("samples")));
  std::string word;
  std::uint64_t count = 0;
  std::map<std::string, std::uint64_t> counters;
  while (last >> word >> count) counters[word] = count;
  EXPECT_EQ(counters["samples"], samples_.size());
  EXPECT_EQ(counters["errors"], 0u);
  // The second session, and after the stop in each.
  EXPECT_EQ(counters["reconnects"], 3u) << states;
  EXPECT_LT(counters["lost"], samples_.size() / 5) << states;
}

TEST_F(HalLive, ValuesThatNobodyWritesAreNotHandedOn) {
  const std::string said =
      "LinuxCNC's servo thread stands still (LinuxCNC was killed, or HAL is stopped)\n";
  EXPECT_NE(file("still.txt").find("kerf-hal: " + said + "4\n"), std::string::npos)
      << file("still.txt");
  EXPECT_EQ(file("still.bin"), "");
  EXPECT_NE(file("probe.states").find("\n0 " + said), std::string::npos) << file("probe.states");
}

TEST_F(HalLive, ThePinsShowWhatKerfSays) {
  std::istringstream pins(file("pins.txt"));
  std::map<std::string, std::string> values;
  std::string line;
  while (std::getline(pins, line)) {
    std::istringstream words(line);
    std::string owner, type, direction, value, name, rest;
    words >> owner >> type >> direction >> value >> name >> rest;
    if (owner.rfind("kerf-hal-", 0) != 0) continue;
    EXPECT_EQ(direction, "OUT") << line;
    EXPECT_EQ(name.rfind("kerf.", 0), 0u) << line;
    EXPECT_EQ(rest, "") << line;
    values[name] = value;
  }
  EXPECT_GT(std::stol(values["kerf.heartbeat"]), 10);
  values.erase("kerf.heartbeat");
  EXPECT_EQ(values.count("kerf.beat"), 1U) << "it goes over all the time";
  values.erase("kerf.beat");
  EXPECT_EQ(values, (std::map<std::string, std::string>{{"kerf.alive", "TRUE"},
                                                        {"kerf.collision-ahead", "TRUE"},
                                                        {"kerf.collision-seconds", "3.5"},
                                                        {"kerf.finding-line", "7"},
                                                        {"kerf.findings", "-1"},
                                                        {"kerf.off-path", "FALSE"},
                                                        {"kerf.off-path-mm", "0.25"},
                                                        {"kerf.program-ok", "FALSE"},
                                                        {"kerf.stale", "FALSE"},
                                                        {"kerf.time-left", "-1"}}));
}

TEST_F(HalLive, NothingIsLinked) {
  const std::string signals = file("sigs.txt");
  // The configuration itself links the motor positions, and nothing that kerf-hal reads.
  EXPECT_NE(signals.find(" joint.0.motor-pos-fb"), std::string::npos) << signals;
  for (const char* name : {" joint.0.pos-fb", " joint.1.pos-fb", " motion.program-line", "kerf"}) {
    EXPECT_EQ(signals.find(name), std::string::npos) << name << " in\n" << signals;
  }
}

TEST_F(HalLive, ASecondOneReadsAndSaysThatThePinsAreTaken) {
  EXPECT_NE(file("second.txt").find("the pins kerf.* are those of another component"),
            std::string::npos);
  const std::string bytes = file("second.bin");
  ASSERT_EQ(bytes.size(), sizeof(HalSampleRecord));
  HalSampleRecord record;
  std::memcpy(&record, bytes.data(), sizeof(record));
  EXPECT_FALSE(head_fault(record).has_value());
  EXPECT_NE(record.on & kHalPinsTaken, 0u);
  EXPECT_EQ(record.joint_count, 3u);
  EXPECT_NEAR(record.joint[2], 5 + kWork[2] + kToolLength, 1e-6);
  EXPECT_TRUE(std::isnan(record.joint[3]));
  EXPECT_EQ(record.known, kHalPinsTaken | kHalToolNumber | kHalProgramLine | kHalInPosition |
                              kHalProgramRunning | kHalProgramPaused | kHalProgramIdle |
                              kHalModeAuto);
  EXPECT_EQ(record.on, kHalPinsTaken | kHalInPosition | kHalProgramIdle | kHalModeAuto);
}

}  // namespace
}  // namespace kerf
