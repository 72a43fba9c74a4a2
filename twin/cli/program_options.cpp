#include "twin/cli/program_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <utility>

#include "base/text_scan.h"
#include "base/translate.h"
#include "interp_bridge/record_cache.h"
#include "twin/config/setting_table.h"
#include "twin/machine/kinematics/kinematics_setup.h"
#include "twin/machine/machine_setup.h"

namespace kerf {
namespace {

constexpr double kFar_mm = 1e6;

std::uint16_t turning_joints_of(const MachineKinematics& machine) {
  std::uint16_t joints = 0;
  for (std::size_t i = 0; i < std::min(machine.joint_letters.size(), kAxisCount); ++i) {
    if (machine.turns_joint(i)) joints = static_cast<std::uint16_t>(joints | 1U << i);
  }
  return joints;
}

/// Without an INI: the machine that most people have who turn a part, which lies on a table; or
/// what a configuration says.
void choose_machine(const ProgramSurroundings& around, OptionReader& reader,
                    ProgramRequest& request) {
  const bool links = around.kinematics && around.kinematics->linked;
  Result<MachineKinematics> machine =
      kinematics_of_request(around.kinematics.value_or(KinematicsRequest{}),
                            around.joints.empty() && !links ? "XYZABC" : around.joints);
  if (!machine) {
    reader.fault("machine.kinematics", machine.error());
    return;
  }
  request.timeline.kinematics =
      std::make_shared<const MachineKinematics>(std::move(machine.value()));
  request.timeline.kinematics_known = around.kinematics.has_value();
  if (around.kinematics) {
    request.turning_joints = turning_joints_of(*request.timeline.kinematics);
  }
  for (const char letter : around.joints) {
    const auto axis = std::find(kAxisLetters.begin(), kAxisLetters.end(), letter);
    if (axis == kAxisLetters.end()) continue;
    request.program.machine.length_axes |= 1 << (axis - kAxisLetters.begin());
  }
}

void read_ini(const std::string& path, const ProgramSurroundings& around, OptionReader& reader,
              ProgramRequest& request) {
  MachineSetup setup;
  KinematicsRequest kinematics = around.kinematics.value_or(KinematicsRequest{});
  kinematics.hal_pins = around.hal_pins;
  read_machine_setup(path, setup, reader.diagnostics(), &kinematics);
  request.program.machine = std::move(setup.interpreter);
  request.program.lathe = std::move(setup.lathe);
  request.timeline = std::move(setup.timeline);
  request.joint_letters = std::move(setup.joint_letters);
  request.turning_joints = setup.turning_joints;
  // What LinuxCNC takes for no limit (1e99) is none.
  const double most_rpm = setting_of("--spindle-max", kRun).most;
  if (setup.spindle_max_rpm > 0 && setup.spindle_max_rpm <= most_rpm)
    reader.ini_says("--spindle-max", number_text(setup.spindle_max_rpm));
  if (!setup.tool_table_path.empty()) {
    reader.ini_says("--tool-table", std::move(setup.tool_table_path));
  }
}

}  // namespace

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

std::optional<WorkpieceFrame> understand_work_offset(const ProgramSurroundings& around,
                                                     OptionReader& reader) {
  const ChosenValue offset = reader.choose("--work-offset");
  if (offset.from != ValueFrom::kCommandLine) return around.configured_offset;
  const std::optional<Vec3> given = three_lengths(offset.text, reader.unit());
  if (!given) {
    reader.fault("--work-offset",
                 trf("'{}' is not allowed; must be X,Y,Z ({}), each from {:g} to {:g}", offset.text,
                     name_of(reader.unit()), from_mm(-kFar_mm, reader.unit()),
                     from_mm(kFar_mm, reader.unit())),
                 tr("as in --work-offset 150,60,-180: the work zero in machine coordinates"));
    return around.configured_offset;
  }
  WorkpieceFrame frame = around.configured_offset.value_or(WorkpieceFrame{});
  frame.g5x_mm = *given;
  return frame;
}

ProgramRequest understand_program(std::string_view program, const ProgramSurroundings& around,
                                  OptionReader& reader) {
  ProgramRequest request;
  ProgramOptions& options = request.program;
  const std::string ini = reader.text("--ini");
  if (ini.empty()) {
    choose_machine(around, reader, request);
  } else {
    read_ini(ini, around, reader, request);
  }
  request.timeline.planner.spindle.accel_rpm_per_s = reader.number("--spindle-accel");
  options.path = reader.text(program);
  options.as_mill = reader.is_yes("--as-mill");
  options.machine.unknown_places = true;
  options.machine.work_offset = understand_work_offset(around, reader);
  // Home is a place of the machine.
  if (!ini.empty() && options.machine.work_offset) options.machine.start_known = true;
  options.tool_table_path = reader.text("--tool-table");
  reader.word("--interp", {InterpreterChoice::kBridge, InterpreterChoice::kText},
              options.interpreter);
  options.block_delete = reader.on_off("--block-delete");
  options.interp_fast = reader.on_off("--interp-fast");
  if (reader.on_off("--interp-cache")) options.cache_folder = record_cache_folder();
  options.cache_bytes = static_cast<std::uint64_t>(reader.whole_number("--interp-cache-size"))
                        << 20;
  if (reader.choose("--max-commands").is_said()) {
    options.max_commands = static_cast<std::uint64_t>(reader.whole_number("--max-commands"));
  }
  options.max_silent_s = reader.number("--max-seconds", options.max_silent_s);
  options.max_cpu_s = reader.number("--max-cpu-seconds", options.max_cpu_s);
  return request;
}

}  // namespace kerf
