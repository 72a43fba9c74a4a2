#include "twin/program/batch_queue.h"

#include <gtest/gtest.h>

#include <thread>

namespace kerf {
namespace {

std::vector<Motion> numbered(std::uint32_t first, std::uint32_t count) {
  std::vector<Motion> motions(count);
  for (std::uint32_t i = 0; i < count; ++i) motions[i].source.line = first + i;
  return motions;
}

TEST(BatchQueue, KeepsOrderAndLosesNothingWhenFull) {
  BatchQueue queue;
  constexpr std::uint32_t kRounds = 300;  // far more than fit
  constexpr std::uint32_t kEach = 1000;
  std::thread producer([&] {
    for (std::uint32_t i = 0; i < kRounds; ++i) EXPECT_TRUE(queue.push(numbered(i * kEach, kEach)));
    queue.close();
  });
  std::uint32_t expected = 0;
  std::vector<Motion> batch;
  while (queue.pop(batch)) {
    EXPECT_LE(batch.size(), BatchQueue::kBatchMotions);
    for (const Motion& m : batch) ASSERT_EQ(m.source.line, expected++);
  }
  producer.join();
  EXPECT_EQ(expected, kRounds * kEach);
}

TEST(BatchQueue, LargeSpansAreDivided) {
  BatchQueue queue;
  ASSERT_TRUE(queue.push(numbered(0, 3 * BatchQueue::kBatchMotions + 1)));
  queue.close();
  std::vector<Motion> batch;
  std::size_t batches = 0;
  std::size_t motions = 0;
  while (queue.pop(batch)) {
    ++batches;
    motions += batch.size();
  }
  EXPECT_EQ(batches, 4U);
  EXPECT_EQ(motions, 3 * BatchQueue::kBatchMotions + 1);
}

TEST(BatchQueue, ClosingWakesAProducerThatWaits) {
  BatchQueue queue;
  std::thread consumer([&] {
    std::vector<Motion> batch;
    EXPECT_TRUE(queue.pop(batch));
    queue.close();
  });
  bool open = true;
  while (open) open = queue.push(numbered(0, BatchQueue::kBatchMotions));
  consumer.join();
  EXPECT_FALSE(open);
}

}  // namespace
}  // namespace kerf
