// A tab in each of LinuxCNC's screens: what its user sees and waits for.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/base/temporary_folder.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

int shell(const std::string& command) {
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class ScreensLiveTest : public testing::TestWithParam<const char*> {};

TEST_P(ScreensLiveTest, TheProgramIsDryRunAndFollowedAndACrashIsMended) {
  const std::string gui = GetParam();
  const std::string script = RUN_SCREEN;
  if (shell(script + " --check " + gui) == 77) GTEST_SKIP() << "not possible here";
  const TemporaryFolder folder;
  shell(script + " " + gui + " " + KERF_EXECUTABLE + " " + PROGRAM + " " + folder.path());
  std::ifstream file(folder.path() + "/screen.json");
  const Json result = Json::parse(file, nullptr, false);
  ASSERT_FALSE(result.is_discarded()) << "it did not come to its end";
  SCOPED_TRACE(result.dump());
  ASSERT_TRUE(result.value("homed", false));
  // A dry run begins within a second of opening, and no older leave stands meanwhile.
  ASSERT_TRUE(result["dry_run_s"].is_number());
  EXPECT_LT(result["dry_run_s"].get<double>(), 1.0);
  ASSERT_TRUE(result["load_to_off_s"].is_number());
  EXPECT_LT(result["load_to_off_s"].get<double>(), 1.0);
  ASSERT_TRUE(result["load_to_ok_s"].is_number());
  // The blank is guessed, and nothing else is wrong with it.
  EXPECT_EQ(result["findings"], "1");
  EXPECT_NEAR(std::stod(result["time_left_s"].get<std::string>()), 34, 3);
  EXPECT_TRUE(result.value("started", false));
  EXPECT_TRUE(result.value("tab_seen", false)) << "while the program runs";
  ASSERT_TRUE(result["program_s"].is_number());
  EXPECT_GT(result["program_s"].get<double>(), 25);
  ASSERT_TRUE(result["edit_to_off_s"].is_number());
  EXPECT_LT(result["edit_to_off_s"].get<double>(), 1.0);
  EXPECT_EQ(result["ok_again"], "TRUE");
  ASSERT_TRUE(result["restarted_s"].is_number());
  EXPECT_EQ(result["errors"], Json::array());
  // The screen has gone, and kerf with it.
  std::ifstream log(folder.path() + "/drive.log");
  const std::string said{std::istreambuf_iterator<char>(log), {}};
  EXPECT_NE(said.find("left: 0"), std::string::npos) << said;
}

INSTANTIATE_TEST_SUITE_P(Screens, ScreensLiveTest, testing::Values("axis", "gmoccapy", "qtdragon"),
                         [](const auto& screen) { return std::string(screen.param); });

}  // namespace
}  // namespace kerf
