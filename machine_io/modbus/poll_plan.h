// machine_io/modbus/poll_plan.h - the fewest reads that fetch all wanted registers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "machine_io/modbus/modbus_settings.h"

namespace kerf {

/// Most registers of one read (Modbus Application Protocol V1.1b3, 6.3 and 6.4).
inline constexpr int kMaxReadRegisters = 125;

/// One request: `count` registers of `table` from `address` on.
struct PollRead {
  ModbusTable table = ModbusTable::kHolding;
  int address = 0;
  int count = 0;
  std::size_t first_word = 0;  ///< where its answer begins among the words of all reads
  bool has_gaps = false;       ///< reads registers that nobody wants
};

/// How to read a set of numbers. Values are never split between reads, tables never mixed.
struct PollPlan {
  std::vector<PollRead> reads;          ///< in the order of table and address
  std::vector<std::size_t> first_word;  ///< of each wanted number, in the order they were given
  std::size_t words = 0;                ///< of all answers together
};

/// The plan with the fewest reads in which no gap of unwanted registers inside a read is longer
/// than `max_gap`. Numbers may overlap or be wanted twice. O(n log n).
PollPlan plan_reads(const std::vector<ModbusRegister>& wanted, int max_gap);

}  // namespace kerf
