// twin/config/live_config.h - the configuration file (--config): read, checked, printed again.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/diagnostic.h"
#include "base/length_unit.h"
#include "interp_bridge/motion.h"
#include "machine_io/can/can_socket_source.h"
#include "machine_io/hal/hal_source.h"
#include "machine_io/logs/log_source.h"
#include "machine_io/modbus/modbus_settings.h"
#include "machine_io/mtconnect/mtconnect_settings.h"
#include "machine_io/recorder.h"
#include "stock/blank.h"
#include "stock/cutter/shape_spec.h"
#include "twin/collision/pair_rules.h"
#include "twin/config/option_layers.h"
#include "twin/job/fixtures.h"
#include "twin/job/stock_choice.h"
#include "twin/job/work_holding.h"
#include "twin/live/live_cutter.h"
#include "twin/live/live_frame.h"
#include "twin/live/path_follower.h"
#include "twin/machine/kinematics/kinematics_setup.h"
#include "twin/machines/machine_choice.h"
#include "twin/report/live_run.h"

namespace kerf {

/// `machine:` What is not given is empty, and comes from the command line, the INI or the program.
struct ConfigMachine {
  std::optional<std::string> ini;         ///< path
  std::optional<std::string> tool_table;  ///< path
  bool as_mill = false;                   ///< ProgramOptions::as_mill
  /// The axis that each joint moves, of XYZABCUVW: "XYZ", "XYYZ". Empty: not given.
  std::string joints;
  /// Bits of the joints that count degrees, by the INI or the kinematics; not given: those that
  /// move A, B, C. No key: understand_live() fills it in.
  std::optional<std::uint16_t> turning_joints;
  /// Where the work zero lies in the machine, mm and degrees: g5x_mm and rotation_deg are set.
  std::optional<WorkpieceFrame> work_offset;
  ToolLengthFrom tool_length = ToolLengthFrom::kAuto;
  std::optional<int> tool;               ///< in the spindle, where the source does not say
  std::optional<double> max_mm_per_min;  ///< positions that need more are a gap
  std::optional<double> max_mm_per_s2;   ///< single positions that need more are dropped
  MachineChoice drawn;                   ///< `model` and `links`
  /// `spindle`: sections from its nose upward, the first begins at 0; empty: it is not described.
  std::vector<ToolSection> spindle;
  std::string spindle_spec;  ///< the text that `spindle` was read from
  std::optional<double> spindle_accel_rpm_per_s;
  WorkHolding holding;  ///< `chuck` and `tailstock`
  std::optional<double> spindle_max_rpm, spindle_power_kw, spindle_torque_nm, spindle_current_a;
  bool collisions = true;         ///< of its links, or of its model
  std::vector<NamedPair> ignore;  ///< PairRules::ignored
  /// `kinematics` and what belongs to it; links are those of `drawn`, too.
  std::optional<KinematicsRequest> kinematics;
};

/// `stock:`
struct ConfigStock {
  std::optional<Blank> blank;
  std::string blank_spec;          ///< the text that `blank` was read from; empty without one
  std::optional<StockKind> model;  ///< absent: what tools and motions need
  std::optional<double> cell_mm;   ///< grid size
  double margin_mm = 5;            ///< around a blank guessed from the program
  double below_mm = 0;             ///< of its floor, that the tool may go
};

/// `beam:`, for sheets. What is not given comes from the command line or is BeamOptions' default.
struct ConfigBeam {
  std::optional<std::string> trigger;  ///< BeamTrigger::parse() takes it
  std::optional<double> kerf_mm, pierce_mm, slats_mm, density_kg_per_m3;
  std::optional<std::string> qtplasmac;  ///< auto, on, off
  std::optional<std::string> materials;  ///< path
  bool operator==(const ConfigBeam&) const = default;
};

/// `follow:`
struct ConfigFollow {
  std::optional<std::string> program;  ///< path
  std::optional<bool> planned_path;    ///< what is cut; not given: the command's default
  FollowOptions options;               ///< tolerance_mm is off_path_mm
  double off_path_s = 2;               ///< LiveCutOptions::off_path_s
  JoinedLate joined_late = JoinedLate::kCut;
  double look_ahead_s = 10;  ///< LiveCutOptions::guard_s; 0: not
  OnProgramEnd on_program_end = OnProgramEnd::kKeep;
};

struct ConfigView {
  bool window = true;  ///< of shadow and replay
  double keyframes_mb = 32;
};

/// What all kinds of source have in common.
struct ConfigSourceCommon {
  double stale_after_s = 0.5;  ///< also LiveCutOptions::gap_s: what is a gap between two samples
  double lost_after_s = 2.0;   ///< above stale_after_s
  GapPolicy gap = GapPolicy::kMark;
  /// Not given: what a recording's head says, else the machine's.
  std::optional<CoordinateFrame> frame;
  /// What a map means: keys X..W are axes, keys J0..J8 joints. Of HAL always joints. A log whose
  /// columns have names says it itself.
  std::optional<CoordinateKind> coordinates;
};

using ConfigSource = std::variant<std::monostate, ModbusSettings, CanSourceOptions, HalSettings,
                                  LogSettings, MtconnectSettings>;

/// A whole configuration as plain values, all checked. Paths are as good as they can be from the
/// current folder: those that the file gives relative to itself have its folder in front. Lengths
/// of maps are in mm already, whatever `units` the file had. Values not given are defaults, so an
/// empty file (or none) is a LiveConfig{}.
struct LiveConfig {
  /// `units:` of what options give and of what is shown; lengths of a configuration are mm.
  std::optional<LengthUnit> units;
  ConfigMachine machine;
  std::vector<ToolShapeArgument> tools;
  std::vector<FixtureSpec> fixtures;        ///< `fixtures:`
  double clearance_mm = 0.5;                ///< near-miss
  std::vector<PairClearance> clearances;    ///< of single pairs
  bool cut_by_shank = false;                ///< CollisionWishes::cut_by_shank
  std::vector<std::string> tool_libraries;  ///< paths
  ConfigStock stock;
  ConfigBeam beam;
  std::optional<std::string> material;  ///< `material:`
  std::optional<std::string> turret;    ///< `turret:`, path; then beam has no more than a density
  ConfigFollow follow;
  ConfigView view;
  ConfigSourceCommon common;
  /// The values that were given, of keys that are options as well: what choose() hears.
  SaidTexts said;
  /// Empty: the file has no `source:`. Joints that count degrees (HalSettings and LogSettings) are
  /// filled in by make_source(), from machine.joints.
  ConfigSource source;
};

/// Reads the file at `path` (empty: there is none), then lays `sets` over it: "source.poll_hz=100",
/// each a key with its dots and one plain value. A path in a set is relative to the current folder.
///
/// Files that it names for the source's map (dbc, pins_file) are read, all others are not looked
/// at. All faults at once, as `file:line:column: error: key: what was found; what is allowed` with
/// the line and, for misspelt keys, what may be meant; of a set as `--set key: ...`. Nothing if
/// there was an error. Anchors, aliases, tags and further documents of YAML are refused; so is a
/// file above kMaxConfig_bytes or nested deeper than kMaxConfigDepth.
std::optional<LiveConfig> read_config(const std::string& path, const std::vector<std::string>& sets,
                                      Diagnostics& diagnostics);
inline constexpr std::size_t kMaxConfig_bytes = std::size_t{1} << 20U;
inline constexpr int kMaxConfigDepth = 16;

/// The same from text; `path` is its name in diagnostics, and the folder for what it names. Any
/// bytes are accepted.
std::optional<LiveConfig> parse_config(std::string_view text, const std::string& path,
                                       const std::vector<std::string>& sets,
                                       Diagnostics& diagnostics);

/// The configuration as a file that reads the same again from the current folder, with every
/// default written out. Presets, DBC names and pin files have become what they stand for; lengths
/// are in mm (of HAL and logs, `units` stays).
std::string effective_yaml(const LiveConfig& config);

/// Every key with unit, range, default and purpose, in the order and shape of a file.
std::string schema_text();

}  // namespace kerf
