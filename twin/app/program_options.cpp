#include "twin/app/program_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <utility>

#include "twin/kinematics/kinematics_setup.h"
#include "twin/machine_setup.h"

namespace kerf {
namespace {

constexpr OptionRange kMaxCommands{1, 1e12, false, "commands"};
constexpr double kFar_mm = 1e6;
constexpr OptionRange kMaxSeconds{0, 1e6, true, "s"};

std::uint16_t turning_joints_of(const MachineKinematics& machine) {
  std::uint16_t joints = 0;
  for (std::size_t i = 0; i < std::min(machine.joint_letters.size(), kAxisCount); ++i) {
    if (machine.turns_joint(i)) joints = static_cast<std::uint16_t>(joints | 1U << i);
  }
  return joints;
}

/// "10,20,-5.5" as mm; nothing if it is not three lengths.
std::optional<Vec3> three_lengths(const std::string& text, LengthUnit unit) {
  Vec3 out{0};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (int i = 0; i < 3; ++i) {
    if (i > 0 && (at == end || *at++ != ',')) return std::nullopt;
    const auto [next, error] = std::from_chars(at, end, out[i]);
    out[i] = to_mm(out[i], unit);
    if (error != std::errc() || !(std::abs(out[i]) <= kFar_mm)) return std::nullopt;
    at = next;
  }
  return at == end ? std::optional(out) : std::nullopt;
}

}  // namespace

std::optional<WorkpieceFrame> understand_work_offset(const ProgramArguments& a,
                                                     OptionReader& reader) {
  if (a.work_offset.empty()) return a.configured_offset;
  const std::optional<Vec3> given = three_lengths(a.work_offset, reader.unit());
  if (!given) {
    reader.fault("--work-offset",
                 fmt::format("'{}' is not allowed; must be X,Y,Z in {}, each from {:g} to {:g}",
                             a.work_offset, name_of(reader.unit()),
                             from_mm(-kFar_mm, reader.unit()), from_mm(kFar_mm, reader.unit())),
                 "as in --work-offset 150,60,-180: the work zero in machine coordinates");
    return a.configured_offset;
  }
  WorkpieceFrame frame = a.configured_offset.value_or(WorkpieceFrame{});
  frame.g5x_mm = *given;
  return frame;
}

ProgramRequest understand_program(const ProgramArguments& a, OptionReader& reader) {
  ProgramRequest request;
  ProgramOptions& options = request.program;
  options.path = a.program;
  options.as_mill = a.as_mill;
  if (!a.ini.empty()) {
    MachineSetup setup;
    KinematicsRequest kinematics = a.kinematics.value_or(KinematicsRequest{});
    kinematics.hal_pins = a.hal_pins;
    read_machine_setup(a.ini, setup, reader.diagnostics(), &kinematics);
    options.machine = std::move(setup.interpreter);
    options.tool_table_path = std::move(setup.tool_table_path);
    options.lathe = std::move(setup.lathe);
    request.timeline = std::move(setup.timeline);
    request.joint_letters = std::move(setup.joint_letters);
    request.turning_joints = setup.turning_joints;
  }
  if (a.ini.empty()) {
    // Where nobody says how: the machine that most people have who turn a part. It lies on a table.
    const bool links = a.kinematics && a.kinematics->linked;
    Result<MachineKinematics> machine =
        kinematics_of_request(a.kinematics.value_or(KinematicsRequest{}),
                              a.joints.empty() && !links ? "XYZABC" : a.joints);
    if (machine) {
      request.timeline.kinematics =
          std::make_shared<const MachineKinematics>(std::move(machine.value()));
      request.timeline.kinematics_known = a.kinematics.has_value();
      if (a.kinematics) {
        request.turning_joints = turning_joints_of(*request.timeline.kinematics);
      }
      for (const char letter : a.joints) {
        const auto axis = std::find(kAxisLetters.begin(), kAxisLetters.end(), letter);
        if (axis == kAxisLetters.end()) continue;
        options.machine.length_axes |= 1 << (axis - kAxisLetters.begin());
      }
    } else {
      reader.fault("machine.kinematics", machine.error());
    }
  }
  options.machine.unknown_places = true;
  options.machine.work_offset = understand_work_offset(a, reader);
  // Home is a place of the machine.
  if (!a.ini.empty() && options.machine.work_offset) options.machine.start_known = true;
  if (!a.tool_table.empty()) options.tool_table_path = a.tool_table;
  if (a.interp == "bridge") {
    options.interpreter = InterpreterChoice::kBridge;
  } else if (a.interp == "text") {
    options.interpreter = InterpreterChoice::kText;
  } else if (!a.interp.empty()) {
    reader.fault("--interp",
                 fmt::format("'{}' is no interpreter; allowed: bridge, text", a.interp));
  }
  options.block_delete = reader.on_off("--block-delete", a.block_delete, options.block_delete);
  if (!a.max_commands.empty()) {
    options.max_commands = static_cast<std::uint64_t>(
        reader.whole_number("--max-commands", a.max_commands, kMaxCommands, 0));
  }
  options.max_silent_s =
      reader.number("--max-seconds", a.max_seconds, kMaxSeconds, options.max_silent_s);
  options.max_cpu_s =
      reader.number("--max-cpu-seconds", a.max_cpu_seconds, kMaxSeconds, options.max_cpu_s);
  return request;
}

}  // namespace kerf
