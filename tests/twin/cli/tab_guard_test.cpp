// What crashes in a tab begins again; what ends, ends.

#include "twin/cli/tab_guard.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <string>

#include "base/exit_code.h"
#include "tests/base/temporary_folder.h"
#include "tests/viewer/virtual_display.h"

namespace kerf {
namespace {

constexpr GuardPatience kQuick{3, 60, 0.01};

class TabGuardTest : public testing::Test {
 protected:
  void SetUp() override {
    Result<VirtualDisplay> display = VirtualDisplay::start();
    if (!display) GTEST_SKIP() << display.error();
    display_.emplace(std::move(*display));
    log_ = folder_.path() + "/starts";
  }
  /// One more start; how many there were with it.
  int note_start() const {
    std::ofstream(log_, std::ios::app) << "x";
    return starts();
  }
  int starts() const {
    std::ifstream file(log_);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    return static_cast<int>(text.size());
  }
  /// The guard in a process of its own: its child returns through it.
  pid_t fork_guard(const std::function<int()>& work) const {
    const pid_t guard = fork();
    if (guard != 0) return guard;
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    Result<ScreenTab> tab = ScreenTab::open(std::nullopt);
    if (!tab) _exit(99);
    _exit(guard_tab(std::move(*tab), work, kQuick));
  }
  static int exit_of(pid_t pid) {
    int status = 0;
    waitpid(pid, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  int run(const std::function<int()>& work) const { return exit_of(fork_guard(work)); }

  std::optional<VirtualDisplay> display_;
  TemporaryFolder folder_;
  std::string log_;
};

TEST_F(TabGuardTest, TheExitCodeIsThatOfTheWork) {
  EXPECT_EQ(run([&] { return note_start(), 3; }), 3);
  EXPECT_EQ(starts(), 1);
}

TEST_F(TabGuardTest, ACrashBeginsAgain) {
  for (const int number : {SIGSEGV, SIGABRT, SIGBUS, SIGILL, SIGFPE}) {
    std::ofstream(log_, std::ios::trunc).close();
    EXPECT_EQ(run([&, number] {
                signal(number, SIG_DFL);
                if (note_start() < 3) raise(number);
                return 0;
              }),
              0)
        << number;
    EXPECT_EQ(starts(), 3) << number;
  }
}

TEST_F(TabGuardTest, FourCrashesInAMinuteAreTheEnd) {
  EXPECT_EQ(run([&] {
              signal(SIGSEGV, SIG_DFL);
              note_start();
              return raise(SIGSEGV);
            }),
            kExitFailure);
  EXPECT_EQ(starts(), 4);
}

/// Whoever kills it means it.
TEST_F(TabGuardTest, WhatIsKilledStaysAway) {
  EXPECT_EQ(run([&] {
              note_start();
              return raise(SIGKILL);
            }),
            kExitFailure);
  EXPECT_EQ(starts(), 1);
}

TEST_F(TabGuardTest, AskedToEndItAsksTheWork) {
  const pid_t guard = fork_guard([&] {
    sigset_t wanted;
    sigemptyset(&wanted);
    sigaddset(&wanted, SIGTERM);
    sigprocmask(SIG_BLOCK, &wanted, nullptr);
    note_start();
    int got = 0;
    sigwait(&wanted, &got);
    return 7;
  });
  while (starts() == 0) usleep(1000);
  kill(guard, SIGTERM);
  EXPECT_EQ(exit_of(guard), 7);
}

/// A guard that is killed leaves nobody behind.
TEST_F(TabGuardTest, TheWorkDoesNotOutliveIt) {
  const std::string pid_file = folder_.path() + "/pid";
  const pid_t guard = fork_guard([&] {
    std::ofstream(pid_file) << getpid();
    note_start();
    while (true) pause();
    return 0;
  });
  while (starts() == 0) usleep(1000);
  pid_t child = 0;
  std::ifstream(pid_file) >> child;
  ASSERT_GT(child, 0);
  kill(guard, SIGKILL);
  EXPECT_EQ(exit_of(guard), -SIGKILL);
  bool is_there = true;
  for (int i = 0; i < 5000 && is_there; ++i, usleep(1000)) {
    // A child that nobody waits for stays as a zombie where init does not collect it.
    std::ifstream status("/proc/" + std::to_string(child) + "/stat");
    std::string number, name, state;
    is_there = static_cast<bool>(status >> number >> name >> state) && state != "Z";
  }
  EXPECT_FALSE(is_there);
}

}  // namespace
}  // namespace kerf
