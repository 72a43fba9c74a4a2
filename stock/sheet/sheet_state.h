// stock/sheet/sheet_state.h - a sheet on disk: kerf-state/1 (stock/state_bytes.h).
//
//   model sheet
//   layout 2               without this line: 1, the tiles alone
//   bounds x0 y0 x1 y1     units of 0.1 um (polygon.h), as all that follows but z
//   tiles columns rows
//   z_mm bottom top
//   arc_tolerance_mm t
//   blank_area2 n          twice the area of the uncut sheet
//   data
// Then the tiles, row by row from low x, y: the number of rings, 32 bits, and of each ring the
// number of corners, 32 bits, and these, x then y, 32 bits each, signed.
// Then who freed the pieces: the number of names, 32 bits, and of each of these files its length,
// 32 bits, and its characters; the number of pieces that the blank consisted of, that of all so
// far, 32 bits each, and of each of the latter, by number:
//   freed_by               64 bits
//   tile, ring             32 bits each: one of its outer rings; tile 0xffffffff: nothing is left
//   x0 y0 x1 y1            PieceRecord::box, 32 bits each, signed
//   name, line             32 bits each: of the program that freed it; name n is the n-th, 0: none
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "base/result.h"
#include "stock/sheet/pieces.h"
#include "stock/sheet/sheet.h"
#include "stock/sheet/sheet_grid.h"

namespace kerf::sheet {

/// By number of the piece.
using PieceOrigins = std::map<std::uint32_t, PieceOrigin>;

struct SavedSheet {
  SheetGrid grid;
  PieceLabels labels;
  PieceOrigins origins;
  double bottom_mm = 0, top_mm = 0, arc_tolerance_mm = 0;
  std::int64_t blank_area2 = 0;
};

Done write_sheet(const std::string& path, const SavedSheet& saved);

/// From a file's bytes; `name` is used in messages. What comes back can be cut and meshed whatever
/// the bytes were: rings lie in their tiles, holes within the box of an outer ring of theirs, each
/// piece has one number. In a file of layout 1 all that lies apart is a piece of the blank. Errors
/// say what is wrong. Allocates in proportion to the bytes.
Result<SavedSheet> parse_sheet(const std::string& bytes, const std::string& name);

}  // namespace kerf::sheet
