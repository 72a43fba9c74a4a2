// stock/zmap/contact.h - would a move touch the material? Reads only.
#pragma once

#include <optional>
#include <span>

#include "stock/stock_model.h"
#include "stock/zmap/sweep_ops.h"
#include "stock/zmap/tile_grid.h"

namespace kerf {

/// First contact of `move` by a cutter that is the union of `tools`, with material that lies deeper
/// than `tolerance_mm` inside the cutter's sweep (measured inward from its sides and up from its
/// bottom): a tool that passes along a wall or floor it has just cut does not touch. Scalar and
/// exact; tiles and cells below the sweep are skipped. Arcs are taken as chords of tolerance / 4.
std::optional<Contact> find_first_contact(const TileGrid& grid, std::span<const ConvexTool> tools,
                                          const CutMove& move, double tolerance_mm);

}  // namespace kerf
