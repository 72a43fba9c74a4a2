#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "machine_io/simulator/can_sender.h"

namespace kerf {
namespace {

using Frames = std::array<SentCanFrame, CanEncoder::kMaxFrames>;

std::uint32_t u32_at(const SentCanFrame& frame, std::size_t byte) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8U | frame.data[byte + i];
  return value;
}

ServedState moving() {
  ServedState served;
  served.state.position = {10, -20.5, 0.001, 90, 0, 0};
  served.state.tool = 3;
  served.state.line = 70000;
  served.state.scan = 513;
  served.state.spindle_rpm = -2;
  served.state.tool_offset_z_mm = 1.5;
  served.state.load = 12.34;
  return served;
}

TEST(CanEncoder, Cia402PositionsLieAtByteTwoOfTpdo3) {
  CanEncoder encoder(CanLayout::kCia402);
  Frames frames;
  ASSERT_EQ(encoder.encode(moving(), 0, frames), 8u);
  for (std::uint32_t axis = 0; axis < 6; ++axis) {
    EXPECT_EQ(frames[axis].id, 0x381U + axis);
    EXPECT_EQ(frames[axis].size, 6u);
    EXPECT_EQ(frames[axis].data[0], 0x37);
    EXPECT_EQ(frames[axis].data[1], 0x06);
  }
  EXPECT_EQ(static_cast<std::int32_t>(u32_at(frames[0], 2)), 10000);
  EXPECT_EQ(static_cast<std::int32_t>(u32_at(frames[1], 2)), -20500);
  EXPECT_EQ(static_cast<std::int32_t>(u32_at(frames[2], 2)), 1);
  EXPECT_EQ(static_cast<std::int32_t>(u32_at(frames[3], 2)), 90000);
  EXPECT_EQ(frames[6].id, kCanStatusId);
  EXPECT_EQ(frames[6].size, 8u);
  EXPECT_EQ(frames[6].data[0], 3);
  EXPECT_EQ(u32_at(frames[6], 2), 70000u);
  EXPECT_EQ(frames[6].data[6], 1);
  EXPECT_EQ(frames[6].data[7], 2);
  EXPECT_EQ(frames[7].id, kCanSpindleId);
  EXPECT_EQ(frames[7].size, 8u);
  EXPECT_EQ(frames[7].data[0], 0xfe);
  EXPECT_EQ(frames[7].data[1], 0xff);
  EXPECT_EQ(u32_at(frames[7], 2), 1500u);
  EXPECT_EQ(frames[7].data[6] | frames[7].data[7] << 8, 1234);
}

TEST(CanEncoder, OdriveTellsTurnsAndTurnsPerSecond) {
  CanEncoder encoder(CanLayout::kOdrive);
  Frames frames;
  ServedState served = moving();
  encoder.encode(served, 0, frames);
  EXPECT_EQ(frames[0].id, 0x009U);
  EXPECT_EQ(frames[5].id, 0x0a9U);
  EXPECT_EQ(std::bit_cast<float>(u32_at(frames[0], 0)), 2.0F);
  EXPECT_EQ(std::bit_cast<float>(u32_at(frames[0], 4)), 0.0F);
  EXPECT_EQ(std::bit_cast<float>(u32_at(frames[3], 0)), 0.25F);
  served.state.position[0] += 0.05;
  encoder.encode(served, 0.001, frames);
  EXPECT_NEAR(std::bit_cast<float>(u32_at(frames[0], 4)), 10.0F, 1e-4);
}

TEST(CanEncoder, FaultsAreSeenInTheFrames) {
  CanEncoder encoder(CanLayout::kCia402);
  Frames clean;
  encoder.encode(moving(), 0, clean);
  Frames frames;
  ServedState served = moving();
  served.faults.add(FaultKind::kNan);
  encoder.encode(served, 0, frames);
  EXPECT_EQ(static_cast<std::int32_t>(u32_at(frames[0], 2)),
            std::numeric_limits<std::int32_t>::min());
  served = moving();
  served.faults.add(FaultKind::kDrop);
  EXPECT_EQ(encoder.encode(served, 0, frames), 0u);
  served = moving();
  served.faults.add(FaultKind::kGarbage);
  ASSERT_EQ(encoder.encode(served, 0, frames), 8u);
  EXPECT_EQ(frames[0].id, clean[0].id);
  EXPECT_NE(frames[0].data, clean[0].data);
  served = moving();
  served.faults.add(FaultKind::kRestart);
  EXPECT_EQ(encoder.encode(served, 0, frames), 0u);
  ASSERT_EQ(encoder.encode(moving(), 0, frames), 14u);
  EXPECT_EQ(frames[0].id, 0x701U);
  EXPECT_EQ(frames[0].size, 1u);
  EXPECT_EQ(frames[5].id, 0x706U);
  EXPECT_EQ(frames[6].id, 0x381U);
  EXPECT_EQ(encoder.encode(moving(), 0, frames), 8u);
  CanEncoder odrive(CanLayout::kOdrive);
  served = moving();
  served.faults.add(FaultKind::kNan);
  odrive.encode(served, 0.001, frames);
  EXPECT_TRUE(std::isnan(std::bit_cast<float>(u32_at(frames[0], 0))));
}

TEST(CanSender, AnInterfaceThatIsNotThereIsNamed) {
  const auto sender = CanSender::open("kerfnone0", CanLayout::kCia402);
  ASSERT_FALSE(sender);
  EXPECT_EQ(sender.error().substr(0, 19), "opening kerfnone0: ");
}

}  // namespace
}  // namespace kerf
