// machine_io/mtconnect/stream_answer.h - what an agent's /current and /sample tell.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"
#include "machine_io/mtconnect/device_model.h"

namespace kerf {

/// A value that a data item has taken.
struct Observation {
  std::string id;
  std::uint64_t sequence = 0;
  std::int64_t stamp_ns = 0;  ///< on the clock of who stamped it
  std::string text;           ///< "12.5", "ACTIVE"; "UNAVAILABLE": nobody knows
  /// Of a table: key of the cell, text; of all its entries.
  std::vector<std::pair<std::string, std::string>> cells;

  bool is_available() const { return text != "UNAVAILABLE"; }
};

struct StreamAnswer {
  AgentHeader header;
  /// The agent's own error, instead of all else: "OUT_OF_RANGE: ..".
  std::string error;
  std::vector<Observation> observations;  ///< in the order of their sequence numbers
  /// All devices': how many there are, and the newest's sequence number.
  std::uint64_t count = 0, newest = 0;
  std::uint64_t damaged = 0;  ///< observations without a number, or without a time: left out
};

/// `device`: the others' observations are left out. Error: not XML, or no such answer.
Result<StreamAnswer> parse_streams(std::string_view text, const DeviceModel& device);

}  // namespace kerf
