// The source against an agent that knows the time: each sample tells how old it truly is.
#include "machine_io/mtconnect/mtconnect_source.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <optional>

#include "tests/machine_io/mtconnect/agent_process.h"

namespace kerf {
namespace {

using std::chrono::milliseconds;
using Next = PositionSource::Next;

/// On a busy computer, between an agent that has seen something and this test that has it.
constexpr double kBusy_s = 0.25;

class MtconnectSourceTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!agent_.is_there()) GTEST_SKIP() << "no /usr/bin/python3";
    settings_.url = agent_.url();
    settings_.interval_ms = 20;
    settings_.heartbeat_ms = 100;
  }

  static double now_s() {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch())
        .count();
  }

  /// The next sample within 20 s; it is of one time, of this machine, and host_ns is when it was
  /// so.
  std::optional<AxisSample> sample(double slack_s = kBusy_s) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    AxisSample out;
    while (std::chrono::steady_clock::now() < end) {
      const Next next = source_->next(out, milliseconds(20));
      if (next == Next::kEnd) return std::nullopt;
      if (next != Next::kSample) continue;
      EXPECT_NEAR(out.position[1], 2 * out.position[0] + 1, 2e-6);
      EXPECT_NEAR(out.position[2], -out.position[0], 2e-6);
      EXPECT_GE(out.host_ns, last_ns_);
      last_ns_ = out.host_ns;
      stamp_error_s_ = static_cast<double>(out.host_ns) * 1e-9 - agent_.begun_s() - out.position[0];
      const double age_s = now_s() - agent_.begun_s() - out.position[0];
      if (moves_) {
        EXPECT_LT(std::abs(stamp_error_s_), slack_s);
        EXPECT_NEAR(static_cast<double>(out.age_ns) * 1e-9, age_s, slack_s);
      }
      return out;
    }
    return std::nullopt;
  }
  void open() {
    source_.emplace(settings_);
    last_ns_ = 0;
  }
  /// Samples until one has `what`; false: none within 20 s.
  bool until(const std::function<bool()>& what) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    AxisSample out;
    while (std::chrono::steady_clock::now() < end) {
      source_->next(out, milliseconds(20));
      if (what()) return true;
    }
    return false;
  }
  const SourceStatus& status() const { return source_->status(); }

  AgentProcess agent_;
  MtconnectSettings settings_;
  std::optional<MtconnectSource> source_;
  std::int64_t last_ns_ = 0;
  double stamp_error_s_ = 0;
  bool moves_ = true;
};

TEST_F(MtconnectSourceTest, a_stream_tells_everything_once) {
  settings_.load = ChosenItem{"load", 1, 0};
  open();
  double before = -1;
  for (int i = 0; i < 60; ++i) {
    const auto one = sample();
    ASSERT_TRUE(one) << status().trouble;
    EXPECT_GE(one->position[0], before);
    // 50 a second, none left out.
    if (i > 1) {
      EXPECT_LT(one->position[0] - before, 0.02 + kBusy_s);
    }
    before = one->position[0];
    EXPECT_EQ(one->known, 7U);
    EXPECT_EQ(one->tool, 4);
    EXPECT_EQ(one->line, 12);
    EXPECT_EQ(one->spindle_rpm, 1000);
    EXPECT_EQ(one->load, 35.5);
    EXPECT_EQ(one->program, ProgramState::kRunning);
  }
  EXPECT_EQ(status().errors, 0U) << status().trouble;
  EXPECT_EQ(status().lost, 0U);
  EXPECT_EQ(status().reconnects, 0U);
  EXPECT_EQ(status().state, SourceState::kReading);
  EXPECT_EQ(source_->describe(), "mtconnect " + agent_.url());
}

TEST_F(MtconnectSourceTest, an_agent_that_does_not_stream_is_asked) {
  agent_.tell("stream no");
  open();
  double before = -1;
  int late = 0;
  for (int i = 0; i < 60; ++i) {
    const auto one = sample();
    ASSERT_TRUE(one) << status().trouble;
    EXPECT_GE(one->position[0], before);
    if (before >= 0 && one->position[0] - before > 0.025 + kBusy_s) ++late;
    before = one->position[0];
  }
  EXPECT_EQ(late, 0);
  EXPECT_EQ(status().errors, 0U) << status().trouble;
  EXPECT_EQ(status().lost, 0U);
}

/// LinuxCNC's agent says that the end of its buffer comes next, where it has told a part of it.
TEST_F(MtconnectSourceTest, an_answer_that_is_cut_off_is_gone_on_with) {
  settings_.interval_ms = 2500;
  settings_.heartbeat_ms = 5000;
  agent_.tell("stream no");
  agent_.tell("rate 170");
  open();
  ASSERT_TRUE(sample(10));
  double before = -1;
  // 510 observations a second; 1000 fit into an answer.
  for (int i = 0; i < 700; ++i) {
    const auto one = sample(10);
    ASSERT_TRUE(one) << status().trouble;
    if (before >= 0) {
      EXPECT_LT(one->position[0] - before, kBusy_s);
    }
    before = one->position[0];
  }
  EXPECT_EQ(status().lost, 0U);
  EXPECT_EQ(status().errors, 0U) << status().trouble;
}

TEST_F(MtconnectSourceTest, bytes_that_come_one_by_one) {
  agent_.tell("chop 7");
  agent_.tell("rate 10");
  open();
  for (int i = 0; i < 12; ++i) ASSERT_TRUE(sample(0.5)) << status().trouble;
  EXPECT_EQ(status().errors, 0U) << status().trouble;
}

TEST_F(MtconnectSourceTest, a_machine_that_stands_is_confirmed) {
  // It stands at the beginning of the second round, too, until the agent looks again.
  moves_ = false;
  for (const char* const streams : {"stream yes", "stream no"}) {
    agent_.tell("rate 50");
    agent_.tell(streams);
    open();
    ASSERT_TRUE(sample());
    agent_.tell("rate 0");
    for (int i = 0; i < 10; ++i) sample();
    const std::uint64_t samples = status().samples;
    const double begun_s = now_s();
    while (now_s() - begun_s < 1.5) {
      const auto one = sample();
      ASSERT_TRUE(one);
      // Of now, not of when it stopped; and not newer than the agent's answer.
      EXPECT_LT(static_cast<double>(one->age_ns) * 1e-9, 0.15 + kBusy_s);
      EXPECT_GE(one->age_ns, 0);
    }
    // About ten a second, and not one for each look.
    EXPECT_GE(status().samples - samples, 5U);
    EXPECT_LE(status().samples - samples, 20U);
    EXPECT_EQ(status().errors, 0U) << status().trouble;
  }
}

TEST_F(MtconnectSourceTest, clocks_of_agents_are_their_own) {
  agent_.tell("clock 7200 0");
  open();
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(sample());
  EXPECT_EQ(status().errors, 0U) << status().trouble;
  EXPECT_EQ(status().disordered, 0U);
}

TEST_F(MtconnectSourceTest, what_is_held_up_is_as_old_as_it_is) {
  agent_.tell("late 0.6");
  agent_.tell("rate 50");
  open();
  sample(2);
  ASSERT_TRUE(until([&] { return status().samples > 60; }));
  for (int i = 0; i < 20; ++i) {
    const auto one = sample();
    ASSERT_TRUE(one);
    EXPECT_GT(one->age_ns, 500'000'000);
  }
}

TEST_F(MtconnectSourceTest, stamps_of_a_third_clock_are_told) {
  agent_.tell("clock 0 -90");
  open();
  sample(100);
  ASSERT_TRUE(until([&] { return status().disordered > 0; }));
  EXPECT_NE(status().trouble.find("behind the agent's clock"), std::string::npos);
  EXPECT_NE(status().trouble.find("90."), std::string::npos) << status().trouble;
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(sample());
  EXPECT_EQ(status().disordered, 1U);
}

TEST_F(MtconnectSourceTest, unavailable_hands_out_nothing) {
  for (const char* const fault : {"fault unavailable", "fault down"}) {
    agent_.tell("fault none");
    open();
    ASSERT_TRUE(sample());
    agent_.tell(fault);
    ASSERT_TRUE(until([&] { return status().state == SourceState::kConnecting; }));
    EXPECT_NE(status().trouble.find("UNAVAILABLE"), std::string::npos);
    const std::uint64_t samples = status().samples;
    AxisSample none;
    for (int i = 0; i < 10; ++i) EXPECT_EQ(source_->next(none, milliseconds(20)), Next::kNothing);
    EXPECT_EQ(status().samples, samples);
    agent_.tell("fault none");
    ASSERT_TRUE(sample());
    EXPECT_EQ(status().state, SourceState::kReading);
    EXPECT_EQ(status().reconnects, 0U);
  }
}

TEST_F(MtconnectSourceTest, an_agent_that_begins_anew_is_asked_everything) {
  for (const char* const streams : {"stream yes", "stream no"}) {
    for (const char* const how : {"restart", "reset"}) {
      agent_.tell(streams);
      agent_.tell("rate 50");
      open();
      for (int i = 0; i < 10; ++i) ASSERT_TRUE(sample());
      agent_.tell(how);
      ASSERT_TRUE(until([&] { return status().lost > 0 || status().reconnects > 0; }))
          << streams << how << status().trouble;
      EXPECT_GT(status().errors, 0U);
      ASSERT_TRUE(sample()) << status().trouble;
      EXPECT_EQ(status().state, SourceState::kReading);
      EXPECT_GE(status().lost, 1U) << streams << how << status().trouble;
    }
  }
}

TEST_F(MtconnectSourceTest, what_was_overwritten_is_counted) {
  for (const char* const streams : {"stream yes", "stream no"}) {
    agent_.tell(streams);
    open();
    ASSERT_TRUE(sample());
    agent_.tell("overrun");
    ASSERT_TRUE(until([&] { return status().lost > 0; })) << streams << status().trouble;
    EXPECT_GE(status().lost, 500U) << streams;
    EXPECT_LT(status().lost, 700U) << streams;
    ASSERT_TRUE(sample());
  }
}

TEST_F(MtconnectSourceTest, faults_have_a_name_and_an_end) {
  settings_.heartbeat_ms = 50;
  struct Row {
    const char* fault;
    const char* trouble;
  };
  for (const char* const streams : {"stream yes", "stream no"}) {
    for (const Row& row : {Row{"hangup", ""}, Row{"garbage", "line "}, Row{"silent", ""},
                           Row{"notfound", "HTTP 404"}, Row{"doctype", "a document type is not"},
                           Row{"noclock", "creationTime is 'soon'"}, Row{"endless", "more than"}}) {
      SCOPED_TRACE(std::string(streams) + " " + row.fault);
      agent_.tell(streams);
      agent_.tell("fault none");
      open();
      ASSERT_TRUE(sample());
      agent_.tell(std::string("fault ") + row.fault);
      const bool is_asked = std::string(streams) == "stream no";
      // These are told of questions alone, and a stream goes on.
      const bool is_question = std::string(row.fault) == "notfound" ||
                               std::string(row.fault) == "doctype" ||
                               std::string(row.fault) == "endless";
      if (is_question && !is_asked) continue;
      ASSERT_TRUE(until([&] { return status().errors > 0; }));
      EXPECT_NE(status().trouble.find(row.trouble), std::string::npos) << status().trouble;
      EXPECT_EQ(status().state, SourceState::kConnecting);
      agent_.tell("fault none");
      ASSERT_TRUE(sample()) << status().trouble;
      EXPECT_EQ(status().reconnects, 1U);
    }
  }
}

TEST_F(MtconnectSourceTest, a_part_that_lies_about_its_length) {
  open();
  ASSERT_TRUE(sample());
  agent_.tell("fault lies");
  ASSERT_TRUE(until([&] { return status().errors > 0; }));
  EXPECT_NE(status().trouble.find("1000000000"), std::string::npos) << status().trouble;
  agent_.tell("fault none");
  ASSERT_TRUE(sample());
}

TEST_F(MtconnectSourceTest, nobody_there_is_tried_again) {
  open();
  ASSERT_TRUE(sample());
  agent_.kill();
  ASSERT_TRUE(until([&] { return status().errors > 2; }));
  EXPECT_NE(status().trouble, "");
  EXPECT_EQ(status().state, SourceState::kConnecting);
  AxisSample none;
  EXPECT_EQ(source_->next(none, milliseconds(1)), Next::kNothing);
}

TEST_F(MtconnectSourceTest, settings_that_do_not_fit_end_it) {
  settings_.device = "Lathe";
  open();
  EXPECT_FALSE(sample());
  EXPECT_EQ(status().state, SourceState::kFailed);
  EXPECT_EQ(status().trouble, "the agent has no device Lathe (source.device); it has Test");
  settings_.device = "Test";
  settings_.commanded = true;
  open();
  EXPECT_FALSE(sample());
  EXPECT_NE(status().trouble.find("source.position: actual"), std::string::npos)
      << status().trouble;
}

TEST_F(MtconnectSourceTest, the_machine_is_asked_once) {
  const auto machine = ask_machine(settings_);
  ASSERT_TRUE(machine) << machine.error();
  EXPECT_EQ(machine->device.name, "Test");
  EXPECT_EQ(machine->plan.letters(), "X Y Z");
  agent_.kill();
  EXPECT_FALSE(ask_machine(settings_));
}

TEST(MtconnectSettingsTest, faults) {
  MtconnectSettings good;
  good.url = "http://192.168.1.7:5000";
  EXPECT_TRUE(validate(good).empty());
  good.url = "https://cell/agents/4/";
  EXPECT_TRUE(validate(good).empty());
  for (const char* const url : {"", "192.168.1.7:5000", "file:///etc/passwd", "http://",
                                "http://:5000", "http://a b", "http://a/?x=1", "ftp://a"}) {
    MtconnectSettings bad;
    bad.url = url;
    EXPECT_EQ(validate(bad).size(), 1U) << url;
  }
  good.interval_ms = -1;
  good.heartbeat_ms = 5;
  good.gather_ms = std::nan("");
  good.load = ChosenItem{"", 0, INFINITY};
  EXPECT_EQ(validate(good).size(), 6U);
}

TEST(MtconnectSettingsTest, a_password_is_not_shown) {
  MtconnectSettings settings;
  settings.url = "http://me:secret@cell:5000/a@b/";
  EXPECT_EQ(MtconnectSource(settings).describe(), "mtconnect http://cell:5000/a@b");
}

}  // namespace
}  // namespace kerf
