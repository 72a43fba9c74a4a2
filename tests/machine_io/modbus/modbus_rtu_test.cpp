#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <ostream>
#include <string>

#include "machine_io/modbus/modbus_source.h"
#include "tests/base/temporary_folder.h"
#include "tests/machine_io/modbus/faulty_device.h"
#include "tests/machine_io/modbus/source_watch.h"

namespace kerf {
namespace {

using std::chrono::milliseconds;
using Next = PositionSource::Next;

struct Case {
  Fault fault;
  const char* name;
  const char* trouble;
};

void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

class RtuFault : public testing::TestWithParam<Case> {};

TEST_P(RtuFault, is_named_gives_no_sample_and_is_over_when_it_ends) {
  const auto device = FaultyDevice::rtu();
  const ModbusSettings settings = settings_for(*device, true);
  ASSERT_TRUE(validate(settings).empty());
  ModbusSource source(settings);
  EXPECT_EQ(source.describe(), fmt::format("modbus rtu {} 115200 8N1 unit 1", device->device()));
  SourceWatch watch(source);
  ASSERT_TRUE(watch.more_samples(5)) << source.status().trouble;
  device->set(GetParam().fault);
  EXPECT_TRUE(watch.trouble_with(GetParam().trouble)) << source.status().trouble;
  const SourceStatus before = source.status();
  for (int i = 0; i < 10; ++i) EXPECT_EQ(watch.step(), Next::kNothing);
  EXPECT_EQ(source.status().samples, before.samples);
  EXPECT_EQ(source.status().state, SourceState::kConnecting);
  device->set(Fault::kNone);
  EXPECT_TRUE(watch.more_samples(20)) << source.status().trouble;
  EXPECT_EQ(source.status().reconnects, 0u);
  EXPECT_EQ(device->functions(), 1u << 3);
}

INSTANTIATE_TEST_SUITE_P(
    All, RtuFault,
    testing::Values(
        Case{Fault::kException1, "exception_1", "answers with exception 1 (Illegal function)"},
        Case{Fault::kException2, "exception_2", "answers with exception 2 (Illegal data address)"},
        Case{Fault::kException3, "exception_3", "answers with exception 3 (Illegal data value)"},
        Case{Fault::kException4, "exception_4",
             "answers with exception 4 (Slave device or server failure)"},
        Case{Fault::kSilent, "silent", "holding 0..15: no answer within 100 ms"},
        Case{Fault::kGarbage, "garbage", "holding 0..15: "},
        Case{Fault::kHalfFrame, "half_frame", "holding 0..15: no answer within 100 ms"},
        Case{Fault::kWrongUnit, "wrong_unit", "holding 0..15: Response not from requested slave"},
        Case{Fault::kWrongFunction, "wrong_function", "holding 0..15: Invalid data"},
        Case{Fault::kWrongCount, "wrong_count", "holding 0..15: Invalid data"},
        Case{Fault::kNan, "nan", "Y reads nan, raw 7FF8 0000 0000 0000: not a position"},
        Case{Fault::kInfinite, "infinite", "Y reads -inf, raw FFF0 0000 0000 0000: not a position"},
        Case{Fault::kHuge, "huge", "Y reads 1e+30, raw 4629 3E59 39A0 8CEA: not a position"},
        Case{Fault::kWrongOrder, "wrong_word_order",
             "positions jump beyond machine limits; is word_order cdab? (X reads "}),
    [](const auto& instance) { return std::string(instance.param.name); });

class RtuLate : public testing::TestWithParam<int> {};

TEST_P(RtuLate, an_old_answer_never_passes_for_a_new_one) {
  const auto device = FaultyDevice::rtu();
  ModbusSource source(settings_for(*device, true));
  SourceWatch watch(source);
  ASSERT_TRUE(watch.more_samples(5)) << source.status().trouble;
  device->set_late(milliseconds(GetParam()));
  device->set(Fault::kLate);
  // SourceWatch judges the age of whatever is handed out in these questions.
  const int questions = device->questions();
  EXPECT_TRUE(
      watch.until([&] { return device->questions() >= questions + 5; }, std::chrono::seconds(60)));
  EXPECT_EQ(source.status().state, SourceState::kConnecting);
  EXPECT_TRUE(watch.trouble_with("bytes arrive after timeout_ms 100 has passed; is it too short?"))
      << source.status().trouble;
  device->set(Fault::kNone);
  EXPECT_TRUE(watch.more_samples(20)) << source.status().trouble;
}

INSTANTIATE_TEST_SUITE_P(Milliseconds, RtuLate, testing::Values(150, 260, 350, 777, 1500));

/// From the moment at which the device answers again, with any timeout: silence makes kerf ask less
/// often, but not for long.
TEST(ModbusRtu, is_in_step_again_within_a_second) {
  for (const int timeout_ms : {50, 200}) {
    const auto device = FaultyDevice::rtu();
    ModbusSettings settings = settings_for(*device, true);
    settings.timeout_ms = timeout_ms;
    ModbusSource source(settings);
    SourceWatch watch(source);
    ASSERT_TRUE(watch.more_samples(5)) << source.status().trouble;
    device->set(Fault::kSilent);
    const auto silent_since = std::chrono::steady_clock::now();
    const std::uint64_t errors = source.status().errors;
    const int questions = device->questions();
    watch.until(
        [&] { return std::chrono::steady_clock::now() - silent_since > std::chrono::seconds(6); });
    // Each question that was not answered is an error.
    EXPECT_GE(source.status().errors - errors + 1,
              static_cast<std::uint64_t>(device->questions() - questions));
    EXPECT_GT(device->questions() - questions, 5);
    device->set(Fault::kNone);
    const auto well_since = std::chrono::steady_clock::now();
    ASSERT_TRUE(watch.more_samples(1)) << source.status().trouble;
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - well_since;
    // Of it 0.5 s and a timeout until it is asked again. The rest is for a busy computer.
    EXPECT_LT(took.count(), 1.0) << timeout_ms;
  }
}

/// Old answers and new ones cannot be told apart by their length there.
TEST(ModbusRtu, without_parts_it_is_in_step_within_a_second_of_the_first_good_answer) {
  struct Kind {
    const char* name;
    int refused_below;
    bool by_exception;
    bool is_small;
  };
  const Kind kinds[] = {{"refuses", 16, true, false},
                        {"does not answer", 16, false, false},
                        {"has few registers", 0, false, true}};
  for (const Kind& kind : kinds) {
    for (const int timeout_ms : {50, 200}) {
      const auto device = FaultyDevice::rtu();
      device->refuse_below(kind.refused_below, kind.by_exception);
      ModbusSettings settings = settings_for(*device, true);
      settings.timeout_ms = timeout_ms;
      if (kind.is_small) {
        for (std::size_t i = 1; i < kMaxPositions; ++i) settings.axes[i].reset();
        settings.tool.reset();
        settings.line.reset();
      }
      ModbusSource source(settings);
      const auto more_samples = [&source](std::uint64_t count) {
        const std::uint64_t wanted = source.status().samples + count;
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        AxisSample sample;
        while (source.status().samples < wanted && std::chrono::steady_clock::now() < end) {
          const double begin_s = FaultyDevice::now_s();
          if (source.next(sample, milliseconds(20)) != Next::kSample) continue;
          EXPECT_GE(sample.position[0], begin_s) << "an old reading passes for a new one";
        }
        return source.status().samples >= wanted;
      };
      const auto wait_for = [&](const auto& done) {
        AxisSample sample;
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (!done() && std::chrono::steady_clock::now() < end) {
          source.next(sample, milliseconds(10));
        }
      };
      ASSERT_TRUE(more_samples(5)) << source.status().trouble;
      device->set(Fault::kSilent);
      const auto silent_since = std::chrono::steady_clock::now();
      wait_for([&] {
        return std::chrono::steady_clock::now() - silent_since > std::chrono::seconds(4);
      });
      const int good = device->good_answers();
      device->set(Fault::kNone);
      wait_for([&] { return device->good_answers() > good; });
      const auto well_since = std::chrono::steady_clock::now();
      ASSERT_TRUE(more_samples(1)) << source.status().trouble;
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - well_since;
      EXPECT_LT(took.count(), 1.0) << kind.name << ", timeout_ms " << timeout_ms;
    }
  }
}

/// What is late and cannot be told apart: none of it passes for new.
TEST(ModbusRtu, an_old_answer_never_passes_for_a_new_one_without_parts) {
  for (const int late_ms : {150, 350, 777, 1500}) {
    const auto device = FaultyDevice::rtu();
    device->refuse_below(16, true);
    ModbusSource source(settings_for(*device, true));
    SourceWatch watch(source);
    ASSERT_TRUE(watch.more_samples(5)) << source.status().trouble;
    device->set_late(milliseconds(late_ms));
    device->set(Fault::kLate);
    const int questions = device->questions();
    EXPECT_TRUE(watch.until([&] { return device->questions() >= questions + 5; },
                            std::chrono::seconds(60)));
    device->set(Fault::kNone);
    EXPECT_TRUE(watch.more_samples(20)) << source.status().trouble;
  }
}

TEST(ModbusRtu, a_late_answer_is_stamped_when_it_was_asked_for) {
  const auto device = FaultyDevice::rtu();
  ModbusSettings settings = settings_for(*device, true);
  settings.timeout_ms = 2000;
  ModbusSource source(settings);
  SourceWatch watch(source);
  ASSERT_TRUE(watch.more_samples(20)) << source.status().trouble;
  device->set_late(milliseconds(480));
  device->set(Fault::kLate);
  for (int i = 0; i < 3; ++i) {
    AxisSample sample;
    while (source.next(sample, milliseconds(50)) != Next::kSample) {
    }
    const auto real_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(
                             std::chrono::system_clock::now().time_since_epoch())
                             .count();
    const double stamped_before_s = static_cast<double>(real_ns - sample.host_ns) * 1e-9;
    const double read_before_s = FaultyDevice::now_s() - sample.position[0];
    EXPECT_GT(read_before_s, 0.4);
    EXPECT_NEAR(stamped_before_s, read_before_s, 0.1) << "the device reads when it is asked";
  }
}

TEST(ModbusRtu, waits_for_a_line_that_is_absent_at_the_start_and_survives_its_loss) {
  const TemporaryFolder folder;
  const std::string line = folder / "line";
  auto device = FaultyDevice::rtu();
  ModbusSettings settings = settings_for(*device, true);
  settings.device = line;
  ModbusSource source(settings);
  SourceWatch watch(source);
  EXPECT_TRUE(watch.trouble_with("line: No such file or directory")) << source.status().trouble;
  for (int i = 0; i < 10; ++i) {
    std::filesystem::create_symlink(device->device(), line);
    ASSERT_TRUE(watch.more_samples(3)) << source.status().trouble;
    // Pulling the adapter: the kernel takes the line from whoever has it open.
    std::filesystem::remove(line);
    device.reset();
    ASSERT_TRUE(watch.trouble_with("line: No such file or directory")) << source.status().trouble;
    device = FaultyDevice::rtu();
  }
  EXPECT_EQ(source.status().reconnects, 9u);
}

TEST(ModbusRtu, outlives_fifty_restarts_of_the_device) {
  const auto device = FaultyDevice::rtu();
  ModbusSettings settings = settings_for(*device, true);
  settings.timeout_ms = 20;
  ModbusSource source(settings);
  SourceWatch watch(source);
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(watch.more_samples(2)) << "restart " << i << ": " << source.status().trouble;
    device->kill();
    ASSERT_TRUE(watch.trouble_with("no answer within 20 ms")) << source.status().trouble;
    device->start();
  }
  ASSERT_TRUE(watch.more_samples(2)) << source.status().trouble;
  EXPECT_EQ(source.status().reconnects, 0u);
}

TEST(ModbusRtu, bytes_that_nobody_asked_for_put_the_line_out_of_trust) {
  const auto device = FaultyDevice::rtu();
  ModbusSource source(settings_for(*device, true));
  SourceWatch watch(source);
  ASSERT_TRUE(watch.more_samples(5));
  // Bytes that come within a question spoil its answer instead.
  bool told = false;
  for (int i = 0; i < 20 && !told; ++i) {
    ASSERT_TRUE(watch.more_samples(3)) << source.status().trouble;
    device->chatter();
    told = watch.until(
        [&] {
          return source.status().trouble.find("bytes arrived without being asked for") !=
                 std::string::npos;
        },
        std::chrono::seconds(1));
  }
  EXPECT_TRUE(told) << source.status().trouble;
  EXPECT_TRUE(watch.more_samples(5));
}

}  // namespace
}  // namespace kerf
