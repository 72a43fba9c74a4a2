#include "machine_io/modbus/register_decoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace kerf {
namespace {

constexpr ModbusType kTypes[] = {ModbusType::kInt16,  ModbusType::kUint16,  ModbusType::kInt32,
                                 ModbusType::kUint32, ModbusType::kFloat32, ModbusType::kFloat64};

/// The order of bytes on the wire, most significant first = 'A', as the header's table has it.
std::string letters(WordOrder order, std::size_t words) {
  static const char* const kTable[4][3] = {{"AB", "ABCD", "ABCDEFGH"},
                                           {"AB", "CDAB", "GHEFCDAB"},
                                           {"BA", "BADC", "BADCFEHG"},
                                           {"BA", "DCBA", "HGFEDCBA"}};
  return kTable[static_cast<int>(order)][words == 1 ? 0 : words == 2 ? 1 : 2];
}

template <class T>
double reinterpret(const std::vector<std::uint8_t>& least_first) {
  T value{};
  std::memcpy(&value, least_first.data(), sizeof value);
  return static_cast<double>(value);
}

double oracle(ModbusType type, WordOrder order, const std::uint16_t* words) {
  const std::size_t count = word_count(type);
  const std::string where = letters(order, count);
  std::vector<std::uint8_t> least_first(2 * count);
  for (std::size_t i = 0; i < 2 * count; ++i) {
    const std::uint16_t word = words[i / 2];
    const auto byte = static_cast<std::uint8_t>(i % 2 == 0 ? word >> 8 : word & 0xff);
    least_first[2 * count - 1 - static_cast<std::size_t>(where[i] - 'A')] = byte;
  }
  switch (type) {
    case ModbusType::kInt16:
      return reinterpret<std::int16_t>(least_first);
    case ModbusType::kUint16:
      return reinterpret<std::uint16_t>(least_first);
    case ModbusType::kInt32:
      return reinterpret<std::int32_t>(least_first);
    case ModbusType::kUint32:
      return reinterpret<std::uint32_t>(least_first);
    case ModbusType::kFloat32:
      return reinterpret<float>(least_first);
    case ModbusType::kFloat64:
      break;
  }
  return reinterpret<double>(least_first);
}

TEST(RegisterDecoder, agrees_with_the_table_of_letters) {
  std::mt19937 random(7);
  for (int round = 0; round < 20000; ++round) {
    std::uint16_t words[4];
    for (auto& word : words) word = static_cast<std::uint16_t>(random());
    for (const ModbusType type : kTypes) {
      for (const WordOrder order : kWordOrders) {
        const double got = decode_registers(type, order, words);
        const double wanted = oracle(type, order, words);
        if (std::isnan(wanted)) {
          ASSERT_TRUE(std::isnan(got));
        } else {
          ASSERT_EQ(got, wanted) << name_of(type) << ' ' << name_of(order);
        }
      }
    }
  }
}

TEST(RegisterDecoder, known_words) {
  const std::uint16_t abcd[] = {0x42f6, 0xe979};
  const std::uint16_t cdab[] = {0xe979, 0x42f6};
  const std::uint16_t badc[] = {0xf642, 0x79e9};
  const std::uint16_t dcba[] = {0x79e9, 0xf642};
  const double value = 123.456F;
  EXPECT_EQ(decode_registers(ModbusType::kFloat32, WordOrder::kAbcd, abcd), value);
  EXPECT_EQ(decode_registers(ModbusType::kFloat32, WordOrder::kCdab, cdab), value);
  EXPECT_EQ(decode_registers(ModbusType::kFloat32, WordOrder::kBadc, badc), value);
  EXPECT_EQ(decode_registers(ModbusType::kFloat32, WordOrder::kDcba, dcba), value);
}

TEST(RegisterDecoder, encoding_is_undone_by_decoding) {
  const double values[] = {0,     1,      -1,    12345,        -12345,
                           32767, -32768, 65535, 2147483647.0, -2147483648.0};
  for (const ModbusType type : kTypes) {
    for (const WordOrder order : kWordOrders) {
      for (const double value : values) {
        std::uint16_t words[4] = {};
        encode_registers(type, order, value, words);
        const double back = decode_registers(type, order, words);
        std::uint16_t again[4] = {};
        encode_registers(type, order, back, again);
        EXPECT_TRUE(std::equal(words, words + 4, again));
        if (type == ModbusType::kFloat64) {
          EXPECT_EQ(back, value);
        }
      }
    }
  }
}

TEST(RegisterDecoder, integers_are_rounded_and_held_within_their_range) {
  const auto through = [](ModbusType type, double value) {
    std::uint16_t words[4] = {};
    encode_registers(type, WordOrder::kCdab, value, words);
    return decode_registers(type, WordOrder::kCdab, words);
  };
  EXPECT_EQ(through(ModbusType::kInt16, 2.6), 3);
  EXPECT_EQ(through(ModbusType::kInt16, -1e9), -32768);
  EXPECT_EQ(through(ModbusType::kUint16, -3), 0);
  EXPECT_EQ(through(ModbusType::kUint16, 1e9), 65535);
  EXPECT_EQ(through(ModbusType::kInt32, 1e19), 2147483647.0);
  EXPECT_EQ(through(ModbusType::kUint32, 1e19), 4294967295.0);
  EXPECT_EQ(through(ModbusType::kInt32, std::nan("")), 0);
}

}  // namespace
}  // namespace kerf
