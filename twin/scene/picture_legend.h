// twin/scene/picture_legend.h - what colours of a picture mean, written into it.
#pragma once

#include <vector>

#include "viewer/labels.h"
#include "viewer/scene.h"

namespace kerf {

inline constexpr float kLegendWords_px = 17, kLegendEdge_px = 22;

/// From the upper left corner down: a square of the colour beside each word.
void add_legend(const std::vector<ColorLegendEntry>& legend, std::vector<Stroke>* strokes);

}  // namespace kerf
