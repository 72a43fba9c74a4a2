// machine_io/modbus/modbus_settings.h - which registers of which Modbus device hold the positions.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "machine_io/modbus/register_decoder.h"
#include "machine_io/position_source.h"

namespace kerf {

/// The two tables that can be read as registers. The value is the function code that reads it;
/// there are no others, so no setting can make a request that writes.
enum class ModbusTable : std::uint8_t { kHolding = 3, kInput = 4 };

/// "holding" or "input".
std::string_view name_of(ModbusTable table);

/// One number in the device: value = raw * scale + offset.
struct ModbusRegister {
  /// Of the first register, as the wire has it: counted from 0. (What a manual calls 40001 is
  /// holding register 0.)
  int address = 0;
  ModbusTable table = ModbusTable::kHolding;
  ModbusType type = ModbusType::kFloat32;
  WordOrder order = WordOrder::kAbcd;
  double scale = 1;   ///< mm (degrees, rpm ...) per raw count. Not 0.
  double offset = 0;  ///< mm (degrees, rpm ...), added after scaling
};

/// What a position can be. A reading outside is taken for a fault of the configuration or the link:
/// it is reported, never handed out.
struct ModbusAxisRange {
  std::optional<double> min;  ///< mm or degrees, after scale and offset; not given: unlimited
  std::optional<double> max;  ///< likewise
  /// mm/s or deg/s. A reading that would need more is handed out only when the next one agrees
  /// with it: a torn 32-bit value stands alone, a newly homed axis stays. Far above what machines
  /// do.
  double max_speed_per_s = 10000;
};

/// Everything about one device. Defaults are what most devices have.
struct ModbusSettings {
  bool rtu = false;  ///< serial line instead of TCP

  std::string host;  ///< TCP: name, IPv4 or IPv6 address. A name is looked up at every connect.
  int port = 502;    ///< TCP: 1..65535

  std::string device;  ///< RTU: "/dev/ttyUSB0"
  int baud = 19200;    ///< RTU: bit/s, a rate that termios knows
  char parity = 'N';   ///< RTU: N, E or O
  int data_bits = 8;   ///< RTU: 7 or 8 (Modbus RTU wants 8)
  int stop_bits = 1;   ///< RTU: 1 or 2

  /// TCP 0..255, RTU 1..247. On TCP the replies' unit is compared with it, except for 0 and 255,
  /// which the standard gives to devices that do not use it.
  int unit = 1;
  double poll_hz = 50;   ///< polls/s, 0.1..2000; a poll reads every register below
  int timeout_ms = 200;  ///< 1..60000, for a whole answer; RTU: above the device's worst answer
  /// Registers between two wanted ones that may be read along to save a request. A device that
  /// answers such a read with exception 2 or 3 is read without gaps from then on.
  int max_gap = 8;

  std::array<std::optional<ModbusRegister>, kMaxPositions> axes;  ///< joints 0..8 or X..W
  std::array<ModbusAxisRange, kMaxPositions> ranges;
  std::optional<ModbusRegister> tool;           ///< tool number
  std::optional<ModbusRegister> line;           ///< program line, 0 = idle
  std::optional<ModbusRegister> spindle;        ///< rpm, signed
  std::optional<ModbusRegister> tool_offset_z;  ///< mm
  std::optional<ModbusRegister> trigger;        ///< of a punch: 0 off, else on
  std::optional<ModbusRegister> load;           ///< of the spindle, in load_unit
  LoadUnit load_unit = LoadUnit::kPercentOfPower;
  /// An integer that the device changes at its every cycle. A reading in which it has not changed
  /// is not handed out: that tells a dead program behind a living server from a machine that
  /// stands.
  std::optional<ModbusRegister> counter;
  /// The same integer, which the device writes before everything else at each cycle, and `counter`
  /// after everything else. While the two differ the answer is of two cycles: it is asked for again
  /// at once.
  std::optional<ModbusRegister> counter_begun;
};

/// "X".."W", "tool", "line" ...: the key of a register, in the order in which they are polled.
inline constexpr std::array<std::string_view, kMaxPositions> kAxisKeys{"X", "Y", "Z", "A", "B",
                                                                       "C", "U", "V", "W"};

/// Every fault in the settings, one text each: key, value found, what is allowed
/// ("unit: 300 is not allowed; must be 0 to 255"). Empty: they can be used.
std::vector<std::string> validate(const ModbusSettings& settings);

}  // namespace kerf
