// twin/machines/builtin_gantry.h - parts of machines with a bridge over the table. For the
// sources of builtin_machine() only.
#pragma once

#include "twin/machines/builtin_parts.h"

namespace kerf {

/// Machine coordinates at rest: what is said of the gantry is relative to the nose.
struct GantrySizes {
  double top = 0;        // of the table: where the blank lies
  double unit = 0;       // what thicknesses are measured by
  double inner_min = 0;  // x: inner faces of the gantry's sides
  double inner_max = 0;
  double side = 0;  // their thickness
  double table_min_y = 0;
  double table_max_y = 0;
  double rail = 0;  // z: the gantry runs on it
  double beam_low = 0;
  double beam_high = 0;
  double body = 0;    // radius of spindle or torch holder
  double plate = 0;   // y: front face of the Z plate, from the nose
  double beam_y = 0;  // y: front face of the beam
  double beam_depth = 0;
  double half_carriage = 0;  // x
};

/// The frame under the machine: rails along Y, legs, cross members.
void add_gantry_frame(MeshBuilder& mesh, const GantrySizes& s, double low, double high);
/// What runs along Y. Frame: y of the nose at 0.
MeshBuilder gantry_bridge(const GantrySizes& s);
/// What runs along X on it, and carries what goes up and down. Frame: x and y of the nose at 0.
MeshBuilder gantry_carriage(const GantrySizes& s);

}  // namespace kerf
