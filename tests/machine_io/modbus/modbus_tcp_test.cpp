#include <arpa/inet.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <modbus.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <ostream>
#include <string>
#include <thread>

#include "machine_io/modbus/modbus_source.h"
#include "tests/machine_io/modbus/faulty_device.h"
#include "tests/machine_io/modbus/source_watch.h"

namespace kerf {
namespace {

using std::chrono::milliseconds;
using Next = PositionSource::Next;

/// libmodbus' own server in a thread: X = 12.5 as float32 abcd at input register 100.
class LibmodbusServer {
 public:
  LibmodbusServer() : mapping_(modbus_mapping_new_start_address(0, 0, 0, 0, 0, 200, 0, 200)) {
    start();
  }
  ~LibmodbusServer() {
    stop();
    modbus_mapping_free(mapping_);
  }

  void start() {
    listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int on = 1;
    setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port_));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    ASSERT_EQ(bind(listener_, generic, size), 0);
    ASSERT_EQ(listen(listener_, 4), 0);
    ASSERT_EQ(getsockname(listener_, generic, &size), 0);
    port_ = ntohs(address.sin_port);
    ASSERT_EQ(pipe(stop_), 0);
    encode_registers(ModbusType::kFloat32, WordOrder::kAbcd, 12.5,
                     &mapping_->tab_input_registers[100]);
    thread_ = std::thread([this] { serve(); });
  }
  void stop() {
    close(stop_[1]);
    thread_.join();
    close(stop_[0]);
    close(listener_);
  }
  int port() const { return port_; }

 private:
  void serve() {
    modbus_t* context = modbus_new_tcp(nullptr, 0);
    int client = -1;
    for (;;) {
      pollfd watched[] = {{stop_[0], 0, 0}, {listener_, POLLIN, 0}, {client, POLLIN, 0}};
      if (poll(watched, 3, -1) < 0 || watched[0].revents != 0) break;
      if ((watched[1].revents & POLLIN) != 0) {
        if (client >= 0) close(client);
        client = accept(listener_, nullptr, nullptr);
        modbus_set_socket(context, client);
        continue;
      }
      std::uint8_t question[MODBUS_TCP_MAX_ADU_LENGTH];
      const int size = modbus_receive(context, question);
      if (size > 0) modbus_reply(context, question, size, mapping_);
      if (size < 0) {
        close(client);
        client = -1;
      }
    }
    if (client >= 0) close(client);
    modbus_free(context);
  }

  modbus_mapping_t* mapping_;
  int port_ = 0;
  int listener_ = -1;
  int stop_[2] = {-1, -1};
  std::thread thread_;
};

ModbusSettings settings_for(const LibmodbusServer& server) {
  ModbusSettings settings;
  settings.host = "localhost";
  settings.port = server.port();
  settings.axes[0] =
      ModbusRegister{100, ModbusTable::kInput, ModbusType::kFloat32, WordOrder::kAbcd, 2, 0.5};
  return settings;
}

TEST(ModbusTcp, reads_the_server_of_libmodbus) {
  LibmodbusServer server;
  const ModbusSettings settings = settings_for(server);
  ASSERT_TRUE(validate(settings).empty());
  ModbusSource source(settings);
  EXPECT_EQ(source.describe(), fmt::format("modbus tcp localhost:{} unit 1", server.port()));
  EXPECT_EQ(source.status().state, SourceState::kConnecting);
  for (int i = 0; i < 5; ++i) {
    AxisSample sample;
    ASSERT_EQ(source.next(sample, milliseconds(2000)), Next::kSample) << source.status().trouble;
    EXPECT_EQ(sample.position[0], 25.5);
    EXPECT_EQ(sample.known, 1);
  }
  EXPECT_EQ(source.status().samples, 5u);
  EXPECT_EQ(source.status().errors, 0u);
  EXPECT_EQ(source.status().state, SourceState::kReading);
  EXPECT_EQ(source.status().trouble, "");
}

TEST(ModbusTcp, comes_back_to_a_restarted_libmodbus_server) {
  LibmodbusServer server;
  ModbusSource source(settings_for(server));
  AxisSample sample;
  ASSERT_EQ(source.next(sample, milliseconds(2000)), Next::kSample);
  server.stop();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(source.next(sample, milliseconds(200)), Next::kNothing);
  EXPECT_EQ(source.status().state, SourceState::kConnecting);
  EXPECT_EQ(source.status().trouble,
            fmt::format("localhost:{}: Connection refused", server.port()));
  server.start();
  Next next = Next::kNothing;
  for (int i = 0; i < 200 && next == Next::kNothing; ++i)
    next = source.next(sample, milliseconds(50));
  ASSERT_EQ(next, Next::kSample);
  EXPECT_EQ(sample.position[0], 25.5);
  EXPECT_EQ(source.status().reconnects, 1u);
}

TEST(ModbusTcp, gaps_that_the_device_refuses_are_left_out_from_then_on) {
  const auto device = FaultyDevice::tcp();
  ModbusSettings settings = settings_for(*device, false);
  settings.spindle = ModbusRegister{44, ModbusTable::kHolding, ModbusType::kUint16};
  settings.max_gap = 40;  // over the hole
  ModbusSource source(settings);
  AxisSample sample;
  EXPECT_EQ(source.next(sample, milliseconds(2000)), Next::kNothing);
  EXPECT_EQ(
      source.status().trouble,
      "holding 0..44: the device answers with exception 2 (Illegal data address); from now on "
      "without the registers between");
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(source.next(sample, milliseconds(2000)), Next::kSample) << source.status().trouble;
    EXPECT_EQ(sample.spindle_rpm, 0);
    EXPECT_EQ(sample.position[1], 2 * sample.position[0] + 1);
  }
  EXPECT_EQ(source.status().errors, 1u);
  EXPECT_EQ(device->questions(), 7);  // two reads a poll instead of one
}

struct Case {
  Fault fault;
  const char* name;
  const char* trouble;
  bool closes;
};

void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

class TcpFault : public testing::TestWithParam<Case> {};

TEST_P(TcpFault, is_named_gives_no_sample_and_is_over_when_it_ends) {
  const auto device = FaultyDevice::tcp();
  ModbusSource source(settings_for(*device, false));
  SourceWatch watch(source);
  ASSERT_TRUE(watch.more_samples(5)) << source.status().trouble;
  device->set_late(milliseconds(350));
  device->set(GetParam().fault);
  EXPECT_TRUE(watch.trouble_with(GetParam().trouble)) << source.status().trouble;
  // A poll that was under way when the fault began may still have been right; none after it is.
  const SourceStatus before = source.status();
  for (int i = 0; i < 10; ++i) EXPECT_EQ(watch.step(), Next::kNothing);
  EXPECT_EQ(source.status().samples, before.samples);
  EXPECT_GT(source.status().errors, 0u);
  EXPECT_EQ(source.status().state, SourceState::kConnecting);
  device->set(Fault::kNone);
  EXPECT_TRUE(watch.more_samples(20)) << source.status().trouble;
  EXPECT_EQ(source.status().reconnects > 0, GetParam().closes);
  EXPECT_EQ(device->functions(), 1u << 3);
}

INSTANTIATE_TEST_SUITE_P(
    All, TcpFault,
    testing::Values(
        Case{Fault::kException1, "exception_1", "answers with exception 1 (Illegal function)",
             false},
        Case{Fault::kException2, "exception_2", "answers with exception 2 (Illegal data address)",
             false},
        Case{Fault::kException3, "exception_3", "answers with exception 3 (Illegal data value)",
             false},
        Case{Fault::kException4, "exception_4",
             "answers with exception 4 (Slave device or server failure)", false},
        Case{Fault::kSilent, "silent", "holding 0..15: no answer within 100 ms", true},
        Case{Fault::kLate, "late", "holding 0..15: no answer within 100 ms", true},
        Case{Fault::kGarbage, "garbage", "answer to question 42405 instead of ", true},
        Case{Fault::kHalfFrame, "half_frame", "holding 0..15: no answer within 100 ms", true},
        Case{Fault::kClose, "closes", "holding 0..15: Connection reset by peer", true},
        Case{Fault::kWrongTransaction, "wrong_transaction", "answer to question 2 instead of 1",
             true},
        Case{Fault::kWrongProtocol, "wrong_protocol", "not Modbus: protocol 1 instead of 0", true},
        Case{Fault::kWrongUnit, "wrong_unit",
             "unit 9 answers instead of unit 1; is unit 9 right, or 255", true},
        Case{Fault::kWrongLength, "wrong_length",
             "the answer's length 36 does not fit its 35 bytes", true},
        Case{Fault::kWrongFunction, "wrong_function", "answer with function 4 instead of 3", true},
        Case{Fault::kWrongCount, "wrong_count", "answer of 28 bytes instead of 32", true},
        Case{Fault::kNan, "nan", "Y reads nan, raw 7FF8 0000 0000 0000: not a position", false},
        Case{Fault::kInfinite, "infinite", "Y reads -inf, raw FFF0 0000 0000 0000: not a position",
             false},
        Case{Fault::kHuge, "huge", "Y reads 1e+30, raw 4629 3E59 39A0 8CEA: not a position", false},
        Case{Fault::kWrongOrder, "wrong_word_order",
             "positions jump beyond machine limits; is word_order cdab? (X reads ", false}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(ModbusTcp, waits_for_a_server_that_is_absent_at_the_start) {
  const auto device = FaultyDevice::tcp();
  const ModbusSettings settings = settings_for(*device, false);
  device->kill();
  ModbusSource source(settings);
  SourceWatch watch(source);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(watch.step(milliseconds(150)), Next::kNothing);
  EXPECT_EQ(source.status().state, SourceState::kConnecting);
  EXPECT_EQ(source.status().trouble,
            fmt::format("127.0.0.1:{}: Connection refused", settings.port));
  device->start();
  EXPECT_TRUE(watch.more_samples(5));
  EXPECT_EQ(source.status().reconnects, 0u);
}

TEST(ModbusTcp, outlives_fifty_restarts_of_the_server) {
  const auto device = FaultyDevice::tcp();
  ModbusSource source(settings_for(*device, false));
  SourceWatch watch(source);
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(watch.more_samples(2)) << "restart " << i << ": " << source.status().trouble;
    device->kill();
    ASSERT_TRUE(watch.trouble_with("onnection")) << source.status().trouble;
    device->start();
  }
  ASSERT_TRUE(watch.more_samples(2)) << source.status().trouble;
  EXPECT_EQ(source.status().reconnects, 50u);
}

TEST(ModbusTcp, patience_cuts_the_wait_for_the_next_attempt_short) {
  const auto device = FaultyDevice::tcp();
  const ModbusSettings settings = settings_for(*device, false);
  device->kill();
  ModbusSource source(settings);
  AxisSample sample;
  while (source.status().errors < 4) source.next(sample, milliseconds(1000));
  // The next attempt is 800 ms away.
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(source.next(sample, milliseconds(20)), Next::kNothing);
  const auto waited = std::chrono::steady_clock::now() - begin;
  EXPECT_GE(waited, milliseconds(20));
  EXPECT_LT(waited, milliseconds(400));
  EXPECT_EQ(source.status().errors, 4u);
}

TEST(ModbusTcp, a_counter_that_stands_still_tells_a_dead_program) {
  const auto device = FaultyDevice::tcp();
  ModbusSettings settings = settings_for(*device, false);
  settings.counter = ModbusRegister{16, ModbusTable::kHolding, ModbusType::kUint16};
  ModbusSource source(settings);
  SourceWatch watch(source);
  ASSERT_TRUE(watch.more_samples(5));
  EXPECT_EQ(source.status().duplicates, 0u);
  device->set(Fault::kStuck);
  EXPECT_TRUE(watch.trouble_with("the device answers but its program does not run"));
  const std::uint64_t samples = source.status().samples;
  EXPECT_EQ(watch.step(), Next::kNothing);
  EXPECT_EQ(source.status().samples, samples);
  EXPECT_GT(source.status().duplicates, 5u);
  EXPECT_EQ(source.status().errors, 0u);
  device->set(Fault::kNone);
  EXPECT_TRUE(watch.more_samples(5));
}

TEST(ModbusTcp, answers_of_two_cycles_are_asked_for_again) {
  const auto device = FaultyDevice::tcp();
  ModbusSettings settings = settings_for(*device, false);
  settings.counter = ModbusRegister{16, ModbusTable::kHolding, ModbusType::kUint16};
  settings.counter_begun = ModbusRegister{17, ModbusTable::kHolding, ModbusType::kUint16};
  ModbusSource source(settings);
  SourceWatch watch(source);
  ASSERT_TRUE(watch.more_samples(5));
  device->set(Fault::kTorn);
  const int questions = device->questions();
  ASSERT_TRUE(watch.more_samples(20));  // the watch judges each
  EXPECT_GE(device->questions() - questions, 55);
  EXPECT_EQ(source.status().errors, 0u);
  device->set(Fault::kTornAlways);
  EXPECT_TRUE(watch.trouble_with("10 answers in a row are of two cycles: counter_begun reads"));
  device->set(Fault::kNone);
  EXPECT_TRUE(watch.more_samples(5));
}

TEST(ModbusTcp, a_hang_is_not_followed_by_a_burst_of_polls) {
  const auto device = FaultyDevice::tcp();
  ModbusSettings settings = settings_for(*device, false);
  settings.poll_hz = 20;
  settings.timeout_ms = 2000;
  ModbusSource source(settings);
  SourceWatch watch(source);
  ASSERT_TRUE(watch.more_samples(3));
  // Whoever asks comes back after ten periods.
  std::this_thread::sleep_for(milliseconds(500));
  const int before = device->questions();
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(watch.more_samples(4));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  // One late, then one for each period: four take three periods less what was left of the first.
  EXPECT_GT(took.count(), 0.1);
  EXPECT_EQ(device->questions() - before, 4);
}

TEST(ModbusTcp, unit_255_takes_answers_of_any_unit) {
  const auto device = FaultyDevice::tcp();
  ModbusSettings settings = settings_for(*device, false);
  settings.unit = 255;
  settings.ranges = {};
  device->set(Fault::kWrongUnit);
  ModbusSource source(settings);
  AxisSample sample;
  ASSERT_EQ(source.next(sample, milliseconds(2000)), Next::kSample) << source.status().trouble;
  EXPECT_EQ(sample.position[0], FaultyDevice::kElsewhere);
}

TEST(ModbusTcp, a_fractional_tool_number_is_no_tool) {
  const auto device = FaultyDevice::tcp();
  ModbusSettings settings = settings_for(*device, false);
  settings.tool->scale = 0.5;
  ModbusSource source(settings);
  SourceWatch watch(source);
  EXPECT_TRUE(
      watch.trouble_with("tool reads 3.5, raw 0007 ...: must be a whole number, 0 or more"));
  EXPECT_EQ(source.status().samples, 0u);
}

}  // namespace
}  // namespace kerf
