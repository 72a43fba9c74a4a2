// stock/zmap/contact.h - would a move touch the material? Reads only.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "stock/stock_model.h"
#include "stock/zmap/sweep_ops.h"
#include "stock/zmap/tile_grid.h"
#include "stock/zmap/tip_traces.h"

namespace kerf {

/// What the search for contacts looks at.
struct ContactField {
  const TileGrid& grid;
  const TipTraces& traces;
  /// Whether something is hollow below the heights of a tile; null: nothing is.
  std::function<bool(std::size_t tile)> is_hollow;
  /// False: of those below the first is not looked for, and where something is hollow the second is
  /// not. For the lower side of a head, under which and above which a cutter ends.
  bool middles = true;
};

/// First contact of `move` by a cutter that is the union of `tools`, with material that lies deeper
/// than `tolerance_mm` inside the cutter's sweep, or into which the cutter goes deeper than that: a
/// tool that passes along a wall or floor it has just cut does not touch.
///
/// Three things are told, and all are certain, whatever the cells:
///  - The middle of a cell is material, and inside the sweep of the tool drawn in by the tolerance
///    (from its sides, and up from its bottom).
///  - Anywhere over a cell the whole tool goes deeper than the material that is there at least
///    (TipTraces), by more than the tolerance: the point of a vee that passes between the middles.
///  - It enters a round side of the blank where nothing has come yet (RimTraces).
/// Not told is what only happens between the middles, over a cell that was cut as deep somewhere
/// already, or beside one: a wall that is entered by less than a cell.
///
/// Scalar and exact; tiles and cells below the sweep are skipped. Arcs are taken as chords of
/// tolerance / 4.
std::optional<Contact> find_first_contact(const ContactField& field,
                                          std::span<const ConvexTool> tools, const CutMove& move,
                                          double tolerance_mm);

}  // namespace kerf
