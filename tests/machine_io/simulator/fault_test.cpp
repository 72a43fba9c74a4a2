#include "machine_io/simulator/fault.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

FaultRule rule(const char* text) {
  const Result<FaultRule> parsed = parse_fault(text);
  EXPECT_TRUE(parsed) << text;
  return parsed ? parsed.value() : FaultRule{};
}

TEST(Fault, ReadsKindValueAndTimes) {
  EXPECT_EQ(rule("drop").kind, FaultKind::kDrop);
  EXPECT_EQ(rule("drop").period_s, 10);
  EXPECT_EQ(rule("drop").duration_s, 1);
  EXPECT_EQ(rule("jump:0.5").duration_s, 0.25);
  EXPECT_EQ(rule("freeze:5:0.2").duration_s, 0.2);
  EXPECT_EQ(rule("delay:200:5:2").value, 200);
  EXPECT_EQ(rule("delay:200:5:2").period_s, 5);
  EXPECT_EQ(rule("delay:200:5:2").duration_s, 2);
  EXPECT_EQ(rule("exception:4").kind, FaultKind::kException);
  EXPECT_EQ(rule("exception:4").value, 4);
  EXPECT_EQ(rule("nan:0").period_s, 0);
}

TEST(Fault, SaysWhatIsWrong) {
  const auto error = [](const char* text) { return parse_fault(text).error(); };
  EXPECT_EQ(error("fire"),
            "'fire' is no fault; allowed: drop, delay, garbage, exception, restart, nan, freeze, "
            "jump");
  EXPECT_EQ(error("delay"),
            "'delay': delay needs ms: a whole number from 1 to 60000, as in delay:200");
  EXPECT_EQ(error("exception:12"),
            "'exception:12': exception needs a code: a whole number from 1 to 11, as in "
            "exception:4");
  EXPECT_EQ(error("drop:-1"),
            "'drop:-1': the period '-1' is not allowed; must be at least 0 (0: always) and at most "
            "1e+06 (s)");
  EXPECT_EQ(error("drop:x"),
            "'drop:x': the period 'x' is not allowed; must be at least 0 (0: always) and at most "
            "1e+06 (s)");
  EXPECT_EQ(error("drop:2:2"),
            "'drop:2:2': the duration '2' is not allowed; must be above 0 and less than the period "
            "(s)");
  EXPECT_EQ(error("drop:nan:1").substr(0, 11), "'drop:nan:1");
  EXPECT_EQ(error("drop:0:1"), "'drop:0:1': with a period of 0 there is no duration");
  EXPECT_EQ(error("drop:1:0.5:3"), "'drop:1:0.5:3': too many parts; KIND:period:duration");
}

TEST(Fault, IsOnInItsWindowsAlone) {
  const FaultRule windows = rule("drop:2:0.5");
  for (const double time : {-1.0, 0.0, 0.3, 1.999, 2.5, 3.9, 4.5}) {
    EXPECT_FALSE(is_active(windows, time)) << time;
  }
  for (const double time : {2.0, 2.499, 4.0, 4.4, 2000.1}) {
    EXPECT_TRUE(is_active(windows, time)) << time;
  }
  EXPECT_TRUE(is_active(rule("drop:0"), -1));
}

TEST(Fault, FreezeHoldsAllAndJumpMovesTheAxes) {
  FaultInjector injector(
      {rule("freeze:1:0.5"), rule("jump:1:0.25"), rule("delay:50:0"), rule("delay:70:0")});
  SimulatedState state;
  for (int i = 0; i <= 200; ++i) {
    const double time = i * 0.01;
    state.position[0] = time;
    state.scan = static_cast<std::uint16_t>(i);
    const ServedState served = injector.serve(state, time);
    EXPECT_EQ(served.faults.delay_ms, 70);
    const bool frozen = (time >= 0.999 && time < 1.4995) || time > 1.9995;
    const bool jumped = (time >= 0.999 && time < 1.2495) || time > 1.9995;
    ASSERT_EQ(served.faults.has(FaultKind::kFreeze), frozen) << time;
    ASSERT_EQ(served.faults.has(FaultKind::kJump), jumped) << time;
    const double held = !frozen ? time : (time > 1.9 ? 2.0 : 1.0);
    EXPECT_NEAR(served.state.position[0], held + (jumped ? kJump_mm : 0), 1e-9) << time;
    EXPECT_EQ(served.state.scan, static_cast<int>(held * 100 + 0.5)) << time;
  }
}

}  // namespace
}  // namespace kerf
