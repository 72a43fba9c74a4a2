#include "machine_io/mtconnect/agent_time.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kerf {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kMs = 1'000'000;

/// By `date -u -d .. +%s`.
constexpr std::int64_t kMoment = 1787404887 * kSecond;  // 2026-08-22T13:21:27Z

TEST(AgentTime, zones_and_fractions) {
  const auto ns = [](const char* text) {
    const auto time = parse_agent_time(text);
    return time ? time->ns - kMoment : INT64_MIN;
  };
  EXPECT_EQ(ns("2026-08-22T13:21:27Z"), 0);
  EXPECT_EQ(ns("2026-08-22T13:21:27"), 0);
  EXPECT_EQ(ns("2026-08-22T13:21:27.123Z"), 123 * kMs);
  EXPECT_EQ(ns("2026-08-22T13:21:27.123456789Z"), 123456789);
  EXPECT_EQ(ns("2026-08-22T13:21:27.1234567899Z"), 123456789);
  EXPECT_EQ(ns("2026-08-22T15:21:27.5+02:00"), 500 * kMs);
  EXPECT_EQ(ns("2026-08-22T08:51:27-0430"), 0);
  EXPECT_EQ(ns("2026-08-22T13:21:27Z@100.0"), 0);
  EXPECT_EQ(ns("2026-08-23T00:21:27+11"), 0);
  EXPECT_EQ(parse_agent_time("1970-01-01T00:00:00Z")->ns, 0);
  EXPECT_EQ(parse_agent_time("2024-02-29T00:00:00Z")->ns, 1709164800 * kSecond);
}

TEST(AgentTime, resolution_is_that_of_the_last_digit) {
  EXPECT_EQ(parse_agent_time("2026-08-22T13:21:27Z")->resolution_ns, kSecond);
  EXPECT_EQ(parse_agent_time("2026-08-22T13:21:27.5Z")->resolution_ns, kSecond / 10);
  EXPECT_EQ(parse_agent_time("2026-08-22T13:21:27.123456Z")->resolution_ns, 1000);
}

TEST(AgentTime, no_times) {
  for (const char* const text :
       {"", "soon", "2026-08-22", "2026-08-22 13:21:27Z", "2026-13-22T13:21:27Z",
        "2026-02-30T13:21:27Z", "2026-08-22T25:21:27Z", "2026-08-22T13:61:27Z", "-026-08-22T1:1:1Z",
        "2026-08-22T13:21:27.Z", "2026-08-22T13:21:27X", "2026-08-22T13:21:27+2",
        "2600-01-01T00:00:00Z", "2026-08-22T13:21:27+99:00", "2026-08-22T13:21:27Zabc"}) {
    EXPECT_FALSE(parse_agent_time(text)) << text;
  }
}

/// The agent's clock is 3600 s ahead; answers take 2 ms there and 4 ms back.
TEST(StampClock, an_agent_with_another_clock_tells_true_ages) {
  StampClock clock;
  const std::int64_t ahead = 3600 * kSecond;
  for (std::int64_t t = kSecond; t < 3 * kSecond; t += 100 * kMs) {
    clock.heard(t, t + 6 * kMs, {t + 2 * kMs + ahead, 1000});
    // Seen 30 ms before the answer was written.
    clock.observed(t - 28 * kMs + ahead, t + 6 * kMs);
  }
  EXPECT_FALSE(clock.behind_s());
  EXPECT_LE(clock.doubt_ns(), 3 * kMs + 2 * kMs);
  // Truly 34 ms.
  EXPECT_NEAR(static_cast<double>(clock.age_ns(2900 * kMs - 28 * kMs + ahead, 2906 * kMs)), 34e6,
              3.5e6);
  // What was held up for a second more is that much older.
  EXPECT_NEAR(static_cast<double>(clock.age_ns(2000 * kMs + ahead, 3000 * kMs)), 1000e6, 3.5e6);
}

/// Whole seconds, as old agents write them: the clock is found all the same, in some answers.
TEST(StampClock, whole_seconds_are_narrowed_down) {
  StampClock clock;
  for (int i = 0; i < 100; ++i) {
    const std::int64_t t = 10 * kSecond + i * 37 * kMs;
    clock.heard(t, t + 2 * kMs, {(t + kMs) / kSecond * kSecond, kSecond});
  }
  // Some answer was written within 37 ms of a full second.
  EXPECT_LE(clock.doubt_ns(), 25 * kMs);
  EXPECT_NEAR(static_cast<double>(clock.answer_age_ns(13 * kSecond, 13500 * kMs)), 500e6, 40e6);
}

/// An adapter whose clock is 90 s behind that of its agent.
TEST(StampClock, stamps_of_another_clock_are_told_and_relative) {
  StampClock clock;
  const std::int64_t behind = 90 * kSecond;
  for (std::int64_t t = kSecond; t < 2 * kSecond; t += 50 * kMs) {
    clock.heard(t, t + kMs, {t, 1000});
    clock.observed(t - 20 * kMs - behind, t + kMs);
  }
  ASSERT_TRUE(clock.behind_s());
  EXPECT_NEAR(*clock.behind_s(), 90.02, 0.01);
  // As quick as the quickest, and one that was held up for 300 ms.
  EXPECT_LE(clock.age_ns(1930 * kMs - behind, 1951 * kMs), kMs);
  EXPECT_NEAR(static_cast<double>(clock.age_ns(1930 * kMs - behind, 2251 * kMs)), 300e6, 1e6);
  // And one that is ahead.
  StampClock other;
  other.heard(kSecond, kSecond + kMs, {kSecond, 1000});
  other.observed(6 * kSecond, kSecond + kMs);
  ASSERT_TRUE(other.behind_s());
  EXPECT_NEAR(*other.behind_s(), -5.0, 0.01);
}

TEST(StampClock, a_clock_that_is_set_is_read_anew) {
  StampClock clock;
  clock.heard(kSecond, kSecond + 2 * kMs, {kSecond + kMs, 1000});
  clock.heard(2 * kSecond, 2 * kSecond + 2 * kMs, {2 * kSecond + kMs - 500 * kSecond, 1000});
  EXPECT_NEAR(static_cast<double>(clock.age_ns(3 * kSecond - 500 * kSecond, 3100 * kMs)), 100e6,
              2e6);
  // Parts of a stream, which were asked for long ago, move it as well.
  clock.heard(std::nullopt, 4 * kSecond, {4 * kSecond - kMs + 700 * kSecond, 1000});
  EXPECT_NEAR(static_cast<double>(clock.age_ns(5 * kSecond + 700 * kSecond, 5200 * kMs)), 200e6,
              3e6);
}

}  // namespace
}  // namespace kerf
