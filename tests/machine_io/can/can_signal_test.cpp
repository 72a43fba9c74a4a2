// Reading numbers from frames, against an oracle that walks single bits.
#include "machine_io/can/can_signal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/machine_io/can/can_encode.h"

namespace kerf {
namespace {

/// The places of a number's bits, most significant first, as the drawings of the DBC format have
/// them: -1 ends the list when it leaves the frame.
std::vector<int> places_of(const CanBits& bits, int length_bytes) {
  std::vector<int> places;
  int byte = bits.start_bit / 8;
  int bit = bits.start_bit % 8;
  for (int i = 0; i < bits.length; ++i) {
    if (byte >= length_bytes) return {};
    places.push_back(byte * 8 + bit);
    if (bits.endian == CanEndian::kLittle) {
      if (++bit == 8) bit = 0, ++byte;
    } else {
      if (--bit < 0) bit = 7, ++byte;
    }
  }
  if (bits.endian == CanEndian::kLittle) return {places.rbegin(), places.rend()};
  return places;
}

std::uint64_t oracle(const CanFrame& frame, const std::vector<int>& places) {
  std::uint64_t value = 0;
  for (const int place : places) {
    const unsigned byte = frame.data[static_cast<std::size_t>(place / 8)];
    value = value * 2 + (byte >> (place % 8) & 1U);
  }
  return value;
}

CanFrame random_frame(std::mt19937_64& random, std::uint8_t length) {
  CanFrame frame;
  frame.length = length;
  for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(random());
  return frame;
}

CanFrame frame_of(std::uint32_t id, std::initializer_list<int> bytes) {
  CanFrame frame;
  frame.id = id;
  for (const int byte : bytes) frame.data[frame.length++] = static_cast<std::uint8_t>(byte);
  return frame;
}

CanSignal signal_of(std::uint32_t id, CanBits bits, CanType type = CanType::kSigned) {
  CanSignal signal;
  signal.id = id;
  signal.bits = bits;
  signal.type = type;
  return signal;
}

TEST(CanSignal, EveryStartAndLengthReadsTheBitsOfTheOracle) {
  std::mt19937_64 random(2);
  int fitting = 0;
  for (const int bytes : {1, 3, 8, 12, 64}) {
    for (const CanEndian endian : {CanEndian::kLittle, CanEndian::kBig}) {
      for (int start = 0; start < bytes * 8; ++start) {
        for (int length = 1; length <= 64; ++length) {
          const CanBits bits{start, length, endian};
          const auto places = places_of(bits, bytes);
          ASSERT_EQ(can_bits_fit(bits, bytes), !places.empty())
              << "start " << start << " length " << length << " of " << bytes << " bytes";
          if (places.empty()) continue;
          ++fitting;
          CanFrame frame = random_frame(random, static_cast<std::uint8_t>(bytes));
          ASSERT_EQ(read_can_bits(frame, bits), oracle(frame, places))
              << "start " << start << " length " << length << " of " << bytes << " bytes";
          const std::uint64_t number =
              length == 64 ? random() : random() & ((std::uint64_t{1} << length) - 1);
          const CanFrame before = frame;
          write_can_bits(frame, bits, number);
          ASSERT_EQ(oracle(frame, places), number);
          write_can_bits(frame, bits, oracle(before, places));
          ASSERT_EQ(frame.data, before.data);
        }
      }
    }
  }
  EXPECT_GT(fitting, 50'000);
}

TEST(CanSignal, BitsOutsideOfEveryFrameDoNotFit) {
  EXPECT_FALSE(can_bits_fit({-1, 8, CanEndian::kLittle}, 8));
  EXPECT_FALSE(can_bits_fit({512, 1, CanEndian::kBig}, 64));
  EXPECT_FALSE(can_bits_fit({0, 0, CanEndian::kLittle}, 8));
  EXPECT_FALSE(can_bits_fit({0, 65, CanEndian::kLittle}, 64));
  EXPECT_FALSE(can_bits_fit({std::numeric_limits<int>::max(), 64, CanEndian::kLittle}, 64));
}

TEST(CanSignal, IntegersOfBothByteOrders) {
  const CanFrame frame = frame_of(0x381, {0x37, 0x06, 0xFE, 0xFF, 0xFF, 0xFF, 0x12, 0x34});
  EXPECT_EQ(decode(frame, signal_of(0x381, {16, 32, CanEndian::kLittle})), -2.0);
  EXPECT_EQ(decode(frame, signal_of(0x381, {16, 32, CanEndian::kLittle}, CanType::kUnsigned)),
            4294967294.0);
  const int byte6 = can_start_of_byte(6, CanEndian::kBig);
  EXPECT_EQ(byte6, 55);
  EXPECT_EQ(decode(frame, signal_of(0x381, {byte6, 16, CanEndian::kBig})), 0x1234);
  EXPECT_EQ(decode(frame, signal_of(0x381, {48, 16, CanEndian::kLittle})), 0x3412);
  EXPECT_EQ(decode(frame, signal_of(0x381, {20, 1, CanEndian::kLittle})), -1.0);
}

TEST(CanSignal, ScaleAndOffset) {
  CanSignal signal = signal_of(0x381, {0, 16, CanEndian::kLittle});
  signal.scale = 0.001;
  signal.offset = 5.0;
  EXPECT_EQ(decode(frame_of(0x381, {0xE8, 0x03}), signal), 6.0);
}

TEST(CanSignal, FloatsAndWhatIsNoNumber) {
  CanSignal signal = signal_of(9, {0, 32, CanEndian::kLittle}, CanType::kFloat32);
  signal.scale = 5.0;
  EXPECT_EQ(decode(frame_of(9, {0, 0, 0xC0, 0x3F}), signal), 7.5);
  EXPECT_EQ(read_can_signal(frame_of(9, {0, 0, 0xC0, 0x7F}), signal).fit, CanFit::kNotFinite);
  EXPECT_EQ(read_can_signal(frame_of(9, {0, 0, 0x80, 0xFF}), signal).fit, CanFit::kNotFinite);
  signal.bits = {7, 64, CanEndian::kBig};
  signal.type = CanType::kFloat64;
  signal.scale = 1.0;
  EXPECT_EQ(decode(frame_of(9, {0xBF, 0xF8, 0, 0, 0, 0, 0, 0}), signal), -1.5);
}

TEST(CanSignal, OtherFramesAreNotIt) {
  const CanSignal signal = signal_of(0x181, {0, 8, CanEndian::kLittle});
  CanFrame frame = frame_of(0x181, {1});
  EXPECT_EQ(decode(frame, signal), 1.0);
  frame.extended = true;
  EXPECT_EQ(read_can_signal(frame, signal).fit, CanFit::kOther);
  frame.extended = false;
  frame.remote = true;
  EXPECT_EQ(read_can_signal(frame, signal).fit, CanFit::kOther);
  frame.remote = false;
  frame.error = true;
  EXPECT_EQ(read_can_signal(frame, signal).fit, CanFit::kOther);
  frame.error = false;
  frame.length = 0;
  EXPECT_EQ(read_can_signal(frame, signal).fit, CanFit::kTooShort);
}

TEST(CanSignal, MultiplexedSignalsNeedTheirValue) {
  CanSignal signal = signal_of(0x200, {8, 16, CanEndian::kLittle});
  signal.mux = CanMux{{0, 8, CanEndian::kLittle}, 3};
  EXPECT_EQ(decode(frame_of(0x200, {3, 7, 0}), signal), 7.0);
  EXPECT_EQ(read_can_signal(frame_of(0x200, {2, 7, 0}), signal).fit, CanFit::kOther);
  EXPECT_EQ(read_can_signal(frame_of(0x200, {}), signal).fit, CanFit::kTooShort);
  EXPECT_EQ(read_can_signal(frame_of(0x200, {3, 7}), signal).fit, CanFit::kTooShort);
}

TEST(CanSignal, WhatIsEncodedIsDecoded) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> value_mm(-900.0, 900.0);
  for (int i = 0; i < 2000; ++i) {
    CanSignal signal = signal_of(0x123, {});
    signal.bits.endian = i % 2 == 0 ? CanEndian::kLittle : CanEndian::kBig;
    signal.bits.length = 21 + static_cast<int>(random() % 44);
    signal.bits.start_bit = static_cast<int>(random() % 440);
    signal.scale = 0.001;
    signal.offset = -2.5;
    const double value = value_mm(random);
    CanFrame frame = random_frame(random, 0);
    ASSERT_TRUE(encode_can_signal(value, signal, frame));
    const auto read = decode(frame, signal);
    ASSERT_TRUE(read.has_value());
    EXPECT_NEAR(*read, value, 0.00051);
  }
}

TEST(CanSignal, WhatTheTypeCannotHoldIsNotEncoded) {
  CanFrame frame;
  const CanSignal small = signal_of(1, {0, 8, CanEndian::kLittle});
  EXPECT_TRUE(encode_can_signal(-128.0, small, frame));
  EXPECT_FALSE(encode_can_signal(128.0, small, frame));
  EXPECT_FALSE(encode_can_signal(std::nan(""), small, frame));
  EXPECT_FALSE(
      encode_can_signal(-1.0, signal_of(1, {0, 8, CanEndian::kLittle}, CanType::kUnsigned), frame));
}

TEST(CanSignal, TypesByName) {
  const auto type = can_type_named("uint16");
  ASSERT_TRUE(type.has_value());
  EXPECT_EQ(type->type, CanType::kUnsigned);
  EXPECT_EQ(type->length, 16);
  EXPECT_EQ(can_type_named("int")->length, 0);
  EXPECT_FALSE(can_type_named("real").has_value());
}

TEST(CanSignal, EveryFaultOfASignalIsNamed) {
  CanSignal signal = signal_of(0x800, {16, 24, CanEndian::kLittle}, CanType::kFloat32);
  signal.scale = 0.0;
  signal.offset = std::nan("");
  signal.max_age_ms = -1.0;
  signal.mux = CanMux{{0, 2, CanEndian::kLittle}, 4};
  const std::vector<std::string> expected{
      "map.X.id: 0x800 is not allowed; must be 0 to 0x7FF, or say that it is extended",
      "map.X.length: 24 is not allowed; float32 has 32 bits",
      "map.X.mux.value: 4 is not allowed; 2 bits hold no such number",
      "map.X.scale: 0 is not allowed; must be a number other than 0",
      "map.X.offset: nan is not allowed; must be a number",
      "map.X.max_age_ms: -1 is not allowed; must be 1 to 3600000, or 0 for never too old"};
  EXPECT_EQ(validate(signal, "map.X"), expected);
  EXPECT_EQ(validate(signal_of(0x20000000, {500, 16, CanEndian::kLittle}), "a"),
            (std::vector<std::string>{
                "a.id: 0x20000000 is not allowed; must be 0 to 0x7FF",
                "a: 16 bits from bit 500 on end in byte 64; a frame has at most bytes 0 to 63"}));
  EXPECT_EQ(validate(signal_of(1, {512, 16, CanEndian::kLittle}), "a"),
            (std::vector<std::string>{"a.start: bit 512 is not allowed; must be 0 to 511"}));
  EXPECT_EQ(validate(signal_of(1, {0, 65, CanEndian::kLittle}), "a"),
            (std::vector<std::string>{"a.length: 65 is not allowed; must be 1 to 64 bits"}));
  EXPECT_TRUE(validate(signal_of(0x7FF, {0, 64, CanEndian::kLittle}), "a").empty());
}

}  // namespace
}  // namespace kerf
