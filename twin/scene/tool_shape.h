// twin/scene/tool_shape.h - a cutter as the viewer draws it.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "stock/cutter/cutter.h"
#include "stock/cutter/insert.h"
#include "viewer/scene.h"

namespace kerf {

/// Outlines of cutter, shank, holder and spindle. Flutes of unknown length are drawn two diameters
/// long, as most are, a shank of unknown length as long again; a holder stands where its sections
/// say, and so does a spindle, whose nose is as in tool_bodies().
///
/// A turning tool is plates alone: its face lies in the plane Y 0 of the workpiece, towards the eye
/// that sees Z to the right and X up, whichever way the spindle turns; how thick they are nobody
/// says.
std::shared_ptr<const ToolShape> tool_shape_of(const Cutter& cutter,
                                               std::span<const ToolSection> spindle = {},
                                               double nose_z_mm = 0);

/// A part of an insert, or of what holds it. Arcs as chords of 5 degrees.
ToolPlate plate_of(const InsertPart& part);

/// For people, from the shape's text: "ball 10", "bull 10 R2", "drill 8".
std::string tool_name_of(const Cutter& cutter);

}  // namespace kerf
