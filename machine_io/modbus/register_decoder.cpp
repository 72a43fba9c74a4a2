#include "machine_io/modbus/register_decoder.h"

#include <bit>
#include <cmath>
#include <limits>

namespace kerf {
namespace {

std::uint16_t swapped(std::uint16_t word) {
  return static_cast<std::uint16_t>(word << 8 | word >> 8);
}

bool swaps_bytes(WordOrder order) { return order == WordOrder::kBadc || order == WordOrder::kDcba; }
bool low_word_first(WordOrder order) {
  return order == WordOrder::kCdab || order == WordOrder::kDcba;
}

/// The words as one number of 16 * count bits.
std::uint64_t gather(WordOrder order, const std::uint16_t* words, std::size_t count) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint16_t word = words[low_word_first(order) ? count - 1 - i : i];
    bits = bits << 16 | (swaps_bytes(order) ? swapped(word) : word);
  }
  return bits;
}

void scatter(WordOrder order, std::uint64_t bits, std::uint16_t* words, std::size_t count) {
  for (std::size_t i = count; i-- > 0; bits >>= 16) {
    const auto word = static_cast<std::uint16_t>(bits & 0xffffU);
    words[low_word_first(order) ? count - 1 - i : i] = swaps_bytes(order) ? swapped(word) : word;
  }
}

template <class Integer>
std::uint64_t integer_bits(double value) {
  using Limits = std::numeric_limits<Integer>;
  Integer held = 0;
  if (value >= static_cast<double>(Limits::max())) {
    held = Limits::max();
  } else if (value <= static_cast<double>(Limits::min())) {
    held = Limits::min();
  } else if (!std::isnan(value)) {
    held = static_cast<Integer>(std::llround(value));
  }
  return static_cast<std::uint64_t>(held);
}

}  // namespace

std::size_t word_count(ModbusType type) {
  switch (type) {
    case ModbusType::kInt16:
    case ModbusType::kUint16:
      return 1;
    case ModbusType::kInt32:
    case ModbusType::kUint32:
    case ModbusType::kFloat32:
      return 2;
    case ModbusType::kFloat64:
      break;
  }
  return 4;
}

std::string_view name_of(ModbusType type) {
  switch (type) {
    case ModbusType::kInt16:
      return "int16";
    case ModbusType::kUint16:
      return "uint16";
    case ModbusType::kInt32:
      return "int32";
    case ModbusType::kUint32:
      return "uint32";
    case ModbusType::kFloat32:
      return "float32";
    case ModbusType::kFloat64:
      break;
  }
  return "float64";
}

std::string_view name_of(WordOrder order) {
  switch (order) {
    case WordOrder::kAbcd:
      return "abcd";
    case WordOrder::kCdab:
      return "cdab";
    case WordOrder::kBadc:
      return "badc";
    case WordOrder::kDcba:
      break;
  }
  return "dcba";
}

double decode_registers(ModbusType type, WordOrder order, const std::uint16_t* words) {
  const std::uint64_t bits = gather(order, words, word_count(type));
  switch (type) {
    case ModbusType::kInt16:
      return static_cast<std::int16_t>(bits);
    case ModbusType::kUint16:
      return static_cast<std::uint16_t>(bits);
    case ModbusType::kInt32:
      return static_cast<std::int32_t>(bits);
    case ModbusType::kUint32:
      return static_cast<std::uint32_t>(bits);
    case ModbusType::kFloat32:
      return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    case ModbusType::kFloat64:
      break;
  }
  return std::bit_cast<double>(bits);
}

void encode_registers(ModbusType type, WordOrder order, double value, std::uint16_t* words) {
  std::uint64_t bits = 0;
  switch (type) {
    case ModbusType::kInt16:
      bits = integer_bits<std::int16_t>(value);
      break;
    case ModbusType::kUint16:
      bits = integer_bits<std::uint16_t>(value);
      break;
    case ModbusType::kInt32:
      bits = integer_bits<std::int32_t>(value);
      break;
    case ModbusType::kUint32:
      bits = integer_bits<std::uint32_t>(value);
      break;
    case ModbusType::kFloat32:
      bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
      break;
    case ModbusType::kFloat64:
      bits = std::bit_cast<std::uint64_t>(value);
      break;
  }
  scatter(order, bits, words, word_count(type));
}

}  // namespace kerf
