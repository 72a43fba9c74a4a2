// stock/plane/svg_path.h - the path language of SVG.
#pragma once

#include <string_view>
#include <vector>

#include "base/geometry.h"
#include "base/result.h"

namespace kerf::plane {

/// Numbers between blanks and commas; a sign begins a new one ("1-2" is two), as SVG has it.
Result<std::vector<double>> parse_numbers(std::string_view text);

/// Closed rings, in the path's own units, y as there. M L H V C S Q T A Z, relative in small
/// letters. A part that ends where it began counts as closed without Z. Error: what was found, at
/// which character.
Result<std::vector<std::vector<Vec2>>> parse_svg_path(std::string_view text, double tolerance);

}  // namespace kerf::plane
