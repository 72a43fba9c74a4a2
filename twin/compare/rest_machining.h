// twin/compare/rest_machining.h - what a program has left for further machining, and which tools
// would reach it.
#pragma once

#include <string>
#include <vector>

#include "stock/stock_model.h"
#include "twin/compare/design_part.h"
#include "twin/compare/rest.h"

namespace kerf {

/// The tool is not one that mills a surface: a drill, a turning tool, a punch. Such are left out.
bool mills_surfaces(const std::string& shape);

/// Null, or why rest material is not looked for on a workpiece like this (sheets, turned parts).
const char* why_no_rest(const StockModel& stock);

/// Where the workpiece, seen from above, is thicker above the design than `thickness_mm`: in each
/// cell the nearest way from its surface to the design, or straight down if that is less. What is
/// under a roof does not count. With it goes what is thinner beside it, at its walls, as far as the
/// thickness. Regions are cells that touch, at a corner at least.
/// `tools`: number, shape, guessed and used are given. How far each would come is ToolReach; so
/// nothing is said of lengths, shanks and holders.
/// Any model with columns (Z-map, M-map, octree); why_no_rest() is null. O(cells) and about 1 us
/// for each cell of a region and each tool, besides what ToolReach takes.
Rest find_rest(const StockModel& stock, const DesignPart& design, double thickness_mm,
               std::vector<RestTool> tools);

}  // namespace kerf
