#include "twin/cli/live_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/translate.h"
#include "base/units.h"
#include "interp_bridge/ini_file.h"
#include "interp_bridge/parameter_file.h"
#include "machine_io/hal/loaded_file.h"
#include "twin/cli/cutting_options.h"
#include "twin/cli/draw_option.h"
#include "twin/cli/run_options.h"
#include "twin/cli/serve_option.h"
#include "twin/config/make_source.h"

namespace kerf {
namespace {

/// The log to replay, with what the configuration says of its kind.
void understand_log(OptionReader& reader, LiveConfig& config) {
  LogSettings log;
  if (const auto* given = std::get_if<LogSettings>(&config.source)) log = *given;
  // A log of a bus that is watched by the same configuration.
  if (const auto* can = std::get_if<CanSourceOptions>(&config.source)) log.can_map = can->map;
  log.path = reader.text("LOG");
  const std::string pins = reader.text("--pins");
  if (pins.ends_with(".hal")) {
    log.pins = pins_from_hal_file(pins, 0, reader.diagnostics());
  } else if (!pins.empty()) {
    log.pins.clear();
    for (std::size_t at = 0; at <= pins.size();) {
      const std::size_t end = std::min(pins.find(',', at), pins.size());
      log.pins.push_back(pins.substr(at, end - at));
      at = end + 1;
    }
  }
  config.source = std::move(log);
}

double understand_speed(OptionReader& reader) {
  if (reader.text("--speed") == "max") return std::numeric_limits<double>::infinity();
  return reader.number("--speed", 1);
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
    if (request.inch_machine) hal->mm_per_unit = kMmPerInch;
  }
  if (auto* log = std::get_if<LogSettings>(&source)) {
    if (request.inch_machine) log->unit = LogUnit::kInch;
  }
}

void understand_cutting(const ProgramRequest& program, const WorkRequest& work,
                        OptionReader& reader, LiveRequest& request) {
  const LiveConfig& config = request.config;
  LiveCutOptions& cutting = request.options.cutting;
  cutting.timeline = program.timeline;
  cutting.timeline.planner.with_path = work.planned_path;
  cutting.follow = config.follow.options;
  cutting.follow.tolerance_mm = reader.length_mm("--off-path");
  cutting.guard_s = reader.number("--look-ahead");
  cutting.off_path_s = config.follow.off_path_s;
  reader.word("--joined-late", {JoinedLate::kCut, JoinedLate::kKeep}, cutting.joined_late);
  reader.word("--gap", {GapPolicy::kMark, GapPolicy::kCut, GapPolicy::kIgnore}, cutting.gap);
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
  const WorkpieceFrame work = file->frame(index, mm_of_unit(request.inch_machine));
  request.options.cutting.frame.work = work;
  request.options.cutting.work_known = true;
  d.severity = Severity::kNote;
  d.file = request.parameter_path;
  d.message =
      trf("the workpiece lies at {}: X{:.3f} Y{:.3f} Z{:.3f} in the machine",
          kNames[static_cast<std::size_t>(index - 1)], work.g5x_mm.x, work.g5x_mm.y, work.g5x_mm.z);
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

/// A punch strikes where the program says.
void refuse_planned(const WorkRequest& work, OptionReader& reader, LiveOptions& options) {
  if (work.planned_path && work.path_from > ValueFrom::kIni) {
    reader.fault(work.path_from == ValueFrom::kConfig ? "follow.path" : "--path",
                 tr("planned is for cutting; a punch strikes where the program says"));
  }
  options.cutting.timeline.planner.with_path = false;
}

void take_work(WorkRequest work, LiveOptions& options) {
  options.tools = std::move(work.tools);
  options.libraries = std::move(work.libraries);
  options.blank = std::move(work.blank);
  options.stock = work.stock;
  options.margin_mm = work.margin_mm;
  options.cutting.checks.below_mm = work.below_mm;
  options.cutting.checks.spindle_max_rpm = work.spindle_max_rpm;
  options.cutting.timeline.planner.spindle.max_rpm = work.spindle_max_rpm;
  options.cutting.checks.collisions = std::move(work.collisions);
}

/// How fast and how long; and all that is written or shown.
void understand_outlets(OptionReader& reader, LiveRequest& request) {
  LiveOptions& options = request.options;
  options.for_s = reader.number("--for");
  if (reader.command() == kReplay) {
    options.speed = understand_speed(reader);
    understand_log(reader, request.config);
  }
  request.cpu_limit_percent = reader.number("--cpu-limit");
  request.memory_limit_mb = reader.number("--memory-limit");
  request.mesh_tolerance_mm = reader.length_mm("--mesh-tolerance");
  if (reader.command() == kReplay) request.finding_png = reader.text("--finding-png");
  request.record = reader.text("--record");
  request.events = reader.text("--events");
  request.serve = understand_serve(reader);
  request.outputs = understand_outputs(reader);
  request.compare = understand_compare(reader, options.tools);
  check_outline_wishes(options.blank, request.outputs, reader);
  request.quiet = reader.is_yes("--quiet");
  request.draw = understand_draw(reader);
}

/// Beside a LinuxCNC, where nothing else is said: the program that it has loaded.
void understand_loaded(OptionReader& reader, LiveRequest& request) {
  if (!std::holds_alternative<HalSettings>(request.config.source)) return;
  if (request.options.program || reader.is_yes("--ignore-loaded")) return;
  // A recording is of one watch.
  if (!request.record.empty()) {
    Diagnostic d;
    d.severity = Severity::kNote;
    d.message = tr("beside --record the program that LinuxCNC has loaded is not followed");
    reader.diagnostics().push_back(std::move(d));
    return;
  }
  request.kerf_status = find_kerf_status();
  if (request.kerf_status.empty()) {
    Diagnostic d;
    d.severity = Severity::kNote;
    d.message = tr(
        "the program that LinuxCNC has loaded is not followed: kerf-status is not installed (it is "
        "built where linuxcnc-uspace-dev is)");
    d.hint = tr("--program names it");
    reader.diagnostics().push_back(std::move(d));
    return;
  }
  if (request.ini.empty()) return;
  Diagnostics told;  // of the INI, by who has read it before
  Result<IniFile> ini = IniFile::read(request.ini, told);
  if (!ini) return;
  if (const IniEntry* const entry = ini->find("EMC", "NML_FILE")) request.nml_file = entry->value;
}

/// The window in a tab of LinuxCNC's screen.
void understand_tab(OptionReader& reader, LiveRequest& request) {
  const std::string id = reader.text("--embed");
  const bool tells_id = reader.is_yes("--xid");
  if (id.empty() && !tells_id) return;
  const char* const option = tells_id ? "--xid" : "--embed";
  if (!id.empty() && tells_id) {
    reader.fault("--xid", tr("not beside --embed: the window is either put into a tab, or taken"));
    return;
  }
  if (!request.window) {
    reader.fault(option, tr("needs a window, and --no-view (view.window) wants none"));
  }
  if (tells_id && (request.outputs.uses_stdout() || request.events == "-")) {
    reader.fault(option, tr("needs standard output for itself: write to files"));
  }
  request.tab.emplace();
  if (tells_id) return;
  request.tab->parent = window_id_from(id);
  if (!request.tab->parent) {
    reader.fault("--embed", trf("'{}' is no X11 window's id", id),
                 tr("a number as 48234517 or 0x2e00015; in an INI {XID}, for which the screen puts "
                    "it"));
  }
}

}  // namespace

LiveRequest understand_live(const Arguments& a, Diagnostics& diagnostics) {
  LiveRequest request;
  // Without one, the configuration of nothing.
  std::optional<LiveConfig> config =
      read_config(a.options.text("--config"), a.options.texts("--set"), diagnostics);
  if (config) request.config = std::move(*config);
  const ConfigMachine& machine = request.config.machine;
  OptionReader reader(diagnostics, layers_of(a, &request.config));
  request.units = reader.unit();
  request.ini = reader.text("--ini");
  LiveOptions& options = request.options;
  TorchOptions torch;
  options.beam = understand_torch(reader, torch);
  ProgramSurroundings around = surroundings_of(&request.config);
  around.hal_pins = torch.hal_values;
  ProgramRequest program = understand_program("--program", around, reader);
  program.program.torch = std::move(torch);
  request.config.machine.work_offset = program.program.machine.work_offset;
  // With the limits of the machine its corners are known, and the real tool runs through those.
  if (program.timeline.limits_known) reader.ini_says("--path", "planned");
  WorkRequest work = understand_work(&request.config, reader);
  options.turret = understand_turret(reader, program.program);
  // Where the machine stands when it starts the program is seen, not read from its INI.
  program.program.machine.start_known = false;
  program.program.machine.unknown_places = false;
  request.inch_machine = program.program.machine.inch_machine;
  request.joint_letters = program.joint_letters;
  request.config.machine.turning_joints = program.turning_joints;
  request.parameter_path = program.program.machine.parameter_path;
  options.tool_table_path = program.program.tool_table_path;
  options.inch_table = request.inch_machine;
  options.lathe = machine.drawn.kind == MachineKind::kLathe ? tr("machine.model is lathe")
                                                            : program.program.lathe;
  options.as_mill = program.program.as_mill;
  if (!program.program.path.empty()) options.program = program.program;
  reader.word("--on-program-end", {OnProgramEnd::kKeep, OnProgramEnd::kNewBlank}, options.on_end);
  options.more_programs = reader.texts("--next-program");
  if (!options.more_programs.empty() && !options.program) {
    reader.fault("--next-program", tr("needs --program, the first one"));
  }
  options.cutting.program_lengths =
      options.program.has_value() && program.program.machine.tool_lengths;
  options.stale_after_s = request.config.common.stale_after_s;
  options.lost_after_s = request.config.common.lost_after_s;
  understand_cutting(program, work, reader, request);
  if (options.turret) refuse_planned(work, reader, options);
  options.cutting.checks.cutting = understand_spindle_load(reader);
  take_work(std::move(work), options);
  understand_outlets(reader, request);
  adapt_source(request, request.config.source);
  request.needs_window = a.in_window;
  // A log that is run as fast as it goes is there for its report.
  const bool is_shown = reader.text("--no-view") == "yes" && !std::isinf(options.speed);
  request.window = a.in_window || is_shown;
  if (reader.command() == kShadow) {
    understand_loaded(reader, request);
    understand_tab(reader, request);
  }
  check_output_arguments(request.outputs, diagnostics);
  return request;
}

/// What is wanted of the spindle's load, and what the source tells of it.
bool check_load(const LiveRequest& request, const PositionSource& source,
                Diagnostics& diagnostics) {
  const CuttingWish& wish = request.options.cutting.checks.cutting;
  if (!wish.material) return true;
  const std::optional<LoadUnit> unit = load_unit_of(request.config, source);
  Diagnostic d;
  if (!unit) {
    d.severity = Severity::kWarning;
    d.message = trf("--material {}: {} tells no load of the spindle to be held against it",
                    wish.material->name, source.describe());
    d.hint = tr("source.map.load says where it is (docs/beside-a-machine.md)");
    diagnostics.push_back(std::move(d));
    return true;
  }
  const bool by_power = *unit == LoadUnit::kPercentOfPower;
  const bool by_torque = *unit == LoadUnit::kPercentOfTorque || *unit == LoadUnit::kAmperes;
  const char* missing = nullptr;
  if (by_power && wish.spindle_power_kw <= 0) missing = "--spindle-power";
  if (*unit == LoadUnit::kAmperes && wish.spindle_current_a <= 0) missing = "--spindle-current";
  if (by_torque && wish.spindle_torque_nm <= 0) missing = "--spindle-torque";
  if (missing == nullptr) return true;
  d.message =
      trf("the spindle's load comes in {}, and what it is rated for is not known: {} is "
          "needed beside --material",
          word_of(*unit), missing);
  d.hint =
      tr("its nameplate has power and current; torque in Nm is 9549 * kW / rpm of the "
         "nameplate");
  diagnostics.push_back(std::move(d));
  return false;
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
  d.message = tr(
      "where the workpiece lies in the machine is not known: its zero is taken to be that of the "
      "machine");
  d.hint = tr("--ini reads it from the machine's parameter file; --work-offset X,Y,Z gives it");
  diagnostics.push_back(std::move(d));
}

}  // namespace kerf
