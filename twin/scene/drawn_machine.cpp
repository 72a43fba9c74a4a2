#include "twin/scene/drawn_machine.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>

namespace kerf {
namespace {

/// What is so much longer along Z than it reaches across is held at its end.
constexpr float kBarSlimness = 1.5f;

bool is_same_turn(const glm::dmat3& a, const glm::dmat3& b) {
  constexpr double kSame = 1e-6;
  for (int i = 0; i < 3; ++i) {
    if (glm::length(a[i] - b[i]) > kSame) return false;
  }
  return true;
}

}  // namespace

WorkRoom work_room(const ProgramTrack& track, const Box& blank_mm, double tool_length_mm) {
  WorkRoom room;
  room.frame = track.frame();
  room.blank_mm = blank_mm;
  room.tool_length_mm = tool_length_mm;
  for (std::size_t i = 0; i < track.size(); ++i) room.reach_mm.extend(track.to_mm(i));
  return room;
}

std::optional<ChuckRoom> chuck_room(const HoldingList& held_by) {
  std::optional<ChuckRoom> room;
  for (std::size_t i = 0; held_by && i < held_by->size(); ++i) {
    const Box box = (*held_by)[i].ring.bounds_mm();
    if ((*held_by)[i].kind == HoldingBody::Kind::kChuck)
      room = ChuckRoom{2 * box.max.x, box.size().z, box.max.z};
    if ((*held_by)[i].kind == HoldingBody::Kind::kJaws && room) {
      room->jaw_diameter_mm = 2 * box.max.x;
      room->jaw_length_mm = box.size().z;
    }
  }
  return room;
}

std::shared_ptr<const MachineModel> drawn_machine(const MachineChoice& choice,
                                                  const std::string& ini, const WorkRoom& room,
                                                  Diagnostics& diagnostics) {
  if (ini.empty() && !choice.kind && !choice.links) return nullptr;
  std::optional<MachineSetup> setup;
  MachineFacts facts;
  if (!ini.empty()) {
    Diagnostics said;  // by whoever read it for the program
    MachineSetup read;
    if (read_machine_setup(ini, read, said)) {
      facts = machine_facts(read);
      setup = std::move(read);
    }
  }
  MachineRoom around = machine_room(setup ? &*setup : nullptr, room.frame, room.blank_mm,
                                    room.reach_mm, room.tool_length_mm);
  around.turret = room.turret;
  around.chuck = room.chuck;
  std::optional<MachineModel> model = make_machine(choice, facts, around, diagnostics);
  return model ? std::make_shared<const MachineModel>(std::move(*model)) : nullptr;
}

SceneMachine scene_machine(const MachineModel& model) {
  SceneMachine scene;
  scene.name = model.name;
  for (const LinkShape& link : model.links)
    scene.links.push_back({link.name, link.mesh, link.color});
  return scene;
}

double drawn_height_mm(const ToolShape& shape) {
  float top = 0;
  for (const auto* outline : {&shape.cutter, &shape.shank, &shape.holder}) {
    for (const ProfilePoint& point : *outline) top = std::max(top, point.height_mm);
  }
  for (const ToolPlate& plate : shape.plates) {
    for (const ToolPlate::Corner& corner : plate.corners) top = std::max(top, corner.zx_mm.y);
  }
  return static_cast<double>(top);
}

Vec3 held_from_tip(const ToolShape& shape) {
  glm::vec2 high(0.0f), low(0.0f);
  for (const ToolPlate& plate : shape.plates) {
    for (const ToolPlate::Corner& corner : plate.corners) {
      high = glm::max(high, corner.zx_mm);
      low = glm::min(low, corner.zx_mm);
    }
  }
  if (shape.plates.empty()) return {0, 0, drawn_height_mm(shape)};
  const bool is_bar = high.x > kBarSlimness * std::max(high.y, -low.y);
  return is_bar ? Vec3(0, 0, static_cast<double>(high.x)) : Vec3(static_cast<double>(high.y), 0, 0);
}

double before_turret_mm(const MachineModel& machine) {
  float low = 0;
  if (machine.name != name_of(MachineKind::kLathe)) return 0;
  for (const LinkShape& link : machine.links) {
    if (link.name != "turret" || !link.mesh) continue;
    for (const glm::vec3& p : link.mesh->positions_mm) low = std::min(low, p.z);
  }
  return -static_cast<double>(low);
}

std::vector<glm::mat4> drawn_poses(const MachineModel& machine, const Vec3& tip_mm,
                                   const std::array<double, 3>& abc_deg, double tool_length_mm,
                                   const AxisValues& joints) {
  AxisValues axes{};
  for (int i = 0; i < 3; ++i) {
    axes[static_cast<std::size_t>(i)] = tip_mm[i];
    axes[static_cast<std::size_t>(i) + 3] = abc_deg[static_cast<std::size_t>(i)];
  }
  std::vector<glm::mat4> poses;
  MachinePosition position = position_of_axes(machine, axes, tool_length_mm);
  position.joints = joints;
  link_poses(machine, position, poses);
  return poses;
}

std::vector<glm::mat4> drawn_poses(const MachineModel& machine, const Pose& tool_in_workpiece,
                                   const std::array<double, 3>& abc_deg, double tool_length_mm) {
  AxisValues axes{};
  for (int i = 0; i < 3; ++i) axes[static_cast<std::size_t>(i)] = tool_in_workpiece.origin_mm[i];
  for (unsigned signs = 0; signs < 8; ++signs) {
    for (unsigned i = 0; i < 3; ++i) axes[i + 3] = (signs >> i & 1) != 0 ? -abc_deg[i] : abc_deg[i];
    const auto position = position_of_tip(machine, axes, tool_length_mm);
    if (!position) return {};
    const Pose tool =
        machine.link_from_workpiece.inverse() * machine.chain.workpiece_from_tool(*position);
    if (!is_same_turn(tool.rotation, tool_in_workpiece.rotation)) continue;
    std::vector<glm::mat4> poses;
    link_poses(machine, *position, poses);
    return poses;
  }
  return {};
}

}  // namespace kerf
