// Frames into samples.
#include "machine_io/can/can_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "machine_io/can/can_socket_source.h"
#include "tests/machine_io/can/can_encode.h"

namespace kerf {
namespace {

using Taken = CanAssembler::Taken;

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kStart = 1'795'210'989'000'000'000;

CanMap three_axes() {
  CanMap map;
  for (std::uint8_t i = 0; i < 3; ++i) map.axes[i] = cia402_position(i + 1, 0.001);
  return map;
}

CanFrame frame_of(const CanSignal& signal, double value) {
  CanFrame frame;
  EXPECT_TRUE(encode_can_signal(value, signal, frame));
  return frame;
}

/// A bus with its assembler: time goes on by hand.
struct Bus {
  explicit Bus(CanMap the_map) : map(std::move(the_map)), assembler(map) {}
  Taken axis(std::size_t i, double value) { return push(frame_of(*map.axes[i], value)); }
  Taken push(const CanFrame& frame) { return assembler.push(frame, now); }
  std::optional<AxisSample> next() {
    AxisSample sample;
    if (!assembler.next(sample)) return std::nullopt;
    return sample;
  }
  CanMap map;
  CanAssembler assembler;
  std::int64_t now = kStart;
};

TEST(CanAssembler, ASampleIsReadyWhenAllAxesHaveCome) {
  Bus bus(three_axes());
  EXPECT_EQ(bus.axis(0, 1.0), Taken::kTaken);
  EXPECT_FALSE(bus.next());
  bus.now += kMs;
  bus.axis(1, -2.0);
  EXPECT_FALSE(bus.next());
  bus.now += kMs;
  bus.axis(2, 3.0);
  // The first one may be made of two cycles; the pause behind it tells.
  EXPECT_FALSE(bus.next());
  EXPECT_TRUE(bus.assembler.is_gathering());
  EXPECT_EQ(bus.assembler.gather_end_ns(), bus.now + kMs / 8);
  bus.assembler.flush();
  const auto sample = bus.next();
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->known, 7);
  EXPECT_EQ(sample->fresh, 7);
  EXPECT_EQ(sample->position[0], 1.0);
  EXPECT_EQ(sample->position[1], -2.0);
  EXPECT_EQ(sample->position[2], 3.0);
  EXPECT_EQ(sample->device_ns, kStart + 2 * kMs);
  EXPECT_EQ(sample->host_ns, AxisSample::kNoTime);
  EXPECT_EQ(sample->tool, AxisSample::kUnknown);
  EXPECT_TRUE(std::isnan(sample->spindle_rpm));
  EXPECT_FALSE(bus.next());
  EXPECT_FALSE(bus.assembler.is_gathering());
}

TEST(CanAssembler, AnAxisThatComesAgainEndsTheSample) {
  Bus bus(three_axes());
  for (std::size_t i = 0; i < 3; ++i) bus.axis(i, 1.0);
  ASSERT_TRUE(bus.next());
  bus.now += 10 * kMs;
  bus.axis(0, 2.0);
  bus.axis(1, 2.0);
  bus.now += 10 * kMs;
  bus.axis(0, 3.0);
  const auto sample = bus.next();
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->known, 7);
  EXPECT_EQ(sample->fresh, 3);
  EXPECT_EQ(sample->position[0], 2.0);
  EXPECT_EQ(sample->position[2], 1.0);
  EXPECT_EQ(sample->device_ns, kStart + 10 * kMs);
}

TEST(CanAssembler, AnAxisNeverReadIsNotKnown) {
  Bus bus(three_axes());
  bus.axis(0, 1.0);
  bus.now += kMs;
  bus.axis(0, 2.0);
  const auto sample = bus.next();
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->known, 1);
  EXPECT_EQ(sample->fresh, 1);
}

TEST(CanAssembler, OldValuesAreNoLongerKnown) {
  CanMap map = three_axes();
  map.axes[1]->max_age_ms = 25.0;
  map.axes[2]->max_age_ms = 0.0;
  Bus bus(map);
  for (std::size_t i = 0; i < 3; ++i) bus.axis(i, 1.0);
  ASSERT_TRUE(bus.next());
  std::vector<unsigned> known;
  for (int i = 0; i < 5; ++i) {
    bus.now += 10 * kMs;
    bus.axis(0, 1.0);
    if (const auto sample = bus.next()) known.push_back(sample->known);
  }
  // Read 10, 20, 30, 40 ms after Y and Z.
  EXPECT_EQ(known, (std::vector<unsigned>{7, 7, 5, 5}));
}

TEST(CanAssembler, ACycleThatStaysIncompleteEndsByTime) {
  CanMap map = three_axes();
  map.gather_ms = 5.0;
  Bus bus(map);
  bus.axis(0, 1.0);
  bus.now += 6 * kMs;
  bus.axis(1, 2.0);
  const auto sample = bus.next();
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->fresh, 1);
  EXPECT_EQ(sample->device_ns, kStart);
  EXPECT_TRUE(bus.assembler.is_gathering());
  EXPECT_EQ(bus.assembler.gather_end_ns(), bus.now + 5 * kMs);
  bus.assembler.flush();
  EXPECT_EQ(bus.next()->fresh, 2);
  bus.assembler.flush();
  EXPECT_FALSE(bus.next());
}

TEST(CanAssembler, OneFrameCanEndASampleAndMakeAnother) {
  CanMap map;
  map.axes[0] = odrive_position(1, 1.0);
  map.axes[1] = odrive_position(1, 1.0);
  map.axes[1]->bits.start_bit = 32;
  Bus bus(map);
  CanFrame both;
  encode_can_signal(1.0, *map.axes[0], both);
  encode_can_signal(2.0, *map.axes[1], both);
  CanFrame one = both;
  one.length = 4;
  EXPECT_EQ(bus.push(one), Taken::kUnfit);
  EXPECT_EQ(bus.assembler.unfit_text(),
            "frame 0x029 has 4 bytes, too few for Y: 32 bits from bit 32 on");
  EXPECT_EQ(bus.push(both), Taken::kTaken);
  EXPECT_EQ(bus.next()->fresh, 1);
  EXPECT_EQ(bus.next()->fresh, 3);
  EXPECT_FALSE(bus.next());
}

TEST(CanAssembler, ToolLineSpindleAndOffsetGoAlong) {
  CanMap map;
  map.axes[0] = cia402_position(1, 0.001);
  const auto number = [](std::uint32_t id) {
    CanSignal signal;
    signal.id = id;
    signal.bits.length = 16;
    return signal;
  };
  map.tool = number(0x201);
  map.line = number(0x202);
  map.spindle = number(0x203);
  map.tool_offset_z = number(0x204);
  map.tool_offset_z->scale = 0.01;
  Bus bus(map);
  EXPECT_EQ(bus.push(frame_of(*map.tool, 3)), Taken::kTaken);
  bus.push(frame_of(*map.line, 120));
  bus.push(frame_of(*map.spindle, -900));
  bus.push(frame_of(*map.tool_offset_z, 55.25));
  EXPECT_FALSE(bus.next());
  bus.axis(0, 1.0);
  auto sample = bus.next();
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->tool, 3);
  EXPECT_EQ(sample->line, 120);
  EXPECT_EQ(sample->spindle_rpm, -900.0);
  EXPECT_EQ(sample->tool_offset_z_mm, 55.25);
  EXPECT_EQ(sample->known, 1);
  EXPECT_EQ(bus.push(frame_of(*map.tool, -1)), Taken::kUnfit);
  EXPECT_EQ(bus.assembler.unfit_text(), "frame 0x201 has -1 in tool, which must be 0 or above");
  bus.now += 1001 * kMs;
  bus.axis(0, 1.0);
  sample = bus.next();
  EXPECT_EQ(sample->tool, AxisSample::kUnknown);
  EXPECT_EQ(sample->line, AxisSample::kUnknown);
  EXPECT_TRUE(std::isnan(sample->spindle_rpm));
  EXPECT_TRUE(std::isnan(sample->tool_offset_z_mm));
}

TEST(CanAssembler, LateFramesAreNotTaken) {
  Bus bus(three_axes());
  bus.axis(0, 1.0);
  bus.now -= kMs;
  EXPECT_EQ(bus.axis(1, 5.0), Taken::kLate);
  bus.now += kMs;
  bus.axis(0, 2.0);
  EXPECT_EQ(bus.next()->known, 1);
}

TEST(CanAssembler, AClockSetBackIsANewBeginning) {
  Bus bus(three_axes());
  for (std::size_t i = 0; i < 3; ++i) bus.axis(i, 1.0);
  ASSERT_TRUE(bus.next());
  bus.now -= 3'600'000 * kMs;
  EXPECT_EQ(bus.axis(0, 2.0), Taken::kClockStepped);
  bus.now += 10 * kMs;
  EXPECT_EQ(bus.axis(0, 3.0), Taken::kTaken);
  const auto sample = bus.next();
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->known, 1);
  EXPECT_EQ(sample->device_ns, bus.now - 10 * kMs);
}

TEST(CanAssembler, FramesOfOthersAreNotMapped) {
  Bus bus(three_axes());
  CanFrame frame;
  frame.id = 0x080;
  EXPECT_EQ(bus.push(frame), Taken::kNotMapped);
  frame = frame_of(*bus.map.axes[0], 1.0);
  frame.extended = true;
  EXPECT_EQ(bus.push(frame), Taken::kNotMapped);
}

TEST(CanAssembler, WhatIsNoNumberIsUnfit) {
  CanMap map;
  map.axes[0] = odrive_position(1, 5.0);
  Bus bus(map);
  CanFrame frame = frame_of(*map.axes[0], 1.0);
  frame.data[2] = 0xC0;
  frame.data[3] = 0x7F;
  EXPECT_EQ(bus.push(frame), Taken::kUnfit);
  EXPECT_EQ(bus.assembler.unfit_text(),
            "frame 0x029 has no finite number in X; is its type or byte order another?");
  EXPECT_FALSE(bus.next());
}

TEST(CanAssembler, APositionBeyondItsRangeIsUnfit) {
  CanMap map = three_axes();
  map.ranges[0] = {-100, 200, std::nullopt};
  map.ranges[1].max = 10;
  Bus bus(map);
  // A hundredth of the span, or 1, more is overshoot.
  EXPECT_EQ(bus.axis(0, 202.5), Taken::kTaken);
  EXPECT_EQ(bus.axis(0, 203.5), Taken::kUnfit);
  EXPECT_EQ(bus.assembler.unfit_text(),
            "frame 0x381 has 203.5 in X, beyond min or max and what a machine may overshoot");
  EXPECT_EQ(bus.axis(0, -103.5), Taken::kUnfit);
  EXPECT_EQ(bus.axis(1, 10.9), Taken::kTaken);
  EXPECT_EQ(bus.axis(1, 11.1), Taken::kUnfit);
  EXPECT_EQ(bus.axis(1, -1e6), Taken::kTaken);
  map.ranges[0].max = -100;
  EXPECT_EQ(validate(map),
            (std::vector<std::string>{"map.X.max: -100 is not allowed; must be above min -100"}));
}

/// Cycles of three drives, each with a position that tells which cycle it is of.
struct CyclicBus : Bus {
  explicit CyclicBus(CanMap the_map = three_axes()) : Bus(std::move(the_map)) {}

  /// Sends the axes of `order` that are not in `lost`, 0.15 ms apart but for `late_ns` before the
  /// axis `late`.
  void cycle(std::vector<std::size_t> order = {0, 1, 2}, unsigned lost = 0,
             std::size_t late = kMaxPositions, std::int64_t late_ns = 0) {
    ++number;
    for (const std::size_t i : order) {
      if (i == late) now += late_ns;
      if ((lost >> i & 1U) == 0) axis(i, static_cast<double>(number));
      take();
      now += 150'000;
    }
  }
  /// The next cycle begins `ns` after `from`.
  void wait_until(std::int64_t from, std::int64_t ns) { now = std::max(now, from + ns); }
  void cycles(int count) {
    for (int i = 0; i < count; ++i) {
      const std::int64_t from = now;
      cycle();
      wait_until(from, 10 * kMs);
    }
  }
  void take() {
    while (const auto sample = next()) {
      ++samples;
      const auto& p = sample->position;
      if (sample->fresh != 7 || p[0] != p[1] || p[1] != p[2]) ++mixed;
    }
  }
  void end() {
    assembler.flush();
    take();
  }
  int number = 0;
  int samples = 0;
  int mixed = 0;  ///< of two cycles, or with a value of before
};

TEST(CanAssembler, OneLostFrameCostsOneCycle) {
  for (const unsigned lost : {1U, 2U, 4U, 3U, 5U, 6U}) {
    CyclicBus bus;
    bus.cycles(50);
    const std::int64_t from = bus.now;
    bus.cycle({0, 1, 2}, lost);
    bus.wait_until(from, 10 * kMs);
    bus.cycles(50);
    bus.end();
    EXPECT_EQ(bus.mixed, 0) << lost;
    EXPECT_EQ(bus.samples, 100) << lost;
    EXPECT_EQ(bus.assembler.incomplete(), 1U) << lost;
  }
}

TEST(CanAssembler, WhatIsMissingIsNamed) {
  CyclicBus bus;
  bus.cycles(20);
  bus.cycle({0, 1, 2}, 0b101);
  bus.now += 9 * kMs;
  bus.cycles(2);
  EXPECT_EQ(bus.assembler.incomplete_text(),
            "a cycle of the bus came without X, Z and was dropped (a frame was lost?)");
}

TEST(CanAssembler, ManyLostFramesMixNothing) {
  // Each frame is lost with one chance in fifty.
  std::uint32_t seed = 1;
  CyclicBus bus;
  bus.cycles(20);
  int whole = 20;
  int in_a_row = 0;
  for (int i = 0; i < 20'000; ++i) {
    unsigned lost = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
      seed = seed * 1664525 + 1013904223;
      // Three in a row are too many without a SYNC.
      in_a_row = seed >> 16U < 65536 / 50 && in_a_row < 2 ? in_a_row + 1 : 0;
      if (in_a_row > 0) lost |= 1U << axis;
    }
    if (lost == 0) ++whole;
    const std::int64_t from = bus.now;
    bus.cycle({0, 1, 2}, lost);
    bus.wait_until(from, 10 * kMs);
  }
  bus.cycles(1);
  EXPECT_EQ(bus.mixed, 0);
  EXPECT_EQ(bus.samples, whole + 1);
  EXPECT_GT(bus.assembler.incomplete(), 1000U);
}

TEST(CanAssembler, WhoBeginsToListenInACycleMixesNothing) {
  for (const unsigned missed : {1U, 3U}) {
    CyclicBus bus;
    bus.cycle({0, 1, 2}, missed);
    bus.now += 9'550'000;
    bus.cycles(30);
    bus.end();
    EXPECT_EQ(bus.mixed, 0) << missed;
    // It takes some cycles to see it, and their frames are no samples.
    EXPECT_EQ(bus.samples, 31 - CanCycle::kShifts) << missed;
    EXPECT_EQ(bus.assembler.incomplete(), 0U) << "nothing was lost";
  }
}

TEST(CanAssembler, CyclesThatAreHeldUpAreWhole) {
  // Cycles of 10 ms, each up to 9 ms late, some held up in their middle for up to 40 ms and those
  // behind them at once: a busy computer stamps late, but in order.
  std::uint32_t seed = 7;
  const auto random = [&seed](std::int64_t below_ns) {
    seed = seed * 1664525 + 1013904223;
    return static_cast<std::int64_t>((seed >> 8U) % static_cast<std::uint64_t>(below_ns));
  };
  CyclicBus bus;
  bus.cycles(5);
  std::int64_t due = bus.now;
  for (int i = 0; i < 20'000; ++i) {
    due += 10 * kMs;
    bus.now = std::max(bus.now, due + random(9 * kMs));
    const bool stalls = i % 20 == 0;
    bus.cycle({0, 1, 2}, 0, static_cast<std::size_t>(i % 3), stalls ? random(40 * kMs) : 0);
  }
  bus.end();
  EXPECT_EQ(bus.mixed, 0);
  EXPECT_EQ(bus.assembler.incomplete(), 0U);
  // A first frame may stand 20 ms (gather_ms) from its last one; nothing else costs a sample.
  EXPECT_EQ(bus.samples, 20'005);
}

TEST(CanAssembler, DrivesThatOvertakeEachOtherAreWhole) {
  std::uint32_t seed = 3;
  CyclicBus bus;
  for (int i = 0; i < 5'000; ++i) {
    std::vector<std::size_t> order{0, 1, 2};
    seed = seed * 1664525 + 1013904223;
    // Sometimes, as where an answer is late; from the middle on always.
    if (i > 2500 || seed >> 16U < 65536 / 30) std::swap(order[seed >> 8U & 1U], order[2]);
    const std::int64_t from = bus.now;
    bus.cycle(order);
    bus.wait_until(from, 10 * kMs);
  }
  bus.end();
  EXPECT_EQ(bus.mixed, 0);
  EXPECT_EQ(bus.samples, 5'000);
  EXPECT_EQ(bus.assembler.incomplete(), 0U);
}

TEST(CanAssembler, FramesThatFollowEachOtherAtOnceAreInTheirOrder) {
  // As fast as they can be sent, by a process that is interrupted now and then, and sometimes
  // always behind the same axis.
  std::uint32_t seed = 9;
  CyclicBus bus;
  for (int i = 0; i < 100'000; ++i) {
    ++bus.number;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      bus.axis(axis, bus.number);
      bus.take();
      seed = seed * 1664525 + 1013904223;
      bus.now += 40'000 + (seed >> 12U) % 20'000;
      if (seed >> 16U < 65536 / 50) bus.now += (seed >> 8U) % (5 * kMs);
      if (i / 1000 % 10 == 7 && axis == 1) bus.now += 400'000;
    }
  }
  bus.end();
  EXPECT_EQ(bus.samples, 100'000);
  EXPECT_EQ(bus.mixed, 0);
  EXPECT_EQ(bus.assembler.incomplete(), 0U);
}

TEST(CanAssembler, ASyncPartsCyclesWhateverTheOrder) {
  CyclicBus bus;
  std::uint32_t seed = 5;
  int whole = 0;
  for (int i = 0; i < 2'000; ++i) {
    CanFrame sync;
    sync.id = 0x080;
    EXPECT_EQ(bus.push(sync), Taken::kNotMapped);
    std::vector<std::size_t> order{0, 1, 2};
    seed = seed * 1664525 + 1013904223;
    std::swap(order[seed >> 8U & 1U], order[2]);
    const unsigned lost = i > 20 && seed >> 16U < 65536 / 10 ? 1U << (i % 3) : 0;
    if (lost == 0) ++whole;
    const std::int64_t from = bus.now;
    bus.cycle(order, lost);
    bus.wait_until(from, 10 * kMs);
  }
  bus.end();
  EXPECT_EQ(bus.mixed, 0);
  EXPECT_EQ(bus.samples, whole);
  EXPECT_NEAR(static_cast<double>(bus.assembler.incomplete()), 2'000 - whole, 1);
}

TEST(CanAssembler, ASyncWithinCyclesPartsNothing) {
  // A slow drive answers when the next SYNC has been already.
  CyclicBus bus;
  CanFrame sync;
  sync.id = 0x080;
  for (int i = 0; i < 100; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axis == 2) bus.push(sync);
      bus.axis(axis, i);
      bus.take();
      bus.now += 3 * kMs;
    }
  }
  bus.end();
  EXPECT_EQ(bus.samples, 100);
  EXPECT_EQ(bus.mixed, 0);
  EXPECT_EQ(bus.assembler.incomplete(), 0U);
}

TEST(CanAssembler, AnIdOfTheMapIsNoSync) {
  CanMap map = three_axes();
  map.axes[0]->id = 0x080;
  CyclicBus bus(map);
  bus.cycles(20);
  bus.end();
  EXPECT_EQ(bus.samples, 20);
  map.sync_id = 0x800;
  EXPECT_EQ(validate(map), (std::vector<std::string>{
                               "map.sync_id: 2048 is not allowed; must be 0 to 0x7FF, or -1 for "
                               "none"}));
}

TEST(CanAssembler, DrivesThatSendWhatChangesLackNothing) {
  // Moves in three axes, then long ones in two, and again: Z comes while it moves.
  for (const double max_age_ms : {0.0, 1000.0}) {
    CanMap map = three_axes();
    for (std::size_t i = 0; i < 3; ++i) map.axes[i]->max_age_ms = max_age_ms;
    CyclicBus bus(map);
    for (int move = 0; move < 20; ++move) {
      bus.cycles(30);
      for (int i = 0; i < 30; ++i) {
        const std::int64_t from = bus.now;
        bus.cycle({0, 1, 2}, 0b100);
        bus.wait_until(from, 10 * kMs);
      }
    }
    bus.end();
    EXPECT_EQ(bus.assembler.incomplete(), 0U);
    // Where nobody says that axes come when they change, it takes some cycles to see that.
    EXPECT_EQ(bus.samples, 1200 - (max_age_ms == 0 ? 0 : 20 * CanCycle::kMostIncomplete));
  }
}

TEST(CanAssembler, FramesThatTheKernelDroppedPartCycles) {
  CyclicBus bus;
  bus.cycles(20);
  // Y and Z of this cycle, and X of the next.
  ++bus.number;
  bus.axis(0, bus.number);
  bus.now += 10 * kMs;
  bus.assembler.frames_lost();
  bus.cycle({0, 1, 2}, 1);
  bus.now += 9 * kMs;
  bus.cycles(20);
  bus.end();
  EXPECT_EQ(bus.mixed, 0);
  EXPECT_EQ(bus.samples, 40);
  EXPECT_EQ(bus.assembler.incomplete(), 2U);
}

TEST(CanMap, EveryFaultIsNamed) {
  CanMap map;
  EXPECT_EQ(validate(map),
            (std::vector<std::string>{"map: no axis is mapped; at least one of X, Y, "
                                      "Z, A, B, C, U, V, W is needed"}));
  map = three_axes();
  EXPECT_TRUE(validate(map).empty());
  map.axes[2] = map.axes[0];
  map.gather_ms = 0.0;
  map.spindle = cia402_position(4, 0.0);
  EXPECT_EQ(validate(map, "source.map"),
            (std::vector<std::string>{
                "source.map.spindle.scale: 0 is not allowed; must be a number other than 0",
                "source.map.Z: reads the same bits of frame 0x381 as source.map.X",
                "source.map.gather_ms: 0 is not allowed; must be 0.1 to 10000 ms"}));
}

TEST(CanMap, FaultsOfTheSocketsOptionsAreNamed) {
  CanSourceOptions options;
  options.map = three_axes();
  EXPECT_TRUE(validate(options).empty());
  options.interface = "can0/../../x";
  options.receive_buffer_bytes = 1;
  options.retry_first_ms = 500;
  options.retry_longest_ms = 100;
  EXPECT_EQ(validate(options),
            (std::vector<std::string>{
                "interface: 'can0/../../x' is not allowed; must be the name of a network "
                "interface, 1 to 15 bytes",
                "receive_buffer_bytes: 1 is not allowed; must be 4096 to 268435456",
                "retry_longest_ms: 100 is not allowed; must be 500 to 600000"}));
}

TEST(CanSource, AKernelWithoutCanIsSaid) {
  CanSourceOptions options;
  options.map = three_axes();
  CanSource source(options);
  AxisSample sample;
  if (source.next(sample, std::chrono::milliseconds(0)) != PositionSource::Next::kEnd) {
    GTEST_SKIP() << "this kernel has CAN";
  }
  EXPECT_EQ(source.status().state, SourceState::kFailed);
  EXPECT_EQ(source.status().trouble,
            "can0: this computer gives no CAN socket (Address family not supported by protocol); "
            "'modprobe can-raw' may help");
  EXPECT_EQ(source.next(sample, std::chrono::milliseconds(0)), PositionSource::Next::kEnd);
}

TEST(CanAssembler, TheLoadGoesAlong) {
  CanMap map = three_axes();
  CanSignal load;
  load.id = 0x200;
  load.bits = {0, 16, CanEndian::kLittle};
  load.scale = 10;
  load.max_age_ms = 100;
  map.load = load;
  map.load_unit = LoadUnit::kAmperes;
  Bus bus(map);
  EXPECT_EQ(bus.push(frame_of(load, 50)), Taken::kTaken);
  for (std::size_t i = 0; i < 3; ++i) bus.axis(i, 1);
  bus.assembler.flush();
  const std::optional<AxisSample> sample = bus.next();
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->load, 50);
  EXPECT_EQ(sample->load_unit, LoadUnit::kAmperes);
  EXPECT_EQ(bus.push(frame_of(load, 200'000)), Taken::kUnfit);  // no spindle has that
  EXPECT_NE(bus.assembler.unfit_text().find("load"), std::string::npos);
}

}  // namespace
}  // namespace kerf
