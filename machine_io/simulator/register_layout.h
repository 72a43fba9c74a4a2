// machine_io/simulator/register_layout.h - which Modbus register of the simulated machine holds
// what.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "machine_io/simulator/state_board.h"

namespace kerf {

/// Registers 0 to 117, the same by function 3 (holding) and 4 (input). Of two registers, "CDAB" is
/// the low word first, "ABCD" the high word first; each word goes out high byte first, as the
/// protocol has it.
///
///       0, 2 .. 10   X Y Z A B C        int32  CDAB    0.001 mm, 0.001 degrees
///      12            tool               uint16         0 = none
///      13            program line       uint32 CDAB    0 = nothing moves
///      15            scan counter       uint16         one up with each update
///      16            spindle speed      int16          rpm, negative = counterclockwise
///      17            tool offset Z      int32  CDAB    0.001 mm
///      19            spindle load       int16          0.01, of --load
///     100, 102 ..110 X Y Z A B C        float32 ABCD   mm, degrees
///     112            tool offset Z      float32 ABCD   mm
///     114            spindle speed      float32 ABCD   rpm
///     116            spindle load       float32 ABCD   of --load
///
/// 20 to 99 read as 0. Any other address: exception 2. Functions other than 3 and 4: exception 1.
inline constexpr std::size_t kRegisterCount = 118;
inline constexpr std::size_t kToolRegister = 12;
inline constexpr std::size_t kLineRegister = 13;
inline constexpr std::size_t kScanRegister = 15;
inline constexpr std::size_t kSpindleRegister = 16;
inline constexpr std::size_t kToolOffsetRegister = 17;
inline constexpr std::size_t kLoadRegister = 19;
inline constexpr std::size_t kFloatRegister = 100;
inline constexpr std::size_t kFloatToolOffsetRegister = 112;
inline constexpr std::size_t kFloatSpindleRegister = 114;
inline constexpr std::size_t kFloatLoadRegister = 116;

using Registers = std::array<std::uint16_t, kRegisterCount>;

/// All registers of one moment. What does not fit a register's type is held at the type's end;
/// under the fault nan positions are NaN, and -2147483648 in the integers.
void encode_registers(const ServedState& served, Registers& registers);

/// A length or an angle in thousandths, rounded to nearest and held within int32. NaN: the lowest.
std::int32_t thousandths(double value);

/// The table above, for --help.
extern const char* const kRegisterHelp;

}  // namespace kerf
