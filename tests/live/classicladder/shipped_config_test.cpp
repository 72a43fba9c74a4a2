// configs/linuxcnc/kerf.yaml says of the registers what configs/linuxcnc/make_ladder.py puts there.
#include <gtest/gtest.h>

#include <variant>

#include "twin/config/live_config.h"

namespace kerf {
namespace {

TEST(ShippedLinuxCncConfig, NamesTheRegistersOfTheLadder) {
  Diagnostics diagnostics;
  const auto config = read_config(LINUXCNC_CONFIGS "/kerf.yaml", {}, diagnostics);
  ASSERT_TRUE(config) << (diagnostics.empty() ? "" : diagnostics[0].message);
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_EQ(config->common.frame, CoordinateFrame::kMachine);
  EXPECT_EQ(config->common.coordinates, CoordinateKind::kAxes);
  const ModbusSettings& modbus = std::get<ModbusSettings>(config->source);
  EXPECT_EQ(modbus.host, "127.0.0.1");
  EXPECT_EQ(modbus.port, 1502);
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(modbus.axes[i]);
    EXPECT_EQ(modbus.axes[i]->address, static_cast<int>(2 * i));
    EXPECT_EQ(modbus.axes[i]->scale, 0.001);
  }
  EXPECT_FALSE(modbus.axes[3]);
  EXPECT_EQ(modbus.tool->address, 6);
  EXPECT_EQ(modbus.counter->address, 8);
  EXPECT_EQ(modbus.tool_offset_z->address, 9);
  EXPECT_EQ(modbus.tool_offset_z->scale, 0.001);
  EXPECT_EQ(modbus.spindle->address, 11);
  EXPECT_EQ(modbus.spindle->scale, 1);
  EXPECT_EQ(modbus.line->address, 13);
  for (const auto& wide : {modbus.axes[0], modbus.axes[1], modbus.axes[2], modbus.tool_offset_z,
                           modbus.spindle, modbus.line}) {
    EXPECT_EQ(wide->type, ModbusType::kInt32);
    EXPECT_EQ(wide->order, WordOrder::kCdab);
  }
}

TEST(ShippedLinuxCncConfig, HalNeedsNoMap) {
  Diagnostics diagnostics;
  const auto config = read_config(LINUXCNC_CONFIGS "/kerf_hal.yaml", {}, diagnostics);
  ASSERT_TRUE(config) << (diagnostics.empty() ? "" : diagnostics[0].message);
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_EQ(std::get<HalSettings>(config->source).mm_per_unit, 1.0);
}

}  // namespace
}  // namespace kerf
