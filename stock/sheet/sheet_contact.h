// stock/sheet/sheet_contact.h - where a disc on its way first meets material.
#pragma once

#include <optional>
#include <span>

#include "stock/sheet/sheet_grid.h"

namespace kerf::sheet {

/// Whether p is in the material or on its edge. O(corners of its tile).
bool holds_material(const SheetGrid& grid, const Point& p);

/// A disc's centre runs along the chain. The share of the way (each chord counts the same) after
/// which it is first within `radius_mm` of material. O(edges of material near the way).
std::optional<double> first_meeting(const SheetGrid& grid, std::span<const Vec2> way_mm,
                                    double radius_mm);

}  // namespace kerf::sheet
