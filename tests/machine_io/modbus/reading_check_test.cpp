#include "machine_io/modbus/reading_check.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>

namespace kerf {
namespace {

using std::chrono::milliseconds;

constexpr WordOrder kAbcd = WordOrder::kAbcd;

/// X and Y of `type`, configured as `order`, -300 .. 300.
ModbusSettings settings_of(ModbusType type, WordOrder order, double scale = 1) {
  ModbusSettings settings;
  for (std::size_t i = 0; i < 2; ++i) {
    settings.axes[i] = ModbusRegister{0, ModbusTable::kHolding, type, order, scale, 0};
    settings.ranges[i].min = -300;
    settings.ranges[i].max = 300;
  }
  return settings;
}

/// What is read when the device holds x and y in `order_of_device`.
AxisReading reading_of(const ModbusSettings& settings, WordOrder order_of_device, double x,
                       double y, int at_ms) {
  AxisReading reading;
  reading.time = SteadyClock::time_point(std::chrono::hours(1)) + milliseconds(at_ms);
  const double values[] = {x, y};
  for (std::size_t i = 0; i < 2; ++i) {
    const ModbusRegister& wanted = *settings.axes[i];
    encode_registers(wanted.type, order_of_device, values[i] / wanted.scale, reading.raw[i].data());
    reading.value[i] =
        decode_registers(wanted.type, wanted.order, reading.raw[i].data()) * wanted.scale;
  }
  return reading;
}

TEST(ReadingCheck, a_moving_machine_gives_a_wrong_word_order_away) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> position(-200, 200);
  std::uniform_real_distribution<double> speed(-40, 40);
  const ModbusType types[] = {ModbusType::kFloat32, ModbusType::kFloat64, ModbusType::kInt32};
  for (const ModbusType type : types) {
    const double scale = type == ModbusType::kInt32 ? 0.001 : 1;
    int named = 0;
    int runs = 0;
    int readings = 0;
    int accepted = 0;
    for (const WordOrder device : kWordOrders) {
      for (const WordOrder configured : kWordOrders) {
        if (device == configured) continue;
        const ModbusSettings settings = settings_of(type, configured, scale);
        const std::string wanted =
            "positions jump beyond machine limits; is word_order " + std::string(name_of(device));
        for (int run = 0; run < 50; ++run, ++runs) {
          ReadingCheck check(settings);
          const double x = position(random);
          const double y = position(random);
          const double vx = speed(random);
          const double vy = speed(random);
          bool is_named = false;
          for (int i = 0; i < 100; ++i, ++readings) {  // 2 s at 50 Hz
            const double t = 0.02 * i;
            accepted +=
                check.accept(reading_of(settings, device, x + vx * t, y + vy * t, 20 * i)) ? 1 : 0;
            is_named = is_named || check.trouble().find(wanted) == 0;
          }
          named += is_named ? 1 : 0;
        }
      }
    }
    // Two axes, and each may be misread as something small. Measured: 1.7, 0.4 and 2.8 %.
    EXPECT_GT(named, runs * 95 / 100) << name_of(type);
    EXPECT_LT(accepted, readings * 4 / 100) << name_of(type);
  }
}

TEST(ReadingCheck, round_floats_with_swapped_words_are_not_taken_for_zero) {
  const ModbusSettings settings = settings_of(ModbusType::kFloat32, kAbcd);
  ReadingCheck check(settings);
  EXPECT_FALSE(check.accept(reading_of(settings, WordOrder::kCdab, 100, 12.5, 0)));
  EXPECT_EQ(check.trouble(),
            "positions jump beyond machine limits; is word_order cdab? (X reads 2.39566e-41, raw "
            "0000 42C8: not a position)");
}

TEST(ReadingCheck, rounding_noise_passes_for_what_it_is) {
  const ModbusSettings settings = settings_of(ModbusType::kFloat64, kAbcd);
  ReadingCheck check(settings);
  int at_ms = 0;
  for (double x = 1; x > ReadingCheck::kTiny; x *= 0.37) {
    ASSERT_TRUE(check.accept(reading_of(settings, kAbcd, x, -x, at_ms += 10))) << check.trouble();
  }
  EXPECT_TRUE(check.accept(reading_of(settings, kAbcd, 0.0, -0.0, at_ms += 10)));
}

TEST(ReadingCheck, outside_is_named_with_the_limits) {
  const ModbusSettings settings = settings_of(ModbusType::kInt16, kAbcd, 0.1);
  ReadingCheck check(settings);
  EXPECT_TRUE(check.accept(reading_of(settings, kAbcd, 305.9, 0, 0)));
  EXPECT_FALSE(check.accept(reading_of(settings, kAbcd, 307, 0, 10)));
  EXPECT_EQ(check.trouble(), "X reads 307, raw 0BFE: outside -300 .. 300");
}

TEST(ReadingCheck, a_torn_value_stands_alone_and_a_homed_axis_stays) {
  ModbusSettings settings = settings_of(ModbusType::kInt32, kAbcd, 0.001);
  settings.ranges[0].max_speed_per_s = 500;
  ReadingCheck check(settings);
  EXPECT_TRUE(check.accept(reading_of(settings, kAbcd, 65.530, 1, 0)));
  EXPECT_TRUE(check.accept(reading_of(settings, kAbcd, 65.534, 1, 10)));
  EXPECT_FALSE(check.accept(reading_of(settings, kAbcd, 131.071, 1, 20)));
  EXPECT_EQ(check.trouble(),
            "X reads 131.071, raw 0001 FFFF: jumps from 65.534; kept back until another agrees");
  EXPECT_TRUE(check.accept(reading_of(settings, kAbcd, 65.537, 1, 30)));
  EXPECT_FALSE(check.accept(reading_of(settings, kAbcd, -200, 1, 40)));
  EXPECT_TRUE(check.accept(reading_of(settings, kAbcd, -200, 1, 50)));
}

TEST(ReadingCheck, jumps_that_go_on_ask_for_the_word_order) {
  ModbusSettings settings = settings_of(ModbusType::kInt32, kAbcd, 0.001);
  settings.ranges[0] = settings.ranges[1] = ModbusAxisRange{};
  ReadingCheck check(settings);
  // 1 um more every 20 ms is 65.5 mm more in swapped words: 3277 mm/s would be believed, so 3 um.
  int accepted = 0;
  for (int i = 0; i < 20; ++i) {
    accepted += check.accept(reading_of(settings, WordOrder::kCdab, 0.1 + 0.005 * i, 0, 20 * i));
  }
  EXPECT_EQ(accepted, 1);
  EXPECT_EQ(check.trouble().find("positions jump beyond machine limits; is word_order cdab? (X"),
            0u)
      << check.trouble();
}

TEST(ReadingCheck, without_limits_only_the_absurd_is_refused) {
  ModbusSettings settings = settings_of(ModbusType::kFloat64, kAbcd);
  settings.ranges[0] = settings.ranges[1] = ModbusAxisRange{};
  for (const double value : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1.1e7}) {
    ReadingCheck check(settings);
    EXPECT_FALSE(check.accept(reading_of(settings, kAbcd, 0, value, 0))) << value;
    EXPECT_EQ(check.trouble().find("Y reads"), 0u) << check.trouble();
  }
  ReadingCheck check(settings);
  EXPECT_TRUE(check.accept(reading_of(settings, kAbcd, 0, 9e6, 0)));
}

}  // namespace
}  // namespace kerf
