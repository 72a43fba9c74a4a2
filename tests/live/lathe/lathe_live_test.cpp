// A real headless LinuxCNC lathe still takes as long as it did when the times were recorded to
// which kerf's are held (tests/interp_bridge/timing/lathe_runs_test.cpp). One program of them, the
// one that hangs most on the spindle. Skipped where LinuxCNC or namespaces of one's own are
// missing.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

namespace kerf {
namespace {

namespace fs = std::filesystem;

constexpr double kWithin = 0.02;
constexpr const char* kProgram = "g96_uncapped";

int shell(const std::string& command, std::string& output) {
  std::FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return -1;
  std::array<char, 4096> block;
  while (std::fgets(block.data(), block.size(), pipe) != nullptr) output += block.data();
  const int status = pclose(pipe);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// The mean of each program's runs.
std::map<std::string, double> seconds_of(const fs::path& path) {
  std::map<std::string, double> out;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream fields(line);
    std::string name;
    std::getline(fields, name, ',');
    double sum_s = 0;
    int count = 0;
    for (std::string number; std::getline(fields, number, ','); ++count) {
      sum_s += std::stod(number);
    }
    if (count > 0) out[name] = sum_s / count;
  }
  return out;
}

TEST(LiveLathe, TakesAsLongAsRecorded) {
  std::string said;
  if (shell(RUN_LINUXCNC " --check", said) != 0) GTEST_SKIP() << said;
  std::string pattern = (fs::temp_directory_path() / "kerf-lathe.XXXXXX").string();
  ASSERT_NE(mkdtemp(pattern.data()), nullptr);
  const fs::path folder = pattern;
  const std::string program = std::string(LATHE_FOLDER "/programs/") + kProgram + ".ngc";
  const int status =
      shell(LATHE_FOLDER "/time_lathe --runs 1 " + folder.string() + " " + program, said);
  const auto now = seconds_of(folder / "lathe_times.csv");
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  ASSERT_EQ(status, 0) << said;
  const auto recorded = seconds_of(LATHE_RUNS);
  ASSERT_EQ(recorded.count(kProgram), 1u);
  ASSERT_EQ(now.count(kProgram), 1u) << said;
  const double recorded_s = recorded.at(kProgram);
  EXPECT_NEAR(now.at(kProgram), recorded_s, kWithin * recorded_s);
}

}  // namespace
}  // namespace kerf
