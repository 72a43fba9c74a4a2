// twin/machine/kinematics/known_kinematics.h - chains of the machines that LinuxCNC's kinematics
// modules describe, with the geometry that these modules take.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "twin/machine/kinematics/kinematic_chain.h"

namespace kerf {

/// Joint values drive these chains (the slides' positions, by axis letter); the frame of the
/// workpiece link is the one in which the module's forward kinematics gives X Y Z. The tool link's
/// origin is the controlled point of a tool without length; its tip lies `tool offset` below, along
/// -Z of the link. Links: those named below, for meshes to hang on.
///
/// Turning tables go the way that each of LinuxCNC's modules has it (2.9). Of xyzac-trt-kins,
/// xyzbc-trt-kins and rotatekins the table itself turns right-handed for growing values, against
/// the naming of axes by the tool; 2.10 can turn them round (conventional-directions).

/// Which end of a machine turns about A, B, C.
enum class RotarySide : std::uint8_t {
  kTable,  ///< the workpiece: a fourth axis
  kHead,   ///< the tool
};

/// trivkins (also of a gantry, and what corexykins' belts move): X, Y, Z carry the tool; `letters`
/// (an axis for each joint: "XYZA") says which of A, B, C and W there are. All turn about lines
/// through `center_mm`, machine coordinates. On a table A carries B carries C; the table turns
/// left-handed, so that the tool as seen from the part turns right-handed, as axes are named (and
/// as LinuxCNC's preview has it). On a head C carries B carries A, right-handed. At 0 all frames
/// are those of the machine. Links: base, bridge (Y),
/// carriage (X), ram (Z), rotary_a, rotary_b, rotary_c, workpiece or nose, quill (W).
KinematicChain straight_chain(std::string_view letters, RotarySide side,
                              const Vec3& center_mm = Vec3(0.0));

/// A lathe whose spindle is an axis: X, Y and Z carry the tool, C turns the workpiece about the
/// line X0 Y0, left-handed as tables do; A does the same, where the spindle is called so. Links:
/// base, bridge (Y), carriage (X), ram (Z), rotary_a, rotary_c (workpiece).
KinematicChain lathe_chain();

/// [KINS]KINEMATICS = xyzac-trt-kins: table X, Y; on it a cradle that tilts about X (A), in it a
/// platter that turns about Z (C); head Z. Links: saddle, table, cradle, platter, workpiece, head.
///   `rotation_point_mm`  x/y/z-rot-point: the axis of the platter at A0, machine coordinates
///   `y_offset_mm`, `z_offset_mm`  the tilting axis, from that point
KinematicChain xyzac_trt_chain(const Vec3& rotation_point_mm, double y_offset_mm,
                               double z_offset_mm);

/// xyzbc-trt-kins: the same with a cradle that tilts about Y (B), `x_offset_mm` beside the point.
KinematicChain xyzbc_trt_chain(const Vec3& rotation_point_mm, double x_offset_mm,
                               double z_offset_mm);

/// xyzab_tdr_kins: head X, Y, Z; a table that turns about Y (B, left-handed), on it one that turns
/// about X (A, left-handed). Links: bridge, carriage, head, rotary_b, rotary_a, workpiece.
///   `rotation_point_mm`  x/y/z-rot-point: on the axis of B, machine coordinates
///   `x_offset_mm`, `z_offset_mm`  the axis of A, from that point (x changes nothing)
KinematicChain xyzab_tdr_chain(const Vec3& rotation_point_mm, double x_offset_mm,
                               double z_offset_mm);

/// rotatekins: X, Y turned with the table about Z (C).
KinematicChain rotate_chain();

/// 5axiskins: a bridge mill whose fork turns about Z (C) and swivels the spindle about Y (B);
/// W slides the quill out along the spindle. At B0 the tool points down. Links: table (workpiece),
/// bridge, carriage, ram, fork, spindle, quill. The pivot lies `pivot_length_mm` above the
/// controlled point. B swivels left-handed about Y: B90 C0 points the tool to +X.
KinematicChain bridge_5axis_chain(double pivot_length_mm);

/// maxkins: a table in X, Y with a platter that turns about Z (C, left-handed); a head in Z that
/// swivels the spindle about Y (B, left-handed), its pivot `pivot_length_mm` above the controlled
/// point, a quill along the spindle (W). U slides across the spindle, against X at B0, V against Y.
/// Links: saddle, table, platter (workpiece), head, cross, swivel, facing, quill. (What LinuxCNC
/// 2.9 shows as its actual position is wrong where B and C are both turned: it sends the joints to
/// the right places.)
KinematicChain max_chain(double pivot_length_mm);

/// scarakins, driven by joints: two arms that turn about Z, a quill that goes down, a wrist.
///   d[0] .. d[5]  D1 .. D6 of the module: height of the inner arm, its length, the outer arm above
///                 it, its length, from the end effector down to the tip, and out to it
/// Links: base (workpiece), inner_arm, outer_arm, quill, wrist.
KinematicChain scara_chain(const std::array<double, 6>& d_mm);

/// One joint of a robot arm in J. J. Craig's convention ("modified" Denavit and Hartenberg): from
/// the frame before, `a` along its X, `alpha` about it, then `d` along the new Z, and the joint
/// about that.
struct ArmJoint {
  double a_mm = 0;
  double alpha_deg = 0;
  double d_mm = 0;
};
struct Arm {
  KinematicChain chain;
  /// Of the flange's frame with all joints at 0: its Z points out of the flange. The frame of the
  /// link is parallel to the base then.
  glm::dmat3 flange_at_rest{1.0};
};
/// genserkins, pumakins: driven by joints 0 .. n-1, all of them turning. Links: base (workpiece),
/// arm_0 .. arm_n-1, and flange, `flange_mm` out along the last Z.
Arm arm_chain(std::span<const ArmJoint> joints, double flange_mm = 0);
/// The arm that pumakins describes with A2, A3, D3, D4.
std::array<ArmJoint, 6> puma_joints(double a2_mm, double a3_mm, double d3_mm, double d4_mm);

}  // namespace kerf
