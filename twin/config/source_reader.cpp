#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <utility>

#include "base/text_scan.h"
#include "base/translate.h"
#include "twin/config/config_reader.h"

namespace kerf {
namespace {

void read_common(const GroupReader& source, ConfigSourceCommon& common) {
  source.seconds("stale_after_ms", common.stale_after_s);
  source.seconds("lost_after_ms", common.lost_after_s);
  if (common.lost_after_s <= common.stale_after_s) {
    ConfigNode* node = source.find("lost_after_ms");
    const bool given = node != nullptr;
    if (!given) node = source.find("stale_after_ms");
    if (node != nullptr) {
      source.faults().at_value(*node,
                               trf("{} is not allowed; must be {}, which is {} (ms)", node->scalar,
                                   given ? tr("above stale_after_ms") : tr("below lost_after_ms"),
                                   1000 * (given ? common.stale_after_s : common.lost_after_s)));
    }
  }
  constexpr std::array kGaps{GapPolicy::kMark, GapPolicy::kCut, GapPolicy::kIgnore};
  if (const int word = source.word("gap"); word >= 0) {
    common.gap = kGaps[static_cast<std::size_t>(word)];
  }
  if (const int word = source.word("frame"); word >= 0) {
    common.frame = word == 0 ? CoordinateFrame::kMachine : CoordinateFrame::kWorkpiece;
  }
  if (const int word = source.word("coordinates"); word >= 0) {
    common.coordinates = word == 0 ? CoordinateKind::kJoints : CoordinateKind::kAxes;
  }
}

/// HOST:PORT, HOST, [IPv6]:PORT, [IPv6].
void read_tcp(const GroupReader& source, ModbusSettings& settings) {
  ConfigNode* const node = source.find("tcp");
  if (node == nullptr) return;
  const std::string& text = node->scalar;
  const auto fault = [&](std::string hint) {
    source.faults().at_value(*node,
                             trf("'{}' is not allowed; must be HOST:PORT, HOST or "
                                 "[IPv6]:PORT",
                                 text.substr(0, 60)),
                             std::move(hint));
  };
  std::size_t colon = text.rfind(':');
  if (text.starts_with('[')) {
    const std::size_t close = text.find(']');
    if (close == text.npos) return fault(tr("']' is missing"));
    settings.host = text.substr(1, close - 1);
    colon = close + 1 < text.size() ? close + 1 : text.npos;
    if (colon != text.npos && text[colon] != ':') return fault(tr("':' must follow ']'"));
  } else {
    if (text.find(':') != colon) return fault(tr("an IPv6 address stands in brackets: [::1]:502"));
    settings.host = text.substr(0, colon);
  }
  if (settings.host.empty() || settings.host.find_first_of(" \t/") != text.npos) {
    return fault(tr("as in 192.168.1.7:502"));
  }
  if (colon == text.npos) return;
  const bool is_number = read_number(std::string_view(text).substr(colon + 1), settings.port);
  if (!is_number || settings.port < 1 || settings.port > 65535) {
    fault(tr("the port is a whole number, 1 to 65535"));
  }
}

void read_rtu(const GroupReader& rtu, ModbusSettings& settings) {
  settings.rtu = true;
  rtu.missing("device", tr("the path of a serial line"), tr("as in /dev/ttyUSB0"));
  settings.device = rtu.text("device").value_or("");
  rtu.number("baud", settings.baud);
  constexpr std::array kParities{'N', 'E', 'O'};
  if (const int word = rtu.word("parity"); word >= 0) {
    settings.parity = kParities[static_cast<std::size_t>(word)];
  }
  rtu.number("data_bits", settings.data_bits);
  rtu.number("stop_bits", settings.stop_bits);
}

ModbusRegister read_register(const GroupReader& item, double mm_per_unit) {
  ModbusRegister out;
  item.missing("register", tr("a whole number, 0 to 65535"));
  item.number("register", out.address);
  if (const int word = item.word("table"); word == 1) out.table = ModbusTable::kInput;
  if (const int word = item.word("type"); word >= 0) out.type = static_cast<ModbusType>(word);
  if (const int word = item.word("word_order"); word >= 0) out.order = static_cast<WordOrder>(word);
  item.number("scale", out.scale);
  item.number("offset", out.offset);
  out.scale *= mm_per_unit;
  out.offset *= mm_per_unit;
  return out;
}

void read_range(const GroupReader& item, double mm_per_unit, ModbusAxisRange& range) {
  item.number("min", range.min);
  item.number("max", range.max);
  if (range.min) *range.min *= mm_per_unit;
  if (range.max) *range.max *= mm_per_unit;
  item.number("max_speed", range.max_speed_per_s);
  if (item.has("max_speed")) range.max_speed_per_s *= mm_per_unit;
}

bool has_fault(const ConfigNode& node) {
  if (node.faulty) return true;
  for (const auto& child : node.children) {
    if (has_fault(*child)) return true;
  }
  return false;
}

void read_kind(const GroupReader& source, const MapReading& reading, LiveConfig& config) {
  const std::string type = source.text("type").value_or("");
  if (type == "modbus") {
    read_modbus(source, reading, config.source.emplace<ModbusSettings>());
  } else if (type == "can") {
    read_can(source, reading, config.source.emplace<CanSourceOptions>());
  } else if (type == "hal") {
    read_hal(source, config.common, reading.inch, config.source.emplace<HalSettings>());
  } else if (type == "log") {
    read_log(source, reading, config.source.emplace<LogSettings>());
  } else if (type == "mtconnect") {
    read_mtconnect(source, config.common, reading, config.source.emplace<MtconnectSettings>());
  }
}

}  // namespace

bool MapReading::is_length(std::size_t index) const {
  const std::string_view letters = kind == CoordinateKind::kJoints ? joints : kAllAxes;
  return index >= letters.size() || letters[index] < 'A' || letters[index] > 'C';
}

double MapReading::mm_per_unit(std::size_t index) const {
  return inch && is_length(index) ? kMmPerInch : 1;
}

std::vector<MapItem> items_of(const GroupReader& map, const MapReading& reading) {
  std::vector<MapItem> items;
  if (!map.is_there()) return items;
  const bool joints = reading.kind == CoordinateKind::kJoints;
  for (const auto& node : map.node()->children) {
    if (node->faulty) continue;
    const int axis = axis_of_item(node->key);
    const int joint = joint_of_item(node->key);
    if (joints ? axis >= 0 : joint >= 0) {
      map.faults().at_key(
          *node,
          joints ? tr("an axis, but source.coordinates is joints")
                 : tr("a joint, but source.coordinates is axes"),
          joints ? tr("joints are J0 to J8") : tr("joints need `coordinates: joints`"));
      continue;
    }
    const int index = joints ? joint : axis;
    MapItem item{GroupReader(node.get(), map.faults()), node->key, std::nullopt};
    if (index >= 0) item.position = static_cast<std::size_t>(index);
    items.push_back(std::move(item));
  }
  return items;
}

void report_faults(const std::vector<std::string>& texts, const GroupReader& source,
                   const MapReading& reading) {
  for (const std::string& text : texts) {
    const std::size_t colon = std::min(text.find(": "), text.size());
    std::string_view key = std::string_view(text).substr(0, colon);
    if (key.starts_with("source.")) key.remove_prefix(7);
    ConfigNode* node = source.node();
    std::string rest;
    for (std::size_t start = 0; start < key.size();) {
      const std::size_t end = std::min(key.find('.', start), key.size());
      std::string name(key.substr(start, end - start));
      const int axis = axis_of_item(name);
      // The settings of Modbus know no joints.
      if (axis >= 0 && reading.kind == CoordinateKind::kJoints) name = fmt::format("J{}", axis);
      ConfigNode* const next = node->child(name);
      if (next == nullptr) {
        rest = fmt::format("{}: ", key.substr(start));
        break;
      }
      node = next;
      start = end + 1;
    }
    if (has_fault(*node)) continue;
    const std::string message = rest + text.substr(std::min(colon + 2, text.size()));
    // A group begins at its first key; its own is what the eye looks for.
    if (node->kind == NodeKind::kScalar) {
      source.faults().at_value(*node, message);
    } else {
      source.faults().at_key(*node, message);
    }
  }
}

void read_modbus(const GroupReader& source, const MapReading& reading, ModbusSettings& settings) {
  if (source.has("rtu") && source.has("tcp")) {
    source.faults().at_key(*source.node()->child("rtu"),
                           tr("has no place beside tcp; must be one of both"));
    read_tcp(source, settings);
  } else if (source.has("rtu")) {
    read_rtu(source.group("rtu"), settings);
  } else {
    source.missing("tcp", tr("HOST:PORT, or rtu: with a device instead"));
    read_tcp(source, settings);
  }
  source.number("unit", settings.unit);
  source.number("poll_hz", settings.poll_hz);
  source.number("timeout_ms", settings.timeout_ms);
  source.number("max_gap", settings.max_gap);

  source.missing("map", tr("a group with at least one axis"), tr("as in X: {register: 0}"));
  for (const MapItem& item : items_of(source.group("map"), reading)) {
    if (item.position) {
      const double mm_per_unit = reading.mm_per_unit(*item.position);
      settings.axes[*item.position] = read_register(item.group, mm_per_unit);
      read_range(item.group, mm_per_unit, settings.ranges[*item.position]);
      continue;
    }
    const bool length = item.name == "tool_offset_z" && reading.inch;
    const ModbusRegister wanted = read_register(item.group, length ? kMmPerInch : 1);
    if (item.name == "tool") settings.tool = wanted;
    if (item.name == "line") settings.line = wanted;
    if (item.name == "spindle") settings.spindle = wanted;
    if (item.name == "tool_offset_z") settings.tool_offset_z = wanted;
    if (item.name == "trigger") settings.trigger = wanted;
    if (item.name == "load") {
      settings.load = wanted;
      settings.load_unit = read_load_unit(item.group);
    }
    if (item.name == "counter") settings.counter = wanted;
    if (item.name == "counter_begun") settings.counter_begun = wanted;
  }
  report_faults(validate(settings), source, reading);
}

LoadUnit read_load_unit(const GroupReader& item) {
  item.missing("unit", trf("one of {}", fmt::join(kLoadUnitWords, ", ")),
               tr("percent: of the rated power, as most drives tell it"));
  const int word = item.word("unit");
  return word >= 0 ? static_cast<LoadUnit>(word) : LoadUnit::kPercentOfPower;
}

namespace {

/// HAL's pins have their names, but for the load's.
void read_hal_load(const GroupReader& map, HalSettings& settings) {
  if (!map.is_there()) return;
  for (const auto& node : map.node()->children) {
    if (node->faulty) continue;
    if (node->key != "load") {
      map.faults().at_key(*node, tr("is read from LinuxCNC's own pin; only load is chosen here"));
      continue;
    }
    const GroupReader item(node.get(), map.faults());
    HalLoad& load = settings.load.emplace();
    item.missing("pin", tr("the name of a HAL pin"), tr("as in vfd.load-percentage"));
    load.pin = item.text("pin").value_or("");
    load.unit = read_load_unit(item);
    item.number("scale", load.scale);
    item.number("offset", load.offset);
  }
}

}  // namespace

void read_hal(const GroupReader& source, const ConfigSourceCommon& common, bool inch,
              HalSettings& settings) {
  source.number("rate_hz", settings.rate_hz);
  if (inch) settings.mm_per_unit = kMmPerInch;
  if (const ConfigNode* const node = source.find("kerf_hal_path")) {
    // A mere name is looked for in PATH.
    const bool is_name = node->scalar.find('/') == node->scalar.npos;
    settings.kerf_hal_path =
        is_name ? node->scalar : resolved_path(*node, node->scalar, source.faults());
  }
  read_hal_load(source.group("map"), settings);
  if (common.coordinates == CoordinateKind::kAxes) {
    source.faults().at_value(*source.find("coordinates"),
                             tr("axes is not allowed; must be joints: that is what HAL has"));
  }
  if (common.frame == CoordinateFrame::kWorkpiece) {
    source.faults().at_value(*source.find("frame"),
                             tr("workpiece is not allowed; must be machine: that is what HAL has"));
  }
}

void read_source(const GroupReader& source, LiveConfig& config) {
  if (!source.is_there()) return;
  source.missing("type", tr("one of modbus, can, hal, log, mtconnect"));
  read_common(source, config.common);
  MapReading reading;
  reading.kind = config.common.coordinates.value_or(CoordinateKind::kAxes);
  reading.inch = source.word("units") == 1;
  reading.joints = config.machine.joints.empty() ? std::string(kAllAxes) : config.machine.joints;
  read_kind(source, reading, config);
}

}  // namespace kerf
