// stock/zmap/state_file.h - a workpiece on disk: kerf-state/1.
//
//   kerf-state/1\n
//   model zmap\n
//   bounds_mm x0 y0 z0 x1 y1 z1\n      shortest decimals that give the same doubles
//   cells nx ny\n
//   blank_mm3 v\n
//   data\n                             nx * ny IEEE float32, little endian, row by row (y outer):
//   height in mm xxh3-128 of all bytes before, 16 bytes, big endian
#pragma once

#include <string>

#include "base/result.h"
#include "stock/zmap/tile_grid.h"

namespace kerf {

struct SavedState {
  TileGrid grid;
  double blank_mm3 = 0;
};

Done write_state(const std::string& path, const TileGrid& grid, double blank_mm3);

/// Errors name the file and what is wrong with it (not a kerf-state file, cut short at byte N,
/// checksum). The size of what is allocated is bounded by the file's own size.
Result<SavedState> read_state(const std::string& path);

/// The same from memory; `name` is used in messages. For fuzzing and read_state().
Result<SavedState> parse_state(const std::string& bytes, const std::string& name);

}  // namespace kerf
