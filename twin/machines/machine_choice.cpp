#include "twin/machines/machine_choice.h"

#include <algorithm>
#include <cmath>

#include "interp_bridge/ini_file.h"

namespace kerf {
namespace {

bool has_axis(const MachineFacts& facts, char letter) {
  return facts.joint_letters.find(letter) != std::string::npos;
}

/// Two joints on X or on Y, as gantries have them.
bool has_double_axis(const std::string& letters) {
  return std::count(letters.begin(), letters.end(), 'X') > 1 ||
         std::count(letters.begin(), letters.end(), 'Y') > 1;
}

bool travels_far(const MachineFacts& facts) {
  return std::any_of(
      facts.limits.axes.begin(), facts.limits.axes.begin() + 2, [](const AxisLimits& axis) {
        const double travel = axis.max - axis.min;
        return axis.present && std::isfinite(travel) && travel > kLongestTableTravel_mm;
      });
}

}  // namespace

MachineFacts machine_facts(const MachineSetup& setup) {
  MachineFacts facts;
  facts.kinematics = setup.kinematics;
  facts.joint_letters = setup.joint_letters;
  facts.limits = setup.timeline.limits;
  Diagnostics said_before;
  Result<IniFile> ini = IniFile::read(setup.interpreter.ini_path, said_before);
  if (!ini) return facts;
  const IniEntry* const display = ini->find("DISPLAY", "DISPLAY");
  facts.is_plasma = ini->has_section("QTPLASMAC") || ini->has_section("PLASMAC") ||
                    (display != nullptr && display->value.find("plasmac") != std::string::npos);
  return facts;
}

MachineKind usual_machine_kind(const MachineFacts& facts) {
  if (facts.is_plasma) return MachineKind::kPlasma;
  if (facts.kinematics == "5axiskins") return MachineKind::kBridgeMill;
  if (facts.kinematics == "maxkins") return MachineKind::kSwivelMill;
  const bool trivial = facts.kinematics.empty() || facts.kinematics == "trivkins";
  const bool tilting = facts.kinematics.find("trt") != std::string::npos;
  if (!trivial && !tilting) return MachineKind::kNone;
  if (!has_axis(facts, 'X') || !has_axis(facts, 'Z')) return MachineKind::kNone;
  if (!has_axis(facts, 'Y')) return MachineKind::kLathe;
  if (has_axis(facts, 'C') && (has_axis(facts, 'A') || has_axis(facts, 'B'))) {
    return MachineKind::kTrunnion;
  }
  if (has_double_axis(facts.joint_letters) || travels_far(facts)) return MachineKind::kGantry;
  return MachineKind::kKneeMill;
}

void check_shapes(const MachineChoice& choice, Diagnostics& diagnostics) {
  if (choice.links) check_shapes(*choice.links, diagnostics);
}

MachineRoom machine_room(const MachineSetup* setup, const WorkpieceFrame& frame,
                         const Box& blank_mm, const Box& reach_mm, double tool_length_mm) {
  MachineRoom room;
  room.blank_mm = blank_mm;
  room.reach_mm = reach_mm;
  room.machine_from_workpiece = machine_from_workpiece(frame);
  room.tool_length_mm = tool_length_mm;
  if (setup == nullptr) return room;
  for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
    const AxisLimits& limits = setup->timeline.limits.axes[axis];
    if (!limits.present || !std::isfinite(limits.min) || !std::isfinite(limits.max)) continue;
    if (limits.min < limits.max) room.travel[axis] = AxisTravel{limits.min, limits.max};
  }
  const MachineKinematics* const machine = setup->timeline.kinematics.get();
  if (machine != nullptr && machine->pivot_length_mm > 0) {
    room.head_pivot_mm = machine->pivot_length_mm;
  }
  room.has_c_axis = setup->joint_letters.find('C') != std::string::npos;
  room.trunnion.tilts_about_y = setup->joint_letters.find('A') == std::string::npos &&
                                setup->joint_letters.find('B') != std::string::npos;
  return room;
}

std::optional<MachineModel> make_machine(const MachineChoice& choice, const MachineFacts& facts,
                                         const MachineRoom& room, Diagnostics& diagnostics) {
  if (choice.links) return linked_machine(*choice.links, room.machine_from_workpiece, diagnostics);
  const MachineKind kind = choice.kind.value_or(usual_machine_kind(facts));
  if (kind == MachineKind::kNone) return std::nullopt;
  return builtin_machine(kind, room);
}

}  // namespace kerf
