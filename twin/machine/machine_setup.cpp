#include "twin/machine/machine_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <string_view>

#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"
#include "interp_bridge/ini_file.h"
#include "twin/machine/kinematics/kinematics_setup.h"
#include "twin/machine/kinematics/rotary_checks.h"
#include "twin/machine/kinematics/tool_path.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

/// Reads values of an INI and reports what is wrong with them.
class IniReader {
 public:
  IniReader(IniFile& ini, Diagnostics& diagnostics) : ini_(ini), diagnostics_(diagnostics) {}
  Diagnostics& diagnostics() { return diagnostics_; }

  std::string text(const std::string& section, const char* key) {
    const IniEntry* const entry = ini_.find(section, key);
    return entry != nullptr ? entry->value : std::string();
  }

  /// Absent: nothing. Not a number, or not above `least`: an error.
  std::optional<double> number(const std::string& section, const char* key,
                               std::optional<double> above = {}) {
    const IniEntry* const entry = ini_.find(section, key);
    if (entry == nullptr || entry->value.empty()) return std::nullopt;
    // LinuxCNC reads the number in front and passes over what follows.
    const std::string& value = entry->value;
    const bool plus = value[0] == '+';
    double result = 0;
    const char* const begin = value.data() + (plus ? 1 : 0);
    const auto [end, error] = std::from_chars(begin, value.data() + value.size(), result);
    const bool ends = end == value.data() + value.size() || *end == ' ' || *end == '\t' ||
                      *end == '#' || *end == ';';
    if (error != std::errc() || !ends || !std::isfinite(result)) {
      fault(*entry, fmt::format("[{}]{}: '{}' is not a number", section, key, value));
      return std::nullopt;
    }
    if (above && !(result > *above)) {
      fault(*entry, fmt::format("[{}]{}: {} is not allowed; must be above {:g}", section, key,
                                value, *above));
      return std::nullopt;
    }
    return result;
  }

  void fault(const IniEntry& entry, std::string message, std::string hint = {},
             Severity severity = Severity::kError) {
    Diagnostic d;
    d.severity = severity;
    d.file = entry.file < ini_.files().size() ? ini_.files()[entry.file] : std::string();
    d.line = entry.line;
    d.column = entry.value_column;
    d.excerpt = entry.excerpt;
    d.message = std::move(message);
    d.hint = std::move(hint);
    diagnostics_.push_back(std::move(d));
  }

  IniFile& file() { return ini_; }

 private:
  IniFile& ini_;
  Diagnostics& diagnostics_;
};

/// mm in one unit of the machine. [TRAJ]LINEAR_UNITS: mm, inch and their other names, or units per
/// mm.
double read_unit_mm(IniReader& reader) {
  const IniEntry* const entry = reader.file().find("TRAJ", "LINEAR_UNITS");
  if (entry == nullptr) return 1;
  const std::string& value = entry->value;
  if (value == "mm" || value == "metric") return 1;
  if (value == "inch" || value == "in" || value == "imperial") return kMmPerInch;
  if (const auto per_mm = reader.number("TRAJ", "LINEAR_UNITS", 0.0)) {
    if (std::abs(*per_mm - 1) < 1e-3) return 1;
    if (std::abs(*per_mm - 1 / kMmPerInch) < 1e-3) return kMmPerInch;
    reader.fault(*entry, fmt::format("[TRAJ]LINEAR_UNITS: {} is neither mm nor inch", value));
  }
  return 1;
}

/// The letter of every joint, in order: "XYZ", "XYYZ" for a gantry.
std::string read_joint_letters(IniReader& reader, std::string& kinematics) {
  const std::string words = reader.text("KINS", "KINEMATICS");
  kinematics = words.substr(0, words.find_first_of(" \t"));
  std::string letters;
  const auto mark = words.find("coordinates=");
  const std::string from = mark != words.npos ? words.substr(mark + 12) : "";
  for (const char c : from.substr(0, from.find_first_of(" \t"))) {
    letters += to_upper(c);
  }
  if (!letters.empty()) return letters;
  for (const char c : reader.text("TRAJ", "COORDINATES")) {
    const char upper = to_upper(c);
    if (std::find(kAxisLetters.begin(), kAxisLetters.end(), upper) != kAxisLetters.end()) {
      letters += upper;
    }
  }
  return letters.empty() ? "XYZ" : letters;
}

/// [JOINT_n]TYPE; `otherwise`: of a joint whose type the INI does not say.
bool joint_turns(IniReader& reader, std::size_t joint, bool otherwise) {
  const IniEntry* const type = reader.file().find(fmt::format("JOINT_{}", joint), "TYPE");
  return type != nullptr ? type->value == "ANGULAR" : otherwise;
}

/// `joint` < 0: it says nothing of the axis.
std::optional<double> axis_number(IniReader& reader, char letter, int joint, const char* key,
                                  std::optional<double> above = {}) {
  if (auto value = reader.number(fmt::format("AXIS_{}", letter), key, above)) return value;
  if (joint < 0) return std::nullopt;
  return reader.number(fmt::format("JOINT_{}", joint), key, above);
}

void read_axes(IniReader& reader, const std::string& letters, double unit_mm, MachineSetup& setup) {
  MachineLimits& limits = setup.timeline.limits;
  limits = MachineLimits{};
  setup.interpreter.axis_mask = 0;
  for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
    const char letter = kAxisLetters[axis];
    const std::size_t joint = letters.find(letter);
    if (joint == letters.npos) continue;
    const bool turns = is_rotary_axis(axis);
    const int n = joint_turns(reader, joint, turns) == turns ? static_cast<int>(joint) : -1;
    const double unit = turns ? 1 : unit_mm;
    AxisLimits& out = limits.axes[axis];
    out.present = true;
    setup.interpreter.axis_mask |= 1 << axis;
    setup.interpreter.length_axes |= 1 << axis;
    if (const auto value = axis_number(reader, letter, n, "MIN_LIMIT")) out.min = *value * unit;
    if (const auto value = axis_number(reader, letter, n, "MAX_LIMIT")) out.max = *value * unit;
    // What LinuxCNC takes where the INI has no such key: 1 unit/s, 1 unit/s2.
    out.max_velocity = axis_number(reader, letter, n, "MAX_VELOCITY", 0.0).value_or(1) * unit;
    out.max_acceleration =
        axis_number(reader, letter, n, "MAX_ACCELERATION", 0.0).value_or(1) * unit;
    const auto home = reader.number(fmt::format("JOINT_{}", joint), "HOME");
    setup.interpreter.start[axis] = home.value_or(0) * unit;
  }
}

void read_planner(IniReader& reader, double unit_mm, MachineLimits& limits) {
  const auto scaled = [&](const char* key, double scale, double& out) {
    const auto value = reader.number("TRAJ", key, 0.0);
    if (value) out = *value * scale;
    return value.has_value();
  };
  if (!scaled("MAX_LINEAR_VELOCITY", unit_mm, limits.max_linear_velocity_mm_per_s)) {
    scaled("MAX_VELOCITY", unit_mm, limits.max_linear_velocity_mm_per_s);
  }
  scaled("MAX_ANGULAR_VELOCITY", 1, limits.max_angular_velocity_deg_per_s);
  scaled("MAX_LINEAR_ACCELERATION", unit_mm, limits.max_linear_acceleration_mm_per_s2);
  scaled("ARC_BLEND_RAMP_FREQ", 1, limits.arc_blend_ramp_hz);
  scaled("ARC_BLEND_KINK_RATIO", 1, limits.arc_blend_kink_ratio);
  if (const auto v = reader.number("TRAJ", "ARC_BLEND_ENABLE")) limits.arc_blend = *v != 0;
  if (const auto v = reader.number("TRAJ", "ARC_BLEND_FALLBACK_ENABLE")) {
    limits.arc_blend_fallback = *v != 0;
  }
  if (const auto v = reader.number("TRAJ", "ARC_BLEND_OPTIMIZATION_DEPTH", 0.0)) {
    limits.arc_blend_depth = static_cast<int>(std::min(*v, 1000.0));
  }
  if (const auto v = reader.number("TRAJ", "ARC_BLEND_GAP_CYCLES")) {
    limits.arc_blend_gap_cycles = static_cast<int>(std::clamp(*v, 0.0, 1000.0));
  }
  if (const auto v = reader.number("EMCMOT", "SERVO_PERIOD", 0.0))
    limits.servo_period_s = *v * 1e-9;
  if (const auto v = reader.number("EMCIO", "CYCLE_TIME", 0.0)) limits.io_period_s = *v;
  if (const auto v = reader.number("TASK", "CYCLE_TIME", 0.0)) limits.task_period_s = *v;
}

/// An existing file that a key names; a fault of `severity` if it is missing.
std::string read_path(IniReader& reader, const char* section, const char* key,
                      const std::string& folder, Severity severity) {
  const IniEntry* const entry = reader.file().find(section, key);
  if (entry == nullptr || entry->value.empty()) return {};
  std::string path = resolve_ini_path(entry->value, folder);
  std::error_code error;
  if (fs::is_regular_file(path, error)) return path;
  reader.fault(*entry,
               fmt::format("[{}]{}: cannot read {}: {}", section, key, path,
                           error ? error.message() : tr("No such file or directory")),
               severity == Severity::kWarning
                   ? tr("work offsets count as 0, and limits are not checked")
                   : "",
               severity);
  return {};
}

/// Keys of the sections that say what a program does, as LinuxCNC 2.9 knows them, besides those
/// that are asked for above. The interpreter reads those of RS274NGC; the others do not matter to a
/// dry run.
constexpr std::array<std::string_view, 50> kKnownKeys = {
    "TRAJ.ANGULAR_UNITS",
    "TRAJ.AXES",
    "TRAJ.CYCLE_TIME",
    "TRAJ.DEFAULT_ACCELERATION",
    "TRAJ.DEFAULT_ANGULAR_ACCELERATION",
    "TRAJ.DEFAULT_ANGULAR_VELOCITY",
    "TRAJ.DEFAULT_LINEAR_ACCELERATION",
    "TRAJ.DEFAULT_LINEAR_VELOCITY",
    "TRAJ.DEFAULT_VELOCITY",
    "TRAJ.HOME",
    "TRAJ.HOMEMOD",
    "TRAJ.MAX_ACCELERATION",
    "TRAJ.MAX_ANGULAR_ACCELERATION",
    "TRAJ.NO_FORCE_HOMING",
    "TRAJ.NO_PROBE_HOME_ERROR",
    "TRAJ.NO_PROBE_JOG_ERROR",
    "TRAJ.POSITION_FILE",
    "TRAJ.SPINDLES",
    "TRAJ.TPMOD",
    "KINS.JOINTS",
    "EMCIO.EMCIO",
    "EMCIO.TOOL_CHANGE_AT_G30",
    "EMCIO.TOOL_CHANGE_QUILL_UP",
    "EMCIO.TOOL_CHANGE_WITH_SPINDLE_ON",
    "RS274NGC.CENTER_ARC_RADIUS_TOLERANCE_INCH",
    "RS274NGC.CENTER_ARC_RADIUS_TOLERANCE_MM",
    "RS274NGC.DISABLE_FANUC_STYLE_SUB",
    "RS274NGC.DISABLE_G92_PERSISTENCE",
    "RS274NGC.FEATURES",
    "RS274NGC.HAL_PIN_VARS",
    "RS274NGC.INI_VARS",
    "RS274NGC.LOG_FILE",
    "RS274NGC.LOG_LEVEL",
    "RS274NGC.NO_DOWNCASE_OWORD",
    "RS274NGC.ON_ABORT_COMMAND",
    "RS274NGC.ORIENT_OFFSET",
    "RS274NGC.OWORD_NARGS",
    "RS274NGC.OWORD_WARNONLY",
    "RS274NGC.PARAMETER_G73_PECK_CLEARANCE",
    "RS274NGC.PARAMETER_G83_PECK_CLEARANCE",
    "RS274NGC.PYTHON_TASK",
    "RS274NGC.REMAP",
    "RS274NGC.RETAIN_G43",
    "RS274NGC.SUBROUTINE_PATH",
    "RS274NGC.USER_M_PATH",
    "RS274NGC.WIZARD_ROOT",
    "EMCIO.DEBUG",
    "TRAJ.COORDINATES",
    "TRAJ.ARC_BLEND_SMOOTHING_THRESHOLD",
    "RS274NGC.USER_DEFINED_FUNCTION_MAX_DIRS"};

/// [EMCIO]TOOL_CHANGE_POSITION, in machine units; mm and degrees. LinuxCNC takes three, six or nine
/// numbers with blanks between them, and nothing else.
void read_tool_change_position(IniReader& reader, double unit_mm, std::vector<double>& position) {
  const IniEntry* const entry = reader.file().find("EMCIO", "TOOL_CHANGE_POSITION");
  if (entry == nullptr) return;
  std::istringstream numbers(entry->value);
  for (double number = 0; position.size() < 9 && numbers >> number;) {
    const std::size_t axis = position.size();
    const bool angle = axis >= 3 && axis < 6;
    position.push_back(angle ? number : number * unit_mm);
  }
  if (position.size() == 3 || position.size() == 6 || position.size() == 9) return;
  reader.fault(
      *entry,
      fmt::format("[EMCIO]TOOL_CHANGE_POSITION: '{}' is not three, six or nine numbers with "
                  "blanks between them; tools are changed where the machine stands",
                  entry->value),
      {}, Severity::kWarning);
  position.clear();
}

/// Keys that a dry run would need to know, and does not.
void list_what_is_not_understood(IniReader& reader) {
  for (const IniEntry& entry : reader.file().entries()) {
    const bool matters = entry.section == "TRAJ" || entry.section == "KINS" ||
                         entry.section == "EMCIO" || entry.section == "RS274NGC";
    if (!matters || entry.asked || entry.shadowed) continue;
    const std::string name = entry.section + "." + entry.key;
    if (std::find(kKnownKeys.begin(), kKnownKeys.end(), name) != kKnownKeys.end()) continue;
    const bool modelled_not = name == "EMCIO.DB_PROGRAM";
    reader.fault(entry,
                 trf("[{}]{} is {}", entry.section, entry.key,
                     modelled_not ? tr("not modelled") : tr("not understood; it is passed over")),
                 {}, Severity::kNote);
  }
}

/// Where the joints stand after homing is where the machine is: robots, and machines that follow
/// the tip, are not at the values of their joints.
void start_at_home(IniReader& reader, const MachineKinematics& machine, double unit_mm,
                   InterpreterSetup& interpreter) {
  if (machine.type(0).mode == KinematicsMode::kAxes) return;
  AxisValues joints{};
  for (std::size_t i = 0; i < std::min(machine.joint_letters.size(), joints.size()); ++i) {
    const bool turns = joint_turns(reader, i, machine.turns_joint(i));
    const double home = reader.number(fmt::format("JOINT_{}", i), "HOME").value_or(0);
    joints[i] = home * (turns ? 1.0 : unit_mm);
  }
  const AxisValues axes = machine.axes_of(joints, 0);
  std::copy(axes.begin(), axes.end(), interpreter.start.begin());
}

/// What LinuxCNC's screens take for yes.
std::string read_lathe(IniReader& reader) {
  for (const char* key : {"LATHE", "BACK_TOOL_LATHE"}) {
    const IniEntry* const entry = reader.file().find("DISPLAY", key);
    if (entry == nullptr) continue;
    const std::string value = to_lower(entry->value.substr(0, entry->value.find_first_of(" \t#;")));
    if (value != "1" && value != "true" && value != "yes" && value != "on") continue;
    const std::string file =
        entry->file < reader.file().files().size() ? reader.file().files()[entry->file] : "";
    return fmt::format("{}:{}: [DISPLAY]{} = {}", file, entry->line, key, entry->value);
  }
  return {};
}

void find_turning_joints(IniReader& reader, MachineSetup& setup) {
  const MachineKinematics* const machine = setup.timeline.kinematics.get();
  const std::string& letters = machine != nullptr ? machine->joint_letters : setup.joint_letters;
  for (std::size_t joint = 0; joint < std::min(letters.size(), kAxisCount); ++joint) {
    const auto letter = std::find(kAxisLetters.begin(), kAxisLetters.end(), letters[joint]);
    const bool by_letter = is_rotary_axis(static_cast<std::size_t>(letter - kAxisLetters.begin()));
    const bool otherwise = machine != nullptr ? machine->turns_joint(joint) : by_letter;
    if (!joint_turns(reader, joint, otherwise)) continue;
    setup.turning_joints = static_cast<std::uint16_t>(setup.turning_joints | 1U << joint);
  }
}

/// `entry` null: the INI has none, and the configuration says what they are.
void read_kinematics(IniReader& reader, const IniEntry* entry, double unit_mm,
                     const KinematicsRequest* request, MachineSetup& setup) {
  // Who says it in a configuration means it.
  const bool given = request != nullptr && request->is_given();
  const auto fault = [&](const std::string& text) {
    if (!given) {
      reader.fault(*entry, text, {}, Severity::kWarning);
      return;
    }
    Diagnostic d;
    d.message = fmt::format("machine.kinematics: {}", text);
    reader.diagnostics().push_back(std::move(d));
  };
  Result<MachineKinematics> machine =
      kinematics_of_ini(reader.file(), setup.interpreter.working_folder, setup.joint_letters,
                        unit_mm, request != nullptr ? *request : KinematicsRequest{});
  if (!machine) {
    fault(given ? machine.error()
                : trf("{}; positions are taken as those of the tip in a machine with "
                      "straight axes",
                      machine.error()));
    return;
  }
  // Whatever the frame is: no other fault of a machine shows only there.
  if (const Result<ToolPath> path = ToolPath::create(*machine, {}, {}); !path) {
    fault(path.error());
    return;
  }
  start_at_home(reader, *machine, unit_mm, setup.interpreter);
  setup.timeline.kinematics = std::make_shared<const MachineKinematics>(std::move(machine.value()));
  setup.timeline.kinematics_known = true;
  const std::vector<KinematicsType>& types = setup.timeline.kinematics->types;
  setup.interpreter.straight_axes =
      std::all_of(types.begin(), types.end(),
                  [](const KinematicsType& type) { return type.mode == KinematicsMode::kAxes; });
  // Of a module that has a joint for every axis, whether the INI names that or not (maxkins).
  setup.timeline.joint_limits =
      joint_limits_of_ini(reader.file(), setup.timeline.kinematics->joint_letters, unit_mm);
}

bool is_of_linuxcnc(const IniFile& ini) {
  constexpr std::array kSections{"EMC",    "DISPLAY", "TASK",     "RS274NGC", "EMCMOT",
                                 "EMCIO",  "HAL",     "TRAJ",     "KINS",     "JOINT_0",
                                 "AXIS_X", "FILTER",  "SPINDLE_0"};
  return std::any_of(kSections.begin(), kSections.end(),
                     [&](const char* section) { return ini.has_section(section); });
}

}  // namespace

bool read_machine_setup(const std::string& path, MachineSetup& setup, Diagnostics& diagnostics,
                        const KinematicsRequest* kinematics) {
  Result<IniFile> ini = IniFile::read(path, diagnostics);
  if (!ini) {
    Diagnostic d;
    d.message = ini.error();
    diagnostics.push_back(std::move(d));
    return false;
  }
  if (!is_of_linuxcnc(*ini)) {
    Diagnostic d;
    d.file = path;
    d.message =
        tr("is no INI of a LinuxCNC machine: it has none of its sections ([EMC], [KINS], "
           "[TRAJ], [JOINT_0] ..)");
    d.hint =
        tr("--ini is the file that LinuxCNC is started with; a program is given without an option");
    diagnostics.push_back(std::move(d));
    return false;
  }
  IniReader reader(*ini, diagnostics);
  InterpreterSetup& interpreter = setup.interpreter;
  interpreter.ini_path = fs::absolute(path).lexically_normal().string();
  interpreter.working_folder = fs::path(interpreter.ini_path).parent_path().string();
  interpreter.ini_text = ini->expanded_text();
  const double unit_mm = read_unit_mm(reader);
  interpreter.inch_machine = unit_mm != 1;
  setup.joint_letters = read_joint_letters(reader, setup.kinematics);
  read_axes(reader, setup.joint_letters, unit_mm, setup);
  read_planner(reader, unit_mm, setup.timeline.limits);
  setup.timeline.limits_known = true;
  setup.timeline.planner.limits_origin = path;
  setup.spindle_max_rpm = reader.number("SPINDLE_0", "MAX_FORWARD_VELOCITY", 0.0).value_or(0);
  setup.tool_table_path =
      read_path(reader, "EMCIO", "TOOL_TABLE", interpreter.working_folder, Severity::kError);
  // A machine that has not run yet has none: all offsets are 0.
  interpreter.parameter_path = read_path(reader, "RS274NGC", "PARAMETER_FILE",
                                         interpreter.working_folder, Severity::kWarning);
  interpreter.start_known = !interpreter.parameter_path.empty();
  if (!interpreter.start_known) {
    // Where the work lies in the machine is not known, so neither is what lies beyond its limits.
    for (AxisLimits& axis : setup.timeline.limits.axes) {
      axis.min = -std::numeric_limits<double>::infinity();
      axis.max = std::numeric_limits<double>::infinity();
    }
  }
  interpreter.startup_code = reader.text("RS274NGC", "RS274NGC_STARTUP_CODE");
  interpreter.random_toolchanger = reader.number("EMCIO", "RANDOM_TOOLCHANGER").value_or(0) != 0;
  interpreter.tool_lengths = true;
  read_tool_change_position(reader, unit_mm, interpreter.tool_change_position);
  setup.lathe = read_lathe(reader);
  const IniEntry* const kins = ini->find("KINS", "KINEMATICS");
  if (kins != nullptr || (kinematics != nullptr && kinematics->is_given())) {
    read_kinematics(reader, kins, unit_mm, kinematics, setup);
  }
  find_turning_joints(reader, setup);
  list_what_is_not_understood(reader);
  return !has_error(diagnostics);
}

}  // namespace kerf
