// stock/plane/outline_file.h - outlines from and to drawings.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "stock/plane/outline.h"

namespace kerf {

enum class OutlineFormat { kDxf, kSvg };

/// How contours of a drawing close.
enum class OutlineClosing {
  kByThemselves,
  /// Chains of loose edges with both ends on the x axis of the drawing (within kJoin_mm) are closed
  /// along it, and edges that lie on it (centre lines) are no part of the outline, nor lines on the
  /// layer FLATS. Of DXF.
  kAlongAxis
};

/// Closed contours of a file of at most kMaxOutlineBytes. Arcs and curves become chords that are
/// off by `tolerance_mm` at most. The result has passed check_outline(). Error: with the file's
/// name, and the line where there is one.
Result<PlaneOutline> read_outline_file(const std::string& path, OutlineFormat format,
                                       double tolerance_mm,
                                       OutlineClosing closing = OutlineClosing::kByThemselves);
/// By the file's name: SVG where it ends so.
OutlineFormat outline_format_of(const std::string& path);

/// The same from text; `name` for messages.
///
/// DXF (ASCII, any version): LINE, ARC, CIRCLE, LWPOLYLINE and POLYLINE with bulges, of the section
/// ENTITIES. $INSUNITS of 1 are inches, 4, 0 or none mm; others are refused. Loose lines and arcs
/// are joined where ends are within kJoin_mm of each other; a chain that does not close is an
/// error. Other entities are an error, but for those that draw no edge (TEXT, MTEXT, POINT,
/// DIMENSION, HATCH).
///
/// SVG: path (M L H V C S Q T A Z, both cases), rect (square corners), circle, ellipse, polygon.
/// One user unit is 1 mm, or what width="..mm|cm|in" and viewBox of the svg element say. y points
/// down there: it is turned round, so that the picture's lower edge is y = 0 if there is a height,
/// and y is negative otherwise. Lines of the classes "axis" and "flats" are read past. transform is
/// an error, and so is a path that is not closed.
Result<PlaneOutline> parse_dxf_outline(std::string_view text, const std::string& name,
                                       double tolerance_mm,
                                       OutlineClosing closing = OutlineClosing::kByThemselves);
Result<PlaneOutline> parse_svg_outline(std::string_view text, const std::string& name,
                                       double tolerance_mm);

/// Files for other programs, mm. Chains of chords of arcs that were cut or drawn with
/// `arc_tolerance_mm` are written as arcs (curves_of(), outline_arcs.h), full circles with their
/// exact diameter. DXF is R12: CIRCLE, or closed POLYLINE with bulges, on the layer "0". SVG is one
/// path (M L A Z), filled even-odd, y turned round, moved to have its lower left corner at 0, 0.
/// Appear whole or not at all. Error: what could not be written and why.
Done write_outline_dxf(const PlaneOutline& outline, double arc_tolerance_mm,
                       const std::string& path);
Done write_outline_svg(const PlaneOutline& outline, double arc_tolerance_mm,
                       const std::string& path);

inline constexpr std::size_t kMaxOutlineBytes = std::size_t{64} << 20;
inline constexpr double kJoin_mm = 0.01;

}  // namespace kerf
