#include "twin/program/probe_desk.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "tests/twin/process/motions.h"

namespace kerf {
namespace {

TEST(ProbeDesk, TheAnswerComesBehindAllMotionsBefore) {
  BatchQueue queue;
  ProbeDesk desk(queue);
  std::vector<double> shares;
  std::thread reader([&] {
    const std::vector<Motion> motions(3);
    for (int i = 0; i < 100; ++i) {
      queue.push(motions);
      shares.push_back(desk.ask({motions[0], i % 2 == 1}).share);
    }
    queue.close();
  });
  std::size_t taken = 0;
  int asked = 0;
  std::span<const Motion> batch;
  while (queue.pop(batch)) {
    taken += batch.size();
    if (!batch.empty()) continue;
    desk.serve([&](const ProbeQuestion& question) {
      EXPECT_EQ(taken, static_cast<std::size_t>(3 * (asked + 1)));
      EXPECT_EQ(question.away, asked % 2 == 1);
      ++asked;
      return ProbeAnswer{ProbeAnswer::Kind::kMet, asked / 100.0, {}};
    });
  }
  reader.join();
  ASSERT_EQ(shares.size(), 100U);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    EXPECT_EQ(shares[i], static_cast<double>(i + 1) / 100.0);
  }
}

TEST(ProbeDesk, WhereNobodyAnswersItIsUnknown) {
  BatchQueue queue;
  ProbeDesk desk(queue);
  std::thread reader([&] {
    EXPECT_EQ(desk.ask({}).kind, ProbeAnswer::Kind::kUnknown);
    EXPECT_EQ(desk.ask({}).kind, ProbeAnswer::Kind::kUnknown) << "closed before it asks";
  });
  std::span<const Motion> batch;
  ASSERT_TRUE(queue.pop(batch));
  EXPECT_TRUE(batch.empty());
  queue.close();
  desk.close();
  reader.join();
}

}  // namespace
}  // namespace kerf
