// What a spindle takes in the air, at speeds that were measured and at others.
#include "twin/live/idle_loads.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kerf {
namespace {

/// As in load_bins.h: a bin is a load.
IdleLoads measured_at(std::initializer_list<double> speeds_rpm, double exponent) {
  IdleLoads idle;
  for (const double rpm : speeds_rpm) {
    for (std::size_t n = 0; n < IdleLoads::kLeastBins; ++n)
      idle.learn(rpm, 2 * std::pow(rpm / 1000, exponent));
  }
  return idle;
}

TEST(IdleLoads, AreKnownAtTheirSpeedAlone) {
  const IdleLoads idle = measured_at({1000}, 1);
  EXPECT_DOUBLE_EQ(idle.at(1050)->load, 2);
  EXPECT_FALSE(idle.at(1200));
  EXPECT_DOUBLE_EQ(idle.near(1050, LoadUnit::kKilowatts)->doubt, 0);
  EXPECT_FALSE(IdleLoads().near(1000, LoadUnit::kKilowatts));
  IdleLoads few;
  for (std::size_t n = 1; n < IdleLoads::kLeastBins; ++n) few.learn(1000, 2);
  EXPECT_FALSE(few.near(2000, LoadUnit::kKilowatts));
}

/// 2 kW at 1000: 2 to 8 at 2000, 0.5 to 2 at 500; as a torque 2 to 4, and 1 to 2.
TEST(IdleLoads, BeyondAllSpeedsAreARange) {
  const IdleLoads idle = measured_at({1000}, 1);
  EXPECT_DOUBLE_EQ(idle.near(2000, LoadUnit::kKilowatts)->load, 5);
  EXPECT_DOUBLE_EQ(idle.near(2000, LoadUnit::kKilowatts)->doubt, 3);
  EXPECT_DOUBLE_EQ(idle.near(500, LoadUnit::kPercentOfPower)->load, 1.25);
  EXPECT_DOUBLE_EQ(idle.near(500, LoadUnit::kPercentOfPower)->doubt, 0.75);
  EXPECT_DOUBLE_EQ(idle.near(2000, LoadUnit::kPercentOfTorque)->load, 3);
  EXPECT_DOUBLE_EQ(idle.near(2000, LoadUnit::kNewtonMetres)->doubt, 1);
  EXPECT_DOUBLE_EQ(idle.near(500, LoadUnit::kNewtonMetres)->load, 1.5);
  EXPECT_DOUBLE_EQ(idle.near(500, LoadUnit::kNewtonMetres)->doubt, 0.5);
}

/// What does not hang on the speed, what grows with it, its square, its cube: each is within the
/// doubt, at all speeds between two that are known.
TEST(IdleLoads, BetweenTwoSpeedsFrictionIsWithinTheDoubt) {
  for (const double exponent : {0.0, 0.5, 1.0, 2.0, 3.0}) {
    const IdleLoads idle = measured_at({500, 4000}, exponent);
    for (double rpm = 500; rpm <= 4000; rpm += 10) {
      const auto known = idle.near(rpm, LoadUnit::kKilowatts).value();
      const bool is_measured = is_same_speed(rpm, 500) || is_same_speed(rpm, 4000);
      EXPECT_EQ(known.doubt == 0, is_measured || exponent == 0) << rpm;
      if (is_measured) continue;
      EXPECT_LE(std::abs(known.load - 2 * std::pow(rpm / 1000, exponent)), known.doubt + 1e-12)
          << rpm << " rpm, to the " << exponent;
    }
  }
}

TEST(IdleLoads, TheNearestOfTwoSpeedsCounts) {
  IdleLoads idle;
  for (std::size_t n = 0; n < IdleLoads::kLeastBins; ++n) {
    idle.learn(1000, 1);
    idle.learn(1150, 3);
  }
  EXPECT_DOUBLE_EQ(idle.at(1060)->load, 1);
  EXPECT_DOUBLE_EQ(idle.at(1090)->load, 3);
}

}  // namespace
}  // namespace kerf
