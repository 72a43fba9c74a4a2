// The network cable between kerf and the machine is out for ten seconds while the machine moves:
// what the user sees, what is recorded, and what is cut. Skipped where network namespaces are not
// permitted.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/live/classicladder/linuxcnc_session.h"

namespace kerf {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

/// Twenty seconds on line 5, at 6 mm/s.
constexpr const char* kProgram =
    "G21 G90 G94 G17 G64 P0.01\n"
    "T1 M6 S8000 M3\n"
    "G0 X0 Y0 Z2\n"
    "G1 Z-2 F600\n"
    "G1 X120 F360\n"
    "G0 Z5\n"
    "M5\n"
    "M2\n";
constexpr double kSpeed_mm_per_s = 6;
constexpr double kSlot_mm = 120;
constexpr double kOut_s = 10;

constexpr const char* kConfig =
    "source:\n"
    "  type: modbus\n"
    "  tcp: 10.77.0.2:1502\n"
    "  poll_hz: 100\n"
    "  frame: workpiece\n"
    "  coordinates: axes\n"
    "  map:\n"
    "    X: {register: 0, type: int32, word_order: cdab, scale: 0.001}\n"
    "    Y: {register: 2, type: int32, word_order: cdab, scale: 0.001}\n"
    "    Z: {register: 4, type: int32, word_order: cdab, scale: 0.001}\n"
    "    tool: {register: 12, type: uint16}\n"
    "    line: {register: 13, type: uint32, word_order: cdab}\n"
    "    counter: {register: 15, type: uint16}\n"
    "    spindle: {register: 16, type: int16}\n";

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// One run with the cable out, for all tests of one way to be out.
struct PulledRun {
  fs::path folder;
  std::string said;
  std::vector<Json> events;
  Json report;

  explicit PulledRun(const std::string& how) {
    std::string pattern = (fs::temp_directory_path() / "kerf-cable.XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) return;
    folder = pattern;
    std::ofstream(folder / "part.ngc") << kProgram;
    std::ofstream(folder / "machine.yaml") << kConfig;
    shell(std::string(PULL_CABLE) + " " + KERF_MACHINE_EXECUTABLE + " " + KERF_EXECUTABLE + " " +
              how + " " + folder.string() + " 2>&1",
          said);
    said += text_of(folder / "err") + text_of(folder / "machine_out");
    std::ifstream lines(folder / "events");
    for (std::string line; std::getline(lines, line);) {
      events.push_back(Json::parse(line, nullptr, false));
    }
    report = Json::parse(text_of(folder / "live.json"), nullptr, false);
  }
  ~PulledRun() {
    std::error_code ignored;
    if (!folder.empty()) fs::remove_all(folder, ignored);
  }
  /// The states, each when it begins.
  std::vector<std::string> states() const {
    std::vector<std::string> out;
    for (const Json& event : events) {
      if (event["event"] != "status") continue;
      const std::string state = event["state"];
      if (out.empty() || out.back() != state) out.push_back(state);
    }
    return out;
  }
};

/// Both at the same time: each has computers of its own.
const PulledRun& the_run(const std::string& how) {
  using Run = std::unique_ptr<PulledRun>;
  static const auto both = [] {
    auto lost = std::async(std::launch::async, [] { return std::make_unique<PulledRun>("lost"); });
    Run unplugged = std::make_unique<PulledRun>("unplugged");
    return std::pair<Run, Run>(std::move(unplugged), lost.get());
  }();
  return how == "lost" ? *both.second : *both.first;
}

const std::string& missing() {
  static const std::string reason = [] {
    std::string said;
    const int status = shell(PULL_CABLE " --check", said);
    return status == 0 ? std::string() : "pull_cable --check: " + said;
  }();
  return reason;
}

class CableOut : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!missing().empty()) GTEST_SKIP() << missing();
    ASSERT_TRUE(run().report.is_object()) << run().said;
    for (const Json& event : run().events) ASSERT_TRUE(event.is_object()) << run().said;
  }
  const PulledRun& run() const { return the_run(GetParam()); }
};

TEST_P(CableOut, IsSeenAsStaleThenLostThenLiveAgain) {
  const std::vector<std::string> wanted = {"live", "stale", "lost", "live", "ended"};
  std::vector<std::string> states = run().states();
  if (!states.empty() && states.front() == "waiting") states.erase(states.begin());
  EXPECT_EQ(states, wanted) << run().said;
  // On the console, too, with its age.
  const std::string err = text_of(run().folder / "err");
  const std::size_t stale = err.find("kerf: stale ");
  const std::size_t lost = err.find("kerf: lost ");
  ASSERT_NE(stale, err.npos) << err;
  ASSERT_NE(lost, err.npos) << err;
  EXPECT_NE(err.find("kerf: live ", lost), err.npos) << err;
}

/// While nothing comes the age grows, and no position is made up.
TEST_P(CableOut, TheLastPositionIsKeptWithItsAge) {
  double oldest_ms = 0;
  double x_mm = 0;
  bool is_silent = false;
  for (const Json& event : run().events) {
    if (event["event"] != "status") continue;
    const bool gone = event["state"] == "stale" || event["state"] == "lost";
    const bool known = event["tip_mm"].is_array();
    if (gone && is_silent && known) {
      EXPECT_EQ(event["tip_mm"][0], x_mm);
    }
    if (gone) {
      EXPECT_GT(event["age_ms"], oldest_ms);
      oldest_ms = event["age_ms"];
    }
    if (known) x_mm = event["tip_mm"][0];
    is_silent = gone;
  }
  EXPECT_GT(oldest_ms, 0.9 * kOut_s * 1e3);
}

TEST_P(CableOut, NothingIsRecordedMeanwhile) {
  std::ifstream lines(run().folder / "run.csv");
  double before_s = 0;
  std::vector<double> pauses_s;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] < '0' || line[0] > '9') continue;
    const double t_s = std::strtod(line.c_str(), nullptr);
    if (before_s > 0 && t_s - before_s > 0.5) pauses_s.push_back(t_s - before_s);
    before_s = t_s;
  }
  ASSERT_EQ(pauses_s.size(), 1U);
  EXPECT_GT(pauses_s[0], kOut_s - 0.5);
}

TEST_P(CableOut, TheConnectionComesBackByItself) {
  const Json& live = run().report["live"];
  EXPECT_GE(live["reconnects"], 1) << live;
  EXPECT_GE(live["errors"], 1) << live;
  // Soon after the cable is in again: the longest pause between two attempts, and one connection.
  EXPECT_LT(live["gap_s"], kOut_s + 5) << live;
}

TEST_P(CableOut, TheGapIsFoundAndCutAsTheProgramHasIt) {
  const Json& live = run().report["live"];
  EXPECT_EQ(live["gaps"], 1) << live;
  EXPECT_GT(live["gap_s"], kOut_s - 0.5);
  const double gap_mm = live["gap_max_mm"];
  EXPECT_GT(gap_mm, (kOut_s - 1) * kSpeed_mm_per_s);
  int gaps = 0;
  for (const Json& finding : run().report["findings"]) {
    if (finding["id"] != "source-gap") continue;
    ++gaps;
    EXPECT_EQ(finding["severity"], "warning");
    const std::string message = finding["message"];
    EXPECT_NE(message.find("cut as the program has it"), std::string::npos) << message;
  }
  EXPECT_EQ(gaps, 1) << run().report["findings"];
  // A slot of flat:6, 2 mm deep, that ends in two half circles: what has not been seen is in it.
  const double cut_mm3 = kSlot_mm * 6 * 2 + 9 * 3.14159265 * 2;
  EXPECT_NEAR(run().report["stock"]["removed_mm3"], cut_mm3, 0.002 * cut_mm3);
}

TEST_P(CableOut, TheExitCodeSaysThatDataWasLost) {
  EXPECT_EQ(text_of(run().folder / "exit"), "3\n") << run().said;
}

TEST_P(CableOut, TheRecordingReplaysWithTheSameGap) {
  std::string said;
  const std::string folder = run().folder.string();
  const std::string replay =
      "cd " + folder + " && " + KERF_EXECUTABLE +
      " replay run.csv --speed max --program part.ngc --stock box:-5,-10,-6:125,10,0 --tool "
      "1=flat:6 --cell 0.2 --quiet --json again.json 2>&1";
  EXPECT_EQ(shell(replay, said), 3) << said;
  const Json again = Json::parse(text_of(run().folder / "again.json"), nullptr, false);
  ASSERT_FALSE(again.is_discarded()) << said;
  EXPECT_EQ(again["live"]["samples"], run().report["live"]["samples"]);
  EXPECT_EQ(again["live"]["gaps"], 1);
  const double removed = run().report["stock"]["removed_mm3"];
  EXPECT_NEAR(again["stock"]["removed_mm3"], removed, 0.005 * removed);
}

INSTANTIATE_TEST_SUITE_P(Ways, CableOut, ::testing::Values("unplugged", "lost"),
                         [](const auto& way) { return std::string(way.param); });

}  // namespace
}  // namespace kerf
