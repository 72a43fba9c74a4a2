#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "base/translate.h"
#include "base/units.h"
#include "machine_io/can/dbc_file.h"
#include "twin/config/config_reader.h"

namespace kerf {
namespace {

/// The DBC file that source.dbc names, read when the first signal asks for it.
class DbcShelf {
 public:
  explicit DbcShelf(const GroupReader& source) : source_(source) {}

  /// False: there is none; that has been reported.
  bool open(ConfigNode& asking) {
    if (!source_.has("dbc")) {
      source_.faults().at_value(asking, tr("needs a DBC file, and source.dbc names none"));
      return false;
    }
    ConfigNode* const node = source_.find("dbc");
    if (node == nullptr) return false;
    if (!file_) {
      file_ = read_dbc_file(*source_.path("dbc"), said_);
      if (has_error(said_) && file_->signals().empty()) {
        node->faulty = true;
        tell(Severity::kError);
        return false;
      }
    }
    return true;
  }

  const DbcFile& file() const { return *file_; }

  /// A file may have faults where no signal of the map is: then they are warnings.
  void finish(bool all_found) {
    if (!file_) {
      if (ConfigNode* const node = source_.find("dbc")) {
        source_.faults().at_key(*node, tr("no key of the map has a signal of it"));
      }
      return;
    }
    tell(all_found ? Severity::kWarning : Severity::kError);
  }

 private:
  void tell(Severity gravest) {
    for (Diagnostic& one : said_) {
      if (one.severity == Severity::kError) one.severity = gravest;
      source_.faults().diagnostics().push_back(std::move(one));
    }
    said_.clear();
  }

  const GroupReader& source_;
  std::optional<DbcFile> file_;
  Diagnostics said_;
};

/// Reports keys that say what another key says already.
void refuse_beside(const GroupReader& item, std::string_view chosen,
                   std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys) {
    if (ConfigNode* const node = item.find(key)) {
      item.faults().at_key(*node, trf("has no place beside {}", chosen));
    }
  }
}

int start_bit_of(const GroupReader& group, CanEndian endian) {
  if (group.find("byte") != nullptr) refuse_beside(group, "byte", {"bit"});
  int byte = 0;
  group.number("byte", byte);
  int bit = can_start_of_byte(byte, endian);
  group.number("bit", bit);
  return bit;
}

CanEndian endian_of(const GroupReader& group) {
  return group.word("endian") == 1 ? CanEndian::kBig : CanEndian::kLittle;
}

void read_type(const GroupReader& item, CanSignal& signal) {
  const std::string name = item.text("type").value_or("int32");
  const CanTypeName type = can_type_named(name).value_or(CanTypeName{CanType::kSigned, 32});
  signal.type = type.type;
  signal.bits.length = type.length;
  ConfigNode* const length = item.find("length");
  if (length != nullptr) {
    if (type.length != 0 && static_cast<int>(length->number) != type.length) {
      item.faults().at_value(
          *length, trf("{} is not allowed; {} has {} bits", length->scalar, name, type.length));
    }
    signal.bits.length = static_cast<int>(length->number);
  } else if (type.length == 0) {
    item.missing("length", trf("1 to 64 (bits), as {} has no length of its own", name));
    signal.bits.length = 8;
  }
}

void read_mux(const GroupReader& mux, CanSignal& signal) {
  if (!mux.is_there()) return;
  mux.missing("value", tr("the number that the bits must hold"));
  CanMux out;
  out.bits.endian = endian_of(mux);
  out.bits.start_bit = start_bit_of(mux, out.bits.endian);
  mux.number("length", out.bits.length);
  mux.number("value", out.value);
  signal.mux = out;
}

CanSignal read_raw(const GroupReader& item) {
  CanSignal signal;
  item.missing("id", tr("the id of the frame, as 0x181"),
               tr("or preset: cia402, or signal: NAME of a DBC file"));
  item.number("id", signal.id);
  item.number("extended", signal.extended);
  signal.bits.endian = endian_of(item);
  signal.bits.start_bit = start_bit_of(item, signal.bits.endian);
  read_type(item, signal);
  read_mux(item.group("mux"), signal);
  return signal;
}

CanSignal read_preset(const GroupReader& item) {
  const bool odrive = item.word("preset") == 1;
  const int least = odrive ? 0 : 1;
  const int most = odrive ? 63 : 127;
  const std::string name = *item.text("preset");
  item.missing("node", trf("the drive's node id, {} to {}", least, most));
  item.missing("scale", odrive ? tr("mm or degrees per turn") : tr("mm or degrees per count"));
  refuse_beside(item, "preset",
                {"signal", "id", "extended", "byte", "bit", "length", "type", "endian", "mux"});
  int node = least;
  item.number("node", node);
  if (node < least || node > most) {
    item.faults().at_value(*item.find("node"), trf("{} is not allowed; must be {} to {} for {}",
                                                   node, least, most, name));
    node = least;
  }
  const auto id = static_cast<std::uint8_t>(node);
  return odrive ? odrive_position(id, 1) : cia402_position(id, 1);
}

/// What a number of the map is.
enum class Quantity : std::uint8_t { kLength, kAngle, kOther };

/// A DBC file that names another unit than the one that the number is taken for.
void check_unit(const GroupReader& item, ConfigNode& node, const DbcSignal& signal,
                Quantity quantity, bool inch) {
  struct Unit {
    std::string_view name;
    Quantity quantity;
    double size;  // mm or degrees
  };
  constexpr Unit kUnits[] = {
      {"mm", Quantity::kLength, 1},          {"cm", Quantity::kLength, 10},
      {"m", Quantity::kLength, 1000},        {"um", Quantity::kLength, 0.001},
      {"\u00b5m", Quantity::kLength, 0.001}, {"\u03bcm", Quantity::kLength, 0.001},
      {"in", Quantity::kLength, kMmPerInch}, {"inch", Quantity::kLength, kMmPerInch},
      {"deg", Quantity::kAngle, 1},          {"\u00b0", Quantity::kAngle, 1},
      {"rad", Quantity::kAngle, kDegPerRad}};
  // A scale is the user's word.
  if (item.has("scale")) return;
  const bool inches = inch && quantity == Quantity::kLength;
  const double wanted = inches ? kMmPerInch : 1;
  for (const Unit& unit : kUnits) {
    if (unit.name != signal.unit || unit.quantity != quantity || unit.size == wanted) continue;
    item.faults().at_value(node,
                           trf("{} is in {}, which is taken for {}", node.scalar, signal.unit,
                               inches                          ? "inch"
                               : quantity == Quantity::kLength ? "mm"
                                                               : tr("degrees")),
                           trf("scale: {} makes it right", unit.size / wanted));
    return;
  }
}

std::optional<CanSignal> read_dbc_signal(const GroupReader& item, DbcShelf& shelf,
                                         Quantity quantity, bool inch) {
  refuse_beside(item, "signal",
                {"id", "extended", "byte", "bit", "length", "type", "endian", "mux", "node"});
  ConfigNode* const node = item.find("signal");
  if (!shelf.open(*node)) {
    node->faulty = true;
    return std::nullopt;
  }
  const Result<DbcSignal> found = shelf.file().find(node->scalar);
  if (!found) {
    item.faults().at_value(*node, found.error());
    return std::nullopt;
  }
  check_unit(item, *node, *found, quantity, inch);
  return found->signal;
}

/// Nothing where the signal could not be found; that has been reported.
std::optional<CanSignal> read_signal(const GroupReader& item, DbcShelf& shelf, Quantity quantity,
                                     bool inch, double stale_after_ms) {
  std::optional<CanSignal> signal;
  if (item.has("preset")) {
    if (item.find("preset") != nullptr) signal = read_preset(item);
  } else if (item.has("signal")) {
    if (item.find("signal") != nullptr) signal = read_dbc_signal(item, shelf, quantity, inch);
  } else {
    if (ConfigNode* const node = item.find("node")) {
      item.faults().at_key(*node, tr("is for a preset, and there is none"));
    }
    signal = read_raw(item);
  }
  if (!signal) return std::nullopt;
  const double mm_per_unit = inch && quantity == Quantity::kLength ? kMmPerInch : 1;
  double scale = 1;
  double offset = 0;
  item.number("scale", scale);
  item.number("offset", offset);
  signal->scale *= scale * mm_per_unit;
  signal->offset = (signal->offset * scale + offset) * mm_per_unit;
  signal->max_age_ms = stale_after_ms;
  item.number("max_age_ms", signal->max_age_ms);
  return signal;
}

CanAxisRange read_range(const GroupReader& item, double mm_per_unit) {
  CanAxisRange range;
  item.number("min", range.min);
  item.number("max", range.max);
  item.number("max_speed", range.max_speed_per_s);
  for (auto* const one : {&range.min, &range.max, &range.max_speed_per_s}) {
    if (*one) **one *= mm_per_unit;
  }
  return range;
}

}  // namespace

void read_can_map(const GroupReader& source, const MapReading& reading, CanMap& map) {
  source.number("gather_ms", map.gather_ms);
  source.number("sync_id", map.sync_id);
  if (reading.kind == CoordinateKind::kJoints) {
    for (std::size_t i = 0; i < kMaxPositions; ++i) map.axis_keys[i] = fmt::format("J{}", i);
  }
  // What has not come for so long is not known, each by itself.
  double stale_after_ms = 500;
  source.number("stale_after_ms", stale_after_ms);
  DbcShelf shelf(source);
  bool all_found = true;
  for (const MapItem& item : items_of(source.group("map"), reading)) {
    if (item.name == "counter" || item.name == "counter_begun") {
      source.faults().at_key(*item.group.node(), tr("only a modbus source has a counter"),
                             tr("a CAN drive that is silent is found by max_age_ms"));
      continue;
    }
    Quantity quantity = Quantity::kOther;
    if (item.name == "tool_offset_z") quantity = Quantity::kLength;
    if (item.position) {
      quantity = reading.is_length(*item.position) ? Quantity::kLength : Quantity::kAngle;
    }
    const std::optional<CanSignal> signal =
        read_signal(item.group, shelf, quantity, reading.inch, stale_after_ms);
    if (!signal) {
      all_found = false;
      continue;
    }
    if (item.position) {
      map.axes[*item.position] = signal;
      const double unit = reading.inch && quantity == Quantity::kLength ? kMmPerInch : 1;
      map.ranges[*item.position] = read_range(item.group, unit);
    }
    if (item.name == "tool") map.tool = signal;
    if (item.name == "line") map.line = signal;
    if (item.name == "spindle") map.spindle = signal;
    if (item.name == "tool_offset_z") map.tool_offset_z = signal;
    if (item.name == "trigger") map.trigger = signal;
    if (item.name == "load") {
      map.load = signal;
      map.load_unit = read_load_unit(item.group);
      refuse_beside(item.group, tr("id or signal"), {"pin"});
    }
  }
  shelf.finish(all_found);
}

void read_can(const GroupReader& source, const MapReading& reading, CanSourceOptions& options) {
  source.missing("interface", tr("the name of a CAN interface"), tr("as in can0"));
  if (const std::optional<std::string> name = source.text("interface")) options.interface = *name;
  source.number("receive_buffer_bytes", options.receive_buffer_bytes);
  source.missing("map", tr("a group with at least one axis"),
                 tr("as in X: {id: 0x181, type: int32}"));
  read_can_map(source, reading, options.map);
  report_faults(validate(options), source, reading);
}

}  // namespace kerf
