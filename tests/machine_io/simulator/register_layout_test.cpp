#include "machine_io/simulator/register_layout.h"

#include <gtest/gtest.h>
#include <modbus/modbus.h>

#include <cmath>
#include <limits>

namespace kerf {
namespace {

std::int32_t int32_cdab(const Registers& registers, std::size_t at) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(registers[at + 1]) << 16U |
                                   registers[at]);
}

SimulatedState some_state() {
  SimulatedState state;
  state.position = {1.2345, -70000.0015, 0.0004, -0.0006, 90, 359.9996};
  state.tool = 7;
  state.line = 123456;
  state.scan = 65535;
  state.spindle_rpm = -1200.4;
  state.tool_offset_z_mm = -12.5;
  state.load = 23.456;
  return state;
}

TEST(RegisterLayout, HoldsThousandthsAndFloats) {
  Registers registers{};
  encode_registers({some_state(), {}}, registers);
  EXPECT_EQ(int32_cdab(registers, 0), 1235);
  EXPECT_EQ(int32_cdab(registers, 2), -70000002);
  EXPECT_EQ(int32_cdab(registers, 4), 0);
  EXPECT_EQ(int32_cdab(registers, 6), -1);
  EXPECT_EQ(int32_cdab(registers, 8), 90000);
  EXPECT_EQ(int32_cdab(registers, 10), 360000);
  EXPECT_EQ(registers[kToolRegister], 7);
  EXPECT_EQ(int32_cdab(registers, kLineRegister), 123456);
  EXPECT_EQ(registers[kScanRegister], 65535);
  EXPECT_EQ(static_cast<std::int16_t>(registers[kSpindleRegister]), -1200);
  EXPECT_EQ(int32_cdab(registers, kToolOffsetRegister), -12500);
  // libmodbus' own reading of ABCD.
  EXPECT_EQ(modbus_get_float_abcd(&registers[kFloatRegister]), 1.2345F);
  EXPECT_EQ(modbus_get_float_abcd(&registers[kFloatRegister + 2]), -70000.0015F);
  EXPECT_EQ(modbus_get_float_abcd(&registers[kFloatToolOffsetRegister]), -12.5F);
  EXPECT_EQ(modbus_get_float_abcd(&registers[kFloatSpindleRegister]), -1200.4F);
  EXPECT_EQ(registers[kLoadRegister], 2346);
  EXPECT_EQ(modbus_get_float_abcd(&registers[kFloatLoadRegister]), 23.456F);
  for (std::size_t i = 20; i < kFloatRegister; ++i) EXPECT_EQ(registers[i], 0) << i;
}

TEST(RegisterLayout, HoldsWhatDoesNotFitAtTheEndOfItsType) {
  SimulatedState state;
  state.position = {1e9, -1e9, 0, 0, 0, 0};
  state.spindle_rpm = 60000;
  state.tool = 100000;
  Registers registers{};
  encode_registers({state, {}}, registers);
  EXPECT_EQ(int32_cdab(registers, 0), std::numeric_limits<std::int32_t>::max());
  EXPECT_EQ(int32_cdab(registers, 2), std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ(registers[kSpindleRegister], 32767);
  EXPECT_EQ(registers[kToolRegister], 65535);
}

TEST(RegisterLayout, NanIsNanOrTheLowestNumber) {
  ServedState served{some_state(), {}};
  served.faults.add(FaultKind::kNan);
  Registers registers{};
  encode_registers(served, registers);
  for (std::size_t axis = 0; axis < kSimulatedAxes; ++axis) {
    EXPECT_EQ(int32_cdab(registers, 2 * axis), std::numeric_limits<std::int32_t>::min());
    EXPECT_TRUE(std::isnan(modbus_get_float_abcd(&registers[kFloatRegister + 2 * axis])));
  }
  EXPECT_EQ(registers[kToolRegister], 7);
}

}  // namespace
}  // namespace kerf
