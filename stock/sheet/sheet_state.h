// stock/sheet/sheet_state.h - a sheet on disk: kerf-state/1 (stock/state_bytes.h).
//
//   model sheet
//   bounds x0 y0 x1 y1     units of 0.1 um (polygon.h), as all that follows but z
//   tiles columns rows
//   z_mm bottom top
//   arc_tolerance_mm t
//   blank_area2 n          twice the area of the uncut sheet
//   data
// Then the tiles, row by row from low x, y: the number of rings, 32 bits, and of each ring the
// number of corners, 32 bits, and these, x then y, 32 bits each, signed.
#pragma once

#include <cstdint>
#include <string>

#include "base/result.h"
#include "stock/sheet/sheet_grid.h"

namespace kerf::sheet {

struct SavedSheet {
  SheetGrid grid;
  double bottom_mm = 0, top_mm = 0, arc_tolerance_mm = 0;
  std::int64_t blank_area2 = 0;
};

/// Without the numbers of pieces.
Done write_sheet(const std::string& path, const SavedSheet& saved);

/// From a file's bytes; `name` is used in messages. What comes back can be cut and meshed whatever
/// the bytes were: rings lie in their tiles, holes within the box of an outer ring of theirs.
/// Errors say what is wrong. Allocates in proportion to the bytes.
Result<SavedSheet> parse_sheet(const std::string& bytes, const std::string& name);

}  // namespace kerf::sheet
