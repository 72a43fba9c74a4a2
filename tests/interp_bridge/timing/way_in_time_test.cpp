#include "interp_bridge/timing/way_in_time.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace kerf {
namespace {

constexpr double kFloat = 1e-6;  ///< shares are kept as floats

/// Way and time of a trapezoid, stepped: 10 mm, from 2 to 12 to 5 mm/s at 40 mm/s2.
TEST(WayInTime, ATrapezoidAsStepped) {
  WayInTime way;
  way.set_ramps(10, 40, 2, 12, 5);
  const double up_mm = (144 - 4) / 80.0, down_mm = (144 - 25) / 80.0;
  const double whole_s = 10 / 40.0 + (10 - up_mm - down_mm) / 12 + 7 / 40.0;
  double at_mm = 0, speed = 2;
  constexpr int kSteps = 100000;
  for (int i = 0; i < kSteps; ++i) {
    if (i % 1000 == 0) {
      const double share = static_cast<double>(i) / kSteps;
      EXPECT_NEAR(way.way_of(share), at_mm / 10, 1e-4) << share;
      EXPECT_NEAR(way.time_of(at_mm / 10), share, 1e-4) << share;
    }
    const double t = whole_s * (i + 0.5) / kSteps;
    speed = std::min({2 + 40 * t, 12.0, 5 + 40 * (whole_s - t)});
    at_mm += speed * whole_s / kSteps;
  }
}

TEST(WayInTime, EvenByDefault) {
  const WayInTime even;
  EXPECT_EQ(even.time_of(0.3), 0.3);
  EXPECT_EQ(even.way_of(0.3), 0.3);
}

/// From and to standing, with the arcs of corners at both ends, rests, braking first.
TEST(WayInTime, OneIsTheInverseOfTheOther) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(0, 1);
  for (int i = 0; i < 2000; ++i) {
    WayInTime way;
    if (i % 3 == 0) {
      const double first = 0.1 + any(random), last = 0.1 + any(random);
      way.set_slowness(first, last, first + (last - first) * any(random));
    } else {
      const double cruise = 1 + 10 * any(random), accel = 500 * any(random) + 1;
      const double first = cruise * 1.2 * any(random), last = cruise * any(random);
      const double ramps =
          (std::abs(cruise * cruise - first * first) + cruise * cruise - last * last) / (2 * accel);
      way.set_ramps(ramps * (1 + any(random)), accel, first, cruise, last);
    }
    if (i % 2 == 0) {
      way.in_way = static_cast<float>(0.3 * any(random));
      way.out_way = static_cast<float>(0.3 * any(random));
      way.in_time = static_cast<float>(0.3 * any(random));
      way.out_time = static_cast<float>(0.3 * any(random));
    }
    double before = -1;
    for (int k = 1; k < 40; ++k) {
      const double share = k / 40.0;
      const double time = way.time_of(share);
      EXPECT_GE(time, before);
      before = time;
      EXPECT_NEAR(way.way_of(time), share, 1e-5) << i << " " << share;
    }
    EXPECT_NEAR(way.way_of(1), 1, kFloat);
    EXPECT_EQ(way.way_of(0), 0);
  }
}

/// 20 mm towards the axis at 6 mm/s / x, x from 20 to 4, where the cap holds.
TEST(WayInTime, SlownessThatFallsUpToACap) {
  WayInTime way;
  const auto slowness = [](double at_mm) { return std::max(20 - at_mm, 4.0) / 6; };
  double whole_s = 0;
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) whole_s += slowness(20 * (i + 0.5) / kSteps) * 20 / kSteps;
  way.set_slowness(slowness(0), slowness(20), whole_s / 20);
  EXPECT_NEAR(way.cap, 0.8, 1e-5);
  double time_s = 0;
  for (int i = 0; i < kSteps; ++i) {
    if (i % 500 == 0) {
      EXPECT_NEAR(way.time_of(static_cast<double>(i) / kSteps), time_s / whole_s, 1e-5);
      EXPECT_NEAR(way.way_of(time_s / whole_s), static_cast<double>(i) / kSteps, 1e-5);
    }
    time_s += slowness(20 * (i + 0.5) / kSteps) * 20 / kSteps;
  }
}

/// A part of a way is run as the whole is there.
TEST(WayInTime, PartsGoAsTheWhole) {
  WayInTime ramps;
  ramps.set_ramps(10, 40, 2, 12, 5);
  WayInTime slow;
  slow.set_slowness(3, 0.5, 1.2);
  for (const WayInTime& whole : {ramps, slow}) {
    for (const auto& [from, to] : {std::pair(0.0, 0.1), std::pair(0.05, 0.6), std::pair(0.3, 0.5),
                                   std::pair(0.4, 1.0), std::pair(0.95, 1.0)}) {
      const WayInTime part = whole.part(from, to);
      const double begin = whole.time_of(from), length = whole.time_of(to) - begin;
      for (int k = 0; k <= 10; ++k) {
        const double share = k / 10.0;
        const double in_whole = whole.time_of(from + share * (to - from));
        EXPECT_NEAR(part.time_of(share), (in_whole - begin) / length, 2e-5)
            << from << " " << to << " " << share;
      }
    }
  }
}

/// Divided anywhere, corners, rests and all.
TEST(WayInTime, DividedItGoesAsBefore) {
  WayInTime way;
  way.set_ramps(10, 40, 2, 12, 5);
  way.in_way = 0.1F;
  way.in_time = 0.2F;
  way.out_way = 0.05F;
  way.out_time = 0.15F;
  WayInTime stands = way;
  stands.in_way = stands.out_way = 0;
  for (const WayInTime& whole : {way, stands}) {
    for (const double middle : {0.04, 0.1, 0.3, 0.5, 0.93, 0.97}) {
      const WayInTime::Part first = whole.between(0, middle), last = whole.between(middle, 1);
      EXPECT_EQ(first.from_time, 0);
      EXPECT_NEAR(first.to_time, last.from_time, 1e-12);
      EXPECT_EQ(last.to_time, 1);
      for (int k = 1; k < 20; ++k) {
        const double at = k / 20.0;
        const WayInTime::Part& part = at < middle ? first : last;
        const double share = at < middle ? at / middle : (at - middle) / (1 - middle);
        const double time =
            part.from_time + (part.to_time - part.from_time) * part.way.time_of(share);
        EXPECT_NEAR(time, whole.time_of(at), 3e-6) << middle << " " << at;
      }
    }
  }
}

TEST(WayInTime, Unevenness) {
  EXPECT_EQ(WayInTime{}.unevenness(), 0);
  // From and to a stand over the whole way: a quarter of the way takes 0.354 of the time.
  WayInTime triangle;
  triangle.set_ramps(10, 40, 0, 20, 0);
  double most = 0;
  for (int k = 1; k < 100; ++k) {
    most = std::max(most, std::abs(triangle.time_of(k / 100.0) - k / 100.0));
  }
  EXPECT_NEAR(triangle.unevenness(), most, 1e-3);
}

/// A thread waits for the index; behind its last move the planner rests.
TEST(WayInTime, StandingAtTheEnds) {
  WayInTime way;
  way.in_time = 0.25F;
  way.out_time = 0.25F;
  EXPECT_EQ(way.way_of(0.2), 0);
  EXPECT_NEAR(way.way_of(0.5), 0.5, kFloat);
  EXPECT_EQ(way.way_of(0.8), 1);
  EXPECT_NEAR(way.time_of(0), 0.25, kFloat);
  EXPECT_NEAR(way.time_of(1), 0.75, kFloat);
}

}  // namespace
}  // namespace kerf
