#include "twin/cli/scheduling.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

namespace kerf {
namespace {

TEST(GoodNeighbour, ReadsListsOfCpus) {
  EXPECT_EQ(cpus_in("0-2,5"), (std::vector<int>{0, 1, 2, 5}));
  EXPECT_EQ(cpus_in(""), std::vector<int>{});
  EXPECT_EQ(cpus_in("3\n"), std::vector<int>{3});
  EXPECT_EQ(cpus_in("nonsense"), std::vector<int>{});
  EXPECT_LE(cpus_in("0-99999999").size(), static_cast<std::size_t>(CPU_SETSIZE));
}

/// In a child, as none of it can be taken back.
int in_child(int (*check)()) {
  const pid_t child = fork();
  if (child == 0) _exit(check());
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(GoodNeighbour, GoesLastInTheQueueAndOffTheIsolatedCpus) {
  cpu_set_t allowed;
  ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
  const bool several = CPU_COUNT(&allowed) > 1;
  EXPECT_EQ(in_child([] {
              make_room("0");
              if (getpriority(PRIO_PROCESS, 0) != 19) return 1;
              return sched_getscheduler(0) == SCHED_BATCH ? 0 : 2;
            }),
            0);
  if (!several || !CPU_ISSET(0, &allowed)) GTEST_SKIP() << "there is no other CPU to go to";
  EXPECT_EQ(in_child([] {
              const bool refused = !make_room("0").empty();
              cpu_set_t now;
              sched_getaffinity(0, sizeof now, &now);
              return CPU_ISSET(0, &now) || refused ? 1 : 0;
            }),
            0);
}

TEST(GoodNeighbour, StaysWhereAllCpusAreIsolatedAndSaysSo) {
  EXPECT_EQ(in_child([] {
              const std::vector<std::string> refused = make_room("0-1023");
              return refused.size() == 1 &&
                             refused[0] == "all CPUs are isolated; kerf runs on one of them"
                         ? 0
                         : 1;
            }),
            0);
}

TEST(GoodNeighbour, KeepsToItsShareOfACpu) {
  CpuBudget budget(25);
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu_start = std::clock();
  while (std::chrono::steady_clock::now() - start < std::chrono::milliseconds(1500)) {
    const auto busy = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - busy < std::chrono::milliseconds(5)) {
    }
    std::this_thread::sleep_for(budget.rest());
  }
  const double cpu_s = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
  const double wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_LT(cpu_s / wall_s, 0.32);
  EXPECT_GT(cpu_s / wall_s, 0.05);
  EXPECT_EQ(CpuBudget(0).rest().count(), 0);
}

}  // namespace
}  // namespace kerf
