// tests/machine_io/can/can_encode.h - numbers into CAN frames: the other direction. For tests
// alone; `kerf` never makes a frame.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "machine_io/can/can_signal.h"

namespace kerf {

/// Puts the lowest bits of `value` where `bits` says. They must fit 64 bytes. The frame's length
/// is left as it is.
inline void write_can_bits(CanFrame& frame, const CanBits& bits, std::uint64_t value) {
  int bit = bits.start_bit;
  for (int i = 0; i < bits.length; ++i) {
    const int from = bits.endian == CanEndian::kLittle ? i : bits.length - 1 - i;
    const auto mask = static_cast<std::uint8_t>(1U << (bit % 8));
    std::uint8_t& byte = frame.data[static_cast<std::size_t>(bit / 8)];
    byte = static_cast<std::uint8_t>((value >> from & 1U) != 0 ? byte | mask : byte & ~mask);
    if (bits.endian == CanEndian::kLittle) {
      ++bit;
    } else {
      bit = bit % 8 == 0 ? bit + 15 : bit - 1;
    }
  }
}

/// The least length that a frame can have and that holds the signal and its multiplexor: up to 8
/// bytes by ones, then 12, 16, 20, 24, 32, 48, 64 (CAN FD).
inline std::uint8_t can_length_for(const CanSignal& signal) {
  constexpr std::array<std::uint8_t, 16> kLengths{0, 1,  2,  3,  4,  5,  6,  7,
                                                  8, 12, 16, 20, 24, 32, 48, 64};
  for (const std::uint8_t length : kLengths) {
    if (can_bits_fit(signal.bits, length) &&
        (!signal.mux || can_bits_fit(signal.mux->bits, length))) {
      return length;
    }
  }
  return kMaxCanBytes;
}

/// Writes `value` into the frame, which gets the signal's id and at least its length; what else is
/// in it stays. False, and nothing written, if the type cannot hold value / scale.
inline bool encode_can_signal(double value, const CanSignal& signal, CanFrame& frame) {
  const double raw = (value - signal.offset) / signal.scale;
  if (!std::isfinite(raw)) return false;
  std::uint64_t bits = 0;
  if (signal.type == CanType::kFloat32) {
    bits = std::bit_cast<std::uint32_t>(static_cast<float>(raw));
  } else if (signal.type == CanType::kFloat64) {
    bits = std::bit_cast<std::uint64_t>(raw);
  } else {
    const bool is_signed = signal.type == CanType::kSigned;
    const double count = std::round(raw);
    const double end = std::ldexp(1.0, signal.bits.length - (is_signed ? 1 : 0));
    if (count >= end || count < (is_signed ? -end : 0.0)) return false;
    bits = is_signed ? static_cast<std::uint64_t>(static_cast<std::int64_t>(count))
                     : static_cast<std::uint64_t>(count);
  }
  frame.id = signal.id;
  frame.extended = signal.extended;
  frame.length = std::max(frame.length, can_length_for(signal));
  frame.fd = frame.fd || frame.length > 8;
  if (signal.mux) write_can_bits(frame, signal.mux->bits, signal.mux->value);
  write_can_bits(frame, signal.bits, bits);
  return true;
}

}  // namespace kerf
