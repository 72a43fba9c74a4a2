// stock/plane/outline_drawing.h - curves as drawings for other programs.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "stock/plane/outline_arcs.h"

namespace kerf::plane {

struct DrawingStyle {
  int digits = 4;           ///< behind the point, of mm
  std::string layer = "0";  ///< of DXF, but for the centre line
  /// From one end to the other, dash-dotted: of DXF on the layer CENTER, of SVG of the class
  /// "axis". Outlines are read without it: of DXF where contours close along the axis, of SVG
  /// anyway.
  std::optional<std::pair<Vec2, Vec2>> centre_line;
  /// What is no edge of the section, dashed, with a note of what it is: of DXF on the layer FLATS,
  /// of SVG of the class "flats", the note its title. Outlines are read without them where they are
  /// read without a centre line.
  std::vector<std::pair<Vec2, Vec2>> flats;
  std::string flats_note;
  /// What the SVG shows, from the lower left corner to the upper right one.
  Vec2 low_mm{0}, high_mm{0};
  /// SVG: x is that of the curves; or else the picture's left edge is 0.
  bool keeps_x = false;
};

/// mm. DXF is R12: CIRCLE, or closed POLYLINE with bulges. SVG is one path (M L A Z), filled
/// even-odd, y turned round, its lower edge at 0. Appear whole or not at all. Error: what could not
/// be written and why.
Done write_curves_dxf(const std::vector<Curve>& curves, const DrawingStyle& style,
                      const std::string& path);
Done write_curves_svg(const std::vector<Curve>& curves, const DrawingStyle& style,
                      const std::string& path);

}  // namespace kerf::plane
