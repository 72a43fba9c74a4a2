#include "twin/config/config_reader.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <utility>

#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

void read_work_offset(const GroupReader& offset, ConfigMachine& machine) {
  if (!offset.is_there()) return;
  WorkpieceFrame frame;
  offset.number("x", frame.g5x_mm.x);
  offset.number("y", frame.g5x_mm.y);
  offset.number("z", frame.g5x_mm.z);
  offset.number("rotation", frame.rotation_deg);
  offset.number("a", frame.offset_abc_deg[0]);
  offset.number("b", frame.offset_abc_deg[1]);
  offset.number("c", frame.offset_abc_deg[2]);
  offset.number("u", frame.offset_uvw_mm.x);
  offset.number("v", frame.offset_uvw_mm.y);
  offset.number("w", frame.offset_uvw_mm.z);
  machine.work_offset = frame;
}

void read_joints(const GroupReader& machine, std::string& joints) {
  ConfigNode* const node = machine.find("joints");
  if (node == nullptr) return;
  const std::string letters = to_upper(node->scalar);
  if (letters.size() > kMaxPositions || letters.find_first_not_of(kAllAxes) != letters.npos) {
    machine.faults().at_value(*node,
                              trf("'{}' is not allowed; must be 1 to {} letters of {}, one a joint",
                                  node->scalar, kMaxPositions, kAllAxes),
                              tr("XYZ: joint 0 moves X, joint 1 Y, joint 2 Z"));
    return;
  }
  joints = letters;
}

void read_ignored(const GroupReader& machine, std::vector<NamedPair>& out) {
  const ConfigNode* const list = machine.find("ignore");
  if (list == nullptr) return;
  for (const auto& pair : list->children)
    out.push_back({pair->children[0]->scalar, pair->children[1]->scalar});
}

/// Sections as holders have them.
void read_spindle(const GroupReader& machine, ConfigMachine& out) {
  ConfigNode* const node = machine.find("spindle");
  if (node == nullptr) return;
  const Result<Cutter> carrier =
      parse_shape(fmt::format("flat:1:flute=1:holder={}", trim(node->scalar)));
  if (!carrier || contains(node->scalar, ":")) {
    machine.faults().at_value(
        *node,
        trf("'{}' is not allowed; must be sections from the nose upward, DxL[+DxL..]",
            shown(node->scalar)),
        tr("as in 80x60+120x100: 80 mm wide for 60 mm, 120 mm wide above"));
    return;
  }
  out.spindle_spec = std::string(trim(node->scalar));
  const double nose_mm = carrier->holder().front().from_z_mm;
  for (const ToolSection& section : carrier->holder()) {
    out.spindle.push_back(
        {section.diameter_mm, section.from_z_mm - nose_mm, section.to_z_mm - nose_mm});
  }
}

void read_holding(const GroupReader& machine, WorkHolding& out) {
  if (ConfigNode* const node = machine.find("chuck")) {
    const Result<ChuckSpec> chuck = parse_chuck(node->scalar);
    if (chuck) {
      out.chuck = *chuck;
    } else {
      machine.faults().at_value(*node, chuck.error());
    }
  }
  if (ConfigNode* const node = machine.find("tailstock")) {
    const Result<TailstockSpec> tailstock = parse_tailstock(node->scalar);
    if (tailstock) {
      out.tailstock = *tailstock;
    } else {
      machine.faults().at_value(*node, tailstock.error());
    }
  }
}

void read_machine(const GroupReader& machine, ConfigMachine& out) {
  out.ini = machine.path("ini");
  out.tool_table = machine.path("tool_table");
  machine.number("as_mill", out.as_mill);
  read_joints(machine, out.joints);
  read_work_offset(machine.group("work_offset"), out);
  constexpr std::array kFrom{ToolLengthFrom::kAuto, ToolLengthFrom::kSource,
                             ToolLengthFrom::kProgram, ToolLengthFrom::kTable,
                             ToolLengthFrom::kNone};
  if (const int word = machine.word("tool_length"); word >= 0) {
    out.tool_length = kFrom[static_cast<std::size_t>(word)];
  }
  machine.number("tool", out.tool);
  machine.number("max_speed_mm_per_min", out.max_mm_per_min);
  machine.number("max_acceleration_mm_per_s2", out.max_mm_per_s2);
  read_drawn_machine(machine, out.drawn);
  machine.number("spindle_accel", out.spindle_accel_rpm_per_s);
  machine.number("collisions", out.collisions);
  read_ignored(machine, out.ignore);
  read_spindle(machine, out);
  read_holding(machine, out.holding);
  machine.number("spindle_max_rpm", out.spindle_max_rpm);
  machine.number("spindle_power_kw", out.spindle_power_kw);
  machine.number("spindle_torque_nm", out.spindle_torque_nm);
  machine.number("spindle_current_a", out.spindle_current_a);
  read_kinematics(machine, out);
}

/// Why it cannot be used (with the model, if one is asked for); empty: it can.
std::string trouble_with(const ToolShapeArgument& tool,
                         const std::vector<ToolShapeArgument>& others,
                         std::optional<StockKind> model) {
  if (tool.tool == 0) return tr("tool 0 is the empty spindle; numbers begin at 1");
  for (const ToolShapeArgument& other : others) {
    if (other.tool == tool.tool) return trf("tool {} is given twice", tool.tool);
  }
  if (const Done fit = can_be_cut(model, tool.cutter); !fit) return fit.error();
  return {};
}

void read_tools(const GroupReader& tools, std::optional<StockKind> model,
                std::vector<ToolShapeArgument>& out) {
  if (!tools.is_there()) return;
  for (const auto& node : tools.node()->children) {
    if (node->faulty) continue;
    Result<ToolShapeArgument> tool =
        parse_tool_argument(fmt::format("{}={}", node->key, resolved_shape(*node, tools.faults())));
    const std::string trouble = tool ? trouble_with(*tool, out, model) : tool.error();
    if (trouble.empty()) {
      out.push_back(std::move(tool.value()));
    } else {
      tools.faults().at_value(*node, fmt::format("'{}': {}", shown(node->scalar), trouble));
    }
  }
}

void read_fixtures(const GroupReader& root, std::vector<FixtureSpec>& out) {
  ConfigNode* const list = root.find("fixtures");
  if (list == nullptr) return;
  for (const auto& element : list->children) {
    if (element->faulty) continue;
    const GroupReader group(element.get(), root.faults());
    group.missing("shape", tr("a shape, as --fixture has it"));
    ConfigNode* const shape = group.find("shape");
    if (shape == nullptr) continue;
    std::string text(trim(shape->scalar));
    for (const std::string_view prefix : {"stl:", "obj:", "3mf:", "step:"}) {
      const std::string resolved = resolved_spec(*shape, prefix, root.faults());
      if (resolved != text) text = resolved;
      if (to_lower(text.substr(0, prefix.size())) == prefix) {
        const std::string_view file = trim(shape->scalar).substr(prefix.size());
        note_mesh_outside(*shape, std::string(trim(file.substr(0, file.find(':')))), root.faults());
      }
    }
    Result<FixtureSpec> spec = parse_fixture(text);
    if (!spec) {
      root.faults().at_value(*shape, spec.error());
      continue;
    }
    if (const auto name = group.text("name")) spec->name = *name;
    read_vector(group, "at", spec->at_mm);
    group.number("turn", spec->turn_deg);
    group.number("in_blank", spec->in_blank);
    group.number("clearance_mm", spec->clearance_mm);
    if (const auto on = group.text("on")) spec->on = *on;
    out.push_back(std::move(spec.value()));
  }
}

void read_clearances(const GroupReader& root, std::vector<PairClearance>& out) {
  ConfigNode* const list = root.find("clearances");
  if (list == nullptr) return;
  for (const auto& element : list->children) {
    if (element->faulty) continue;
    const GroupReader group(element.get(), root.faults());
    group.missing("pair", tr("two names, [a, b]"));
    group.missing("mm", tr("a length"));
    ConfigNode* const pair = group.find("pair");
    if (pair == nullptr) continue;
    if (pair->children.size() != 2) {
      root.faults().at_value(*pair, tr("must be two names, [a, b]"));
      continue;
    }
    PairClearance clearance{{pair->children[0]->scalar, pair->children[1]->scalar}};
    group.number("mm", clearance.mm);
    out.push_back(std::move(clearance));
  }
}

void read_tool_libraries_key(const GroupReader& root, std::vector<std::string>& out) {
  const ConfigNode* const list = root.find("tool_libraries");
  if (list == nullptr) return;
  for (const auto& file : list->children) {
    if (file->faulty) continue;
    // N=FILE
    const std::size_t digits = file->scalar.find_first_not_of("0123456789");
    const bool has_number =
        digits != 0 && digits != file->scalar.npos && file->scalar[digits] == '=';
    const std::size_t name = has_number ? digits + 1 : 0;
    out.push_back(file->scalar.substr(0, name) +
                  resolved_path(*file, file->scalar.substr(name), root.faults()));
  }
}

void read_stock(const GroupReader& stock, ConfigStock& out) {
  // The words of the key table: auto, then the models in their order.
  if (const int word = stock.word("model"); word > 0) {
    out.model = stock_models()[static_cast<std::size_t>(word) - 1].kind;
  }
  stock.number("cell_mm", out.cell_mm);
  stock.number("margin_mm", out.margin_mm);
  stock.number("below_mm", out.below_mm);
  ConfigNode* const node = stock.find("blank");
  if (node == nullptr) return;
  std::string spec = resolved_spec(*node, "state:", stock.faults());
  Result<Blank> blank = parse_blank(spec);
  if (blank && blank->sheet && !blank->sheet->file.empty()) {
    spec = resolved_spec(*node, "sheet:", stock.faults());
    blank = parse_blank(spec);
  }
  if (blank && blank->mesh) {
    const std::size_t colon = spec.find(':');
    const std::string word = to_lower(trim(spec.substr(0, colon)));
    const bool has_word = colon != std::string::npos && !spec.substr(0, colon).empty() &&
                          (word == "stl" || word == "obj" || word == "3mf" || word == "step");
    spec = resolved_spec(*node, has_word ? word + ":" : "", stock.faults());
    blank = parse_blank(spec);
  }
  if (blank && !blank->profile_file.empty()) {
    spec = resolved_spec(*node, "profile:", stock.faults());
    blank = parse_blank(spec);
  }
  if (!blank) {
    stock.faults().at_value(*node, blank.error());
    return;
  }
  out.blank = std::move(blank.value());
  out.blank_spec = spec;
}

void read_beam(const GroupReader& beam, ConfigBeam& out) {
  beam.number("kerf_mm", out.kerf_mm);
  beam.number("pierce_mm", out.pierce_mm);
  beam.number("slats_mm", out.slats_mm);
  beam.number("density_kg_per_m3", out.density_kg_per_m3);
  out.qtplasmac = beam.text("qtplasmac");
  out.materials = beam.path("materials");
  ConfigNode* const node = beam.find("trigger");
  if (node == nullptr) return;
  const Result<BeamTrigger> trigger = BeamTrigger::parse(node->scalar);
  if (trigger) {
    out.trigger = node->scalar;
  } else {
    beam.faults().at_value(*node, trigger.error());
  }
}

/// What a torch is told has no place beside a punch.
void read_turret_key(const GroupReader& root, LiveConfig& config) {
  config.turret = root.path("turret");
  const GroupReader beam = root.group("beam");
  if (!config.turret || !beam.is_there()) return;
  for (const auto& child : beam.node()->children) {
    if (child->faulty || child->key == "density_kg_per_m3") continue;
    root.faults().at_key(*child, tr("is for torches, lasers and jets; turret punches"));
  }
}

void read_follow(const GroupReader& follow, ConfigFollow& out) {
  out.program = follow.path("program");
  if (const int word = follow.word("path"); word >= 0) out.planned_path = word == 1;
  follow.number("off_path_mm", out.options.tolerance_mm);
  follow.number("off_path_s", out.off_path_s);
  if (const int word = follow.word("joined_late"); word >= 0) {
    out.joined_late = word == 1 ? JoinedLate::kKeep : JoinedLate::kCut;
  }
  follow.number("look_ahead_s", out.look_ahead_s);
  if (const int word = follow.word("on_program_end"); word >= 0) {
    out.on_program_end = word == 1 ? OnProgramEnd::kNewBlank : OnProgramEnd::kKeep;
  }
}

}  // namespace

ConfigNode* GroupReader::find(std::string_view key) const {
  ConfigNode* const node = group_ == nullptr ? nullptr : group_->child(key);
  return node == nullptr || node->faulty ? nullptr : node;
}

bool GroupReader::has(std::string_view key) const {
  return group_ != nullptr && group_->child(key) != nullptr;
}

GroupReader GroupReader::group(std::string_view key) const { return {find(key), faults_}; }

void GroupReader::seconds(std::string_view key, double& out_s) const {
  if (const ConfigNode* const node = find(key)) out_s = node->number / 1000;
}

std::optional<std::string> GroupReader::text(std::string_view key) const {
  const ConfigNode* const node = find(key);
  return node == nullptr ? std::nullopt : std::optional(node->scalar);
}

std::optional<std::string> GroupReader::path(std::string_view key) const {
  const ConfigNode* const node = find(key);
  return node == nullptr ? std::nullopt
                         : std::optional(resolved_path(*node, node->scalar, faults_));
}

int GroupReader::word(std::string_view key) const {
  const ConfigNode* const node = find(key);
  return node == nullptr ? -1 : static_cast<int>(node->number);
}

void GroupReader::missing(std::string_view key, const std::string& what, std::string hint) const {
  if (group_ == nullptr || has(key)) return;
  faults_.at_key(*group_, trf("{} is missing; must be {}", key, what), std::move(hint));
}

std::string resolved_path(const ConfigNode& node, const std::string& path,
                          const ConfigFaults& faults) {
  if (node.from_set || path.empty() || path.front() == '/' || path == "-") return path;
  const std::filesystem::path folder = std::filesystem::path(faults.text().path()).parent_path();
  return folder.empty() ? path : (folder / path).string();
}

void note_mesh_outside(const ConfigNode& node, const std::string& file, ConfigFaults& faults) {
  namespace fs = std::filesystem;
  if (node.from_set || file.empty()) return;
  std::error_code none;
  const fs::path folder =
      fs::absolute(fs::path(faults.text().path()), none).parent_path().lexically_normal();
  const fs::path way = (folder / file).lexically_normal().lexically_relative(folder);
  if ((!way.empty() && *way.begin() != "..") || !faults.first_outside()) return;
  faults.note_at_value(
      node, trf("'{}' lies outside of this file's folder: who copies that has no such mesh", file),
      tr("a copy beside the configuration goes with it"));
}

std::string resolved_spec(const ConfigNode& node, std::string_view prefix,
                          const ConfigFaults& faults) {
  const std::string_view text = trim(node.scalar);
  if (to_lower(text.substr(0, prefix.size())) != prefix) return std::string(text);
  const std::string file(trim(text.substr(prefix.size())));
  return std::string(prefix) + resolved_path(node, file, faults);
}

std::string resolved_shape(const ConfigNode& node, const ConfigFaults& faults) {
  constexpr std::string_view kHolder = ":holder=profile:";
  std::string spec = resolved_spec(node, "profile:", faults);
  const std::size_t at = to_lower(spec).find(kHolder);
  if (at == spec.npos) return spec;
  const std::size_t file = at + kHolder.size();
  return spec.substr(0, file) + resolved_path(node, spec.substr(file), faults);
}

void read_workshop(const GroupReader& root, LiveConfig& config) {
  if (const int word = root.word("units"); word >= 0) {
    config.units = word == 1 ? LengthUnit::kInch : LengthUnit::kMm;
  }
  read_machine(root.group("machine"), config.machine);
  read_stock(root.group("stock"), config.stock);
  read_tools(root.group("tools"), config.stock.model, config.tools);
  read_fixtures(root, config.fixtures);
  root.number("clearance_mm", config.clearance_mm);
  read_clearances(root, config.clearances);
  root.number("cut_by_shank", config.cut_by_shank);
  read_tool_libraries_key(root, config.tool_libraries);
  read_beam(root.group("beam"), config.beam);
  read_turret_key(root, config);
  config.material = root.text("material");
  if (ConfigNode* const node = root.find("material")) {
    // FILE:NAME, beside the configuration.
    const std::size_t colon = node->scalar.rfind(':');
    if (colon != node->scalar.npos && colon > 0) {
      config.material = resolved_path(*node, node->scalar.substr(0, colon), root.faults()) +
                        node->scalar.substr(colon);
    }
  }
  read_follow(root.group("follow"), config.follow);
  const GroupReader view = root.group("view");
  view.number("window", config.view.window);
  view.number("keyframes_mb", config.view.keyframes_mb);
}

}  // namespace kerf
