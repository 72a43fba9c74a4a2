// twin/machines/builtin_models.h - machines that kerf draws by itself, made to the size of
// the workpiece and the travels.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "twin/machine/turret.h"
#include "twin/machines/machine_model.h"

namespace kerf {

enum class MachineKind : std::uint8_t {
  kNone,
  kKneeMill,
  kGantry,
  kLathe,
  kTrunnion,
  kPlasma,
  kPunch,
  kBridgeMill,
  kSwivelMill,
};
/// As configurations have it: "none", "knee-mill", "gantry", "lathe", "trunnion", "plasma",
/// "punch", "bridge-mill", "swivel-mill".
std::string_view name_of(MachineKind kind);

/// Joints of a punch press that has a turret; no program names them.
enum PunchJoint : std::uint8_t {
  kGripX = 5,  ///< mm that the clamps have moved along the sheet, ..
  kGripY = 6,
  kTurret = 7,  ///< degrees; station i of n (in the order of their numbers) works at i / n turns
  kStroke = 8,  ///< mm of the ram, from where Z has it; down is negative
};

/// The link of the punch in a station: its frame has the tip at the origin.
std::string punch_link(int station);

/// From least to greatest position.
struct AxisTravel {
  double min = 0.0;
  double max = 0.0;
};

/// Of a table that tilts and turns, as the pins of xyzac-trt-kins and xyzbc-trt-kins have it.
struct TrunnionGeometry {
  bool tilts_about_y = false;  ///< B and C; else A and C
  /// The platter's axis at A0 (B0), machine coordinates; not given: through the middle of the
  /// blank's bottom.
  std::optional<Vec3> rotation_point_mm;
  double side_offset_mm = 0.0;  ///< y-offset (of A), x-offset (of B)
  double z_offset_mm = 0.0;
};

/// A lathe's chuck as somebody described it; z in the workpiece frame.
struct ChuckRoom {
  double diameter_mm = 0, length_mm = 0, face_z_mm = 0;
  double jaw_diameter_mm = 0;  ///< outside; 0: jaws are as is usual
  double jaw_length_mm = 0;
};

/// What a machine is built around.
struct MachineRoom {
  Box blank_mm;  ///< Workpiece frame. Empty: a block of 100 x 100 x 50 below the origin.
  Box reach_mm;  ///< Where the program's tips go, workpiece frame. May be empty.
  Pose machine_from_workpiece;  ///< The work offset.
  /// Of the nose, machine coordinates. Not given: what blank and reach need.
  std::array<std::optional<AxisTravel>, kAxisCount> travel{};
  double tool_length_mm = 100.0;   ///< From tip to nose, of the longest tool.
  bool has_c_axis = false;         ///< Lathe: the chuck turns with C.
  std::optional<ChuckRoom> chuck;  ///< Of a lathe; not given: one that goes around the blank.
  TrunnionGeometry trunnion;
  /// Of a head that tilts: from the nose up to the pivot. Not given: as is usual.
  std::optional<double> head_pivot_mm;
  TurretPointer turret;  ///< Punch: its stations and clamps, and what moves; null: as is usual.
};

/// The machine of that kind, for every kind but kNone. Each link a closed mesh, 300 to 5000
/// triangles in all. Workpiece and tool are not part of it. What it promises:
///  - the blank's bottom lies on the table (slats, platter, sheet table); of a lathe its end with
///    the least Z is in the chuck
///  - the origin of the tool link is where the tool's upper end is held
///  - while the tip is over or beside the blank, and no lower than its top (of a lathe: outside of
///    it), what carries the tool does not run into what carries the workpiece
/// Where travel and workpiece do not fit each other, the machine is built for both.
///
///     knee mill   column, ram and spindle stand; knee Z, saddle Y, table X
///     gantry      table stands; gantry Y, carriage X, spindle Z
///     plasma      the same over slats, with a torch
///     lathe       spindle along Z, X to the turret, Y up; chuck, carriage Z, cross slide X
///     trunnion    saddle Y, table X, cradle A or B, platter C; head Z
///     bridge mill  table stands; bridge Y, carriage X, ram Z, fork C, swivel B with the spindle
///     swivel mill  saddle Y, table X, platter C about X0 Y0; head Z, swivel B with the spindle
///     punch       frame and turret stand (translucent); carriage Y, clamps X, ram Z. With a turret
///                 beside these: PunchJoint, punch_link(); and where the head moves, rails Y and
///                 frame X
MachineModel builtin_machine(MachineKind kind, const MachineRoom& room);

}  // namespace kerf
