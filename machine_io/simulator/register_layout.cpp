#include "machine_io/simulator/register_layout.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/translate.h"

namespace kerf {
namespace {

void put_cdab(std::uint32_t value, std::uint16_t* out) {
  out[0] = static_cast<std::uint16_t>(value & 0xffffU);
  out[1] = static_cast<std::uint16_t>(value >> 16U);
}

void put_float_abcd(double value, std::uint16_t* out) {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  out[0] = static_cast<std::uint16_t>(bits >> 16U);
  out[1] = static_cast<std::uint16_t>(bits & 0xffffU);
}

template <class Word>
Word held(double value) {
  using Limits = std::numeric_limits<Word>;
  const double low = Limits::min();
  const double high = Limits::max();
  return static_cast<Word>(std::clamp(std::round(value), low, high));
}

}  // namespace

const char* const kRegisterHelp = tr_noop(
    "Modbus registers, the same by functions 3 and 4; CDAB = low word first, ABCD = high first:\n"
    "    0, 2 .. 10     X Y Z A B C    int32   CDAB  0.001 mm, 0.001 degrees\n"
    "   12              tool           uint16        0 = none\n"
    "   13              program line   uint32  CDAB  0 = nothing moves\n"
    "   15              scan counter   uint16        one up with each update\n"
    "   16              spindle speed  int16         rpm, negative = counterclockwise\n"
    "   17              tool offset Z  int32   CDAB  0.001 mm\n"
    "   19              spindle load   int16         0.01, of --load\n"
    "  100, 102 .. 110  X Y Z A B C    float32 ABCD  mm, degrees\n"
    "  112              tool offset Z  float32 ABCD  mm\n"
    "  114              spindle speed  float32 ABCD  rpm\n"
    "  116              spindle load   float32 ABCD  of --load\n"
    "20 to 99 read as 0, above 117: exception 2. Whatever would write: exception 1.\n");

std::int32_t thousandths(double value) {
  if (std::isnan(value)) return std::numeric_limits<std::int32_t>::min();
  return held<std::int32_t>(value * 1000);
}

void encode_registers(const ServedState& served, Registers& registers) {
  const SimulatedState& state = served.state;
  registers.fill(0);
  for (std::size_t i = 0; i < kSimulatedAxes; ++i) {
    const double position = served.faults.has(FaultKind::kNan)
                                ? std::numeric_limits<double>::quiet_NaN()
                                : state.position[i];
    put_cdab(static_cast<std::uint32_t>(thousandths(position)), &registers[2 * i]);
    put_float_abcd(position, &registers[kFloatRegister + 2 * i]);
  }
  registers[kToolRegister] = held<std::uint16_t>(state.tool);
  put_cdab(state.line, &registers[kLineRegister]);
  registers[kScanRegister] = state.scan;
  registers[kSpindleRegister] = static_cast<std::uint16_t>(held<std::int16_t>(state.spindle_rpm));
  put_cdab(static_cast<std::uint32_t>(thousandths(state.tool_offset_z_mm)),
           &registers[kToolOffsetRegister]);
  put_float_abcd(state.tool_offset_z_mm, &registers[kFloatToolOffsetRegister]);
  put_float_abcd(state.spindle_rpm, &registers[kFloatSpindleRegister]);
  constexpr double kLoadSteps = 100;
  registers[kLoadRegister] =
      static_cast<std::uint16_t>(held<std::int16_t>(kLoadSteps * state.load));
  put_float_abcd(state.load, &registers[kFloatLoadRegister]);
}

}  // namespace kerf
