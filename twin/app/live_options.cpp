#include "twin/app/live_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "interp_bridge/parameter_file.h"
#include "twin/app/draw_option.h"
#include "twin/config/make_source.h"

namespace kerf {
namespace {

constexpr OptionRange kMeshTolerance{0, 1000, false, "mm"};
constexpr OptionRange kSpeed{0, 1e6, true, "times real time"};
constexpr OptionRange kSeconds{0, 1e9, true, "s"};
constexpr OptionRange kLookAhead{0, 3600, false, "s; 0 is off"};
constexpr OptionRange kOffPath{0, 1000, true, "mm"};
constexpr OptionRange kCpuLimit{0, 100, true, "% of one CPU"};
constexpr OptionRange kMemoryLimit{16, 1e6, false, "MB"};

void understand_gap(const std::string& text, OptionReader& reader, GapPolicy& policy) {
  if (text.empty()) return;
  if (text == "mark") {
    policy = GapPolicy::kMark;
  } else if (text == "cut") {
    policy = GapPolicy::kCut;
  } else if (text == "ignore") {
    policy = GapPolicy::kIgnore;
  } else {
    reader.fault("--gap", fmt::format("'{}' is no policy; allowed: mark, cut, ignore", text));
  }
}

void understand_joined_late(const std::string& text, OptionReader& reader, JoinedLate& policy) {
  if (text.empty()) return;
  if (text == "cut") {
    policy = JoinedLate::kCut;
  } else if (text == "keep") {
    policy = JoinedLate::kKeep;
  } else {
    reader.fault("--joined-late", fmt::format("'{}' is no policy; allowed: cut, keep", text));
  }
}

void understand_on_end(const std::string& text, OptionReader& reader, OnProgramEnd& policy) {
  if (text.empty()) return;
  if (text == "keep") {
    policy = OnProgramEnd::kKeep;
  } else if (text == "new-blank") {
    policy = OnProgramEnd::kNewBlank;
  } else {
    reader.fault("--on-program-end",
                 fmt::format("'{}' is no policy; allowed: keep, new-blank", text));
  }
}

/// The log to replay, with what the configuration says of its kind.
void understand_log(const LiveArguments& a, LiveConfig& config, Diagnostics& diagnostics) {
  LogSettings log;
  if (const auto* given = std::get_if<LogSettings>(&config.source)) log = *given;
  // A log of a bus that is watched by the same configuration.
  if (const auto* can = std::get_if<CanSourceOptions>(&config.source)) log.can_map = can->map;
  log.path = a.log;
  if (a.pins.ends_with(".hal")) {
    log.pins = pins_from_hal_file(a.pins, 0, diagnostics);
  } else if (!a.pins.empty()) {
    log.pins.clear();
    for (std::size_t at = 0; at <= a.pins.size();) {
      const std::size_t end = std::min(a.pins.find(',', at), a.pins.size());
      log.pins.push_back(a.pins.substr(at, end - at));
      at = end + 1;
    }
  }
  config.source = std::move(log);
}

double understand_speed(const std::string& text, OptionReader& reader) {
  if (text == "max") return std::numeric_limits<double>::infinity();
  return reader.number("--speed", text, kSpeed, 1);
}

/// The fastest that the axes together can be.
double fastest_mm_per_s(const MachineLimits& limits) {
  double square = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!limits.axes[axis].present) continue;
    square += limits.axes[axis].max_velocity * limits.axes[axis].max_velocity;
  }
  return std::sqrt(square);
}

/// The INI of a running machine says more of it than its pins do.
void adapt_source(const LiveRequest& request, ConfigSource& source) {
  if (auto* hal = std::get_if<HalSettings>(&source)) {
    if (request.inch_machine) hal->mm_per_unit = 25.4;
  }
  if (auto* log = std::get_if<LogSettings>(&source)) {
    if (request.inch_machine) log->unit = LogUnit::kInch;
  }
}

void understand_cutting(const LiveArguments& a, const ProgramRequest& program,
                        const WorkRequest& work, OptionReader& reader, LiveRequest& request) {
  const LiveConfig& config = request.config;
  LiveCutOptions& cutting = request.options.cutting;
  cutting.timeline = program.timeline;
  // With the limits of the machine its corners are known, and the real tool runs through those.
  const bool planned = config.follow.planned_path.value_or(program.timeline.limits_known);
  cutting.timeline.planner.with_path = work.planned_path.value_or(planned);
  cutting.follow = config.follow.options;
  cutting.follow.tolerance_mm =
      reader.length_mm("--off-path", a.off_path, kOffPath, cutting.follow.tolerance_mm);
  cutting.guard_s =
      reader.number("--look-ahead", a.look_ahead, kLookAhead, config.follow.look_ahead_s);
  cutting.off_path_s = config.follow.off_path_s;
  cutting.joined_late = config.follow.joined_late;
  understand_joined_late(a.joined_late, reader, cutting.joined_late);
  cutting.gap = config.common.gap;
  understand_gap(a.gap, reader, cutting.gap);
  if (config.machine.max_mm_per_min) {
    cutting.most_mm_per_s = *config.machine.max_mm_per_min / 60;
  } else if (program.timeline.limits_known) {
    cutting.most_mm_per_s = fastest_mm_per_s(program.timeline.limits);
  }
  if (config.machine.max_mm_per_min) cutting.most.per_s = cutting.most_mm_per_s;
  cutting.most.per_s2 = config.machine.max_mm_per_s2.value_or(0);
  const CanMap* map = nullptr;
  if (const auto* can = std::get_if<CanSourceOptions>(&config.source)) map = &can->map;
  if (const auto* log = std::get_if<LogSettings>(&config.source); log && log->can_map) {
    map = &*log->can_map;
  }
  for (std::size_t i = 0; map && i < kMaxPositions; ++i) {
    if (map->ranges[i].max_speed_per_s) {
      cutting.most.of_position_per_s[i] = *map->ranges[i].max_speed_per_s;
    }
  }
}

/// The work offset that was in force when LinuxCNC last wrote its parameter file.
void read_work_offset(LiveRequest& request, Diagnostics& diagnostics) {
  constexpr std::array<const char*, 9> kNames = {"G54", "G55",   "G56",   "G57",  "G58",
                                                 "G59", "G59.1", "G59.2", "G59.3"};
  const Result<ParameterFile> file = read_parameter_file(request.parameter_path, diagnostics);
  Diagnostic d;
  if (!file) {
    d.message = file.error();
    diagnostics.push_back(std::move(d));
    return;
  }
  const int index = file->work_offset_index();
  const WorkpieceFrame work = file->frame(index, request.inch_machine ? 25.4 : 1.0);
  request.options.cutting.frame.work = work;
  request.options.cutting.work_known = true;
  d.severity = Severity::kNote;
  d.file = request.parameter_path;
  d.message = fmt::format("the workpiece lies at {}: X{:.3f} Y{:.3f} Z{:.3f} in the machine",
                          kNames[static_cast<std::size_t>(index - 1)], work.g5x_mm.x, work.g5x_mm.y,
                          work.g5x_mm.z);
  diagnostics.push_back(std::move(d));
}

/// Joints that are not the axes under other names: what makes axes of them.
void choose_kinematics(LiveRequest& request, const PositionSource& source) {
  LiveCutOptions& cutting = request.options.cutting;
  const std::shared_ptr<const MachineKinematics>& machine = cutting.timeline.kinematics;
  if (!machine || cutting.frame.workpiece_frame ||
      coordinates_of(request.config, source) != CoordinateKind::kJoints) {
    return;
  }
  const KinematicsType plain;
  const bool others =
      std::any_of(machine->types.begin(), machine->types.end(), [&](const KinematicsType& type) {
        return type.mode != plain.mode || type.source != plain.source || type.sign != plain.sign;
      });
  if (machine->belts || others) cutting.frame.kinematics = machine;
}

}  // namespace

LiveRequest understand_live(const LiveArguments& a, LiveCommand command, Diagnostics& diagnostics) {
  LiveRequest request;
  std::optional<LiveConfig> config = read_config(a.config, a.sets, diagnostics);
  if (config) request.config = std::move(*config);
  const ConfigMachine& machine = request.config.machine;
  request.units = understand_units(a.source.units, request.config.units, diagnostics);
  OptionReader reader(diagnostics, request.units);
  ProgramArguments source = a.source;
  const auto complete = [](std::string& given, const std::optional<std::string>& configured) {
    if (given.empty() && configured) given = *configured;
  };
  complete(source.program, request.config.follow.program);
  complete(source.ini, machine.ini);
  complete(source.tool_table, machine.tool_table);
  request.ini = source.ini;
  source.as_mill = source.as_mill || machine.as_mill;
  source.kinematics = machine.kinematics;
  source.joints = machine.joints;
  source.configured_offset = machine.work_offset;
  ProgramRequest program = understand_program(source, reader);
  request.config.machine.work_offset = program.program.machine.work_offset;
  WorkRequest work = understand_work(a.work, reader);
  LiveOptions& options = request.options;
  TorchArguments torch = a.torch;
  complete_torch(request.config, request.units, torch);
  options.beam = understand_torch(torch, reader, program.program.torch);
  options.turret = understand_turret(torch, reader, program.program);
  // Where the machine stands when it starts the program is seen, not read from its INI.
  program.program.machine.start_known = false;
  program.program.machine.unknown_places = false;
  request.inch_machine = program.program.machine.inch_machine;
  request.joint_letters = program.joint_letters;
  request.config.machine.turning_joints = program.turning_joints;
  request.parameter_path = program.program.machine.parameter_path;
  options.tool_table_path = program.program.tool_table_path;
  options.inch_table = request.inch_machine;
  options.lathe =
      machine.drawn.kind == MachineKind::kLathe ? "machine.model is lathe" : program.program.lathe;
  options.as_mill = source.as_mill;
  if (!source.program.empty()) options.program = program.program;
  options.on_end = request.config.follow.on_program_end;
  understand_on_end(a.on_program_end, reader, options.on_end);
  options.more_programs = a.next_programs;
  if (!options.more_programs.empty() && !options.program) {
    reader.fault("--next-program", "needs --program, the first one");
  }
  options.cutting.program_lengths =
      options.program.has_value() && program.program.machine.tool_lengths;
  options.tools = work.tools.empty() ? request.config.tools : std::move(work.tools);
  options.blank = work.blank ? std::move(work.blank) : request.config.stock.blank;
  options.stock = work.stock;
  if (a.work.model.empty()) options.stock.kind = request.config.stock.model;
  if (a.work.cell.empty() && request.config.stock.cell_mm) {
    options.stock.cell_mm = *request.config.stock.cell_mm;
  }
  options.margin_mm = a.work.margin.empty() ? request.config.stock.margin_mm : work.margin_mm;
  options.cutting.checks.below_mm =
      a.work.below.empty() ? request.config.stock.below_mm : work.below_mm;
  options.stale_after_s = request.config.common.stale_after_s;
  options.lost_after_s = request.config.common.lost_after_s;
  understand_cutting(a, program, work, reader, request);
  if (options.turret) {
    constexpr const char* kNot = "planned is for cutting; a punch strikes where the program says";
    if (work.planned_path.value_or(false)) {
      reader.fault("--path", kNot);
    } else if (!work.planned_path && request.config.follow.planned_path.value_or(false)) {
      reader.fault("follow.path", kNot);
    }
    options.cutting.timeline.planner.with_path = false;
  }
  options.for_s = reader.number("--for", a.for_s, kSeconds, 0);
  if (command == LiveCommand::kReplay) {
    options.speed = understand_speed(a.speed, reader);
    understand_log(a, request.config, diagnostics);
  }
  adapt_source(request, request.config.source);
  request.cpu_limit_percent = reader.number("--cpu-limit", a.cpu_limit, kCpuLimit, 0);
  request.memory_limit_mb = reader.number("--memory-limit", a.memory_limit, kMemoryLimit, 0);
  request.mesh_tolerance_mm = reader.length_mm("--mesh-tolerance", a.mesh_tolerance, kMeshTolerance,
                                               request.mesh_tolerance_mm);
  request.record = a.record;
  request.events = a.events;
  request.outputs = a.outputs;
  check_outline_wishes(options.blank, request.outputs, reader);
  request.quiet = a.quiet;
  request.needs_window = a.in_window;
  request.draw = understand_draw(a.draw, reader);
  // A log that is run as fast as it goes is there for its report.
  request.window = a.in_window ||
                   (!a.no_view && request.config.view.window && !std::isinf(request.options.speed));
  check_output_arguments(request.outputs, diagnostics);
  return request;
}

void choose_frame(LiveRequest& request, const PositionSource& source, Diagnostics& diagnostics) {
  LiveCutOptions& cutting = request.options.cutting;
  std::string& joints = request.config.machine.joints;
  if (joints.empty()) joints = request.joint_letters;
  if (joints.empty() && cutting.timeline.kinematics_known) {
    joints = cutting.timeline.kinematics->joint_letters;
  }
  cutting.frame = frame_for(request.config, source);
  choose_kinematics(request, source);
  cutting.work_known = request.config.machine.work_offset.has_value();
  if (cutting.frame.workpiece_frame || cutting.work_known) return;
  if (!request.parameter_path.empty()) {
    // A program says itself which of the offsets it uses.
    if (!request.options.program) read_work_offset(request, diagnostics);
    return;
  }
  Diagnostic d;
  d.severity = Severity::kWarning;
  d.message =
      "where the workpiece lies in the machine is not known: its zero is taken to be that of the "
      "machine";
  d.hint = "--ini reads it from the machine's parameter file; --work-offset X,Y,Z gives it";
  diagnostics.push_back(std::move(d));
}

}  // namespace kerf
