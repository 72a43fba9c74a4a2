// stock/sheet/sheet_contact.h - what material a point is in, and where a disc on its way first
// meets any.
#pragma once

#include <optional>
#include <span>

#include "stock/sheet/sheet_grid.h"

namespace kerf::sheet {

/// Whether p is in the material or on its edge. O(corners of its tile).
bool holds_material(const SheetGrid& grid, const Point& p);

/// Tile::pieces of the material that holds p; kNoPiece: there is none. The same cost.
std::uint32_t piece_under(const SheetGrid& grid, const Point& p);

/// A disc's centre runs along the chain. The share of the way (each chord counts the same) after
/// which it is first within `radius_mm` of material. O(edges of material near the way).
std::optional<double> first_meeting(const SheetGrid& grid, std::span<const Vec2> way_mm,
                                    double radius_mm);

}  // namespace kerf::sheet
