// twin/motion/motion_geometry.h - lengths, points and bounds of one motion. mm, radians.
#pragma once

#include "base/geometry.h"
#include "interp_bridge/motion.h"
#include "interp_bridge/motion_kinds.h"
#include "stock/stock_model.h"

namespace kerf {

struct PathPiece;

/// Length of the way of the tip. Helices exactly; spirals (radius changing with the angle) by their
/// mean radius, which is right to second order in the change. 0 for motions that do not move.
/// Without the shift of a wrong tool length: where the program has the tip.
Motion as_programmed(const Motion& motion);

double path_length_mm(const Motion& motion);

/// What the feed is for: the way of X Y Z, or where these stand that of U V W.
double fed_length_mm(const Motion& motion);

/// The tip at fraction t in [0, 1] of the way (of the angle, for arcs).
Vec3 point_at(const Motion& motion, double t);

/// Box around the way of the tip; for a motion whose start is not known, around its end. Exact for
/// lines and for arcs in a plane; for helices and spirals it may be larger, by the way along the
/// axis and the change of radius at most.
Box bounds_of(const Motion& motion);

/// It goes nowhere, as far as anybody knows: a feed word without a move (G1 F100), a move to where
/// the machine stands, or one whose start is not known.
bool stands_still(const Motion& motion);

/// In X or Y, or around a circle.
bool moves_sideways(const Motion& motion);

/// CutMove::lead_mm: of a thread how far the tool goes along its way in a turn of the spindle,
/// negative where that turns as M4 has it. LinuxCNC's K is that, also of slanting ways; G76 gives
/// its slanting ends a longer one, so that they keep the lead along the axis. 0 for all other
/// motions, and where the spindle stands.
double lead_mm_of(const Motion& motion);

/// The motion as the stock model takes it.
CutMove cut_move_from(const Motion& motion, std::uint64_t id);
/// The same, into a move that is there already: takes less time.
void set_cut_move(CutMove& move, const Motion& motion, std::uint64_t id);

/// A piece of the path that the machine plans for a motion, as a motion of its own.
Motion motion_of(const Motion& motion, const PathPiece& piece);

}  // namespace kerf
