// stock/zmap/mmap/mmap_state.h - an M-map on disk: kerf-state/1 (stock/state_bytes.h).
//
// As a Z-map's (stock/zmap/state_file.h), with "model mmap"; behind the heights the gaps, each
//   cell, 32 bits: number in its row + nx * number of the row
//   low, high: IEEE float32, mm
// by tile (as TileGrid has them), then row, then cell, and of one cell the topmost first.
#pragma once

#include <string>

#include "base/result.h"
#include "stock/zmap/mmap/gap_grid.h"
#include "stock/zmap/tile_grid.h"

namespace kerf {

struct SavedColumns {
  TileGrid heights;
  GapGrid gaps;
  double blank_mm3 = 0;
};

/// Without numbers of moves.
Done write_columns(const std::string& path, const SavedColumns& saved);

/// From a file's bytes; `name` is used in messages. Gaps come back within their column, with
/// material between them, or not at all: then the error says which one is wrong.
Result<SavedColumns> parse_columns(const std::string& bytes, const std::string& name);

}  // namespace kerf
