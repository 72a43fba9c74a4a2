// stock/sheet/punch_shape.h - what a punch takes out of a sheet, from text.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "stock/plane/outline.h"

namespace kerf {

/// SHAPE, in mm and degrees, centred on the punch's axis at angle 0:
///     round:D             diameter
///     square:A            edge
///     rectangle:A:B       edges along x and y
///     obround:A:B         A x B over all, with half circles at both ends of the longer one
///     polygon:N:D         regular, N corners (3 to 100), the first on x; D across its corners
///     dxf:FILE, svg:FILE  outline_dxf.h, outline_svg.h; their origin is the axis
/// Sizes from 0.1 to 1000 mm. Arcs are off by `tolerance_mm` at most, and keep their area. Error:
/// the part that is wrong, what was found and what is allowed.
Result<PlaneOutline> parse_punch_shape(std::string_view spec, double tolerance_mm);

/// The forms for --help and messages, one a line.
std::string_view punch_shape_help();

}  // namespace kerf
