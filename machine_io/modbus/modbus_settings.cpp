#include "machine_io/modbus/modbus_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/translate.h"

namespace kerf {
namespace {

constexpr int kLastAddress = 65535;

/// The rates that libmodbus can set (modbus-rtu.c maps these to termios' names).
constexpr std::array kBauds{110,   300,    600,    1200,   2400,   4800,   9600,   19200,  38400,
                            57600, 115200, 230400, 460800, 500000, 576000, 921600, 1000000};

class Faults {
 public:
  template <class Value>
  void add(std::string_view key, const Value& found, std::string_view allowed) {
    texts.push_back(trf("{}: {} is not allowed; must be {}", key, found, allowed));
  }
  template <class Value>
  void need(bool good, std::string_view key, const Value& found, std::string_view allowed) {
    if (!good) add(key, found, allowed);
  }
  std::vector<std::string> texts;
};

void check_register(Faults& faults, std::string_view key, const ModbusRegister& wanted) {
  const auto last = kLastAddress + 1 - static_cast<int>(word_count(wanted.type));
  faults.need(wanted.address >= 0 && wanted.address <= last, fmt::format("map.{}.register", key),
              wanted.address, trf("0 to {} for {}", last, name_of(wanted.type)));
  faults.need(std::isfinite(wanted.scale) && wanted.scale != 0, fmt::format("map.{}.scale", key),
              wanted.scale, tr("a number other than 0"));
  faults.need(std::isfinite(wanted.offset), fmt::format("map.{}.offset", key), wanted.offset,
              tr("a number"));
}

void check_range(Faults& faults, std::string_view key, const ModbusAxisRange& range) {
  const auto finite = [&](std::string_view name, const std::optional<double>& limit) {
    if (limit) {
      faults.need(std::isfinite(*limit), fmt::format("map.{}.{}", key, name), *limit,
                  tr("a number"));
    }
  };
  finite("min", range.min);
  finite("max", range.max);
  if (range.min && range.max && std::isfinite(*range.max)) {
    faults.need(!(*range.min >= *range.max), fmt::format("map.{}.min", key), *range.min,
                trf("below max, which is {}", *range.max));
  }
  faults.need(range.max_speed_per_s > 0, fmt::format("map.{}.max_speed", key),
              range.max_speed_per_s, tr("above 0 (mm/s or deg/s)"));
}

void check_connection(Faults& faults, const ModbusSettings& s) {
  if (s.rtu) {
    faults.need(!s.device.empty(), "rtu.device", "''", tr("the path of a serial line"));
    faults.need(std::find(kBauds.begin(), kBauds.end(), s.baud) != kBauds.end(), "rtu.baud", s.baud,
                trf("one of {}", fmt::join(kBauds, ", ")));
    faults.need(s.parity == 'N' || s.parity == 'E' || s.parity == 'O', "rtu.parity", s.parity,
                tr("N, E or O"));
    faults.need(s.data_bits == 7 || s.data_bits == 8, "rtu.data_bits", s.data_bits, tr("7 or 8"));
    faults.need(s.stop_bits == 1 || s.stop_bits == 2, "rtu.stop_bits", s.stop_bits, tr("1 or 2"));
    faults.need(s.unit >= 1 && s.unit <= 247, "unit", s.unit, tr("1 to 247 for rtu"));
  } else {
    // 1024 is the longest name that libmodbus keeps.
    faults.need(!s.host.empty() && s.host.size() <= 1024, "tcp.host",
                fmt::format("'{}'", s.host.substr(0, 40)), tr("a name or an address"));
    faults.need(s.port >= 1 && s.port <= 65535, "tcp.port", s.port, "1 to 65535");
    faults.need(s.unit >= 0 && s.unit <= 255, "unit", s.unit, "0 to 255");
  }
  faults.need(s.poll_hz >= 0.1 && s.poll_hz <= 2000, "poll_hz", s.poll_hz,
              tr("0.1 to 2000 (polls/s)"));
  faults.need(s.timeout_ms >= 1 && s.timeout_ms <= 60000, "timeout_ms", s.timeout_ms,
              tr("1 to 60000 (ms)"));
  faults.need(s.max_gap >= 0 && s.max_gap <= 123, "max_gap", s.max_gap, tr("0 to 123 (registers)"));
}

}  // namespace

std::string_view name_of(ModbusTable table) {
  return table == ModbusTable::kHolding ? "holding" : "input";
}

std::vector<std::string> validate(const ModbusSettings& settings) {
  Faults faults;
  check_connection(faults, settings);
  bool any = false;
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if (!settings.axes[i]) continue;
    any = true;
    check_register(faults, kAxisKeys[i], *settings.axes[i]);
    check_range(faults, kAxisKeys[i], settings.ranges[i]);
  }
  if (!any)
    faults.texts.emplace_back(tr("map: no axis is given; at least one of X to W is needed"));
  const std::pair<std::string_view, const std::optional<ModbusRegister>&> others[] = {
      {"tool", settings.tool},       {"line", settings.line},
      {"spindle", settings.spindle}, {"tool_offset_z", settings.tool_offset_z},
      {"trigger", settings.trigger}, {"load", settings.load},
      {"counter", settings.counter}, {"counter_begun", settings.counter_begun}};
  for (const auto& [key, wanted] : others) {
    if (wanted) check_register(faults, key, *wanted);
  }
  if (settings.counter) {
    const ModbusType type = settings.counter->type;
    faults.need(type != ModbusType::kFloat32 && type != ModbusType::kFloat64, "map.counter.type",
                name_of(type), tr("int16, uint16, int32 or uint32"));
  }
  if (settings.counter_begun && !settings.counter) {
    faults.texts.emplace_back(
        tr("map.counter_begun: there is no map.counter; the two are compared with each other"));
  }
  return std::move(faults.texts);
}

}  // namespace kerf
