// Recorded runs of a real LinuxCNC. Needs KERF_SHARED_DATA, and xz.
#include <fmt/format.h>

#include <cstdlib>

#include "tests/machine_io/logs/log_test_support.h"

namespace kerf {
namespace {

class LogData : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* data = std::getenv("KERF_SHARED_DATA");
    if (data == nullptr) GTEST_SKIP() << "KERF_SHARED_DATA is not set";
    if (std::system("command -v xz > /dev/null") != 0) GTEST_SKIP() << "needs the package xz-utils";
    logs_ = std::string(data) + "/live_logs/";
  }

  std::string unpacked(const std::string& name) const {
    const std::string path = folder_.file(name);
    const std::string command = fmt::format("xz -dc '{}{}.xz' > '{}'", logs_, name, path);
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    return path;
  }

  ReadLog read_hal1k(const std::string& name) const {
    Diagnostics diagnostics;
    const auto pins = pins_from_hal_file(logs_ + "sampler.hal", 0, diagnostics);
    EXPECT_EQ(all_text(diagnostics), "");
    return read_hal1k(name, pins);
  }

  ReadLog read_hal1k(const std::string& name, const std::vector<std::string>& pins) const {
    LogSettings settings;
    settings.pins = pins;
    settings.path = unpacked(name);
    return read_log(std::move(settings));
  }

  std::string logs_;
  TestFolder folder_;
};

TEST_F(LogData, NamesThePinsOfTheSampler) {
  Diagnostics diagnostics;
  const auto pins = pins_from_hal_file(logs_ + "sampler.hal", 0, diagnostics);
  EXPECT_EQ(pins, (std::vector<std::string>{
                      "joint.0.pos-fb", "joint.1.pos-fb", "joint.2.pos-fb", "signal Xpos",
                      "signal Ypos", "signal Zpos", "motion.tooloffset.z", "motion.current-vel",
                      "spindle.0.speed-out", "spindle.0.on", "motion.in-position",
                      "iocontrol.0.tool-number", "motion.program-line"}));
}

TEST_F(LogData, TheHundredHertzCsvIsEveryTenthOfTheSampler) {
  for (const std::string name : {"pocket_drill", "chips_piece"}) {
    const ReadLog slow = read_file(logs_ + name + ".100hz.csv");
    ASSERT_TRUE(slow.is_open) << all_text(slow.errors);
    const ReadLog fast = read_hal1k(name + ".hal1k");
    ASSERT_TRUE(fast.is_open) << all_text(fast.errors);
    EXPECT_EQ(slow.status.errors + slow.status.duplicates + slow.status.disordered, 0U);
    EXPECT_EQ(fast.status.errors + fast.status.duplicates + fast.status.disordered, 0U);
    EXPECT_EQ(fast.status.lost, 0U);
    EXPECT_GT(slow.samples.size(), 6000U);
    ASSERT_GE(fast.samples.size(), slow.samples.size() * 10 - 9);
    for (std::size_t i = 0; i < slow.samples.size(); ++i) {
      const AxisSample& a = slow.samples[i];
      const AxisSample& b = fast.samples[i * 10];
      ASSERT_EQ(a.device_ns, b.device_ns);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        // The CSV has four decimals.
        ASSERT_NEAR(a.position[axis], b.position[axis], 0.5001e-4) << name << " sample " << i;
      }
      ASSERT_EQ(a.tool, b.tool);
      ASSERT_EQ(a.line, b.line);
      ASSERT_NEAR(a.tool_offset_z_mm, b.tool_offset_z_mm, 0.5001e-3);
      ASSERT_NEAR(a.spindle_rpm, b.spindle_rpm, 0.5001);
    }
  }
}

TEST_F(LogData, TheBusesShowTheSameMotion) {
  // The drives report motor positions, which the sampler has in columns of their own. Both logs
  // were made of the sampler's, every tenth line.
  const std::vector<std::string> motors{"", "", "", "joint0", "joint1", "joint2", "",
                                        "", "", "", "",       "",       ""};
  const ReadLog hal = read_hal1k("pocket_drill.hal1k", motors);
  LogSettings drives;
  drives.path = unpacked("pocket_drill.cia402.candump.log");
  drives.can_map.emplace();
  for (std::uint8_t i = 0; i < 3; ++i) {
    drives.can_map->axes[i] = cia402_position(static_cast<std::uint8_t>(i + 1), 0.001);
  }
  const ReadLog cia402 = read_log(drives);
  ASSERT_TRUE(cia402.is_open) << all_text(cia402.errors);
  EXPECT_EQ(cia402.status.errors + cia402.status.disordered, 0U);
  ASSERT_EQ(cia402.samples.size(), (hal.samples.size() + 9) / 10);
  for (std::size_t i = 0; i < cia402.samples.size(); ++i) {
    ASSERT_EQ(cia402.samples[i].known, 0b111);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // Counts of 0.001 mm.
      ASSERT_NEAR(cia402.samples[i].position[axis], hal.samples[i * 10].position[axis], 0.000501)
          << "sample " << i;
    }
  }

  LogSettings turns;
  turns.path = unpacked("pocket_drill.odrive.candump.log");
  turns.can_map.emplace();
  for (std::uint8_t i = 0; i < 3; ++i) turns.can_map->axes[i] = odrive_position(i, 5.0);
  const ReadLog odrive = read_log(turns);
  ASSERT_TRUE(odrive.is_open) << all_text(odrive.errors);
  EXPECT_EQ(odrive.status.errors, 0U);
  ASSERT_EQ(odrive.samples.size(), cia402.samples.size());
  for (std::size_t i = 0; i < odrive.samples.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ASSERT_NEAR(odrive.samples[i].position[axis], cia402.samples[i].position[axis], 0.0011);
    }
  }
}

TEST_F(LogData, ARegisterTableIsNoLogOfPositions) {
  const ReadLog log = read_file(logs_ + "pocket_drill.classicladder_poll50hz.csv");
  EXPECT_FALSE(log.is_open);
  ASSERT_EQ(log.errors.size(), 1U);
  EXPECT_EQ(log.errors[0].message,
            "none of the columns is a position; found: t_request, t_reply, r0, r1, r2, r3, r4, r5, "
            "r6, r7, r8");
}

}  // namespace
}  // namespace kerf
