// A real headless LinuxCNC loads its kinematics modules and says where joints and axes are: kerf's
// chains say the same. Skipped where LinuxCNC or namespaces of one's own are missing.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "tests/twin/machine/kinematics/recorded_places.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

constexpr double kTolerance = 1e-6;

int shell(const std::string& command, std::string& output) {
  std::FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return -1;
  std::array<char, 4096> block;
  while (std::fgets(block.data(), block.size(), pipe) != nullptr) output += block.data();
  const int status = pclose(pipe);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class LiveKinematics : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    std::string reason;
    if (shell(RUN_LINUXCNC " --check", reason) != 0) GTEST_SKIP() << reason;
    std::string pattern = (fs::temp_directory_path() / "kerf-kinematics.XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
  }
  fs::path folder_;
};

TEST_P(LiveKinematics, TheModuleSaysWhatTheChainSays) {
  const std::string name = GetParam();
  std::string said;
  ASSERT_EQ(shell(std::string(RECORD_KINEMATICS) + " " + name + " " + folder_.string(), said), 0)
      << said;
  const RecordedMachine live = read_recorded((folder_ / (name + ".csv")).string());
  ASSERT_GE(live.places.size(), 20u);
  const auto machine = known_machine(live.kinematics, "", live.geometry, {});
  ASSERT_TRUE(machine) << machine.error();
  const KinematicsErrors errors = errors_of(live, *machine);
  EXPECT_LT(errors.axes, kTolerance);
  EXPECT_LT(errors.joints, kTolerance);
}

INSTANTIATE_TEST_SUITE_P(Modules, LiveKinematics,
                         ::testing::Values("trivkins_a", "corexykins", "xyzac-trt-kins",
                                           "xyzbc-trt-kins", "5axiskins", "maxkins"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           for (char& c : name) {
                             if (c == '-') c = '_';
                           }
                           return name;
                         });

}  // namespace
}  // namespace kerf
