// Buses that lose frames, against the truth: no sample is of two cycles, and none goes uncounted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "machine_io/can/can_map.h"
#include "tests/machine_io/can/can_encode.h"

namespace kerf {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kStart = 1'795'210'989'000'000'000;

struct Frame {
  std::int64_t at_ns;
  std::size_t axis;
  int cycle;
};

struct Bus {
  std::size_t axes = 3;
  std::int64_t period_ns = 10 * kMs;
  std::int64_t apart_ns = 150'000;  ///< from drive to drive
  double late = 0.0;                ///< cycles are late by up to so much of a period, in order
  int cycles = 2000;
  unsigned seed = 1;
};

std::vector<Frame> frames_of(const Bus& bus, std::mt19937& random) {
  std::uniform_real_distribution<double> late(0, bus.late);
  std::vector<Frame> frames;
  std::int64_t now = kStart;
  for (int cycle = 0; cycle < bus.cycles; ++cycle) {
    const double periods = cycle + late(random);
    const auto due = static_cast<std::int64_t>(periods * static_cast<double>(bus.period_ns));
    now = std::max(now, kStart + due);
    for (std::size_t i = 0; i < bus.axes; ++i, now += bus.apart_ns) {
      frames.push_back({now, i, cycle});
    }
  }
  return frames;
}

/// Runs of 1 to 10 frames, as they follow each other on the bus, with 40 cycles between them.
std::vector<Frame> lose_some(const std::vector<Frame>& frames, std::size_t axes,
                             std::mt19937& random) {
  std::uniform_int_distribution<int> length(1, 10);
  std::uniform_int_distribution<int> more(0, static_cast<int>(10 * axes));
  std::vector<Frame> kept;
  std::size_t next = 40 * axes;
  for (std::size_t i = 0; i < frames.size();) {
    if (i < next) {
      kept.push_back(frames[i++]);
      continue;
    }
    i += static_cast<std::size_t>(length(random));
    next = i + 40 * axes + static_cast<std::size_t>(more(random));
  }
  return kept;
}

struct Outcome {
  int samples = 0;
  int mixed = 0;
  int back = 0;
  int first = -1;
  int last = -1;
  int whole = 0;  ///< cycles of which no frame was lost
  std::uint64_t incomplete = 0;
};

Outcome run(const Bus& bus, const std::vector<Frame>& frames) {
  CanMap map;
  for (std::size_t i = 0; i < bus.axes; ++i) {
    map.axes[i] = cia402_position(static_cast<std::uint8_t>(i + 1), 0.001);
  }
  map.gather_ms = std::max(50.0, 2e-6 * static_cast<double>(bus.period_ns));
  CanAssembler assembler(map);
  Outcome outcome;
  std::vector<std::size_t> came(static_cast<std::size_t>(bus.cycles), 0);
  const auto take = [&] {
    AxisSample sample;
    while (assembler.next(sample)) {
      ++outcome.samples;
      const int cycle = static_cast<int>(std::lround(sample.position[0]));
      for (std::size_t i = 0; i < bus.axes; ++i) {
        if (!sample.has(i) || std::lround(sample.position[i]) != cycle) {
          ++outcome.mixed;
          break;
        }
      }
      if (cycle <= outcome.last) ++outcome.back;
      if (outcome.first < 0) outcome.first = cycle;
      outcome.last = cycle;
    }
  };
  for (const Frame& frame : frames) {
    CanFrame sent;
    EXPECT_TRUE(encode_can_signal(frame.cycle, *map.axes[frame.axis], sent));
    assembler.push(sent, frame.at_ns);
    take();
    if (++came[static_cast<std::size_t>(frame.cycle)] == bus.axes) ++outcome.whole;
  }
  assembler.flush();
  take();
  outcome.incomplete = assembler.incomplete();
  return outcome;
}

void expect_truth(const Outcome& outcome, const std::string& what) {
  EXPECT_EQ(outcome.mixed, 0) << what;
  EXPECT_EQ(outcome.back, 0) << what;
  // Dropping everything would mix nothing, too.
  EXPECT_GE(outcome.samples, outcome.whole * 97 / 100) << what;
}

std::string text_of(const Bus& bus) {
  return "axes " + std::to_string(bus.axes) + ", period " + std::to_string(bus.period_ns) +
         " ns, late " + std::to_string(bus.late) + ", seed " + std::to_string(bus.seed);
}

TEST(CanLoss, NothingLostIsNothingDropped) {
  for (const double late : {0.0, 0.05, 0.1, 0.3, 0.9}) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
      Bus bus;
      bus.late = late;
      bus.axes = 2 + seed % 8;
      bus.seed = seed;
      std::mt19937 random(seed);
      const Outcome outcome = run(bus, frames_of(bus, random));
      EXPECT_EQ(outcome.mixed, 0) << text_of(bus);
      EXPECT_EQ(outcome.samples, bus.cycles) << text_of(bus);
      EXPECT_EQ(outcome.incomplete, 0U) << text_of(bus);
    }
  }
}

TEST(CanLoss, RunsOfLostFramesMixNothing) {
  for (const double late : {0.0, 0.02, 0.05}) {
    for (unsigned seed = 1; seed <= 200; ++seed) {
      Bus bus;
      bus.late = late;
      bus.axes = 2 + seed % 5;
      bus.period_ns = seed % 4 == 0 ? kMs : seed % 4 == 1 ? 20 * kMs : 10 * kMs;
      bus.apart_ns = bus.period_ns / 70;
      bus.seed = seed;
      std::mt19937 random(seed);
      const auto frames = lose_some(frames_of(bus, random), bus.axes, random);
      expect_truth(run(bus, frames), text_of(bus));
    }
  }
}

TEST(CanLoss, SoManyInARowAtEachPlace) {
  // X .. and the whole row behind it up to the X that follows: what is left is in order.
  for (std::size_t axes = 2; axes <= 9; ++axes) {
    for (std::size_t first = 0; first < axes; ++first) {
      for (std::size_t count = 1; count <= 3 * axes; ++count) {
        Bus bus;
        bus.axes = axes;
        bus.cycles = 60;
        std::mt19937 random(1);
        std::vector<Frame> frames = frames_of(bus, random);
        const auto begin = frames.begin() + static_cast<std::ptrdiff_t>(30 * axes + first);
        frames.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
        const Outcome outcome = run(bus, frames);
        const bool whole_cycles = first == 0 && count % axes == 0;
        EXPECT_EQ(outcome.mixed, 0) << axes << " axes, " << count << " from " << first;
        EXPECT_EQ(outcome.samples, outcome.whole)
            << axes << " axes, " << count << " from " << first;
        // A cycle of which nothing came is a gap, and not counted.
        EXPECT_EQ(outcome.incomplete > 0, !whole_cycles) << axes << ", " << count << ", " << first;
      }
    }
  }
}

}  // namespace
}  // namespace kerf
