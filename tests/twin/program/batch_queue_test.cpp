#include "twin/program/batch_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>
#include <vector>

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
  std::span<const Motion> batch;
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
  std::span<const Motion> batch;
  std::size_t batches = 0;
  std::size_t motions = 0;
  while (queue.pop(batch)) {
    ++batches;
    motions += batch.size();
  }
  EXPECT_EQ(batches, 4U);
  EXPECT_EQ(motions, 3 * BatchQueue::kBatchMotions + 1);
}

/// Each differs from the one before in one member, or in nothing but its way and its line.
std::vector<Motion> of_many_kinds() {
  std::vector<Motion> motions;
  Motion m;
  const auto add = [&](int count) {
    for (int i = 0; i < count; ++i) {
      m.source.line += 1;
      m.from_mm = m.to_mm;
      m.to_mm += Vec3(0.25, -0.5, 0.125);
      motions.push_back(m);
    }
  };
  add(3);
  m.kind = MotionKind::kFeed, m.feed_mm_per_min = 300;
  add(700);  // more than a batch
  m.tool = 7;
  add(1);
  m.arc.sweep_rad = 0.5;
  add(1);
  m.halts = 1;
  add(1);
  m.halts = 0;
  add(200);
  m.from_abc_deg[0] = m.to_abc_deg[0] = -30;
  add(2);
  m.source.file = 2;
  add(600);
  m.torch.outputs = 4;
  add(1);
  m.length.displaces = true;
  add(300);
  return motions;
}

bool is_same(const Motion& a, const Motion& b) {
  return a.source == b.source && a.from_mm == b.from_mm && a.to_mm == b.to_mm && a.kind == b.kind &&
         a.feed_mm_per_min == b.feed_mm_per_min && a.tool == b.tool &&
         a.arc.sweep_rad == b.arc.sweep_rad && a.halts == b.halts &&
         a.from_abc_deg == b.from_abc_deg && a.to_abc_deg == b.to_abc_deg && a.torch == b.torch &&
         a.length == b.length;
}

TEST(BatchQueue, WhatDiffersComesOutAndWhatDoesNotStays) {
  const std::vector<Motion> motions = of_many_kinds();
  BatchQueue queue;
  // Spans of several lengths, so that places in a batch are used for one kind and then another.
  std::size_t pushed = 0, popped = 0;
  for (std::size_t count = 1; pushed < 3 * motions.size(); count = count * 3 % 509) {
    const std::size_t at = pushed % motions.size();
    const auto some = std::span(motions).subspan(at, std::min(count, motions.size() - at));
    ASSERT_TRUE(queue.push(some));
    pushed += some.size();
    for (std::span<const Motion> batch; queue.try_pop(batch);) {
      for (const Motion& m : batch) {
        ASSERT_TRUE(is_same(m, motions[popped % motions.size()])) << popped;
        ++popped;
      }
    }
  }
  EXPECT_EQ(popped, pushed);
}

TEST(BatchQueue, ClosingWakesAProducerThatWaits) {
  BatchQueue queue;
  std::thread consumer([&] {
    std::span<const Motion> batch;
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
