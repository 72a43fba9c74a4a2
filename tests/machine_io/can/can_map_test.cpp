// Frames into samples.
#include "machine_io/can/can_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "machine_io/can/can_encode.h"
#include "machine_io/can/can_socket_source.h"

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

}  // namespace
}  // namespace kerf
