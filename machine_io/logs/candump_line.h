// machine_io/logs/candump_line.h - one line of a CAN log as `candump -l` and `candump -L` write it.
#pragma once

#include <cstdint>
#include <string_view>

#include "machine_io/can/can_signal.h"

namespace kerf {

struct CandumpLine {
  /// The stamp, ns on the clock of the computer that logged; not negative. candump writes
  /// microseconds.
  std::int64_t time_ns = 0;
  std::string_view interface;  ///< "can0"; lies in the line that was read
  CanFrame frame;
};

/// Where and why a line is none.
struct CandumpFault {
  int column = 0;         ///< in bytes, from 1
  const char* text = "";  ///< "an identifier of 3 or 8 hexadecimal digits is expected here"
};

/// Reads one line, without its line end:
///     (1795210989.363816) can0 381#370600000000     3 digits: 11-bit id, 8: 29-bit id
///     (1795210989.363816) can0 381#R, 381#R4        remote frame, with or without its length
///     (1795210989.363816) can0 381##5AB01           CAN FD; the first digit holds its flags
///     (1795210989.363816) can0 20000040#00000000    bit 29 of the id: an error frame
/// Bytes of data may be apart by '.'; `_9` to `_F` behind 8 bytes is a raw length code, which kerf
/// does not need. Words behind the frame (newer versions write a direction) are not looked at.
/// False: not such a line. `line` is not altered; nothing is allocated.
bool read_candump_line(std::string_view text, CandumpLine& line, CandumpFault& fault);

}  // namespace kerf
