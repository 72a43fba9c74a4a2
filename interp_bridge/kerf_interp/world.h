// interp_bridge/kerf_interp/world.h - the machine as the interpreter asks for it: where it stands,
// which offsets and tools it has. Nothing outside of this process is read or written for it.
#pragma once

#include <array>
#include <canon.hh>
#include <map>
#include <string>
#include <vector>

#include "base/units.h"
#include "interp_bridge/torch_materials.h"

namespace kerf::interp {

/// X Y Z A B C U V W; what is a length is in mm, what is an angle in degrees.
using Pose = std::array<double, 9>;

constexpr bool is_length(std::size_t axis) { return axis < 3 || axis > 5; }

/// The machine. Positions are kept in machine coordinates, so that they stay right when an offset
/// or the tool's length changes under a standing machine (rs274 forgets that).
class World {
 public:
  World();

  // ---- What the machine is ----------------------------------------------------------------------
  double units_per_mm = 1;  ///< machine units: 1, or 1 / 25.4
  int axis_mask = 0x1ff;
  bool block_delete = true;
  bool random_toolchanger = false;
  /// [EMCIO]TOOL_CHANGE_POSITION, machine coordinates: the first so many axes go there before every
  /// change. 0: it is changed where the machine stands.
  std::size_t tool_change_axes = 0;
  Pose tool_change_place{};
  std::string parameter_file;
  /// Pins that `#<_hal[..]>` reads, in machine units.
  std::map<std::string, double> hal_values;
  bool qtplasmac = false;  ///< `materials` are those of M190 and of its comments
  /// QtPlasmaC's filter writes a conversion of units behind the feed and the kerf of a material.
  bool convert_material = false;
  MaterialTable materials;
  /// The value of a pin; false: there is none of that name.
  bool hal_value(const std::string& name, double& value) const;

  // ---- What the program has set
  // -------------------------------------------------------------------
  CANON_UNITS units = CANON_UNITS_MM;
  CANON_PLANE plane = CANON_PLANE_XY;
  CANON_MOTION_MODE motion_mode = CANON_CONTINUOUS;
  double motion_tolerance_mm = 0;
  double naivecam_tolerance_mm = 0;
  double feed_mm_per_min = 0;
  bool flood = false;
  bool mist = false;
  bool feed_override = true;
  bool adaptive_feed = false;
  bool feed_hold = true;
  static constexpr std::size_t kSpindles = 8;  ///< EMCMOT_MAX_SPINDLES
  std::array<double, kSpindles> spindle_speed{};
  std::array<CANON_DIRECTION, kSpindles> spindle_direction{};
  std::array<bool, kSpindles> speed_override{};
  bool optional_stop = true;
  /// Analog outputs, M67 and M68. Switchable kinematics hang on the last (motion.switchkins-type),
  /// as in LinuxCNC's sample configurations: their M428, M429 and M430 look whether it went there.
  static constexpr std::size_t kAnalogOutputs = 4;
  std::array<double, kAnalogOutputs> analog_outputs{};
  void set_analog_output(int index, double value) {
    const auto output = static_cast<std::size_t>(index);
    if (index >= 0 && output < kAnalogOutputs) analog_outputs[output] = value;
  }

  double rotation_deg = 0;  ///< by set_rotation()

  double unit_mm() const { return kerf::mm_of_unit(units == CANON_UNITS_INCHES); }

  // ---- Frames
  // ---------------------------------------------------------------------------------------
  void set_g5x(const Pose& program_units) { g5x_ = scaled(program_units); }
  void set_g92(const Pose& program_units) { g92_ = scaled(program_units); }
  void set_tool_offset(const Pose& program_units) { tool_offset_ = scaled(program_units); }
  void set_rotation(double degrees);
  double tool_offset(std::size_t axis) const;  ///< program units
  /// Whose row an offset is.
  struct OffsetSource {
    enum Origin { kNone, kRow, kAddedRow, kStated } origin = kNone;  ///< kerf::OffsetOrigin
    int tool = -1;
  };
  /// Of the offset that is about to be set by `block`; before set_tool_offset().
  OffsetSource offset_source(const Pose& program_units, const std::string& block) const;
  /// The look-ups of tools so far are not those of an H word that comes.
  void forget_lookup() { looked_up_ = -1; }

  // ---- Position
  // -------------------------------------------------------------------------------------
  void stand_at(const Pose& machine) { machine_ = machine; }
  void move_to(const Pose& program);  ///< program coordinates and units
  double position(std::size_t axis) const { return program_from_machine(machine_)[axis]; }
  /// Where tools are changed when the next is, program coordinates and units.
  Pose tool_change_position() const;
  /// A probing move goes to its end, and finds it there if the program insists on it (G38.2, G38.4;
  /// they would be errors otherwise) or finds nothing if it may (G38.3, G38.5).
  void probe_to(const Pose& program, bool found);
  /// It has not moved since a probe met something here: G38.2 and G38.3 would find it tripped.
  bool stands_tripped() const { return tripped_ && machine_ == probed_; }
  void note_tripped(bool tripped) { tripped_ = tripped; }
  bool probe_found() const { return probe_found_; }
  double probed(std::size_t axis) const { return program_from_machine(probed_)[axis]; }

  // ---- Tools
  // ------------------------------------------------------------------------------------------
  /// Rows 1.. in the order of the table; row 0 is the spindle. Lengths in machine units.
  void add_tool(const CANON_TOOL_TABLE& tool);
  /// A random tool changer's pocket 0 is the spindle: what the table has there is mounted.
  void mount_pocket_0();
  /// The row of a tool, made (with no diameter) if there is none: a program whose tools the table
  /// does not know is still to be run. -1 if there is no more room.
  int row_of_tool(int number);
  /// An empty one where the table has no such row (the interpreter looks at all it could have).
  CANON_TOOL_TABLE row(int index) const;
  void set_row(int index, const CANON_TOOL_TABLE& tool);
  /// Mounts what is in a row; 0 empties the spindle. Returns the tool's number.
  int load(int index);
  int loaded_row() const { return loaded_; }

 private:
  Pose scaled(const Pose& program_units) const;
  Pose machine_from_program(const Pose& p) const;
  Pose program_from_machine(const Pose& m) const;
  int find_row(int number);
  bool is_offset(const Pose& offset_mm, int row) const;

  Pose g5x_{}, g92_{}, tool_offset_{};
  double cos_ = 1, sin_ = 0;
  Pose machine_{}, probed_{};
  bool probe_found_ = false;
  bool tripped_ = false;
  std::vector<CANON_TOOL_TABLE> rows_;
  int loaded_ = 0;
  int looked_up_ = -1;  ///< row of the last tool that was asked for by its number
};

CANON_TOOL_TABLE empty_tool();

}  // namespace kerf::interp
