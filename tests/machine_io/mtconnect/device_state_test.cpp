#include "machine_io/mtconnect/device_state.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/small_file.h"

namespace kerf {
namespace {

constexpr std::int64_t kStampMs = 1'000'000;

ItemPlan plan_of_xyz() {
  ItemPlan plan;
  plan.axes[0] = TakenItem{"x", 1, 0};
  plan.axes[1] = TakenItem{"y", 25.4, 0};
  plan.axes[2] = TakenItem{"z", 1, 0.5};
  plan.axes[3] = TakenItem{"a", 1, 0};
  plan.spindle = TakenItem{"rpm", 1, 0};
  plan.load = TakenItem{"load", 1, 0};
  plan.tool = TakenItem{"tool", 1, 0};
  plan.line = TakenItem{"line", 1, 0};
  plan.execution = "exec";
  plan.mode = "mode";
  plan.availability = "avail";
  plan.direction = "dir";
  return plan;
}

DeviceState state_of_xyz() {
  return DeviceState(plan_of_xyz(), LoadUnit::kPercentOfPower, 2 * kStampMs);
}

/// And the last one, for which no other axis comes.
std::vector<DeviceState::Stamped> all_of(DeviceState& state,
                                         const std::vector<Observation>& observations) {
  std::vector<DeviceState::Stamped> made = state.take(observations);
  for (const auto& one : state.take({})) made.push_back(one);
  return made;
}

std::vector<Observation> told(std::initializer_list<std::pair<const char*, const char*>> values,
                              std::int64_t stamp_ns) {
  std::vector<Observation> out;
  for (const auto& [id, text] : values) {
    Observation one;
    one.id = id;
    one.stamp_ns = stamp_ns;
    one.text = text;
    out.push_back(one);
  }
  return out;
}

TEST(DeviceState, one_time_is_one_sample) {
  DeviceState state = state_of_xyz();
  auto news =
      told({{"x", "1.5"}, {"y", "2"}, {"z", "-3"}, {"tool", "7"}, {"line", "12"}}, 10 * kStampMs);
  const auto later = told({{"x", "2.5"}, {"other", "9"}}, 110 * kStampMs);
  news.insert(news.end(), later.begin(), later.end());
  const auto made = all_of(state, news);
  ASSERT_EQ(made.size(), 2U);
  EXPECT_EQ(made[0].stamp_ns, 10 * kStampMs);
  EXPECT_EQ(made[0].sample.position[0], 1.5);
  EXPECT_EQ(made[0].sample.position[1], 50.8);
  EXPECT_EQ(made[0].sample.position[2], -2.5);
  EXPECT_EQ(made[0].sample.known, 7);
  EXPECT_EQ(made[0].sample.fresh, 7);
  EXPECT_EQ(made[0].sample.tool, 7);
  EXPECT_EQ(made[0].sample.line, 12);
  // What was not told again holds, and is not fresh.
  EXPECT_EQ(made[1].sample.position[0], 2.5);
  EXPECT_EQ(made[1].sample.position[1], 50.8);
  EXPECT_EQ(made[1].sample.known, 7);
  EXPECT_EQ(made[1].sample.fresh, 1);
  EXPECT_EQ(state.sample().fresh, 7);
  EXPECT_EQ(state.missing(), "");
  EXPECT_TRUE(all_of(state, told({{"other", "1"}}, 200 * kStampMs)).empty());
}

TEST(DeviceState, stamps_that_lie_close_are_one_sample_but_an_axis_is_in_one_place) {
  DeviceState state = state_of_xyz();
  auto news = told({{"x", "1"}}, 0);
  const auto add = [&](const std::vector<Observation>& more) {
    news.insert(news.end(), more.begin(), more.end());
  };
  add(told({{"y", "1"}}, kStampMs));
  add(told({{"z", "1"}}, 2 * kStampMs));
  add(told({{"x", "2"}}, 2 * kStampMs));
  add(told({{"y", "2"}}, 5 * kStampMs));
  const auto made = all_of(state, news);
  ASSERT_EQ(made.size(), 3U);
  EXPECT_EQ(made[0].sample.fresh, 7);
  EXPECT_EQ(made[0].stamp_ns, 2 * kStampMs);
  EXPECT_EQ(made[1].sample.fresh, 1);
  EXPECT_EQ(made[2].sample.fresh, 2);
}

TEST(DeviceState, an_answer_that_ends_between_two_axes_is_gone_on_with) {
  DeviceState state = state_of_xyz();
  ASSERT_EQ(state.take(told({{"x", "1"}, {"y", "1"}, {"z", "1"}}, 0)).size(), 1U);
  EXPECT_TRUE(state.take(told({{"x", "2"}}, 20 * kStampMs)).empty());
  EXPECT_TRUE(state.is_waiting());
  const auto made = state.take(told({{"y", "2"}, {"z", "2"}}, 20 * kStampMs));
  ASSERT_EQ(made.size(), 1U);
  EXPECT_EQ(made[0].sample.fresh, 7);
  EXPECT_EQ(made[0].stamp_ns, 20 * kStampMs);
  EXPECT_FALSE(state.is_waiting());
  // The others stand: that shows as soon as there is other news, or none.
  EXPECT_TRUE(state.take(told({{"x", "3"}}, 40 * kStampMs)).empty());
  const auto next = state.take(told({{"x", "4"}}, 60 * kStampMs));
  ASSERT_EQ(next.size(), 2U);
  EXPECT_EQ(next[0].sample.position[0], 3);
  EXPECT_EQ(next[1].sample.position[0], 4);
  // A tool alone is no axis that others could follow.
  EXPECT_EQ(state.take(told({{"tool", "3"}}, 80 * kStampMs)).size(), 1U);
  EXPECT_TRUE(state.take({}).empty());
}

TEST(DeviceState, unavailable_is_not_known) {
  DeviceState state = state_of_xyz();
  EXPECT_EQ(state.missing(), "the agent has no position of X, Y, Z (UNAVAILABLE)");
  state.take(
      told({{"x", "1"}, {"y", "1"}, {"z", "1"}, {"a", "90"}, {"rpm", "500"}, {"tool", "3"}}, 0));
  EXPECT_EQ(state.missing(), "");
  state.take(
      told({{"y", "UNAVAILABLE"}, {"rpm", "UNAVAILABLE"}, {"tool", "UNAVAILABLE"}}, 10 * kStampMs));
  EXPECT_EQ(state.missing(), "the agent has no position of Y (UNAVAILABLE)");
  EXPECT_EQ(state.sample().known, 1U | 4U | 8U);
  EXPECT_TRUE(std::isnan(state.sample().spindle_rpm));
  EXPECT_EQ(state.sample().tool, AxisSample::kUnknown);
  // It is no fault.
  EXPECT_EQ(state.damaged(), 0U);
  state.take(told({{"y", "2"}, {"a", "UNAVAILABLE"}}, 20 * kStampMs));
  EXPECT_EQ(state.missing(), "");
  EXPECT_EQ(state.sample().known, 7U);
  state.take(told({{"avail", "UNAVAILABLE"}}, 30 * kStampMs));
  EXPECT_EQ(state.missing(), "the agent says that the machine is UNAVAILABLE");
  state.take(told({{"avail", "AVAILABLE"}}, 40 * kStampMs));
  EXPECT_EQ(state.missing(), "");
}

TEST(DeviceState, what_was_unavailable_in_between_is_not_handed_out) {
  DeviceState state = state_of_xyz();
  auto news = told({{"x", "1"}, {"y", "1"}, {"z", "1"}}, 0);
  for (const auto& one : told({{"x", "2"}, {"y", "UNAVAILABLE"}, {"z", "2"}}, 20 * kStampMs)) {
    news.push_back(one);
  }
  for (const auto& one : told({{"x", "3"}, {"y", "3"}, {"z", "3"}}, 40 * kStampMs)) {
    news.push_back(one);
  }
  const auto made = state.take(news);
  ASSERT_EQ(made.size(), 3U);
  EXPECT_TRUE(made[0].is_whole);
  EXPECT_FALSE(made[1].is_whole);
  EXPECT_TRUE(made[2].is_whole);
}

TEST(DeviceState, what_is_no_number_is_a_fault) {
  DeviceState state = state_of_xyz();
  state.take(told({{"x", "1"}, {"y", "1"}, {"z", "1"}}, 0));
  for (const char* const text : {"nan", "1e30", "", "1,5", "0x10", "1 2"}) {
    state.take(told({{"x", text}}, kStampMs));
    EXPECT_EQ(state.sample().known, 6U) << text;
  }
  EXPECT_EQ(state.damaged(), 6U);
  EXPECT_EQ(state.trouble(), "data item x reads '1 2': must be a number from -1e+07 to 1e+07");
  state.take(told({{"tool", "2.5"}}, kStampMs));
  EXPECT_EQ(state.sample().tool, AxisSample::kUnknown);
  EXPECT_EQ(state.damaged(), 7U);
  // Names of tools and N words are none.
  state.take(told({{"tool", "T-drill"}, {"line", "N10"}}, kStampMs));
  EXPECT_EQ(state.sample().line, AxisSample::kUnknown);
  EXPECT_EQ(state.damaged(), 7U);
}

TEST(DeviceState, programs_and_spindles) {
  const auto program = [](const char* execution, const char* mode) {
    DeviceState state = state_of_xyz();
    state.take(told({{"exec", execution}, {"mode", mode}}, 0));
    return state.sample().program;
  };
  EXPECT_EQ(program("ACTIVE", "AUTOMATIC"), ProgramState::kRunning);
  EXPECT_EQ(program("INTERRUPTED", "AUTOMATIC"), ProgramState::kPaused);
  EXPECT_EQ(program("FEED_HOLD", "AUTOMATIC"), ProgramState::kPaused);
  EXPECT_EQ(program("READY", "AUTOMATIC"), ProgramState::kIdle);
  EXPECT_EQ(program("ACTIVE", "MANUAL_DATA_INPUT"), ProgramState::kIdle);
  EXPECT_EQ(program("UNAVAILABLE", "UNAVAILABLE"), ProgramState::kUnknown);
  DeviceState state = state_of_xyz();
  state.take(told({{"rpm", "500"}, {"dir", "COUNTER_CLOCKWISE"}, {"load", "35.5"}}, 0));
  EXPECT_EQ(state.sample().spindle_rpm, -500);
  EXPECT_EQ(state.sample().load, 35.5);
  state.take(told({{"dir", "CLOCKWISE"}}, kStampMs));
  EXPECT_EQ(state.sample().spindle_rpm, 500);
}

TEST(DeviceState, a_path_is_three_numbers) {
  ItemPlan plan;
  plan.path_position = TakenItem{"pp", 25.4, 0};
  DeviceState state(plan, LoadUnit::kPercentOfPower, 0);
  state.take(told({{"pp", "1 -2 0.5"}}, 0));
  EXPECT_EQ(state.missing(), "");
  EXPECT_EQ(state.sample().position[1], -50.8);
  state.take(told({{"pp", "1 2"}}, kStampMs));
  EXPECT_NE(state.missing(), "");
  EXPECT_EQ(state.damaged(), 1U);
}

/// What LinuxCNC's own agent says of a machine that is known (answers/README.md).
TEST(DeviceState, linuxcnc_current) {
  const std::string folder = KERF_MTCONNECT_ANSWERS;
  const auto probe_text = read_small_file(folder + "/linuxcnc_probe.xml", 1U << 20U);
  const auto text = read_small_file(folder + "/linuxcnc_current.xml", 1U << 20U);
  ASSERT_TRUE(probe_text && text);
  const auto probe = parse_probe(*probe_text);
  ASSERT_TRUE(probe);
  const auto plan = plan_items(probe->devices.at(0), {});
  const auto answer = parse_streams(*text, probe->devices.at(0));
  ASSERT_TRUE(plan && answer);
  EXPECT_EQ(answer->header.first, 1U);
  EXPECT_EQ(answer->header.next, 87U);
  EXPECT_EQ(answer->damaged, 0U);
  DeviceState state(*plan, LoadUnit::kPercentOfPower, 2 * kStampMs);
  state.take(answer->observations);
  const AxisSample sample = state.sample();
  EXPECT_EQ(sample.position[0], 0.913229);
  EXPECT_EQ(sample.position[1], 2.826459);
  EXPECT_EQ(sample.position[2], -0.913229);
  EXPECT_EQ(sample.known, 7U);
  EXPECT_EQ(sample.tool, 3);
  EXPECT_EQ(sample.line, 7);
  EXPECT_EQ(sample.tool_offset_z_mm, 50.8);
  EXPECT_EQ(sample.spindle_rpm, -1000);
  EXPECT_EQ(sample.program, ProgramState::kRunning);
  EXPECT_EQ(state.missing(), "");
}

TEST(StreamAnswer, in_the_order_of_their_numbers_and_of_one_machine) {
  DeviceModel device;
  device.name = "D";
  device.uuid = "u";
  const auto answer = parse_streams(
      "<MTConnectStreams><Header instanceId='5' creationTime='2026-01-01T00:00:00Z' "
      "firstSequence='1' nextSequence='10'/><Streams><DeviceStream uuid='v'><ComponentStream>"
      "<Samples><P dataItemId='x' sequence='9' timestamp='2026-01-01T00:00:00Z'>9</P></Samples>"
      "</ComponentStream></DeviceStream><DeviceStream uuid='u'><ComponentStream><Samples>"
      "<P dataItemId='x' sequence='4' timestamp='2026-01-01T00:00:01Z'>4</P>"
      "<P dataItemId='x' sequence='2' timestamp='2026-01-01T00:00:00Z'>2</P>"
      "<P dataItemId='x' sequence='x' timestamp='2026-01-01T00:00:00Z'>0</P>"
      "<P dataItemId='x' sequence='5' timestamp='never'>0</P></Samples><Condition>"
      "<Normal dataItemId='c' sequence='3' timestamp='2026-01-01T00:00:00Z'/></Condition>"
      "</ComponentStream></DeviceStream></Streams></MTConnectStreams>",
      device);
  ASSERT_TRUE(answer) << answer.error();
  ASSERT_EQ(answer->observations.size(), 2U);
  EXPECT_EQ(answer->observations[0].text, "2");
  EXPECT_EQ(answer->observations[1].text, "4");
  EXPECT_EQ(answer->count, 4U);
  EXPECT_EQ(answer->newest, 9U);
  EXPECT_EQ(answer->damaged, 2U);
  EXPECT_EQ(parse_streams("<MTConnectDevices/>", device).error(),
            "a document of MTConnectDevices, and MTConnectStreams is wanted");
}

}  // namespace
}  // namespace kerf
