// stock/zmap/mmap/head_contact.h - would the head of a cutter touch the material? Reads only.
#pragma once

#include <optional>

#include "stock/stock_model.h"
#include "stock/zmap/mmap/gap_grid.h"
#include "stock/zmap/mmap/headed_tool.h"
#include "stock/zmap/tile_grid.h"

namespace kerf {

/// First contact of the head of `tool` with material that lies deeper than `tolerance_mm` inside
/// its sweep, from below, from above and from the sides. Scalar and exact; arcs are taken as chords
/// of tolerance / 4. None for a tool without a head.
std::optional<Contact> find_head_contact(const TileGrid& grid, const GapGrid& gaps,
                                         const HeadedTool& tool, const CutMove& move,
                                         double tolerance_mm);

/// The earlier of two along a move, with the greater depth.
std::optional<Contact> earlier_contact(const CutMove& move, const std::optional<Contact>& a,
                                       const std::optional<Contact>& b);

}  // namespace kerf
