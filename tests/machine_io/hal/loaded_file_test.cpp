// Which program LinuxCNC has loaded, as kerf-status says it. Stands for it: a script.
#include "machine_io/hal/loaded_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "machine_io/hal/status_lines.h"

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;

/// A program that says these words as kerf-status does and then waits for its end.
class Script {
 public:
  Script(const std::string& says, const std::string& then) {
    std::string pattern = (std::filesystem::temp_directory_path() / "kerf-status-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    std::ofstream(path()) << "#!/bin/sh\n" << says << "\n" << then << "\n";
    std::filesystem::permissions(path(), std::filesystem::perms::owner_all);
  }
  ~Script() { std::filesystem::remove_all(folder_); }
  Script(const Script&) = delete;
  Script& operator=(const Script&) = delete;
  std::string path() const { return folder_ + "/status"; }

 private:
  std::string folder_;
};

bool comes(LoadedFile& file, const std::optional<std::string>& wanted) {
  for (const auto until = Clock::now() + std::chrono::seconds(20); Clock::now() < until;) {
    file.wait(std::chrono::milliseconds(50));
    if (file.path() == wanted) return true;
  }
  return false;
}

TEST(LoadedFile, IsWhatTheLastWholeLineSays) {
  const Script script("printf 'program /a b/part.ngc\\nhello\\nprogram /cut of'", "exec sleep 30");
  LoadedFile file(script.path(), {});
  EXPECT_FALSE(file.path());
  EXPECT_TRUE(comes(file, "/a b/part.ngc"));
}

TEST(LoadedFile, IsNotKnownAnyMoreWhenLinuxCncIsGone) {
  const Script script("printf 'program /part.ngc\\n'; sleep 0.3", "exit 0");
  LoadedFile file(script.path(), {});
  EXPECT_TRUE(comes(file, "/part.ngc"));
  EXPECT_TRUE(comes(file, std::nullopt));
  // It is started again, and says it again.
  EXPECT_TRUE(comes(file, "/part.ngc"));
}

TEST(LoadedFile, IsNotKnownWithoutKerfStatus) {
  LoadedFile file("/nowhere/kerf-status", {});
  file.wait(std::chrono::milliseconds(20));
  EXPECT_FALSE(file.path());
}

TEST(StatusLines, NoPathIsTheBeginningOfALongerOne) {
  StatusLines lines;
  lines.take("program /short.ngc\nprogram /");
  for (int i = 0; i < 100; ++i) lines.take(std::string(100, 'x'));
  lines.take("\n");
  EXPECT_EQ(lines.program(), "/short.ngc");
  lines.take("program \n");
  EXPECT_EQ(lines.program(), "");
}

TEST(StatusLines, APathOfAnyAllowedLengthIsTakenWhole) {
  const std::string path = "/" + std::string(4095, 'y');
  StatusLines lines;
  lines.take("program " + path + "\n");
  EXPECT_EQ(lines.program(), path);
}

}  // namespace
}  // namespace kerf
