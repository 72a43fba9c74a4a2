// viewer/raycast/stroke_raster.h - draws strokes (lines, lettering) over a picture on the CPU.
#pragma once

#include <glm/vec2.hpp>
#include <span>

#include "viewer/labels.h"
#include "viewer/picture.h"

namespace kerf {

/// As StrokeRenderer draws them: in order, blended, antialiased by coverage. `depths` is the window
/// depth of the part, rows from the top, of the picture's size: where it is nearer than a stroke,
/// the stroke fades to its hidden_alpha. O(pixels of the strokes).
void draw_strokes(std::span<const Stroke> strokes, std::span<const float> depths, Picture* picture);

}  // namespace kerf
