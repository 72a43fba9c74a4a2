// machine.kinematics: what the cutter's machine is, where it is no INI's or not as that has it.
#include <fmt/format.h>

#include <array>

#include "base/translate.h"
#include "twin/config/config_reader.h"

namespace kerf {
namespace {

constexpr std::array kKeys{"kinematics",  "follows_tip",   "geometry",
                           "rotary_side", "rotary_center", "told_tool_length"};

std::string module_of(const std::string& kinematics) {
  return kinematics.substr(0, kinematics.find_first_of(" \t"));
}

/// Of keys that mean nothing to these kinematics.
void refuse(const GroupReader& machine, const char* key, const std::string& why) {
  ConfigNode* const node = machine.find(key);
  if (node != nullptr) machine.faults().at_key(*node, tr("has no place here: ") + why);
}

void read_linked(const GroupReader& machine, ConfigNode& node, const ConfigMachine& out,
                 KinematicsRequest& request) {
  for (const char* const key : {"geometry", "rotary_side", "rotary_center"}) {
    refuse(machine, key, tr("the links say where everything is"));
  }
  if (!out.drawn.links) {
    if (!machine.has("links")) {
      machine.faults().at_value(node, tr("there are no links"), tr("machine.links lists them"));
    }
    return;
  }
  LinkedKinematics linked;
  linked.links = out.drawn.links->links_of_chain();
  linked.workpiece_on = out.drawn.links->workpiece_on;
  linked.tool_on = out.drawn.links->tool_on;
  machine.number("follows_tip", linked.follows_tip);
  // What is wrong with single links has been told.
  const bool sound =
      KinematicChain::faults_of(linked.links, linked.workpiece_on, linked.tool_on).empty();
  if (sound) {
    const Result<MachineKinematics> made = kinematics_of_links(linked, out.joints);
    if (!made) machine.faults().at_value(node, made.error());
  }
  request.linked = std::move(linked);
}

void read_geometry(const GroupReader& geometry, const std::string& module,
                   KinematicsGeometry& out) {
  if (!geometry.is_there()) return;
  for (const auto& node : geometry.node()->children) {
    if (node->faulty) continue;
    out[node->key] = node->number;
    if (module.empty()) continue;  // that of the INI, which is not known here
    std::string names;
    bool known = false;
    for (const GeometryPin& pin : geometry_pins(module)) {
      known = known || pin.name == node->key;
      names.append(names.empty() ? "" : ", ").append(pin.name);
    }
    if (known) continue;
    geometry.faults().at_key(*node, names.empty()
                                        ? trf("{} takes no numbers", module)
                                        : trf("is no number of {}; it takes {}", module, names));
  }
}

void read_module(const GroupReader& machine, ConfigNode* node, const ConfigMachine& out,
                 KinematicsRequest& request) {
  refuse(machine, "follows_tip", tr("only `kinematics: links` has it"));
  std::string module;
  if (node != nullptr) {
    request.kinematics = node->scalar;
    const Result<MachineKinematics> made =
        known_machine(node->scalar, out.joints.empty() ? "XYZABC" : out.joints, {}, {});
    if (!made) {
      machine.faults().at_value(*node, made.error());
      return;
    }
    module = module_of(node->scalar);
    if (!takes_rotary_placement(module)) {
      for (const char* const key : {"rotary_side", "rotary_center"}) {
        refuse(machine, key, module + tr(" says what turns, and where"));
      }
    }
  }
  read_geometry(machine.group("geometry"), module, request.geometry);
  if (const int side = machine.word("rotary_side"); side >= 0) {
    request.rotary_side = side == 0 ? RotarySide::kTable : RotarySide::kHead;
  }
  if (machine.find("rotary_center") != nullptr) {
    read_vector(machine, "rotary_center", request.rotary_center_mm.emplace(0.0));
  }
}

}  // namespace

void read_kinematics(const GroupReader& machine, ConfigMachine& out) {
  bool any = false;
  for (const char* const key : kKeys) any = any || machine.find(key) != nullptr;
  if (!any) return;
  KinematicsRequest request;
  ConfigNode* const node = machine.find("kinematics");
  if (node != nullptr && node->scalar == "links") {
    read_linked(machine, *node, out, request);
  } else {
    read_module(machine, node, out, request);
  }
  machine.number("told_tool_length", request.told_tool_mm);
  out.kinematics = std::move(request);
}

}  // namespace kerf
