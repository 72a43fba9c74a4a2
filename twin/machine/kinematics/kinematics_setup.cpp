#include "twin/machine/kinematics/kinematics_setup.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text_scan.h"
#include "base/translate.h"
#include "twin/machine/kinematics/hal_facts.h"
#include "twin/machine/kinematics/tool_path.h"

namespace kerf {
namespace {

std::string join(const std::vector<std::string>& items) {
  std::string out;
  for (const std::string& item : items) out += (out.empty() ? "" : ", ") + item;
  return out;
}

/// Pins of the modules that take the tool's length.
std::string tool_pin(std::string_view module) {
  if (module == "xyzac-trt-kins" || module == "xyzbc-trt-kins") return "tool-offset";
  if (module == "xyzab_tdr_kins") return "tool-offset-z";
  // The tool lengthens the way from the pivot to the controlled point.
  if (module == "5axiskins") return "pivot-length";
  return {};
}

bool is_angle(std::string_view pin) { return pin.rfind("ALPHA", 0) == 0; }

/// Numbers of the module's pins with where they are from.
class GeometrySearch {
 public:
  /// Error: a number is given that the module does not take.
  static Done check(std::string_view module, const KinematicsGeometry& given) {
    std::vector<std::string> names;
    for (const GeometryPin& pin : geometry_pins(module)) names.push_back(pin.name);
    for (const auto& [pin, value] : given) {
      if (std::find(names.begin(), names.end(), pin) != names.end()) continue;
      return Error{trf("'{}' is no number of {}; {}", pin, module,
                       names.empty() ? tr("it takes none") : tr("it takes ") + join(names))};
    }
    return std::monostate{};
  }

  GeometrySearch(std::string_view module, const KinematicsRequest& request)
      : module_(module),
        pins_(geometry_pins(module)),
        geometry_(request.geometry),
        hal_pins_(request.hal_pins) {
    for (const auto& [pin, value] : request.geometry) {
      given_.push_back(fmt::format("{} {:g}", pin, value));
    }
  }

  void search(const HalFacts& hal, double unit_mm) {
    for (const GeometryPin& pin : pins_) {
      if (geometry_.count(pin.name) != 0) continue;
      const std::string full = fmt::format("{}.{}", module_, pin.name);
      if (const auto told = hal_pins_.find(to_lower(full)); told != hal_pins_.end()) {
        geometry_[pin.name] = is_angle(pin.name) ? told->second : told->second * unit_mm;
        given_.push_back(fmt::format("{} {:g}", pin.name, geometry_[pin.name]));
        continue;
      }
      const HalValue value = hal.value_of(full);
      // A part that nobody knows: better all of it as the module has it.
      if (value.is_set && (value.from.empty() || !value.has_tool_length)) {
        geometry_[pin.name] = is_angle(pin.name) ? value.number : value.number * unit_mm;
        from_hal_.push_back(fmt::format("{} {:g}", pin.name, geometry_[pin.name]));
      } else if (!value.from.empty()) {
        elsewhere_.push_back(trf("{} (from {})", pin.name, join(value.from)));
      }
    }
  }

  /// All of it in mm; what nobody sets is in units of the machine, too.
  KinematicsGeometry complete(double unit_mm) const {
    KinematicsGeometry all = geometry_;
    for (const GeometryPin& pin : pins_) {
      all.try_emplace(pin.name, is_angle(pin.name) ? pin.standard : pin.standard * unit_mm);
    }
    return all;
  }

  void tell(std::vector<std::string>& notes) const {
    if (pins_.empty()) return;
    std::vector<std::string> standard;
    for (const GeometryPin& pin : pins_) {
      if (geometry_.count(pin.name) == 0) {
        standard.push_back(fmt::format("{} {:g}", pin.name, pin.standard));
      }
    }
    std::string text;
    const auto add = [&](const char* origin, const std::vector<std::string>& items) {
      if (items.empty()) return;
      text += (text.empty() ? "" : "; ") + fmt::format("{}: {}", origin, join(items));
    };
    add(tr("as told"), given_);
    add(tr("from HAL"), from_hal_);
    add(tr("as the module has them"), standard);
    add(tr("set by a running program, not known"), elsewhere_);
    notes.push_back(trf("{}, geometry {}", module_, text));
  }

 private:
  std::string module_;
  std::vector<GeometryPin> pins_;
  KinematicsGeometry geometry_;
  std::map<std::string, double> hal_pins_;
  std::vector<std::string> given_, from_hal_, elsewhere_;
};

/// Which analog output switches the kinematics.
void find_switch(const HalFacts& hal, MachineKinematics& machine) {
  if (!machine.is_switchable() || !hal.known()) return;
  constexpr std::string_view kOutput = "motion.analog-out-0";
  for (const std::string& pin : hal.linked_with("motion.switchkins-type")) {
    if (pin.rfind(kOutput, 0) != 0 || pin.size() != kOutput.size() + 1) continue;
    machine.switch_output = static_cast<unsigned>(pin.back() - '0');
    return;
  }
  const std::string name = machine.types.front().name;
  machine.types.resize(1);
  machine.notes = {
      trf("no net ties an analog output to motion.switchkins-type in the HAL files: the "
          "kinematics stay {}",
          name)};
}

void find_tool(const HalFacts& hal, MachineKinematics& machine) {
  const bool follows =
      std::any_of(machine.types.begin(), machine.types.end(),
                  [](const KinematicsType& type) { return type.mode == KinematicsMode::kTip; });
  if (!follows) return;
  const std::string pin = tool_pin(machine.module);
  if (pin.empty()) {
    machine.told_tool_mm = 0;  // it has no way to know
    return;
  }
  if (!hal.known()) {
    machine.notes.push_back(trf("{} is taken to be told the tool's length", machine.module));
    return;
  }
  const HalValue value = hal.value_of(machine.module + "." + pin);
  if (value.has_tool_length) return;
  const bool pivot = pin == "pivot-length";
  machine.told_tool_mm = value.is_set && !pivot ? value.number : 0.0;
  machine.notes.push_back(trf(
      "motion.tooloffset.z is not netted to {}.{}: the tip of a tool with a length (G43) moves off "
      "its place when the machine turns",
      machine.module, pin));
}

void tell_quill(MachineKinematics& machine) {
  const bool simple = machine.types.front().mode == KinematicsMode::kAxes;
  // corexykins has all nine joints, whether there is a W or not.
  if (!simple || machine.belts || !machine.chain.is_driven_by(8)) return;
  machine.notes.push_back(
      trf("{} does not say what W slides: taken for a quill that carries the tool along Z",
          machine.module));
}

void tell_side(const KinematicsRequest& request, const RotaryPlacement& placement,
               MachineKinematics& machine) {
  const bool open = machine.types.front().mode == KinematicsMode::kAxes &&
                    !machine.is_switchable() && machine.turns();
  tell_quill(machine);
  if (!open || request.rotary_side) return;
  const Vec3& c = placement.center_mm;
  machine.notes.push_back(
      trf("{} does not say what A, B and C turn: taken for a table that turns about lines "
          "through X{:g} Y{:g} Z{:g} (machine coordinates)",
          machine.module, c.x, c.y, c.z));
}

RotaryPlacement placement_of(const KinematicsRequest& request) {
  return {request.rotary_side.value_or(RotarySide::kTable),
          request.rotary_center_mm.value_or(Vec3(0.0))};
}

std::string_view first_word(std::string_view text) {
  return text.substr(0, text.find_first_of(" \t"));
}

/// X, Y and Z of the axes that drive links, and what else does; all nine where joints do.
std::string letters_of(const std::vector<ChainLink>& links) {
  std::string letters;
  for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
    const bool drives = std::any_of(links.begin(), links.end(), [&](const ChainLink& link) {
      return link.joint != JointKind::kFixed && (link.by_joint || link.input == axis);
    });
    if (drives) letters += kAxisLetters[axis];
  }
  return letters;
}

}  // namespace

bool takes_rotary_placement(std::string_view module) {
  const auto machine = known_machine(module, "XYZ", {}, {});
  return machine && machine->types.front().mode == KinematicsMode::kAxes &&
         geometry_pins(module).empty();
}

Result<MachineKinematics> kinematics_of_links(const LinkedKinematics& linked,
                                              std::string_view joint_letters) {
  Result<KinematicChain> rest =
      KinematicChain::create(linked.links, linked.workpiece_on, linked.tool_on);
  if (!rest) return Error{rest.error()};
  // A link of its own: no name of the file's may be that.
  std::vector<ChainLink> links = linked.links;
  ChainLink zero;
  zero.name = linked.workpiece_on + " (zero)";
  while (rest->find(zero.name)) zero.name += '\'';
  zero.parent = linked.workpiece_on;
  zero.origin_mm = rest->workpiece_from_tool({}).origin_mm;
  links.push_back(zero);
  Result<KinematicChain> chain = KinematicChain::create(links, zero.name, linked.tool_on);
  if (!chain) return Error{chain.error()};
  MachineKinematics machine;
  machine.module = "links";
  machine.joint_letters = joint_letters.empty() ? letters_of(links) : std::string(joint_letters);
  machine.chain = std::move(chain.value());
  KinematicsType type;
  type.name = "links";
  type.mode = linked.follows_tip ? KinematicsMode::kTip : KinematicsMode::kAxes;
  machine.types.push_back(type);
  if (const Result<ToolPath> path = ToolPath::create(machine, {}, {}); !path) {
    return Error{path.error()};
  }
  if (linked.follows_tip && !machine.position_of({}, 0)) {
    return Error{
        tr("the links do not slide along three directions: X, Y and Z cannot follow the tip")};
  }
  return machine;
}

Result<MachineKinematics> kinematics_of_ini(IniFile& ini, const std::string& folder,
                                            std::string_view joint_letters, double unit_mm,
                                            const KinematicsRequest& request) {
  if (request.linked) return kinematics_of_links(*request.linked, joint_letters);
  std::string kinematics = request.kinematics;
  if (kinematics.empty()) {
    const IniEntry* const entry = ini.find("KINS", "KINEMATICS");
    kinematics = entry != nullptr ? entry->value : "trivkins";
  }
  if (const Done known = GeometrySearch::check(first_word(kinematics), request.geometry); !known) {
    return Error{known.error()};
  }
  const HalFacts hal(ini, folder);
  GeometrySearch search(first_word(kinematics), request);
  search.search(hal, unit_mm);
  const RotaryPlacement placement = placement_of(request);
  Result<MachineKinematics> machine =
      known_machine(kinematics, joint_letters, search.complete(unit_mm), placement);
  if (!machine) return machine;
  find_switch(hal, *machine);
  find_tool(hal, *machine);
  if (machine->told_tool_mm) *machine->told_tool_mm *= unit_mm;
  if (request.told_tool_mm) machine->told_tool_mm = request.told_tool_mm;
  search.tell(machine->notes);
  tell_side(request, placement, *machine);
  return machine;
}

Result<MachineKinematics> kinematics_of_request(const KinematicsRequest& request,
                                                std::string_view joint_letters) {
  if (request.linked) return kinematics_of_links(*request.linked, joint_letters);
  const RotaryPlacement placement = placement_of(request);
  Result<MachineKinematics> machine =
      known_machine(request.kinematics.empty() ? "trivkins" : request.kinematics, joint_letters,
                    request.geometry, placement);
  if (!machine) return machine;
  if (const Done known = GeometrySearch::check(machine->module, request.geometry); !known) {
    return Error{known.error()};
  }
  GeometrySearch(machine->module, request).tell(machine->notes);
  if (request.told_tool_mm) machine->told_tool_mm = request.told_tool_mm;
  tell_side(request, placement, *machine);
  return machine;
}

}  // namespace kerf
