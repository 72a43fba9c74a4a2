// machine_io/can/can_signal.h - where a number lies in a CAN frame, and reading it. No sockets.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

inline constexpr std::uint32_t kMaxStandardCanId = 0x7FF;       // 11 bits
inline constexpr std::uint32_t kMaxExtendedCanId = 0x1FFFFFFF;  // 29 bits
inline constexpr int kMaxCanBytes = 64;                         // CAN FD; classic CAN has 8

/// One frame, as a socket or a log gives it.
struct CanFrame {
  std::uint32_t id = 0;     ///< without flags; of an error frame: its classes, CAN_ERR_* of Linux
  bool extended = false;    ///< 29-bit id. 0x123 standard and 0x123 extended are two messages
  bool fd = false;          ///< CAN FD: up to 64 bytes
  bool error = false;       ///< no data of any node: the controller reports
  bool remote = false;      ///< asks for data, holds none
  std::uint8_t length = 0;  ///< bytes in use of `data`
  std::array<std::uint8_t, kMaxCanBytes> data{};
};

enum class CanType : std::uint8_t {
  kUnsigned,
  kSigned,  ///< two's complement
  kFloat32,
  kFloat64,
};

enum class CanEndian : std::uint8_t { kLittle, kBig };

/// Bits of a frame's data. Bit b is bit b % 8 (0 = least) of byte b / 8. As DBC files have it,
/// `start_bit` is the least bit of a little-endian number and the *most* significant bit of a
/// big-endian one, which goes on with the bits below in its byte and then with bit 7 of the next:
///
///     byte           0                       1
///     bit    7 6 5 4 3 2 1 0        15 14 13 12 11 10 9 8
///     little, start 4, length 8: bits 4..7 are its low half, 8..11 its high half
///     big,    start 3, length 8: bits 3..0 are its high half, 15..12 its low half
struct CanBits {
  int start_bit = 0;  ///< 0..511
  int length = 8;     ///< 1..64
  CanEndian endian = CanEndian::kLittle;
};

/// The start bit of a number that begins with the whole byte `byte`.
constexpr int can_start_of_byte(int byte, CanEndian endian) {
  return byte * 8 + (endian == CanEndian::kBig ? 7 : 0);
}

/// True if every bit lies in `length_bytes` bytes and start and length are in their ranges.
bool can_bits_fit(const CanBits& bits, int length_bytes);

/// The bits as an unsigned number. They must fit the frame's length.
std::uint64_t read_can_bits(const CanFrame& frame, const CanBits& bits);

/// A message that means different things at different times says which by a number in it.
struct CanMux {
  CanBits bits;
  std::uint64_t value = 0;  ///< the signal is there when the bits hold this
};

/// One number that frames of one id carry: value = raw * scale + offset.
struct CanSignal {
  std::uint32_t id = 0;
  bool extended = false;
  std::optional<CanMux> mux;
  CanBits bits;
  CanType type = CanType::kSigned;
  double scale = 1.0;   ///< mm or degrees per count or turn; rpm per count. Not 0
  double offset = 0.0;  ///< added after scaling, mm or degrees: where the drive's zero lies
  /// A value older than this is no longer known; ms, 1 to 3 600 000. 0: never too old, for what is
  /// sent only when it changes.
  double max_age_ms = 1000.0;
};

enum class CanFit : std::uint8_t {
  kOther,      ///< another id, another mux value, an error frame, a remote frame
  kTooShort,   ///< the right frame, but it ends before the signal does
  kNotFinite,  ///< the signal holds NaN or infinity, or becomes so by its scale
  kValue,
};

struct CanReading {
  CanFit fit = CanFit::kOther;
  double value = 0.0;  ///< for kValue alone
};

/// Whole numbers beyond 2^53 are rounded to a double's 53 bits.
CanReading read_can_signal(const CanFrame& frame, const CanSignal& signal);

/// The value, if the frame has it.
std::optional<double> decode(const CanFrame& frame, const CanSignal& signal);

/// What a type's name stands for.
struct CanTypeName {
  CanType type;
  int length;  ///< bits; 0: "int" and "uint", whose length is given beside them
};

/// int8 uint8 int16 uint16 int32 uint32 int64 uint64 float32 float64, int and uint.
std::optional<CanTypeName> can_type_named(std::string_view name);

/// "0x381", or "0x00000381 (extended)".
std::string can_id_text(std::uint32_t id, bool extended);

/// What is wrong with a signal, each as one sentence that begins with `key` and the field ("map.X"
/// gives "map.X.scale: 0 is not allowed; ..."). Empty: nothing.
std::vector<std::string> validate(const CanSignal& signal, const std::string& key);

}  // namespace kerf
