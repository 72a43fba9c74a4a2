#include "base/print.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>

#include "base/exit_code.h"
#include "tests/base/temporary_folder.h"

namespace kerf {
namespace {

/// Ends the process, as a program does whose standard output is `stream`.
[[noreturn]] void print_and_end(std::FILE* stream) {
  std::setvbuf(stream, nullptr, _IONBF, 0);
  print(stream, "{} findings\n", 3);
  std::_Exit(end_console(kExitFindings));
}

TEST(Print, WritesFormattedText) {
  const TemporaryFolder folder;
  const std::string path = folder / "out";
  std::FILE* const stream = std::fopen(path.c_str(), "w+");
  print(stream, "{}:{}", "part.ngc", 7);
  print_text(stream, "\n");
  std::rewind(stream);
  char read[32] = {};
  EXPECT_STREQ(std::fgets(read, sizeof read, stream), "part.ngc:7\n");
  std::fclose(stream);
}

TEST(PrintDeathTest, AFullDiskIsToldAtTheEnd) {
  EXPECT_EXIT(print_and_end(std::fopen("/dev/full", "w")), ::testing::ExitedWithCode(kExitFailure),
              "kerf: error: standard output: No space left on device");
}

TEST(PrintDeathTest, AReaderThatHasGoneChangesNothing) {
  EXPECT_EXIT(
      {
        std::signal(SIGPIPE, SIG_IGN);
        int ends[2];
        if (pipe(ends) != 0) std::abort();
        close(ends[0]);
        print_and_end(fdopen(ends[1], "w"));
      },
      ::testing::ExitedWithCode(kExitFindings), "^$");
}

}  // namespace
}  // namespace kerf
