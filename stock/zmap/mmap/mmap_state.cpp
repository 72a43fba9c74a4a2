#include "stock/zmap/mmap/mmap_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "base/mesh_patch.h"
#include "base/translate.h"
#include "stock/zmap/state_file.h"

namespace kerf {
namespace {

struct Record {
  std::uint32_t cell = 0;
  float low = 0, high = 0;
};
static_assert(sizeof(Record) == 12);

void put_tile(StateWriter& file, const TileGrid& grid, std::size_t number, const GapTile& tile) {
  const int first_x = static_cast<int>(number) % grid.tiles_x() * kTileCells;
  const int first_y = static_cast<int>(number) / grid.tiles_x() * kTileCells;
  for (int j = first_y; j < std::min(first_y + kTileCells, grid.ny()); ++j) {
    for (int i = first_x; i < std::min(first_x + kTileCells, grid.nx()); ++i) {
      tile.each(TileGrid::offset(i, j), [&](const Gap& gap) {
        const Record record{static_cast<std::uint32_t>(j) * static_cast<std::uint32_t>(grid.nx()) +
                                static_cast<std::uint32_t>(i),
                            gap.low, gap.high};
        file.put(&record, sizeof record);
      });
    }
  }
}

/// Puts the gaps of one cell, topmost first, into the grid; false if they do not fit in the column.
bool set_gaps(const TileGrid& grid, std::uint32_t cell, const std::vector<Gap>& gaps, GapGrid& to) {
  const std::uint32_t nx = static_cast<std::uint32_t>(grid.nx());
  if (cell >= static_cast<std::uint64_t>(nx) * static_cast<std::uint64_t>(grid.ny())) return false;
  const int i = static_cast<int>(cell % nx), j = static_cast<int>(cell / nx);
  float above = grid.height(i, j);
  for (const Gap& gap : gaps) {
    // Written so that what is no number fails as well.
    if (!(gap.high < above && gap.low < gap.high && gap.low >= grid.floor_mm())) return false;
    above = gap.low;
  }
  GapTile& tile =
      to.make_writable(static_cast<std::size_t>(j / kTileCells * grid.tiles_x() + i / kTileCells));
  const std::size_t offset = TileGrid::offset(i, j);
  if (tile.has(offset)) return false;  // the same cell at two places of the file
  tile.write(offset, gaps);
  return true;
}

}  // namespace

Done write_columns(const std::string& path, const SavedColumns& saved) {
  Result<StateWriter> file = StateWriter::create(path);
  if (!file) return Error{file.error()};
  put_heights(*file, "mmap", saved.heights, saved.blank_mm3);
  for (std::size_t n = 0; n < saved.heights.tile_count(); ++n)
    if (const GapTile* const tile = saved.gaps.tile(n)) put_tile(*file, saved.heights, n, *tile);
  return file->commit();
}

Result<SavedColumns> parse_columns(const std::string& bytes, const std::string& name) {
  Result<SavedHeights> heights = parse_heights(bytes, name, "mmap", true);
  if (!heights) return Error{heights.error()};
  const std::size_t size = heights->rest.size();
  if (size % sizeof(Record) != 0)
    return Error{trf("{}: {} bytes of gaps are no whole number of them", name, size)};
  const std::size_t tiles = heights->state.grid.tile_count();
  SavedColumns saved{std::move(heights->state.grid), GapGrid(tiles), heights->state.blank_mm3};
  const std::size_t count = size / sizeof(Record);
  const auto record = [&](std::size_t n) {
    Record r;
    std::memcpy(&r, heights->rest.data() + n * sizeof r, sizeof r);
    return r;
  };
  std::vector<Gap> gaps;
  for (std::size_t n = 0; n < count;) {
    const std::uint32_t cell = record(n).cell;
    const std::size_t first = n;
    gaps.clear();
    for (; n < count && record(n).cell == cell; ++n)
      gaps.push_back({record(n).low, record(n).high, MeshPatch::kNotCut, MeshPatch::kNotCut});
    if (!set_gaps(saved.heights, cell, gaps, saved.gaps))
      return Error{trf("{}: gap {} does not lie in its column", name, first)};
  }
  return saved;
}

}  // namespace kerf
