#include "machine_io/can/can_signal.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "base/translate.h"

namespace kerf {
namespace {

struct NamedType {
  std::string_view name;
  CanTypeName type;
};

constexpr std::array kTypes{
    NamedType{"int8", {CanType::kSigned, 8}},      NamedType{"uint8", {CanType::kUnsigned, 8}},
    NamedType{"int16", {CanType::kSigned, 16}},    NamedType{"uint16", {CanType::kUnsigned, 16}},
    NamedType{"int32", {CanType::kSigned, 32}},    NamedType{"uint32", {CanType::kUnsigned, 32}},
    NamedType{"int64", {CanType::kSigned, 64}},    NamedType{"uint64", {CanType::kUnsigned, 64}},
    NamedType{"float32", {CanType::kFloat32, 32}}, NamedType{"float64", {CanType::kFloat64, 64}},
    NamedType{"int", {CanType::kSigned, 0}},       NamedType{"uint", {CanType::kUnsigned, 0}}};

constexpr double kLongestAge_ms = 3'600'000.0;

std::uint64_t low_bits(std::uint64_t value, int count) {
  return count >= 64 ? value : value & ((std::uint64_t{1} << count) - 1);
}

/// The bytes from the first on that a number needs: its last byte + 1.
int bytes_needed(const CanBits& bits) {
  if (bits.endian == CanEndian::kLittle) return (bits.start_bit + bits.length - 1) / 8 + 1;
  const int in_first_byte = bits.start_bit % 8 + 1;
  return bits.start_bit / 8 + 1 + (std::max(0, bits.length - in_first_byte) + 7) / 8;
}

double number_of(std::uint64_t raw, CanType type, int length) {
  switch (type) {
    case CanType::kUnsigned:
      return static_cast<double>(raw);
    case CanType::kSigned: {
      const int above = 64 - length;
      return static_cast<double>(static_cast<std::int64_t>(raw << above) >> above);
    }
    case CanType::kFloat32:
      return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
    case CanType::kFloat64:
      return std::bit_cast<double>(raw);
  }
  return 0.0;
}

void check_bits(const CanBits& bits, const std::string& key, std::vector<std::string>& faults) {
  if (bits.length < 1 || bits.length > 64) {
    faults.push_back(trf("{}.length: {} is not allowed; must be 1 to 64 bits", key, bits.length));
  } else if (bits.start_bit < 0 || bits.start_bit >= kMaxCanBytes * 8) {
    faults.push_back(trf("{}.start: bit {} is not allowed; must be 0 to {}", key, bits.start_bit,
                         kMaxCanBytes * 8 - 1));
  } else if (!can_bits_fit(bits, kMaxCanBytes)) {
    faults.push_back(
        trf("{}: {} bits from bit {} on end in byte {}; a frame has at most bytes 0 to {}", key,
            bits.length, bits.start_bit, bytes_needed(bits) - 1, kMaxCanBytes - 1));
  }
}

}  // namespace

bool can_bits_fit(const CanBits& bits, int length_bytes) {
  return bits.length >= 1 && bits.length <= 64 && bits.start_bit >= 0 &&
         bits.start_bit < kMaxCanBytes * 8 && bytes_needed(bits) <= length_bytes;
}

std::uint64_t read_can_bits(const CanFrame& frame, const CanBits& bits) {
  assert(can_bits_fit(bits, frame.length));
  std::uint64_t value = 0;
  int bit = bits.start_bit;
  int taken = 0;
  while (taken < bits.length) {
    const std::uint64_t byte = frame.data[static_cast<std::size_t>(bit / 8)];
    const int place = bit % 8;
    if (bits.endian == CanEndian::kLittle) {
      const int count = std::min(8 - place, bits.length - taken);
      value |= low_bits(byte >> place, count) << taken;
      bit += count;
      taken += count;
    } else {
      const int count = std::min(place + 1, bits.length - taken);
      value = value << count | low_bits(byte >> (place + 1 - count), count);
      bit = (bit / 8 + 1) * 8 + 7;
      taken += count;
    }
  }
  return value;
}

CanReading read_can_signal(const CanFrame& frame, const CanSignal& signal) {
  if (frame.id != signal.id || frame.extended != signal.extended || frame.error || frame.remote) {
    return {};
  }
  if (signal.mux) {
    if (!can_bits_fit(signal.mux->bits, frame.length)) return {CanFit::kTooShort, 0.0};
    if (read_can_bits(frame, signal.mux->bits) != signal.mux->value) return {};
  }
  if (!can_bits_fit(signal.bits, frame.length)) return {CanFit::kTooShort, 0.0};
  const double raw = number_of(read_can_bits(frame, signal.bits), signal.type, signal.bits.length);
  const double value = raw * signal.scale + signal.offset;
  if (!std::isfinite(value)) return {CanFit::kNotFinite, 0.0};
  return {CanFit::kValue, value};
}

std::optional<double> decode(const CanFrame& frame, const CanSignal& signal) {
  const CanReading reading = read_can_signal(frame, signal);
  if (reading.fit != CanFit::kValue) return std::nullopt;
  return reading.value;
}

std::optional<CanTypeName> can_type_named(std::string_view name) {
  for (const NamedType& known : kTypes) {
    if (known.name == name) return known.type;
  }
  return std::nullopt;
}

std::string can_id_text(std::uint32_t id, bool extended) {
  return extended ? fmt::format("0x{:08X} (extended)", id) : fmt::format("0x{:03X}", id);
}

std::vector<std::string> validate(const CanSignal& signal, const std::string& key) {
  std::vector<std::string> faults;
  if (signal.id > kMaxExtendedCanId) {
    faults.push_back(trf("{}.id: 0x{:X} is not allowed; must be 0 to 0x{:X}", key, signal.id,
                         signal.extended ? kMaxExtendedCanId : kMaxStandardCanId));
  } else if (!signal.extended && signal.id > kMaxStandardCanId) {
    faults.push_back(
        trf("{}.id: 0x{:X} is not allowed; must be 0 to 0x{:X}, or say that it is extended", key,
            signal.id, kMaxStandardCanId));
  }
  check_bits(signal.bits, key, faults);
  const int wanted = signal.type == CanType::kFloat32   ? 32
                     : signal.type == CanType::kFloat64 ? 64
                                                        : signal.bits.length;
  if (signal.bits.length != wanted) {
    faults.push_back(trf("{}.length: {} is not allowed; float{} has {} bits", key,
                         signal.bits.length, wanted, wanted));
  }
  if (signal.mux) {
    check_bits(signal.mux->bits, key + ".mux", faults);
    if (signal.mux->value != low_bits(signal.mux->value, std::max(1, signal.mux->bits.length))) {
      faults.push_back(trf("{}.mux.value: {} is not allowed; {} bits hold no such number", key,
                           signal.mux->value, signal.mux->bits.length));
    }
  }
  if (!std::isfinite(signal.scale) || signal.scale == 0.0) {
    faults.push_back(
        trf("{}.scale: {} is not allowed; must be a number other than 0", key, signal.scale));
  }
  if (!std::isfinite(signal.offset)) {
    faults.push_back(trf("{}.offset: {} is not allowed; must be a number", key, signal.offset));
  }
  if (signal.max_age_ms != 0.0 &&
      !(signal.max_age_ms >= 1.0 && signal.max_age_ms <= kLongestAge_ms)) {
    faults.push_back(
        trf("{}.max_age_ms: {} is not allowed; must be 1 to {:.0f}, or 0 for never too old", key,
            signal.max_age_ms, kLongestAge_ms));
  }
  return faults;
}

}  // namespace kerf
