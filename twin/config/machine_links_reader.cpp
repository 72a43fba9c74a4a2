// machine.model and machine.links: the machine that is drawn.
#include <fmt/format.h>

#include <array>

#include "base/text_scan.h"
#include "base/translate.h"
#include "twin/config/config_reader.h"

namespace kerf {
namespace {

void read_color(const GroupReader& group, std::uint32_t& out) {
  ConfigNode* const node = group.find("color");
  if (node == nullptr) return;
  const std::string_view text = node->scalar;
  std::uint32_t value = 0;
  const bool sized = (text.size() == 7 || text.size() == 9) && text[0] == '#';
  if (!sized || !read_number(text.substr(1), value, 16)) {
    group.faults().at_value(
        *node, trf("'{}' is not allowed; must be #RRGGBB or #RRGGBBAA", shown(node->scalar)),
        tr("in quotes, as '#' begins a comment: \"#8090a0\""));
    return;
  }
  if (text.size() == 7) value = value << 8U | 0xffU;
  // Red comes first in the text, and last (lowest) in the viewer's colours.
  out = (value >> 24U) | (value >> 8U & 0xff00U) | (value << 8U & 0xff0000U) | (value << 24U);
}

void read_joint(const GroupReader& group, ChainLink& link) {
  ConfigNode* const node = group.find("axis");
  ConfigNode* const moves = group.find("moves");
  if (node == nullptr) {
    for (const char* const key : {"moves", "direction"}) {
      ConfigNode* const alone = group.find(key);
      if (alone != nullptr && !group.has("axis")) {
        group.faults().at_key(*alone,
                              tr("has no place in a link without axis, which does not move"));
      }
    }
    return;
  }
  const int axis = axis_of_item(node->scalar);
  const int joint = joint_of_item(node->scalar);
  if (axis < 0 && joint < 0) {
    group.faults().at_value(*node, trf("'{}' is not allowed; must be one of X, Y, Z, A, B, "
                                       "C, U, V, W or J0 to J8",
                                       shown(node->scalar)));
    return;
  }
  link.by_joint = axis < 0;
  link.input = static_cast<std::uint8_t>(link.by_joint ? joint : axis);
  const bool turns = moves != nullptr
                         ? moves->number == 1
                         : !link.by_joint && is_rotary_axis(static_cast<std::size_t>(axis));
  link.joint = turns ? JointKind::kRotary : JointKind::kPrismatic;
  link.direction = Vec3(0.0);
  if (!link.by_joint) link.direction[axis % 3] = 1.0;
  if (link.by_joint) group.missing("direction", tr("three numbers, x,y,z"));
  read_vector(group, "direction", link.direction);
}

LinkSpec read_link(const GroupReader& group) {
  LinkSpec link;
  group.missing("name", "a text");
  link.chain.name = group.text("name").value_or("");
  link.chain.parent = group.text("parent").value_or("");
  read_joint(group, link.chain);
  read_vector(group, "origin", link.chain.origin_mm);
  if (ConfigNode* const mesh = group.find("mesh")) {
    const Result<Blank> shape = parse_blank(mesh->scalar);
    if (shape && !need_to_turn(*shape).empty()) {
      group.faults().at_value(*mesh, tr("bars and profiles are no shapes of a machine; a box is"),
                              tr("a file is named by stl: FILE"));
    } else if (shape && !shape->bodies.empty()) {
      link.bodies = shape->bodies;
      link.bodies_spec = mesh->scalar;
    } else {
      group.faults().at_value(*mesh,
                              shape ? shape->sheet
                                          ? tr("'sheet:' is no shape of a machine; a box is")
                                          : tr("'state:' is no shape of a machine")
                                    : shape.error(),
                              tr("a file is named by stl: FILE"));
    }
  }
  link.stl_path = group.path("stl").value_or("");
  if (const ConfigNode* const stl = group.find("stl"))
    note_mesh_outside(*stl, stl->scalar, group.faults());
  if (group.word("stl_units") == 1) link.mm_per_unit = kMmPerInch;
  read_vector(group, "stl_offset", link.mesh_offset_mm);
  for (const char* const key : {"stl_units", "stl_offset"}) {
    ConfigNode* const alone = group.find(key);
    if (alone != nullptr && !group.has("stl")) {
      group.faults().at_key(*alone, tr("has no place in a link without stl"));
    }
  }
  read_color(group, link.color);
  return link;
}

/// Where a fault of the chain stands in the file: at the key, or else at the link.
void report_fault(const GroupReader& machine, const ChainFault& fault) {
  using Field = ChainFault::Field;
  constexpr std::array<const char*, 5> kKeys{"name", "parent", "direction", "workpiece_on",
                                             "tool_on"};
  const char* const key = kKeys[static_cast<std::size_t>(fault.field)];
  const bool of_link = fault.field < Field::kWorkpiece;
  ConfigNode* const group =
      of_link ? machine.find("links")->children[fault.link].get() : machine.node();
  if (ConfigNode* const node = group->child(key)) {
    if (!node->faulty) machine.faults().at_value(*node, fault.message);
  } else if (fault.field == Field::kDirection) {
    machine.faults().at_value(*group, fault.message);
  }  // a name, workpiece_on or tool_on that is missing has been reported
}

void read_links(const GroupReader& machine, ConfigNode& list, LinkedMachine& out) {
  bool sound = true;
  for (const auto& element : list.children) {
    sound = sound && !element->faulty;
    if (element->faulty) continue;
    out.links.push_back(read_link({element.get(), machine.faults()}));
    for (const auto& node : element->children) sound = sound && !node->faulty;
    sound = sound && !element->faulty;
  }
  machine.missing("workpiece_on", tr("the name of a link"));
  machine.missing("tool_on", tr("the name of a link"));
  out.workpiece_on = machine.text("workpiece_on").value_or("");
  out.tool_on = machine.text("tool_on").value_or("");
  // The chain of links of which some could not be read would be said to have faults of its own.
  if (!sound) return;
  for (const ChainFault& fault :
       KinematicChain::faults_of(out.links_of_chain(), out.workpiece_on, out.tool_on)) {
    report_fault(machine, fault);
  }
}

}  // namespace

void read_vector(const GroupReader& group, std::string_view key, Vec3& out) {
  ConfigNode* const node = group.find(key);
  if (node == nullptr) return;
  const std::vector<std::string_view> parts = split(node->scalar, ',');
  Vec3 read(0.0);
  bool good = parts.size() == 3;
  for (std::size_t i = 0; good && i < 3; ++i) {
    const std::optional<double> value = parse_decimal(trim(parts[i]));
    good = value.has_value();
    if (good) read[static_cast<int>(i)] = *value;
  }
  if (good) {
    out = read;
    return;
  }
  group.faults().at_value(
      *node, trf("'{}' is not allowed; must be three numbers, x,y,z", shown(node->scalar)),
      tr("as in 0,0,-120.5"));
}

void read_drawn_machine(const GroupReader& machine, MachineChoice& out) {
  // In the order of the key table.
  constexpr std::array kWords{
      MachineKind::kNone,  MachineKind::kKneeMill,   MachineKind::kGantry,
      MachineKind::kLathe, MachineKind::kTrunnion,   MachineKind::kPlasma,
      MachineKind::kPunch, MachineKind::kBridgeMill, MachineKind::kSwivelMill};
  if (const int word = machine.word("model"); word >= 0)
    out.kind = kWords[static_cast<std::size_t>(word)];
  ConfigNode* const links = machine.find("links");
  if (links == nullptr) {
    for (const char* const key : {"workpiece_on", "tool_on"}) {
      ConfigNode* const alone = machine.find(key);
      if (alone != nullptr && !machine.has("links")) {
        machine.faults().at_key(*alone, tr("has no place without links"));
      }
    }
    return;
  }
  if (ConfigNode* const model = machine.find("model")) {
    machine.faults().at_key(*model, tr("has no place beside links"));
  }
  if (links->children.empty()) {
    machine.faults().at_value(*links, tr("is empty; a machine has at least one link"));
    return;
  }
  read_links(machine, *links, out.links.emplace());
}

}  // namespace kerf
