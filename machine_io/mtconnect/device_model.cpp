#include "machine_io/mtconnect/device_model.h"

#include <algorithm>

#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"

namespace kerf {
namespace {

constexpr std::string_view kLetters = "XYZABCUVW";

/// Of a length in mm, of an angle in degrees; nothing: it is another quantity's, or none.
std::optional<double> scale_of_unit(std::string_view unit, bool is_length) {
  struct Unit {
    std::string_view name;
    bool is_length;
    double scale;
  };
  constexpr Unit kUnits[] = {
      {"MILLIMETER", true, 1},       {"INCH", true, kMmPerInch},    {"CENTIMETER", true, 10},
      {"METER", true, 1000},         {"MICRON", true, 0.001},       {"FOOT", true, 12 * kMmPerInch},
      {"MILLIMETER_3D", true, 1},    {"INCH_3D", true, kMmPerInch}, {"DEGREE", false, 1},
      {"RADIAN", false, kDegPerRad}, {"REVOLUTION", false, 360}};
  for (const Unit& one : kUnits) {
    if (one.name == unit && one.is_length == is_length) return one.scale;
  }
  return std::nullopt;
}

std::optional<std::uint64_t> whole_of(const XmlElement& element, std::string_view key) {
  std::uint64_t value = 0;
  return read_number(element.attribute(key), value) ? std::optional(value) : std::nullopt;
}

/// Limits of the travel, of a Specification in the component's Configuration.
void read_travel(const XmlElement& element, DeviceComponent& out) {
  const bool is_length = out.kind == "Linear";
  const XmlElement* const configuration = element.child("Configuration");
  const XmlElement* const list =
      configuration != nullptr ? configuration->child("Specifications") : nullptr;
  if (list == nullptr) return;
  for (const XmlElement& spec : list->children) {
    const std::string_view type = spec.attribute("type");
    if (type != (is_length ? "POSITION" : "ANGLE")) continue;
    const std::optional<double> scale = scale_of_unit(spec.attribute("units"), is_length);
    if (!scale) continue;
    const auto limit = [&](std::string_view key, std::optional<double>& to) {
      const XmlElement* const found = spec.child(key);
      const std::optional<double> value = found ? parse_decimal(found->text) : std::nullopt;
      if (value) to = *value * *scale;
    };
    limit("Minimum", out.least);
    limit("Maximum", out.most);
  }
}

/// Limits of a data item's values are those of the travel, too, where nothing else says them.
void read_constraints(const XmlElement& element, const DataItem& item, DeviceComponent& out) {
  const XmlElement* const list = element.child("Constraints");
  const bool is_length = out.kind == "Linear";
  const bool is_travel = item.type == (is_length ? "POSITION" : "ANGLE") &&
                         (item.coordinates.empty() || item.coordinates == "MACHINE");
  const std::optional<double> scale = scale_of_unit(item.units, is_length);
  if (list == nullptr || !is_travel || !scale) return;
  const auto limit = [&](std::string_view key, std::optional<double>& to) {
    const XmlElement* const found = list->child(key);
    const std::optional<double> value = found ? parse_decimal(found->text) : std::nullopt;
    if (value && !to) to = *value * *scale;
  };
  limit("Minimum", out.least);
  limit("Maximum", out.most);
}

void read_component(const XmlElement& element, DeviceModel& out) {
  const std::size_t index = out.components.size();
  DeviceComponent component;
  component.kind = element.name;
  component.name = element.attribute("name");
  component.native_name = element.attribute("nativeName");
  read_travel(element, component);
  out.components.push_back(std::move(component));
  if (const XmlElement* const items = element.child("DataItems")) {
    for (const XmlElement& one : items->children) {
      if (one.name != "DataItem" || one.attribute("id").empty()) continue;
      DataItem item;
      item.id = one.attribute("id");
      item.name = one.attribute("name");
      item.type = one.attribute("type");
      item.sub_type = one.attribute("subType");
      item.units = one.attribute("units");
      item.coordinates = one.attribute("coordinateSystem");
      const std::string_view form = one.attribute("representation");
      item.is_plain = form.empty() || form == "VALUE";
      item.component = index;
      read_constraints(one, item, out.components[index]);
      out.items.push_back(std::move(item));
    }
  }
  if (const XmlElement* const components = element.child("Components")) {
    for (const XmlElement& one : components->children) read_component(one, out);
  }
}

DeviceModel read_device(const XmlElement& element) {
  DeviceModel device;
  device.name = element.attribute("name");
  device.uuid = element.attribute("uuid");
  read_component(element, device);
  if (const XmlElement* const description = element.child("Description")) {
    if (const XmlElement* const own = description->child("Kinematics")) {
      device.kinematics = LinuxcncKinematics{std::string(own->attribute("module")),
                                             std::string(own->attribute("params"))};
    }
  }
  return device;
}

void find_error(const XmlElement& element, std::string& out) {
  const std::string_view code = element.attribute("errorCode");
  if (!code.empty() && out.empty()) {
    const XmlElement* const message = element.child("ErrorMessage");
    out = trf("{}: {}", code, message != nullptr ? message->text : element.text);
  }
  for (const XmlElement& child : element.children) find_error(child, out);
}

}  // namespace

Result<AgentHeader> read_agent_header(const XmlElement& root, bool with_sequences) {
  const XmlElement* const element = root.child("Header");
  if (element == nullptr) return Error{tr("the answer has no Header")};
  AgentHeader header;
  header.sender = element->attribute("sender");
  const auto broken = [&](std::string_view key) {
    return Error{
        trf("Header: {} is '{}'", key, std::string(element->attribute(key).substr(0, 40)))};
  };
  const std::optional<std::uint64_t> instance = whole_of(*element, "instanceId");
  if (!instance) return broken("instanceId");
  header.instance = *instance;
  const std::optional<AgentTime> created = parse_agent_time(element->attribute("creationTime"));
  if (!created) return broken("creationTime");
  header.created = *created;
  header.buffer = whole_of(*element, "bufferSize").value_or(0);
  if (!with_sequences) return header;
  const std::optional<std::uint64_t> first = whole_of(*element, "firstSequence");
  const std::optional<std::uint64_t> next = whole_of(*element, "nextSequence");
  if (!first) return broken("firstSequence");
  if (!next) return broken("nextSequence");
  header.first = *first;
  header.next = *next;
  return header;
}

std::optional<std::string> agent_error_of(const XmlElement& root) {
  if (root.name != "MTConnectError") return std::nullopt;
  std::string text;
  find_error(root, text);
  return text.empty() ? std::string(tr("an error without a code")) : text.substr(0, 300);
}

Result<DevicesAnswer> parse_probe(std::string_view text) {
  Result<XmlElement> root = parse_xml(text);
  if (!root) return Error{root.error()};
  if (const std::optional<std::string> error = agent_error_of(*root)) return Error{*error};
  if (root->name != "MTConnectDevices") {
    return Error{trf("a document of {}, and MTConnectDevices is wanted", root->name.substr(0, 60))};
  }
  const Result<AgentHeader> header = read_agent_header(*root, false);
  if (!header) return Error{header.error()};
  DevicesAnswer out;
  out.header = *header;
  if (const XmlElement* const devices = root->child("Devices")) {
    for (const XmlElement& one : devices->children) {
      if (one.name == "Device") out.devices.push_back(read_device(one));
    }
  }
  if (out.devices.empty()) return Error{tr("the agent has no device")};
  return out;
}

Result<const DeviceModel*> choose_device(const DevicesAnswer& probe, const std::string& wanted) {
  std::string names;
  for (const DeviceModel& device : probe.devices) {
    if (!wanted.empty() && (device.name == wanted || device.uuid == wanted)) return &device;
    names += (names.empty() ? "" : ", ") + device.name;
  }
  if (wanted.empty() && probe.devices.size() == 1) return &probe.devices.front();
  if (wanted.empty()) {
    return Error{trf("the agent has {} devices ({}); source.device says which one",
                     probe.devices.size(), names)};
  }
  return Error{trf("the agent has no device {} (source.device); it has {}", wanted, names)};
}

namespace {

/// The axis that a component is: X, by its name or its native name; X1 is X, too.
std::optional<std::size_t> axis_of(const DeviceComponent& component, bool& is_exact) {
  const bool linear = component.kind == "Linear";
  if (!linear && component.kind != "Rotary") return std::nullopt;
  const std::string_view allowed = linear ? "XYZUVW" : "ABC";
  const auto letter_of = [&](const std::string& name, bool exact) -> std::optional<std::size_t> {
    if (name.empty() || allowed.find(to_upper(name[0])) == allowed.npos) return std::nullopt;
    const std::string_view rest = std::string_view(name).substr(1);
    const bool is_number = std::all_of(rest.begin(), rest.end(), is_digit);
    if (exact ? !rest.empty() : !is_number) return std::nullopt;
    return kLetters.find(to_upper(name[0]));
  };
  is_exact = true;
  if (const auto found = letter_of(component.name, true)) return found;
  // A spindle is often C to the standard, and S to its control.
  if (!component.name.empty() || !component.native_name.empty()) {
    if (const auto found = letter_of(component.native_name, true)) return found;
  }
  is_exact = false;
  return letter_of(component.name, false);
}

/// Looks for items, and notes the first fault.
class ItemPlanner {
 public:
  ItemPlanner(const DeviceModel& device, const MtconnectSettings& settings)
      : device_(device), settings_(settings) {}

  Result<ItemPlan> plan() {
    if (settings_.chooses_axes()) {
      choose_axes();
    } else {
      find_axes();
    }
    find_spindle();
    find_rest();
    if (fault_.empty() && plan_.letters().empty()) fault_ = nothing_found();
    if (!fault_.empty()) return Error{std::move(fault_)};
    return std::move(plan_);
  }

 private:
  void fail(std::string text) {
    if (fault_.empty()) fault_ = std::move(text);
  }
  const DeviceComponent& component_of(const DataItem& item) const {
    return device_.components[item.component];
  }

  bool is_position(const DataItem& item, bool is_path) const {
    const std::string& kind = component_of(item).kind;
    const bool fits = is_path
                          ? item.type == "PATH_POSITION"
                          : item.type == "POSITION" || (kind == "Rotary" && item.type == "ANGLE");
    return fits && item.is_plain;
  }
  /// What the standard says where the item does not.
  bool is_wanted_frame(const DataItem& item, bool is_path) const {
    const bool is_work = item.coordinates.empty() ? is_path : item.coordinates == "WORK";
    return is_work == settings_.workpiece;
  }
  bool is_wanted_kind(const DataItem& item) const {
    if (settings_.commanded) return item.sub_type == "COMMANDED";
    return item.sub_type == "ACTUAL" || item.sub_type.empty();
  }

  std::optional<TakenItem> taken(const DataItem& item, bool is_length) {
    const std::optional<double> scale = scale_of_unit(item.units, is_length);
    if (!scale) {
      fail(is_length ? trf("data item {}: '{}' is no unit of a length", item.id, item.units)
                     : trf("data item {}: '{}' is no unit of an angle", item.id, item.units));
      return std::nullopt;
    }
    return TakenItem{item.id, *scale, 0};
  }

  void take_limits(std::size_t axis, const DeviceComponent& component) {
    if (settings_.workpiece) return;
    plan_.least[axis] = component.least;
    plan_.most[axis] = component.most;
  }

  void find_axes() {
    std::array<const DataItem*, kMaxPositions> found{};
    std::array<bool, kMaxPositions> exact{};
    for (const DataItem& item : device_.items) {
      if (!is_position(item, false) || !is_wanted_frame(item, false) || !is_wanted_kind(item)) {
        continue;
      }
      bool is_exact = false;
      const std::optional<std::size_t> axis = axis_of(component_of(item), is_exact);
      if (!axis) continue;
      const DataItem*& slot = found[*axis];
      if (slot != nullptr && slot->component == item.component) continue;
      if (slot != nullptr && exact[*axis] == is_exact) {
        return fail(trf("{} is both {} and {}: source.map.{}.item says which one", kLetters[*axis],
                        component_of(*slot).name, component_of(item).name, kLetters[*axis]));
      }
      if (slot != nullptr && exact[*axis]) continue;
      slot = &item;
      exact[*axis] = is_exact;
    }
    for (std::size_t i = 0; i < kMaxPositions; ++i) {
      if (found[i] == nullptr) continue;
      plan_.axes[i] = taken(*found[i], component_of(*found[i]).kind == "Linear");
      take_limits(i, component_of(*found[i]));
    }
    if (found[0] || found[1] || found[2]) return;
    for (const DataItem& item : device_.items) {
      if (plan_.path_position || !is_position(item, true)) continue;
      if (!is_wanted_frame(item, true) || !is_wanted_kind(item)) continue;
      plan_.path_position = taken(item, true);
    }
  }

  const DataItem* named(const std::string& key, const ChosenItem& chosen) {
    for (const DataItem& item : device_.items) {
      if (item.id == chosen.item || item.name == chosen.item) return &item;
    }
    fail(
        trf("source.map.{}.item: device {} has no data item '{}'", key, device_.name, chosen.item));
    return nullptr;
  }

  void choose_axes() {
    for (std::size_t i = 0; i < kMaxPositions; ++i) {
      if (!settings_.axes[i]) continue;
      const std::string key(1, kLetters[i]);
      const DataItem* const item = named(key, *settings_.axes[i]);
      if (item == nullptr) return;
      const bool is_length = i < 3 || i > 5;
      std::optional<TakenItem> one = taken(*item, is_length);
      if (!one) return;
      one->scale *= settings_.axes[i]->scale;
      one->offset = settings_.axes[i]->offset;
      plan_.axes[i] = std::move(one);
      take_limits(i, component_of(*item));
    }
  }

  void choose(const char* key, const std::optional<ChosenItem>& chosen,
              std::optional<TakenItem>& out) {
    if (!chosen) return;
    if (const DataItem* const item = named(key, *chosen)) {
      out = TakenItem{item->id, chosen->scale, chosen->offset};
    }
  }

  /// The first of these types, of the first of these sub types that there is.
  const DataItem* first(std::initializer_list<std::string_view> types,
                        std::initializer_list<std::string_view> sub_types) const {
    for (const std::string_view type : types) {
      for (const std::string_view sub_type : sub_types) {
        for (const DataItem& item : device_.items) {
          if (item.type == type && item.sub_type == sub_type && item.is_plain) return &item;
        }
      }
    }
    return nullptr;
  }

  void find_spindle() {
    choose("spindle", settings_.spindle, plan_.spindle);
    if (settings_.spindle) return;
    const DataItem* const item = first({"ROTARY_VELOCITY", "SPINDLE_SPEED"}, {"ACTUAL", ""});
    // Revolutions per minute are all that the standard has.
    if (item == nullptr || item->units != "REVOLUTION/MINUTE") return;
    plan_.spindle = TakenItem{item->id, 1, 0};
    for (const DataItem& other : device_.items) {
      if (other.component == item->component && other.type == "DIRECTION") {
        plan_.direction = other.id;
      }
    }
  }

  void find_rest() {
    choose("load", settings_.load, plan_.load);
    choose("tool_offset_z", settings_.tool_offset_z, plan_.tool_offset_z);
    const auto id_of = [](const DataItem* item) { return item ? item->id : std::string(); };
    const auto plain = [](const DataItem* item) {
      return item ? std::optional(TakenItem{item->id, 1, 0}) : std::nullopt;
    };
    choose("tool", settings_.tool, plan_.tool);
    if (!settings_.tool) plan_.tool = plain(first({"TOOL_NUMBER", "TOOL_ID"}, {""}));
    choose("line", settings_.line, plan_.line);
    if (!settings_.line) {
      plan_.line = plain(first({"LINE_NUMBER", "LINE"}, {"ACTUAL", "ABSOLUTE", ""}));
    }
    plan_.execution = id_of(first({"EXECUTION"}, {""}));
    plan_.mode = id_of(first({"CONTROLLER_MODE"}, {""}));
    plan_.availability = id_of(first({"AVAILABILITY"}, {""}));
    for (const DataItem& item : device_.items) {
      // Of others it may be any offset; of LinuxCNC it is the one that is applied.
      if (device_.kinematics && item.type == "TOOL_OFFSET" && !settings_.tool_offset_z) {
        plan_.tool_offsets = item.id;
      }
    }
  }

  /// What there is instead of the positions that are wanted.
  std::string nothing_found() const {
    bool actual = false, commanded = false, machine = false, work = false;
    for (const DataItem& item : device_.items) {
      const bool is_path = item.type == "PATH_POSITION";
      if (!is_position(item, is_path)) continue;
      (item.sub_type == "COMMANDED" ? commanded : actual) = true;
      const bool is_work = item.coordinates.empty() ? is_path : item.coordinates == "WORK";
      (is_work ? work : machine) = true;
    }
    std::string text =
        trf("device {} tells no {} positions in {} coordinates", device_.name,
            settings_.commanded ? "commanded" : "actual", settings_.workpiece ? "WORK" : "MACHINE");
    if (settings_.workpiece ? machine : work) {
      text += trf("; source.frame: {} takes those that it has",
                  settings_.workpiece ? "machine" : "workpiece");
    } else if (settings_.commanded ? actual : commanded) {
      text += trf("; source.position: {} takes those that it has",
                  settings_.commanded ? "actual" : "commanded");
    }
    return text;
  }

  const DeviceModel& device_;
  const MtconnectSettings& settings_;
  ItemPlan plan_;
  std::string fault_;
};

}  // namespace

std::string ItemPlan::letters() const {
  std::string text;
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if (!axes[i] && !(path_position && i < 3)) continue;
    if (!text.empty()) text += ' ';
    text += kLetters[i];
  }
  return text;
}

Result<ItemPlan> plan_items(const DeviceModel& device, const MtconnectSettings& settings) {
  return ItemPlanner(device, settings).plan();
}

}  // namespace kerf
