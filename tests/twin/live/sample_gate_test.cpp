// Single readings that no machine can have, and sound ones that look like it.
#include "twin/live/sample_gate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace kerf {
namespace {

constexpr double kGap_s = 0.5;

SampleGate gate_of(double most_per_s2 = 0, double most_per_s = 0) {
  PositionMost most;
  most.per_s2 = most_per_s2;
  if (most_per_s > 0) most.per_s = most_per_s;
  return {motion_bounds(LiveFrameOptions{}, TimelineOptions{}, most), kGap_s};
}

AxisSample at(double x, double y = 0, double a = 0) {
  AxisSample sample;
  sample.set(0, x);
  sample.set(1, y);
  sample.set(2, 0);
  sample.set(3, a);
  return sample;
}

struct Passed {
  std::vector<SampleGate::Timed> out;
  std::size_t wild = 0;
};

Passed run(SampleGate gate, const std::vector<SampleGate::Timed>& samples) {
  Passed passed;
  for (const auto& one : samples) passed.wild += gate.take(one, passed.out);
  gate.finish(passed.out);
  return passed;
}

/// `x(t)` every `period_s`.
std::vector<SampleGate::Timed> sampled(const std::function<double(double)>& x, double period_s,
                                       double until_s) {
  std::vector<SampleGate::Timed> out;
  for (int i = 0; i * period_s < until_s; ++i) out.push_back({at(x(i * period_s)), i * period_s});
  return out;
}

TEST(SampleGate, ASampleThatIsElsewhereAloneIsDropped) {
  for (const std::size_t count : {1U, 2U}) {
    auto samples = sampled([](double t) { return 2 * t; }, 0.01, 10);
    for (std::size_t i = 0; i < count; ++i) samples[500 + i].sample.position[1] = 40;
    samples[500].lost = true;
    // Two give a machine of which nothing is known more time than 40 mm there and back need.
    const Passed passed = run(gate_of(count == 2 ? 5000 : 0), samples);
    EXPECT_EQ(passed.wild, count);
    ASSERT_EQ(passed.out.size(), samples.size() - count);
    for (const auto& one : passed.out) EXPECT_EQ(one.sample.position[1], 0);
    EXPECT_TRUE(passed.out[500].lost) << "what was lost before it is lost";
  }
}

TEST(SampleGate, SaysWhatIsWrong) {
  SampleGate gate = gate_of();
  std::vector<SampleGate::Timed> out;
  gate.take({at(-20.02), 0.00}, out);
  gate.take({at(20), 0.01}, out);
  EXPECT_EQ(out.size(), 1U) << "it waits for the next one";
  EXPECT_EQ(gate.take({at(-19.98), 0.02}, out), 1U);
  EXPECT_EQ(gate.fault(),
            "X reads 20 mm, 39.98 mm away from where it is before and after, within 0.020 s: no "
            "machine is so quick");
}

TEST(SampleGate, WithTheMachinesAccelerationLessIsWild) {
  // There and back within 20 ms, and 50 ms of doubt: 500 mm/s2 0.07^2 / 8 = 0.31 mm, and half of it
  // more, and 1 mm.
  for (const double off_mm : {1.4, 1.5}) {
    auto samples = sampled([](double) { return 0.0; }, 0.01, 1);
    samples[50].sample.position[0] = off_mm;
    EXPECT_EQ(run(gate_of(500), samples).wild, off_mm > 1.46 ? 1U : 0U);
    EXPECT_EQ(run(gate_of(), samples).wild, 0U) << "a machine of which nothing is known";
  }
}

TEST(SampleGate, ASlowMachineIsNoQuickerForItsAcceleration) {
  // 10 mm/s for half of 70 ms: 0.35 mm, and half of it more, and 1 mm.
  auto samples = sampled([](double) { return 0.0; }, 0.01, 1);
  samples[50].sample.position[0] = 1.6;
  EXPECT_EQ(run(gate_of(0, 10), samples).wild, 1U);
}

TEST(SampleGate, AMachineAtItsRapidIsSound) {
  // To and fro at 500 mm/s, turning with 5 m/s2, at 10, 1 and 100 ms.
  const auto zigzag = [](double t) {
    const double turn_s = 0.1;  // from rest to 500 mm/s
    const double phase = std::fmod(t, 1.0);
    const auto way = [&](double s) {
      if (s < turn_s) return 2500 * s * s;
      if (s < 0.5 - turn_s) return 25 + 500 * (s - turn_s);
      const double left = 0.5 - s;
      return 200 - 2500 * left * left;
    };
    return phase < 0.5 ? way(phase) : 200 - way(phase - 0.5);
  };
  for (const double period_s : {0.001, 0.01, 0.1}) {
    for (const double most_per_s2 : {0.0, 5000.0}) {
      const auto samples = sampled(zigzag, period_s, 10);
      const Passed passed = run(gate_of(most_per_s2), samples);
      EXPECT_EQ(passed.wild, 0U) << period_s;
      EXPECT_EQ(passed.out.size(), samples.size());
    }
  }
}

TEST(SampleGate, StampsThatTrembleAreNoJumps) {
  // 500 mm/s; every reading is up to 40 ms later than its stamp, and they come in their order.
  std::uint32_t seed = 1;
  std::vector<SampleGate::Timed> samples;
  double real_s = 0;
  for (int i = 0; i < 20'000; ++i) {
    seed = seed * 1664525 + 1013904223;
    real_s = std::max(real_s, i * 0.01 + (seed >> 8U) % 40 * 0.001);
    // To and fro, turning with 5 m/s2 as a sine: 50 mm at 10 rad/s.
    samples.push_back({at(50 * std::sin(10 * real_s)), i * 0.01});
  }
  const Passed passed = run(gate_of(5000), samples);
  EXPECT_EQ(passed.wild, 0U);
  EXPECT_EQ(passed.out.size(), samples.size());
}

TEST(SampleGate, AMachineThatIsElsewhereAndStaysIsThere) {
  auto samples = sampled([](double t) { return t < 0.5 ? 0.0 : 300.0; }, 0.01, 1);
  const Passed passed = run(gate_of(500), samples);
  EXPECT_EQ(passed.wild, 0U);
  ASSERT_EQ(passed.out.size(), samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) EXPECT_EQ(passed.out[i].t_s, samples[i].t_s);
}

TEST(SampleGate, AcrossAGapAndOfAnglesNothingIsJudged) {
  std::vector<SampleGate::Timed> samples{{at(0), 0}, {at(300), 0.6}, {at(0), 1.2}};
  EXPECT_EQ(run(gate_of(500), samples).wild, 0U);
  // A spindle that is counted from 0 to 360.
  samples = {{at(0, 0, 359), 0}, {at(0, 0, 1), 0.01}, {at(0, 0, 358), 0.02}};
  EXPECT_EQ(run(gate_of(500), samples).wild, 0U);
}

TEST(SampleGate, ThePositionsOfAnIniHaveItsLimits) {
  TimelineOptions timeline;
  timeline.limits_known = true;
  const MotionBounds bounds = motion_bounds(LiveFrameOptions{}, timeline, {});
  EXPECT_EQ(bounds.bounds[2].name, "Z");
  EXPECT_EQ(bounds.bounds[2].most_per_s2, 300);
  EXPECT_EQ(bounds.bounds[2].most_per_s, 60);
  EXPECT_FALSE(bounds.bounds[3].judged);
  PositionMost most;
  most.of_position_per_s[2] = 40;
  most.per_s2 = 1000;
  const MotionBounds said = motion_bounds(LiveFrameOptions{}, timeline, most);
  EXPECT_EQ(said.bounds[2].most_per_s, 40);
  EXPECT_EQ(said.bounds[2].most_per_s2, 1000);
}

}  // namespace
}  // namespace kerf
