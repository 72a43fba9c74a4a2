// machine_io/logs/log_columns.h - what the columns of a log are, by their names.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "machine_io/logs/log_source.h"

namespace kerf {

enum class ColumnRole : std::uint8_t {
  kIgnored,
  kHostTime,
  kDeviceTime,
  kPosition,
  kTool,
  kLine,
  kToolOffsetZ,
  kSpindle,
  kTrigger,
  kProgram,
  kLoad,
};

/// One column, ready for reading its cells.
struct LogColumn {
  ColumnRole role = ColumnRole::kIgnored;
  std::uint8_t index = 0;                          ///< of a position
  double factor = 1.0;                             ///< value in the cell times this: mm or degrees
  double offset = 0.0;                             ///< of a load, added then
  std::int64_t ns_per_unit = 1'000'000'000;        ///< of a time
  LoadUnit load_unit = LoadUnit::kPercentOfPower;  ///< of a load
};

struct ColumnName {
  std::string text;
  int column = 0;  ///< where it stands in its line, from 1; 0: not in the file
};

/// The columns and all that was said about them.
struct LogColumns {
  std::vector<LogColumn> columns;
  std::uint16_t positions = 0;
  std::optional<CoordinateKind> kind;
  bool has_time = false;
  std::optional<LoadUnit> load;
  /// Names without a part in AxisSample, or that a better one has displaced.
  std::vector<std::string> ignored;
};

/// What is wrong with a header, and where.
struct ColumnFault {
  int column = 0;
  std::string message;
  std::string hint;
};

/// Gives each name its role. Upper and lower case are the same. A unit may be in the name: x_mm,
/// "x [in]", x(mm), t_ms. Of HAL pins for the same joint, pos-fb goes before pos-cmd, and joints go
/// before axes. False, and `faults` with the column each: two columns for one thing, a unit that is
/// not known or does not fit, no position at all (with what was found and what is allowed).
bool find_columns(const std::vector<ColumnName>& names, const LogSettings& settings,
                  LogColumns& found, std::vector<ColumnFault>& faults);

/// Cells of a header row, quotes taken off, with their columns.
std::vector<ColumnName> split_header(std::string_view line, char delimiter);

/// ',', ';' or tab: what the line has most of outside quotes. ',' if it has none.
char find_delimiter(std::string_view line);

}  // namespace kerf
