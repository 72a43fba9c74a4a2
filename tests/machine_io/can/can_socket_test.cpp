// The live source on a real CAN interface, vcan0. `with-vcan` runs it where there is none.
#include <gtest/gtest.h>
#include <time.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>

#include "machine_io/can/can_socket_source.h"
#include "tests/base/temporary_folder.h"
#include "tests/machine_io/can/can_bus.h"
#include "tests/machine_io/can/can_encode.h"

namespace kerf {
namespace {

using std::chrono::milliseconds;
using Next = PositionSource::Next;

constexpr milliseconds kPatience{20};
constexpr milliseconds kLongPatience{20'000};
constexpr const char* kOwnBus = "kerfvcan1";  // to be taken down and away

#define NEEDS_PROGRAM(name, package) \
  if (!has_program(name))            \
  GTEST_SKIP() << name << " is missing: apt-get install --no-remove " package

class CanSocket : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_bus()) GTEST_SKIP() << "no interface " << kBusName << ": start this by with-vcan";
  }
};

CanSourceOptions cia402_options(std::size_t axes) {
  CanSourceOptions options;
  options.interface = kBusName;
  for (std::size_t i = 0; i < axes; ++i) {
    options.map.axes[i] = cia402_position(static_cast<std::uint8_t>(i + 1), 0.001);
  }
  options.retry_first_ms = 5;
  options.retry_longest_ms = 20;
  // On a busy computer the parts of a cycle may lie far apart.
  options.map.gather_ms = 10'000.0;
  // The same of what is sent faster than it can be read.
  options.receive_buffer_bytes = 64 * 1024 * 1024;
  return options;
}

CanFrame frame_of(const CanSignal& signal, double value) {
  CanFrame frame;
  EXPECT_TRUE(encode_can_signal(value, signal, frame));
  return frame;
}

CanFrame cia402_frame(std::uint8_t node, double position_mm) {
  return frame_of(cia402_position(node, 0.001), position_mm);
}

/// Asks once, which opens the socket: what is sent from now on is heard.
void open(CanSource& source) {
  AxisSample sample;
  EXPECT_EQ(source.next(sample, milliseconds(0)), Next::kNothing);
  EXPECT_EQ(source.status().trouble,
            std::string(kBusName) + ": no frame with a mapped id has come yet");
}

/// Asks until a sample comes or `done`; false if neither happens for long.
bool ask(
    CanSource& source, AxisSample& sample,
    const std::function<bool()>& done = [] { return false; }) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (std::chrono::steady_clock::now() < end) {
    const Next next = source.next(sample, kPatience);
    if (next == Next::kSample || done()) return true;
    if (next == Next::kEnd) return false;
  }
  return false;
}

bool ask_for_trouble(CanSource& source, const std::string& text) {
  AxisSample sample;
  const auto said = [&] { return source.status().trouble.find(text) != std::string::npos; };
  return said() || (ask(source, sample, said) && said());
}

std::int64_t thread_cpu_ns() {
  timespec used{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return std::int64_t{used.tv_sec} * 1'000'000'000 + used.tv_nsec;
}

/// Ticks are a millisecond apart. On a computer that is too busy for that, ticks are left out:
/// what was missed does not come as one burst.
void wait_for_tick(timespec& tick) {
  constexpr long kTick_ns = 1'000'000;
  constexpr long kSecond_ns = 1'000'000'000;
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const double behind_s = static_cast<double>(now.tv_sec - tick.tv_sec) +
                          static_cast<double>(now.tv_nsec - tick.tv_nsec) * 1e-9;
  if (behind_s > 0.05) tick = now;
  tick.tv_nsec += kTick_ns;
  if (tick.tv_nsec >= kSecond_ns) {
    tick.tv_nsec -= kSecond_ns;
    ++tick.tv_sec;
  }
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &tick, nullptr);
}

TEST_F(CanSocket, PositionsOfCia402Drives) {
  NEEDS_PROGRAM("cansend", "can-utils");
  CanSource source(cia402_options(3));
  EXPECT_EQ(source.describe(), "can vcan0");
  open(source);
  EXPECT_EQ(source.status().state, SourceState::kConnecting);
  // Statusword 0x0637; 1234.567, -0.001, 0 mm.
  ASSERT_TRUE(run_program({"cansend", kBusName, "381#370687D61200"}));
  ASSERT_TRUE(run_program({"cansend", kBusName, "382#3706FFFFFFFF"}));
  ASSERT_TRUE(run_program({"cansend", kBusName, "383#370600000000"}));
  AxisSample sample;
  ASSERT_TRUE(ask(source, sample));
  EXPECT_EQ(sample.fresh, 7);
  EXPECT_DOUBLE_EQ(sample.position[0], 1234.567);
  EXPECT_DOUBLE_EQ(sample.position[1], -0.001);
  EXPECT_DOUBLE_EQ(sample.position[2], 0.0);
  EXPECT_LE(sample.device_ns, sample.host_ns);
  EXPECT_GT(sample.device_ns, sample.host_ns - 10'000'000'000);
  EXPECT_EQ(source.status().state, SourceState::kReading);
  EXPECT_EQ(source.status().samples, 1U);
  EXPECT_EQ(source.status().errors, 0U);
  EXPECT_EQ(source.status().trouble, "");
}

TEST_F(CanSocket, PositionsOfOdriveAxes) {
  NEEDS_PROGRAM("cansend", "can-utils");
  CanSourceOptions options = cia402_options(0);
  options.map.axes[0] = odrive_position(0, 5.0);
  options.map.axes[1] = odrive_position(1, 5.0);
  CanSource source(options);
  open(source);
  ASSERT_TRUE(run_program({"cansend", kBusName, "009#0000C03F00000000"}));  // 1.5 turns
  ASSERT_TRUE(run_program({"cansend", kBusName, "029#000020C100000000"}));  // -10 turns
  AxisSample sample;
  ASSERT_TRUE(ask(source, sample));
  EXPECT_EQ(sample.position[0], 7.5);
  EXPECT_EQ(sample.position[1], -50.0);
}

TEST_F(CanSocket, FramesOfCanFdAndExtendedIds) {
  NEEDS_PROGRAM("cansend", "can-utils");
  CanSourceOptions options = cia402_options(1);
  options.map.axes[0]->bits.start_bit = 8 * 8;
  options.map.axes[1] = cia402_position(1, 0.001);
  options.map.axes[1]->extended = true;
  CanSource source(options);
  open(source);
  ASSERT_TRUE(run_program({"cansend", kBusName, "381##11122334455667788E8030000"}));
  ASSERT_TRUE(run_program({"cansend", kBusName, "00000381#3706D0070000"}));
  AxisSample sample;
  ASSERT_TRUE(ask(source, sample));
  EXPECT_EQ(sample.fresh, 3);
  EXPECT_EQ(sample.position[0], 1.0);
  EXPECT_EQ(sample.position[1], 2.0);
}

TEST_F(CanSocket, FramesThatDoNotFitAreCounted) {
  CanSource source(cia402_options(1));
  open(source);
  BusNode bus;
  CanFrame frame = cia402_frame(1, 1.0);
  frame.length = 2;
  ASSERT_TRUE(bus.send(frame));
  EXPECT_TRUE(ask_for_trouble(
      source, "vcan0: frame 0x381 has 2 bytes, too few for X: 32 bits from bit 16 on"));
  EXPECT_EQ(source.status().errors, 1U);
  frame = cia402_frame(1, 1.0);
  frame.remote = true;
  ASSERT_TRUE(bus.send(frame));
  ASSERT_TRUE(bus.send(cia402_frame(1, 2.0)));
  AxisSample sample;
  ASSERT_TRUE(ask(source, sample));
  EXPECT_EQ(sample.position[0], 2.0);
  EXPECT_EQ(source.status().errors, 1U);
}

TEST_F(CanSocket, BusOffAndWhatTheControllerReports) {
  NEEDS_PROGRAM("cansend", "can-utils");
  CanSource source(cia402_options(1));
  open(source);
  BusNode bus;
  ASSERT_TRUE(bus.send(cia402_frame(1, 1.0)));
  AxisSample sample;
  ASSERT_TRUE(ask(source, sample));
  ASSERT_EQ(source.status().state, SourceState::kReading);

  ASSERT_TRUE(run_program({"cansend", kBusName, "20000040#0000000000000000"}));
  EXPECT_TRUE(ask_for_trouble(source, "vcan0: bus-off: the controller has left the bus"));
  EXPECT_EQ(source.status().state, SourceState::kConnecting);
  EXPECT_EQ(source.status().errors, 1U);

  ASSERT_TRUE(run_program({"cansend", kBusName, "20000100#0000000000000000"}));
  EXPECT_TRUE(ask_for_trouble(source, "vcan0: the controller was restarted"));
  EXPECT_EQ(source.status().state, SourceState::kReading);
  EXPECT_EQ(source.status().reconnects, 1U);

  ASSERT_TRUE(run_program({"cansend", kBusName, "20000004#0001000000000000"}));
  EXPECT_TRUE(ask_for_trouble(source, "receive buffer overran"));
  EXPECT_EQ(source.status().lost, 1U);
  ASSERT_TRUE(run_program({"cansend", kBusName, "20000004#0010000000000000"}));
  EXPECT_TRUE(ask_for_trouble(source, "error passive"));
  EXPECT_EQ(source.status().state, SourceState::kReading);
  EXPECT_EQ(source.status().errors, 4U);
  ASSERT_TRUE(bus.send(cia402_frame(1, 2.0)));
  ASSERT_TRUE(ask(source, sample));
  EXPECT_EQ(sample.position[0], 2.0);
}

/// One of three drives falls silent: its last position is not taken for a new one, and no other
/// waits for it longer than the gather time.
TEST_F(CanSocket, AnAxisThatFallsSilentIsNoLongerKnown) {
  CanSourceOptions options = cia402_options(3);
  options.map.gather_ms = 200.0;
  options.map.axes[1]->max_age_ms = 50.0;
  CanSource source(options);
  open(source);
  BusNode bus;
  AxisSample sample;
  for (std::uint8_t node = 1; node <= 3; ++node) ASSERT_TRUE(bus.send(cia402_frame(node, 1.0)));
  ASSERT_TRUE(ask(source, sample));
  EXPECT_EQ(sample.fresh, 7);
  bool forgotten = false;
  for (int i = 0; i < 1000 && !forgotten; ++i) {
    ASSERT_TRUE(bus.send(cia402_frame(1, 2.0)));
    ASSERT_TRUE(bus.send(cia402_frame(3, 2.0)));
    ASSERT_TRUE(ask(source, sample));
    EXPECT_EQ(sample.fresh, 5);
    forgotten = sample.known == 5;
  }
  EXPECT_TRUE(forgotten);
}

/// In the middle of cycles of 10 ms, by the kernel's stamps.
TEST_F(CanSocket, OneLostFrameCostsOneCycle) {
  CanSource source(cia402_options(3));
  open(source);
  BusNode bus;
  int sent = 0;
  int taken = 0;
  int mixed = 0;
  const auto take = [&] {
    AxisSample sample;
    while (source.next(sample, milliseconds(0)) == Next::kSample) {
      ++taken;
      const auto& p = sample.position;
      if (sample.fresh != 7 || p[0] != p[1] || p[1] != p[2]) ++mixed;
    }
  };
  for (int i = 0; i < 60; ++i) {
    const bool is_lost = i == 30;
    for (std::uint8_t node = 1; node <= 3; ++node) {
      if (is_lost && node == 1) continue;
      ASSERT_TRUE(bus.send(cia402_frame(node, i)));
    }
    if (!is_lost) ++sent;
    std::this_thread::sleep_for(milliseconds(10));
    take();
  }
  EXPECT_EQ(taken, sent);
  EXPECT_EQ(mixed, 0);
  EXPECT_EQ(source.status().incomplete, 1U);
  EXPECT_EQ(source.status().trouble,
            "vcan0: a cycle of the bus came without X and was dropped (a frame was lost?)");
}

TEST_F(CanSocket, ABurstOfAHundredThousandFramesIsReadWithoutLoss) {
  constexpr int kFrames = 100'000;
  constexpr int kPerTick = 8;  // a millisecond: 8000 frames/s
  CanSource source(cia402_options(1));
  open(source);
  std::thread sender([&] {
    BusNode bus;
    timespec tick{};
    for (int i = 0; i < kFrames; ++i) {
      if (i % kPerTick == 0) wait_for_tick(tick);
      if (!bus.send(cia402_frame(1, i * 0.001))) break;
    }
  });
  const auto start = std::chrono::steady_clock::now();
  const std::int64_t cpu_start = thread_cpu_ns();
  AxisSample sample;
  int count = 0;
  int wrong = 0;
  std::int64_t last_ns = 0;
  std::int64_t longest_wait_ns = 0;
  while (count < kFrames && source.next(sample, kLongPatience) == Next::kSample) {
    if (std::lround(sample.position[0] * 1000.0) != count || sample.device_ns < last_ns) ++wrong;
    last_ns = sample.device_ns;
    longest_wait_ns = std::max(longest_wait_ns, sample.host_ns - sample.device_ns);
    ++count;
  }
  sender.join();
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_EQ(count, kFrames);
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(source.status().samples, static_cast<std::uint64_t>(kFrames));
  EXPECT_EQ(source.status().lost, 0U);
  EXPECT_EQ(source.status().errors, 0U);
  std::printf("%d frames in %.2f s: %.0f/s, reader %.1f %% of a core, longest wait %.2f ms\n",
              count, seconds, count / seconds,
              static_cast<double>(thread_cpu_ns() - cpu_start) / seconds * 1e-7,
              static_cast<double>(longest_wait_ns) * 1e-6);
}

/// Frames that others mean do not fill the queue; those that are mapped and not fetched do, and
/// then it is known how many were dropped.
TEST_F(CanSocket, DroppedFramesAreCounted) {
  constexpr std::uint64_t kFrames = 5000;
  CanSourceOptions options = cia402_options(1);
  options.receive_buffer_bytes = 4096;
  CanSource source(options);
  open(source);
  BusNode bus;
  CanFrame other = cia402_frame(2, 1.0);
  for (std::uint64_t i = 0; i < kFrames; ++i) ASSERT_TRUE(bus.send(other));
  ASSERT_TRUE(bus.send(cia402_frame(1, 1.0)));
  AxisSample sample;
  ASSERT_TRUE(ask(source, sample));
  EXPECT_EQ(source.status().lost, 0U);

  for (std::uint64_t i = 0; i < kFrames; ++i) ASSERT_TRUE(bus.send(cia402_frame(1, 2.0)));
  while (source.next(sample, milliseconds(0)) == Next::kSample) {
  }
  ASSERT_TRUE(bus.send(cia402_frame(1, 3.0)));
  ASSERT_TRUE(ask(source, sample));
  EXPECT_EQ(sample.position[0], 3.0);
  EXPECT_GT(source.status().lost, 0U);
  EXPECT_EQ(source.status().lost + source.status().samples, kFrames + 2);
  EXPECT_NE(source.status().trouble.find("frames were lost: the receive queue was full"),
            std::string::npos)
      << source.status().trouble;
}

TEST_F(CanSocket, GeneratedFramesAtFullSpeed) {
  NEEDS_PROGRAM("cangen", "can-utils");
  CanSourceOptions options = cia402_options(1);
  options.map.axes[0]->bits = {0, 64, CanEndian::kLittle};  // cangen counts in all 8 bytes
  options.map.axes[0]->scale = 1.0;
  CanSource source(options);
  open(source);
  Program cangen({"cangen", kBusName, "-g", "0", "-p", "100", "-I", "381", "-L", "8", "-D", "i",
                  "-n", "20000"});
  AxisSample sample;
  double last = 0.0;
  int gaps = 0;
  for (int i = 0; i < 20'000; ++i) {
    ASSERT_EQ(source.next(sample, kLongPatience), Next::kSample) << i;
    if (i > 0 && sample.position[0] != last + 1.0) ++gaps;
    last = sample.position[0];
  }
  EXPECT_EQ(gaps, 0);
  EXPECT_EQ(cangen.wait(), 0);
  EXPECT_EQ(source.status().lost, 0U);
}

TEST_F(CanSocket, TwoSourcesOnOneBus) {
  CanSourceOptions second_options = cia402_options(0);
  second_options.map.axes[1] = cia402_position(2, 0.001);
  CanSource first(cia402_options(1));
  CanSource second(second_options);
  CanSource twin(cia402_options(1));
  for (CanSource* source : {&first, &second, &twin}) open(*source);
  BusNode bus;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(bus.send(cia402_frame(1, i)));
    ASSERT_TRUE(bus.send(cia402_frame(2, -i)));
    AxisSample x;
    AxisSample y;
    AxisSample again;
    ASSERT_TRUE(ask(first, x) && ask(second, y) && ask(twin, again));
    EXPECT_EQ(x.known, 1);
    EXPECT_EQ(y.known, 2);
    EXPECT_EQ(x.position[0], i);
    EXPECT_EQ(y.position[1], -i);
    EXPECT_EQ(again.position[0], x.position[0]);
    EXPECT_EQ(again.device_ns, x.device_ns);
  }
}

TEST_F(CanSocket, WhatIsNoCanInterface) {
  CanSourceOptions options = cia402_options(1);
  options.interface = "kerfnone";
  CanSource absent(options);
  EXPECT_TRUE(ask_for_trouble(absent, "kerfnone: there is no such network interface (yet)"));
  EXPECT_EQ(absent.status().state, SourceState::kConnecting);
  options.interface = "lo";
  CanSource loopback(options);
  EXPECT_TRUE(ask_for_trouble(loopback, "lo: is no CAN interface"));
  EXPECT_EQ(loopback.status().state, SourceState::kConnecting);
}

/// An interface of its own, which can be taken down and away.
class CanLink : public CanSocket {
 protected:
  void SetUp() override {
    CanSocket::SetUp();
    if (IsSkipped()) return;
    if (!create()) GTEST_SKIP() << "interfaces can be created by root only";
  }
  void TearDown() override {
    if (std::filesystem::exists(std::string("/sys/class/net/") + kOwnBus)) remove();
  }
  static bool create() {
    return run_program({"ip", "link", "add", kOwnBus, "type", "vcan"}) && set("up");
  }
  static bool remove() { return run_program({"ip", "link", "delete", kOwnBus}); }
  static bool set(const char* state) { return run_program({"ip", "link", "set", kOwnBus, state}); }
  static CanSourceOptions options() {
    CanSourceOptions options = cia402_options(1);
    options.interface = kOwnBus;
    return options;
  }
  /// Sends the position until the source has it.
  static bool hears(CanSource& source, double position_mm) {
    AxisSample sample;
    for (int i = 0; i < 1000; ++i) {
      BusNode bus(kOwnBus);
      if (bus.is_open()) bus.send(cia402_frame(1, position_mm));
      if (source.next(sample, kPatience) == Next::kSample) {
        return sample.position[0] == position_mm;
      }
    }
    return false;
  }
};

TEST_F(CanLink, DownAndUpAgain) {
  CanSource source(options());
  ASSERT_TRUE(hears(source, 1.0));
  for (std::uint64_t round = 1; round <= 10; ++round) {
    ASSERT_TRUE(set("down"));
    AxisSample sample;
    ASSERT_TRUE(ask(source, sample,
                    [&source] { return source.status().state == SourceState::kConnecting; }));
    EXPECT_EQ(source.status().trouble,
              "kerfvcan1: the interface is down; 'ip link set kerfvcan1 up' brings it up");
    ASSERT_TRUE(set("up"));
    const double position_mm = static_cast<double>(round) + 1.0;
    ASSERT_TRUE(hears(source, position_mm));
    EXPECT_EQ(source.status().state, SourceState::kReading);
    EXPECT_EQ(source.status().reconnects, round);
    EXPECT_EQ(source.status().errors, round);
  }
}

TEST_F(CanLink, DeletedAndCreatedAgain) {
  CanSource source(options());
  ASSERT_TRUE(hears(source, 1.0));
  for (std::uint64_t round = 1; round <= 5; ++round) {
    ASSERT_TRUE(remove());
    EXPECT_TRUE(ask_for_trouble(source, "kerfvcan1: there is no such network interface (yet)"));
    EXPECT_EQ(source.status().state, SourceState::kConnecting);
    ASSERT_TRUE(create());
    const double position_mm = static_cast<double>(round) + 1.0;
    ASSERT_TRUE(hears(source, position_mm));
    EXPECT_EQ(source.status().reconnects, round);
  }
}

TEST_F(CanLink, DownOrAbsentAtTheStart) {
  ASSERT_TRUE(set("down"));
  CanSource source(options());
  EXPECT_TRUE(ask_for_trouble(source, "kerfvcan1: the interface is down"));
  ASSERT_TRUE(remove());
  CanSource other(options());
  EXPECT_TRUE(ask_for_trouble(other, "kerfvcan1: there is no such network interface (yet)"));
  ASSERT_TRUE(create());
  EXPECT_TRUE(hears(source, 2.0));
  EXPECT_TRUE(hears(other, 3.0));
  EXPECT_EQ(source.status().reconnects, 0U);
}

/// Pauses between tries grow up to the longest: an absent interface costs next to nothing.
TEST_F(CanSocket, AnAbsentInterfaceIsLookedForWithGrowingPauses) {
  CanSourceOptions options = cia402_options(1);
  options.interface = "kerfnone";
  options.retry_first_ms = 5;
  options.retry_longest_ms = 40;
  CanSource source(options);
  AxisSample sample;
  std::vector<double> pauses_ms;
  auto last = std::chrono::steady_clock::now();
  for (int i = 0; i < 6; ++i) {
    // Far more patience than a pause: it comes back when a try has failed.
    ASSERT_EQ(source.next(sample, std::chrono::seconds(20)), Next::kNothing);
    const auto now = std::chrono::steady_clock::now();
    pauses_ms.push_back(std::chrono::duration<double, std::milli>(now - last).count());
    last = now;
  }
  const std::vector<double> least{0.0, 5.0, 10.0, 20.0, 40.0, 40.0};
  for (std::size_t i = 0; i < least.size(); ++i) EXPECT_GE(pauses_ms[i], least[i]) << i;
}

TEST_F(CanLink, NothingIsEverTransmitted) {
  BusNode listener(kOwnBus);
  ASSERT_TRUE(listener.is_open());
  CanSource source(options());
  AxisSample sample;
  for (std::uint64_t round = 0; round < 5; ++round) {
    EXPECT_EQ(source.next(sample, kPatience), Next::kNothing);
    ASSERT_TRUE(set("down"));
    ASSERT_TRUE(ask(source, sample, [&] { return source.status().errors > round; }));
    ASSERT_TRUE(set("up"));
  }
  EXPECT_EQ(listener.heard(), 0);
  BusNode speaker(kOwnBus);
  ASSERT_TRUE(speaker.send(cia402_frame(1, 1.0)));
  ASSERT_TRUE(ask(source, sample));
  EXPECT_EQ(listener.heard(), 1);
}

/// The log of a real machine, played by canplayer: the samples are those that its lines say.
class CanRecording : public CanSocket {
 protected:
  using Rows = std::vector<std::array<double, 3>>;

  static std::string log_path(const std::string& name) {
    const char* folder = std::getenv("KERF_SHARED_DATA");
    if (folder == nullptr) return {};
    return std::string(folder) + "/live_logs/pocket_drill." + name + ".candump.log.xz";
  }

  /// Rows of the log's own numbers, read without any code that is under test: `number_of` gets the
  /// data's hex digits.
  static Rows rows_of(const std::string& path, const std::map<std::string, std::size_t>& axis_of_id,
                      const std::function<double(const std::string&)>& number_of) {
    Rows rows;
    std::ifstream in(path);
    std::array<double, 3> row{};
    unsigned have = 0;
    for (std::string line; std::getline(in, line);) {
      const std::size_t id = line.rfind(' ') + 1;
      const auto axis = axis_of_id.find(line.substr(id, 3));
      if (axis == axis_of_id.end()) continue;
      row[axis->second] = number_of(line.substr(id + 4));
      have |= 1U << axis->second;
      if (have != 7) continue;
      rows.push_back(row);
      have = 0;
    }
    return rows;
  }

  static std::uint32_t little_endian(const std::string& digits, std::size_t byte) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) {
      std::uint32_t part = 0;
      const char* const at = digits.data() + (byte + i) * 2;
      std::from_chars(at, at + 2, part, 16);
      value = value << 8U | part;
    }
    return value;
  }

  static void expect_rows(CanSource& source, const std::string& log, const Rows& rows) {
    ASSERT_GT(rows.size(), 5000U);
    open(source);
    Program player({"canplayer", "-t", "-g", "0", "-I", log, "vcan0=can0"});
    AxisSample sample;
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      ASSERT_TRUE(ask(source, sample))
          << "sample " << i << " of " << rows.size() << ", lost " << source.status().lost
          << ", incomplete " << source.status().incomplete << ", disordered "
          << source.status().disordered << ", " << source.status().trouble;
      if (sample.fresh != 7) ++wrong;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (std::abs(sample.position[axis] - rows[i][axis]) > 1e-9) ++wrong;
      }
    }
    EXPECT_EQ(wrong, 0U);
    EXPECT_EQ(player.wait(), 0);
    EXPECT_EQ(source.status().lost, 0U);
    EXPECT_EQ(source.status().errors, 0U);
    EXPECT_EQ(source.status().incomplete, 0U);
  }
};

#define NEEDS_RECORDING(path)                                                                  \
  if ((path).empty() || !std::filesystem::exists(path)) GTEST_SKIP() << "no KERF_SHARED_DATA"; \
  NEEDS_PROGRAM("canplayer", "can-utils");                                                     \
  NEEDS_PROGRAM("xz", "xz-utils")

TEST_F(CanRecording, OfCia402Drives) {
  const std::string packed = log_path("cia402");
  NEEDS_RECORDING(packed);
  const TemporaryFolder folder;
  const std::string log = folder / "log";
  ASSERT_EQ(Program({"xz", "-dc", packed}, log).wait(), 0);
  const Rows rows =
      rows_of(log, {{"381", 0}, {"382", 1}, {"383", 2}}, [](const std::string& digits) {
        return 0.001 * static_cast<std::int32_t>(little_endian(digits, 2));
      });
  CanSource source(cia402_options(3));
  expect_rows(source, log, rows);
}

TEST_F(CanRecording, OfOdriveAxes) {
  const std::string packed = log_path("odrive");
  NEEDS_RECORDING(packed);
  const TemporaryFolder folder;
  const std::string log = folder / "log";
  ASSERT_EQ(Program({"xz", "-dc", packed}, log).wait(), 0);
  const Rows rows =
      rows_of(log, {{"009", 0}, {"029", 1}, {"049", 2}}, [](const std::string& digits) {
        return 5.0 * static_cast<double>(std::bit_cast<float>(little_endian(digits, 0)));
      });
  CanSourceOptions options = cia402_options(0);
  for (std::uint8_t i = 0; i < 3; ++i) options.map.axes[i] = odrive_position(i, 5.0);
  CanSource source(options);
  expect_rows(source, log, rows);
}

}  // namespace
}  // namespace kerf
