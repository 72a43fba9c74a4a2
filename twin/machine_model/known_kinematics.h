// twin/machine_model/known_kinematics.h - chains of the machines that LinuxCNC's kinematics modules
// describe, with the geometry that these modules take.
#pragma once

#include "twin/machine_model/kinematic_chain.h"

namespace kerf {

/// Joint values drive these chains (the slides' positions, by axis letter); the frame of the
/// workpiece link is the one in which the module's forward kinematics gives X Y Z. The tool link's
/// origin is the controlled point of a tool without length; its tip lies `tool offset` below, along
/// -Z of the link. Links: those named below, for meshes to hang on.
///
/// Turning tables go the way that LinuxCNC's modules have it: the table itself turns right-handed
/// for growing values, against the naming of axes by the tool.

/// [KINS]KINEMATICS = xyzac-trt-kins: table X, Y; on it a cradle that tilts about X (A), in it a
/// platter that turns about Z (C); head Z. Links: saddle, table, cradle, platter, workpiece, head.
///   `rotation_point_mm`  x/y/z-rot-point: the axis of the platter at A0, machine coordinates
///   `y_offset_mm`, `z_offset_mm`  the tilting axis, from that point
KinematicChain xyzac_trt_chain(const Vec3& rotation_point_mm, double y_offset_mm,
                               double z_offset_mm);

/// xyzbc-trt-kins: the same with a cradle that tilts about Y (B), `x_offset_mm` beside the point.
KinematicChain xyzbc_trt_chain(const Vec3& rotation_point_mm, double x_offset_mm,
                               double z_offset_mm);

/// 5axiskins: a bridge mill whose fork turns about Z (C) and swivels the spindle about Y (B);
/// W slides the quill out along the spindle. At B0 the tool points down. Links: table (workpiece),
/// bridge, carriage, ram, fork, spindle, quill. The pivot lies `pivot_length_mm` above the
/// controlled point. B swivels left-handed about Y: B90 C0 points the tool to +X.
KinematicChain bridge_5axis_chain(double pivot_length_mm);

}  // namespace kerf
