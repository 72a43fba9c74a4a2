#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/text_scan.h"
#include "twin/config/config_reader.h"
#include "twin/config/live_config.h"

namespace kerf {
namespace {

/// A text that YAML gives back as it is: bare if that is safe, else in double quotes.
std::string quoted(const std::string& text) {
  const auto is_plain = [](char c) {
    return is_letter(c) || is_digit(c) || c == '_' || c == '.' || c == '/' || c == '-';
  };
  const bool safe = !text.empty() && text != "null" && text != "Null" && text != "NULL" &&
                    text.front() != '-' && text.front() != '.' &&
                    std::all_of(text.begin(), text.end(), is_plain);
  if (safe) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

/// Seconds as milliseconds, without what the division into seconds left behind.
double milliseconds(double seconds) { return std::round(seconds * 1e9) / 1e6; }

class Printer {
 public:
  void open(std::string_view key) {
    line(fmt::format("{}:", key));
    ++depth_;
  }
  void close() { --depth_; }
  template <class Value>
  void put(std::string_view key, const Value& value) {
    line(fmt::format("{}: {}", key, value));
  }
  void text(std::string_view key, const std::string& value) { put(key, quoted(value)); }
  void text(std::string_view key, const std::optional<std::string>& value) {
    if (value) text(key, *value);
  }
  void line(const std::string& text) { out += std::string(2 * depth_, ' ') + text + "\n"; }
  std::string out;

 private:
  std::size_t depth_ = 0;
};

const char* name_of(ToolLengthFrom from) {
  constexpr std::array kNames{"auto", "source", "program", "table", "none"};
  return kNames[static_cast<std::size_t>(from)];
}

std::string vector_text(const Vec3& v) { return fmt::format("\"{},{},{}\"", v.x, v.y, v.z); }

std::string link_text(const LinkSpec& link) {
  const ChainLink& chain = link.chain;
  std::string text = fmt::format("name: {}", quoted(chain.name));
  if (!chain.parent.empty()) text += fmt::format(", parent: {}", quoted(chain.parent));
  if (chain.joint != JointKind::kFixed) {
    text += chain.by_joint ? fmt::format(", axis: J{}", chain.input)
                           : fmt::format(", axis: {}", kAllAxes[chain.input]);
    text += fmt::format(", moves: {}, direction: {}",
                        chain.joint == JointKind::kRotary ? "turn" : "slide",
                        vector_text(chain.direction));
  }
  text += fmt::format(", origin: {}", vector_text(chain.origin_mm));
  if (!link.bodies_spec.empty()) text += fmt::format(", mesh: {}", quoted(link.bodies_spec));
  if (!link.stl_path.empty()) {
    text += fmt::format(", stl: {}, stl_units: {}, stl_offset: {}", quoted(link.stl_path),
                        link.mm_per_unit == 1.0 ? "mm" : "inch", vector_text(link.mesh_offset_mm));
  }
  // The file has red first, the viewer has it in the lowest byte.
  const std::uint32_t c = link.color;
  return text + fmt::format(", color: \"#{:02x}{:02x}{:02x}{:02x}\"", c & 0xffU, (c >> 8U) & 0xffU,
                            (c >> 16U) & 0xffU, c >> 24U);
}

void print_links(Printer& printer, const LinkedMachine& machine) {
  printer.text("workpiece_on", machine.workpiece_on);
  printer.text("tool_on", machine.tool_on);
  printer.open("links");
  for (const LinkSpec& link : machine.links) {
    printer.line(fmt::format("- {{{}}}", link_text(link)));
  }
  printer.close();
}

void print_kinematics(Printer& printer, const KinematicsRequest& kinematics) {
  if (kinematics.linked) {
    printer.put("kinematics", "links");
    printer.put("follows_tip", kinematics.linked->follows_tip ? "yes" : "no");
  } else if (!kinematics.kinematics.empty()) {
    printer.text("kinematics", kinematics.kinematics);
  }
  if (!kinematics.geometry.empty()) {
    printer.open("geometry");
    for (const auto& [pin, value] : kinematics.geometry) printer.put(pin, value);
    printer.close();
  }
  if (kinematics.rotary_side) {
    printer.put("rotary_side", *kinematics.rotary_side == RotarySide::kTable ? "table" : "head");
  }
  if (kinematics.rotary_center_mm) {
    printer.put("rotary_center", vector_text(*kinematics.rotary_center_mm));
  }
  if (kinematics.told_tool_mm) printer.put("told_tool_length", *kinematics.told_tool_mm);
}

std::string pair_text(const NamedPair& pair) {
  return fmt::format("[{}, {}]", quoted(pair[0]), quoted(pair[1]));
}

void print_machine(Printer& printer, const ConfigMachine& machine) {
  printer.open("machine");
  printer.text("ini", machine.ini);
  printer.text("tool_table", machine.tool_table);
  printer.put("as_mill", machine.as_mill ? "yes" : "no");
  if (!machine.joints.empty()) printer.text("joints", machine.joints);
  if (machine.kinematics) print_kinematics(printer, *machine.kinematics);
  if (machine.work_offset) {
    printer.open("work_offset");
    printer.put("x", machine.work_offset->g5x_mm.x);
    printer.put("y", machine.work_offset->g5x_mm.y);
    printer.put("z", machine.work_offset->g5x_mm.z);
    printer.put("rotation", machine.work_offset->rotation_deg);
    for (std::size_t i = 0; i < 3; ++i) {
      constexpr std::array kNames{"a", "b", "c"};
      printer.put(kNames[i], machine.work_offset->offset_abc_deg[i]);
    }
    for (int i = 0; i < 3; ++i) {
      constexpr std::array kNames{"u", "v", "w"};
      printer.put(kNames[static_cast<std::size_t>(i)], machine.work_offset->offset_uvw_mm[i]);
    }
    printer.close();
  }
  printer.put("tool_length", name_of(machine.tool_length));
  if (machine.tool) printer.put("tool", *machine.tool);
  if (machine.max_mm_per_min) printer.put("max_speed_mm_per_min", *machine.max_mm_per_min);
  if (machine.max_mm_per_s2) printer.put("max_acceleration_mm_per_s2", *machine.max_mm_per_s2);
  if (machine.drawn.kind) printer.put("model", kerf::name_of(*machine.drawn.kind));
  if (!machine.spindle_spec.empty()) printer.text("spindle", machine.spindle_spec);
  if (machine.spindle_accel_rpm_per_s.value_or(0) > 0) {
    printer.put("spindle_accel", *machine.spindle_accel_rpm_per_s);
  }
  if (machine.holding.chuck) printer.text("chuck", machine.holding.chuck->text);
  if (machine.holding.tailstock) printer.text("tailstock", machine.holding.tailstock->text);
  if (machine.spindle_max_rpm) printer.put("spindle_max_rpm", *machine.spindle_max_rpm);
  if (machine.spindle_power_kw) printer.put("spindle_power_kw", *machine.spindle_power_kw);
  if (machine.spindle_torque_nm) printer.put("spindle_torque_nm", *machine.spindle_torque_nm);
  if (machine.spindle_current_a) printer.put("spindle_current_a", *machine.spindle_current_a);
  if (machine.drawn.links) print_links(printer, *machine.drawn.links);
  printer.put("collisions", machine.collisions ? "yes" : "no");
  if (!machine.ignore.empty()) {
    printer.open("ignore");
    for (const NamedPair& pair : machine.ignore) printer.line("- " + pair_text(pair));
    printer.close();
  }
  printer.close();
}

/// Only what is given: the rest hangs on the program.
void print_beam(Printer& printer, const ConfigBeam& beam) {
  if (beam == ConfigBeam{}) return;
  printer.open("beam");
  printer.text("trigger", beam.trigger);
  const std::pair<const char*, const std::optional<double>*> numbers[] = {
      {"kerf_mm", &beam.kerf_mm},
      {"pierce_mm", &beam.pierce_mm},
      {"slats_mm", &beam.slats_mm},
      {"density_kg_per_m3", &beam.density_kg_per_m3}};
  for (const auto& [key, value] : numbers) {
    if (*value) printer.put(key, **value);
  }
  printer.text("qtplasmac", beam.qtplasmac);
  printer.text("materials", beam.materials);
  printer.close();
}

std::string fixture_text(const FixtureSpec& fixture) {
  std::string text = fmt::format("shape: {}", quoted(fixture.text));
  if (!fixture.name.empty()) text = fmt::format("name: {}, {}", quoted(fixture.name), text);
  if (fixture.at_mm != Vec3{0}) text += fmt::format(", at: {}", vector_text(fixture.at_mm));
  if (fixture.turn_deg != 0) text += fmt::format(", turn: {}", fixture.turn_deg);
  if (fixture.in_blank) text += ", in_blank: yes";
  if (!fixture.on.empty()) text += fmt::format(", on: {}", quoted(fixture.on));
  if (fixture.clearance_mm) text += fmt::format(", clearance_mm: {}", *fixture.clearance_mm);
  return text;
}

void print_work(Printer& printer, const LiveConfig& config) {
  if (!config.tools.empty()) {
    printer.open("tools");
    for (const ToolShapeArgument& tool : config.tools) {
      printer.text(fmt::format("{}", tool.tool), tool.cutter.spec());
    }
    printer.close();
  }
  if (!config.fixtures.empty()) {
    printer.open("fixtures");
    for (const FixtureSpec& fixture : config.fixtures) {
      printer.line(fmt::format("- {{{}}}", fixture_text(fixture)));
    }
    printer.close();
  }
  printer.put("clearance_mm", config.clearance_mm);
  if (!config.clearances.empty()) {
    printer.open("clearances");
    for (const PairClearance& one : config.clearances)
      printer.line(fmt::format("- {{pair: {}, mm: {}}}", pair_text(one.pair), one.mm));
    printer.close();
  }
  printer.put("cut_by_shank", config.cut_by_shank ? "yes" : "no");
  if (!config.tool_libraries.empty()) {
    printer.open("tool_libraries");
    for (const std::string& path : config.tool_libraries) printer.line("- " + quoted(path));
    printer.close();
  }
  printer.open("stock");
  printer.put("model", config.stock.model ? stock_model(*config.stock.model).name : "auto");
  if (config.stock.blank) printer.text("blank", config.stock.blank_spec);
  if (config.stock.cell_mm) printer.put("cell_mm", *config.stock.cell_mm);
  printer.put("margin_mm", config.stock.margin_mm);
  printer.put("below_mm", config.stock.below_mm);
  printer.close();
  print_beam(printer, config.beam);
  printer.text("material", config.material);
  printer.text("turret", config.turret);
  printer.put("units", config.units == LengthUnit::kInch ? "inch" : "mm");
  printer.open("follow");
  printer.text("program", config.follow.program);
  if (config.follow.planned_path) {
    printer.put("path", *config.follow.planned_path ? "planned" : "programmed");
  }
  printer.put("off_path_mm", config.follow.options.tolerance_mm);
  printer.put("off_path_s", config.follow.off_path_s);
  printer.put("joined_late", config.follow.joined_late == JoinedLate::kKeep ? "keep" : "cut");
  printer.put("look_ahead_s", config.follow.look_ahead_s);
  printer.put("on_program_end",
              config.follow.on_program_end == OnProgramEnd::kNewBlank ? "new-blank" : "keep");
  printer.close();
  printer.open("view");
  printer.put("window", config.view.window ? "yes" : "no");
  printer.put("keyframes_mb", config.view.keyframes_mb);
  printer.close();
}

std::string register_text(const ModbusRegister& one) {
  return fmt::format("register: {}, table: {}, type: {}, word_order: {}, scale: {}, offset: {}",
                     one.address, kerf::name_of(one.table), kerf::name_of(one.type),
                     kerf::name_of(one.order), one.scale, one.offset);
}

std::string item_key(CoordinateKind kind, std::size_t index) {
  return kind == CoordinateKind::kJoints ? fmt::format("J{}", index)
                                         : std::string(1, kAllAxes[index]);
}

std::string bits_text(const CanBits& bits) {
  return fmt::format("bit: {}, length: {}, endian: {}", bits.start_bit, bits.length,
                     bits.endian == CanEndian::kBig ? "big" : "little");
}

std::string signal_text(const CanSignal& signal) {
  constexpr std::array kTypes{"uint", "int", "float32", "float64"};
  std::string text = fmt::format(
      "id: 0x{:X}, extended: {}, type: {}, {}, ", signal.id, signal.extended ? "yes" : "no",
      kTypes[static_cast<std::size_t>(signal.type)], bits_text(signal.bits));
  if (signal.mux) {
    text += fmt::format("mux: {{{}, value: {}}}, ", bits_text(signal.mux->bits), signal.mux->value);
  }
  return text + fmt::format("scale: {}, offset: {}, max_age_ms: {}", signal.scale, signal.offset,
                            signal.max_age_ms);
}

void print_can_map(Printer& printer, const CanMap& map, CoordinateKind kind) {
  printer.put("gather_ms", map.gather_ms);
  printer.put("sync_id", map.sync_id);
  printer.open("map");
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if (!map.axes[i]) continue;
    const CanAxisRange& range = map.ranges[i];
    std::string text = signal_text(*map.axes[i]);
    if (range.min) text += fmt::format(", min: {}", *range.min);
    if (range.max) text += fmt::format(", max: {}", *range.max);
    if (range.max_speed_per_s) text += fmt::format(", max_speed: {}", *range.max_speed_per_s);
    printer.line(fmt::format("{}: {{{}}}", item_key(kind, i), text));
  }
  const auto other = [&](const char* key, const std::optional<CanSignal>& signal) {
    if (signal) printer.line(fmt::format("{}: {{{}}}", key, signal_text(*signal)));
  };
  other("tool", map.tool);
  other("line", map.line);
  other("spindle", map.spindle);
  other("tool_offset_z", map.tool_offset_z);
  other("trigger", map.trigger);
  if (map.load) {
    printer.line(
        fmt::format("load: {{{}, unit: {}}}", signal_text(*map.load), word_of(map.load_unit)));
  }
  printer.close();
}

/// What each kind of source adds below the common keys.
struct SourcePrinter {
  Printer& printer;
  CoordinateKind kind;

  void operator()(const std::monostate&) const {}

  void operator()(const ModbusSettings& s) const {
    if (s.rtu) {
      printer.open("rtu");
      printer.text("device", s.device);
      printer.put("baud", s.baud);
      printer.put("parity", s.parity == 'E' ? "even" : s.parity == 'O' ? "odd" : "none");
      printer.put("data_bits", s.data_bits);
      printer.put("stop_bits", s.stop_bits);
      printer.close();
    } else {
      const bool v6 = s.host.find(':') != s.host.npos;
      printer.text("tcp", fmt::format("{}{}{}:{}", v6 ? "[" : "", s.host, v6 ? "]" : "", s.port));
    }
    printer.put("unit", s.unit);
    printer.put("poll_hz", s.poll_hz);
    printer.put("timeout_ms", s.timeout_ms);
    printer.put("max_gap", s.max_gap);
    printer.open("map");
    for (std::size_t i = 0; i < kMaxPositions; ++i) {
      if (!s.axes[i]) continue;
      std::string text = register_text(*s.axes[i]);
      if (s.ranges[i].min) text += fmt::format(", min: {}", *s.ranges[i].min);
      if (s.ranges[i].max) text += fmt::format(", max: {}", *s.ranges[i].max);
      text += fmt::format(", max_speed: {}", s.ranges[i].max_speed_per_s);
      printer.line(fmt::format("{}: {{{}}}", item_key(kind, i), text));
    }
    const auto other = [&](const char* key, const std::optional<ModbusRegister>& one) {
      if (one) printer.line(fmt::format("{}: {{{}}}", key, register_text(*one)));
    };
    other("tool", s.tool);
    other("line", s.line);
    other("spindle", s.spindle);
    other("tool_offset_z", s.tool_offset_z);
    other("trigger", s.trigger);
    if (s.load) {
      printer.line(
          fmt::format("load: {{{}, unit: {}}}", register_text(*s.load), word_of(s.load_unit)));
    }
    other("counter", s.counter);
    other("counter_begun", s.counter_begun);
    printer.close();
  }

  void operator()(const CanSourceOptions& options) const {
    printer.text("interface", options.interface);
    printer.put("receive_buffer_bytes", options.receive_buffer_bytes);
    print_can_map(printer, options.map, kind);
  }

  void operator()(const HalSettings& settings) const {
    printer.put("rate_hz", settings.rate_hz);
    if (!settings.kerf_hal_path.empty()) printer.text("kerf_hal_path", settings.kerf_hal_path);
    if (settings.load) {
      print_load_pin(settings.load->pin, settings.load->unit, settings.load->scale,
                     settings.load->offset);
    }
  }

  void print_load_pin(const std::string& pin, LoadUnit unit, double scale, double offset) const {
    printer.open("map");
    printer.line(fmt::format("load: {{pin: {}, unit: {}, scale: {}, offset: {}}}", quoted(pin),
                             word_of(unit), scale, offset));
    printer.close();
  }

  void operator()(const MtconnectSettings& s) const {
    printer.text("url", s.url);
    if (!s.device.empty()) printer.text("device", s.device);
    printer.put("position", s.commanded ? "commanded" : "actual");
    printer.put("interval_ms", s.interval_ms);
    printer.put("heartbeat_ms", s.heartbeat_ms);
    printer.put("gather_ms", s.gather_ms);
    const auto text_of = [](const ChosenItem& chosen) {
      return fmt::format("item: {}, scale: {}, offset: {}", quoted(chosen.item), chosen.scale,
                         chosen.offset);
    };
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < kMaxPositions; ++i) {
      if (!s.axes[i]) continue;
      lines.push_back(fmt::format("{}: {{{}}}", kAllAxes[i], text_of(*s.axes[i])));
    }
    const auto other = [&](const char* key, const std::optional<ChosenItem>& chosen) {
      if (chosen) lines.push_back(fmt::format("{}: {{{}}}", key, text_of(*chosen)));
    };
    other("tool", s.tool);
    other("line", s.line);
    other("spindle", s.spindle);
    other("tool_offset_z", s.tool_offset_z);
    if (s.load) {
      lines.push_back(
          fmt::format("load: {{{}, unit: {}}}", text_of(*s.load), word_of(s.load_unit)));
    }
    if (lines.empty()) return;
    printer.open("map");
    for (const std::string& line : lines) printer.line(line);
    printer.close();
  }

  void operator()(const LogSettings& settings) const {
    constexpr std::array kFormats{"auto", "recording", "csv", "halsampler", "candump"};
    printer.text("file", settings.path);
    printer.put("format", kFormats[static_cast<std::size_t>(settings.format)]);
    if (!settings.pins.empty()) {
      std::string pins;
      for (const std::string& pin : settings.pins) {
        pins += (pins.empty() ? "" : ", ") + quoted(pin);
      }
      printer.put("pins", "[" + pins + "]");
    }
    if (settings.format == LogFormat::kHalsampler) printer.put("period_s", settings.period_s);
    if (!settings.can_interface.empty()) printer.text("interface", settings.can_interface);
    if (settings.can_map) print_can_map(printer, *settings.can_map, kind);
    if (settings.load) {
      print_load_pin(settings.load->column, settings.load->unit, settings.load->scale,
                     settings.load->offset);
    }
  }
};

bool in_inches(const ConfigSource& source) {
  if (const auto* const hal = std::get_if<HalSettings>(&source)) return hal->mm_per_unit != 1;
  if (const auto* const log = std::get_if<LogSettings>(&source)) return log->unit == LogUnit::kInch;
  return false;
}

void print_source(Printer& printer, const LiveConfig& config) {
  if (std::holds_alternative<std::monostate>(config.source)) return;
  constexpr std::array kTypes{"", "modbus", "can", "hal", "log", "mtconnect"};
  constexpr std::array kGaps{"mark", "cut", "ignore"};
  const ConfigSourceCommon& common = config.common;
  printer.open("source");
  printer.put("type", kTypes[config.source.index()]);
  printer.put("stale_after_ms", milliseconds(common.stale_after_s));
  printer.put("lost_after_ms", milliseconds(common.lost_after_s));
  printer.put("gap", kGaps[static_cast<std::size_t>(common.gap)]);
  if (common.frame) {
    printer.put("frame", *common.frame == CoordinateFrame::kMachine ? "machine" : "workpiece");
  }
  printer.put("units", in_inches(config.source) ? "inch" : "mm");
  if (common.coordinates) {
    printer.put("coordinates", *common.coordinates == CoordinateKind::kAxes ? "axes" : "joints");
  }
  std::visit(SourcePrinter{printer, common.coordinates.value_or(CoordinateKind::kAxes)},
             config.source);
  printer.close();
}

}  // namespace

std::string effective_yaml(const LiveConfig& config) {
  Printer printer;
  print_machine(printer, config.machine);
  print_work(printer, config);
  print_source(printer, config);
  return std::move(printer.out);
}

}  // namespace kerf
