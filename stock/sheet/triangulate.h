// stock/sheet/triangulate.h - a polygon with holes as triangles between its own corners.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "stock/sheet/polygon.h"

namespace kerf::sheet {

using Triangle = std::array<std::uint32_t, 3>;

/// Triangles, counter-clockwise, of what `rings[0]` (counter-clockwise) bounds without the holes
/// `rings[1..]` (clockwise). Their corners count through all rings in order. No other corner lies
/// within a triangle or on its sides, so triangulations of regions that share border corners fit
/// together. Where rings touch, some triangles have no area. However they touch, each edge of
/// theirs is the side of just one triangle and each other side that of two: what is built on it is
/// closed.
///
/// Holes are joined to the rest by bridges to the right (D. Eberly, "Triangulation by ear
/// clipping", 2002), then ears are cut off. Exact on the integer grid. O(n r) for n corners of
/// which r are reflex: for tiles, not for whole sheets.
std::vector<Triangle> triangulate(std::span<const Ring* const> rings);

}  // namespace kerf::sheet
