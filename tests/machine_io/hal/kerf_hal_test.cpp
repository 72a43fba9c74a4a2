// The executable kerf-hal where no LinuxCNC runs.
#include <gtest/gtest.h>
#include <sys/shm.h>
#include <sys/wait.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <set>
#include <sstream>
#include <string>

#include "machine_io/hal/hal_stream.h"

namespace kerf {
namespace {

struct Ran {
  int status = -1;
  std::string output;
};

Ran run(const std::string& command) {
  Ran ran;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return ran;
  std::array<char, 512> part{};
  while (std::fgets(part.data(), part.size(), pipe) != nullptr) ran.output += part.data();
  const int status = pclose(pipe);
  if (WIFEXITED(status)) ran.status = WEXITSTATUS(status);
  return ran;
}

TEST(KerfHal, SaysWhatItTakes) {
  const Ran help = run(KERF_HAL " --help");
  EXPECT_EQ(help.status, 0);
  EXPECT_EQ(help.output.rfind("usage: kerf-hal [--rate HZ] [--load PIN] >PIPE\n", 0), 0u)
      << help.output;
}

TEST(KerfHal, RefusesWrongArguments) {
  for (const auto& [arguments, said] :
       {std::pair(" --rate", "kerf-hal: --rate: a number must follow\n"),
        std::pair(" --rate 0.5",
                  "kerf-hal: --rate 0.5: a number of readings per second, 1 to 1000\n"),
        std::pair(" --rate 1001",
                  "kerf-hal: --rate 1001: a number of readings per second, 1 to 1000\n"),
        std::pair(" --rate 10x",
                  "kerf-hal: --rate 10x: a number of readings per second, 1 to 1000\n"),
        std::pair(" --rate nan",
                  "kerf-hal: --rate nan: a number of readings per second, 1 to 1000\n"),
        std::pair(" --fast", "kerf-hal: unknown argument --fast (kerf-hal --help)\n")}) {
    const Ran ran = run(std::string(KERF_HAL) + arguments);
    EXPECT_EQ(ran.status, kHalExitUsage) << arguments;
    EXPECT_EQ(ran.output, said);
  }
}

TEST(KerfHal, CreatesNoHalWhereThereIsNone) {
  constexpr key_t kHalKey = 0x48414C32;
  if (shmget(kHalKey, 0, 0) >= 0 || errno != ENOENT) GTEST_SKIP() << "a LinuxCNC runs here";
  const Ran ran = run(KERF_HAL);
  EXPECT_EQ(ran.status, kHalExitNoLinuxCnc);
  EXPECT_EQ(ran.output, "kerf-hal: no LinuxCNC runs on this computer\n");
  EXPECT_LT(shmget(kHalKey, 0, 0), 0);
}

/// What kerf-hal takes from HAL's library: nothing with which it could link, make a signal, set a
/// parameter, or start and stop threads.
TEST(KerfHal, HasNoCallThatChangesAMachinesHal) {
  std::istringstream symbols(run("nm -D --undefined-only " KERF_HAL).output);
  std::set<std::string> used;
  std::string kind, name;
  while (symbols >> kind >> name) {
    name = name.substr(0, name.find('@'));
    if (name.rfind("hal", 0) == 0 || name.rfind("rtapi", 0) == 0) used.insert(name);
  }
  EXPECT_EQ(used, (std::set<std::string>{"hal_exit", "hal_get_pin_value_by_name", "hal_init",
                                         "hal_malloc", "hal_pin_bit_new", "hal_pin_float_new",
                                         "hal_pin_s32_new", "hal_pin_u32_new", "hal_ready"}));
}

}  // namespace
}  // namespace kerf
