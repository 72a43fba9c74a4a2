// stock/zmap/state_file.h - heights on disk: kerf-state/1 (stock/state_bytes.h) of a Z-map, and the
// first part of that of an M-map (stock/zmap/mmap/mmap_state.h).
//
//   model zmap
//   bounds_mm x0 y0 z0 x1 y1 z1
//   cells nx ny
//   blank_mm3 v
//   data
// Then nx * ny IEEE float32, row by row (y outer): height in mm. Of a Z-map that knows where walls
// stand between middles of cells, then for each tile of 64 x 64 cells, row by row: a uint32, how
// many marks follow, and these, 8 bytes each (WallMark). Files without are of older versions, or
// have no such walls.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "stock/state_bytes.h"
#include "stock/zmap/tile_grid.h"
#include "stock/zmap/wall_marks.h"

namespace kerf {

struct SavedState {
  TileGrid grid;
  double blank_mm3 = 0;
  std::vector<PlacedMark> marks{};
};

/// Head and heights, with which the file of any model of heights begins.
void put_heights(StateWriter& file, const std::string& model, const TileGrid& grid,
                 double blank_mm3);
struct SavedHeights {
  SavedState state;
  std::string_view rest;  ///< of the bytes, between the heights and the checksum
};
/// `goes_on`: there may be such a rest. The checksum is checked.
Result<SavedHeights> parse_heights(const std::string& bytes, const std::string& name,
                                   const std::string& model, bool goes_on);

Done write_state(const std::string& path, const TileGrid& grid, const WallMarks& marks,
                 double blank_mm3);

/// Errors name the file and what is wrong with it (not a kerf-state file, cut short at byte N,
/// checksum). The size of what is allocated is bounded by the file's own size.
Result<SavedState> read_state(const std::string& path);

/// The same from memory; `name` is used in messages. For fuzzing and read_state().
Result<SavedState> parse_state(const std::string& bytes, const std::string& name);

}  // namespace kerf
