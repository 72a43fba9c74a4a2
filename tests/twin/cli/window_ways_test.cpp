// What is opened in a window, and what is changed on the disk meanwhile: after a dry run, of a log,
// one instead of the other.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>

#include "tests/twin/cli/window_process.h"
#include "tests/viewer/virtual_display.h"

namespace kerf {
namespace {

constexpr const char* kProgram =
    "G21 G90 G94 G17 G64 P0.01\n"
    "T1 M6 S8000 M3\n"
    "G0 X0 Y0 Z2\n"
    "G1 Z-2 F1200\n"
    "G1 X20 F3000\n"
    "G0 Z5\n"
    "M5\n"
    "M2\n";

const std::vector<std::string> kWork = {
    "--stock", "box:-10,-10,-6:40,30,0", "--tool", "1=flat:6", "--cell", "0.2"};

class WindowWays : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!display_trouble().empty()) GTEST_SKIP() << display_trouble();
  }
  void open(std::vector<std::string> arguments) {
    KerfCall call;
    call.arguments = std::move(arguments);
    call.arguments.insert(call.arguments.end(), kWork.begin(), kWork.end());
    kerf_ = std::make_unique<WindowedKerf>(std::move(call));
    ASSERT_TRUE(kerf_->opens()) << (kerf_->has_ended() ? kerf_->finish().err : "");
  }
  /// The same slot, which may be drawn more finely than at first: another one makes over 1000.
  bool shows_again(const Picture& before) {
    return kerf_->shows([&](const Picture& now) { return different_pixels(before, now) < 700; });
  }
  /// A slot along X at this Y, driven in half a second.
  static std::string log_text(double y_mm) {
    std::string text = "t_s,x_mm,y_mm,z_mm,tool\n";
    for (int i = 0; i <= 50; ++i) {
      text += fmt::format("{:.2f},{:.4f},{},-2,1\n", 0.01 * i, 0.5 * i, y_mm);
    }
    return text;
  }
  void close(int exit_code) {
    kerf_->key("Q");
    const KerfResult result = kerf_->finish();
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    result_ = result;
  }
  TestFolder folder_;
  std::string program_ = folder_.write("part.ngc", kProgram);
  std::unique_ptr<WindowedKerf> kerf_;
  KerfResult result_;
};

TEST_F(WindowWays, AfterADryRunAChangedProgramIsReadAgain) {
  open({"run", program_, "--view", "--quiet"});
  const Picture slot = kerf_->settled();
  std::string text = kProgram;
  text.replace(text.find("G1 X20"), 6, "G1 Y20");
  folder_.write("part.ngc", text);
  EXPECT_TRUE(kerf_->changes_from(slot));
  close(0);
}

TEST_F(WindowWays, AJobPlaysThroughItsSetups) {
  folder_.write("bottom.ngc", kProgram);
  folder_.write("job.yaml",
                "setups:\n"
                "  - {program: part.ngc, stock: 'box:-10,-10,-6:40,30,0', tools: 1=flat:6, "
                "cell_mm: 0.2}\n"
                "  - {program: bottom.ngc, tools: 1=flat:6, flip: x, zero: top, name: below}\n");
  KerfCall call;
  call.arguments = {"view", folder_.file("job.yaml"), "--speed", "max"};
  kerf_ = std::make_unique<WindowedKerf>(std::move(call));
  ASSERT_TRUE(kerf_->opens()) << (kerf_->has_ended() ? kerf_->finish().err : "");
  EXPECT_TRUE(kerf_->is_titled("kerf - job.yaml, setup 2 of 2: below"));
  const Picture second = kerf_->settled();
  kerf_->key("Prior");
  EXPECT_TRUE(kerf_->is_titled("kerf - job.yaml, setup 1 of 2"));
  EXPECT_TRUE(kerf_->changes_from(second));
  close(0);
  const std::string recent = read_file(kerf_->home() + "/kerf/view.conf");
  EXPECT_NE(recent.find("recent.1 = " + folder_.file("job.yaml")), std::string::npos) << recent;
}

TEST_F(WindowWays, AChangedLogIsReplayedAgain) {
  const std::string log = folder_.write("run.csv", log_text(0));
  open({"replay", log, "--json", folder_.file("report.json"), "--quiet"});
  const Picture first = kerf_->settled();
  folder_.write("run.csv", log_text(20));
  EXPECT_TRUE(kerf_->changes_from(first, 1000));
  const Picture second = kerf_->settled();
  // What cannot be replayed leaves what is there.
  folder_.write("run.csv", "what is this\n");
  std::this_thread::sleep_for(std::chrono::seconds(1));
  EXPECT_TRUE(shows_again(second));
  folder_.write("run.csv", log_text(0));
  EXPECT_TRUE(shows_again(first));
  close(0);
}

TEST_F(WindowWays, ALogIsOpenedLikeAProgramAndTheOtherWayRound) {
  const std::string log = folder_.write("run.csv", log_text(20));
  const std::string other = folder_.write("other.csv", log_text(5));
  open({"view", program_, "--speed", "max"});
  const Picture program = kerf_->settled();
  kerf_->open_file(log);
  EXPECT_TRUE(kerf_->changes_from(program, 1000));
  const Picture replayed = kerf_->settled();
  kerf_->open_file(other);
  EXPECT_TRUE(kerf_->changes_from(replayed, 1000));
  kerf_->settled();
  kerf_->open_file(program_);
  ASSERT_TRUE(kerf_->is_titled("kerf - part.ngc"));
  close(0);
  const std::string recent = read_file(kerf_->home() + "/kerf/view.conf");
  EXPECT_NE(recent.find("recent.1 = " + program_), std::string::npos) << recent;
  EXPECT_NE(recent.find("recent.2 = " + other), std::string::npos) << recent;
  EXPECT_NE(recent.find("recent.3 = " + log), std::string::npos) << recent;
}

TEST_F(WindowWays, ALogThatCannotBeReplayedLeavesTheProgram) {
  const std::string log = folder_.write("run.csv", "what is this\n");
  open({"view", program_});
  const Picture program = kerf_->settled();
  kerf_->open_file(log);
  std::this_thread::sleep_for(std::chrono::seconds(1));
  EXPECT_TRUE(shows_again(program));
  kerf_->key("End");
  EXPECT_TRUE(kerf_->changes_from(program)) << "it still plays";
  close(0);
}

TEST_F(WindowWays, AReplayOpensAnotherLog) {
  const std::string log = folder_.write("run.csv", log_text(0));
  const std::string other = folder_.write("other.csv", log_text(20));
  open({"replay", log, "--quiet"});
  const Picture first = kerf_->settled();
  kerf_->open_file(program_);  // refused: not in this window
  std::this_thread::sleep_for(std::chrono::seconds(1));
  EXPECT_TRUE(shows_again(first));
  kerf_->open_file(other);
  EXPECT_TRUE(kerf_->changes_from(first, 1000));
  close(0);
}

}  // namespace
}  // namespace kerf
