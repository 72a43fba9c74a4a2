// stock/turning/turned_drawing.h - the contour of a turned part as a drawing for other programs.
#pragma once

#include <string>

#include "base/result.h"
#include "stock/turning/turned_part.h"

namespace kerf {

/// The half section above the axis as closed contours of lines and true arcs (contour_arcs.h), x of
/// the drawing is Z and y the radius, mm with five digits; and a centre line. DXF: on the layer
/// CONTOUR, the centre line on the layer CENTER. SVG: its lower edge is the axis. Either is read
/// again by --stock profile:FILE. Of a bar of flats the contour is that of its corners; as far as
/// it still has flats a dashed line shows how high these are, with a note, "HEX 27" or "SQ 20", the
/// width across them (DrawingStyle::flats). Appear whole or not at all. Error:
/// what could not be written and why.
Done write_turned_dxf(const TurnedPart& part, const std::string& path);
Done write_turned_svg(const TurnedPart& part, const std::string& path);

}  // namespace kerf
