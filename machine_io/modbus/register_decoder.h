// machine_io/modbus/register_decoder.h - numbers from Modbus registers and back. Knows no network.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace kerf {

/// How a number lies in 16-bit registers.
enum class ModbusType : std::uint8_t { kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

/// The order of a number's bytes on the wire; A is the most significant byte of four. The names say
/// what the wire carries, first byte first:
///
///              16 bit   32 bit   64 bit
///     abcd     AB       ABCD     ABCDEFGH   big-endian throughout: what the standard means
///     cdab     AB       CDAB     GHEFCDAB   low word first (many PLCs, LinuxCNC's ClassicLadder)
///     badc     BA       BADC     BADCFEHG   bytes swapped in every word
///     dcba     BA       DCBA     HGFEDCBA   little-endian throughout
enum class WordOrder : std::uint8_t { kAbcd, kCdab, kBadc, kDcba };

inline constexpr std::array<WordOrder, 4> kWordOrders{WordOrder::kCdab, WordOrder::kAbcd,
                                                      WordOrder::kDcba, WordOrder::kBadc};

/// Registers that one number takes: 1, 2 or 4.
std::size_t word_count(ModbusType type);

/// "int16" ... "float64", as a configuration spells them.
std::string_view name_of(ModbusType type);
/// "abcd" ... "dcba".
std::string_view name_of(WordOrder order);

/// The number in `words[0 .. word_count(type))`, which hold register values (not wire bytes),
/// lowest address first. Every integer comes out exactly. Floats may come out as NaN or infinite.
double decode_registers(ModbusType type, WordOrder order, const std::uint16_t* words);

/// The reverse, for simulated machines and tests. Integers are rounded to nearest and held within
/// the type's range; NaN becomes 0 in an integer.
void encode_registers(ModbusType type, WordOrder order, double value, std::uint16_t* words);

}  // namespace kerf
