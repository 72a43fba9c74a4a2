#include "stock/zmap/state_file.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "stock/state_bytes.h"

namespace kerf {
namespace {

struct Head {
  double bounds[6] = {};
  std::int64_t cells[2] = {};
  double blank_mm3 = 0;
};

bool sane(const Head& h) {
  for (const double value : h.bounds)
    if (!std::isfinite(value) || std::abs(value) > 1e6) return false;
  return h.bounds[0] < h.bounds[3] && h.bounds[1] < h.bounds[4] && h.bounds[2] < h.bounds[5] &&
         h.cells[0] > 0 && h.cells[1] > 0 && h.cells[0] < (1 << 30) && h.cells[1] < (1 << 30) &&
         std::isfinite(h.blank_mm3);
}

bool read_head(StateHead& reader, Head& head) {
  return reader.numbers("bounds_mm", head.bounds, 6) && reader.numbers("cells", head.cells, 2) &&
         reader.numbers("blank_mm3", &head.blank_mm3, 1) && reader.line("data") && sane(head);
}

void put_marks(StateWriter& file, const TileGrid& grid, const WallMarks& marks) {
  std::vector<std::vector<WallMark>> tiles(grid.tile_count());
  bool any = false;
  for (std::size_t tile = 0; tile < tiles.size(); ++tile) {
    tiles[tile] = marks.marks(tile, grid);
    any |= !tiles[tile].empty();
  }
  if (!any) return;
  for (const std::vector<WallMark>& tile : tiles) {
    const auto count = static_cast<std::uint32_t>(tile.size());
    file.put(&count, sizeof count);
    file.put(tile.data(), tile.size() * sizeof(WallMark));
  }
}

/// False where they are not what put_marks() writes.
bool take_marks(std::string_view bytes, SavedState& state) {
  if (bytes.empty()) return true;
  for (std::size_t tile = 0; tile < state.grid.tile_count(); ++tile) {
    std::uint32_t count = 0;
    if (bytes.size() < sizeof count) return false;
    std::memcpy(&count, bytes.data(), sizeof count);
    bytes.remove_prefix(sizeof count);
    if (bytes.size() / sizeof(WallMark) < count) return false;
    for (; count > 0; --count, bytes.remove_prefix(sizeof(WallMark))) {
      WallMark mark;
      std::memcpy(&mark, bytes.data(), sizeof mark);
      if (!is_sound(mark, tile, state.grid)) return false;
      state.marks.push_back({static_cast<std::uint32_t>(tile), mark});
    }
  }
  return bytes.empty();
}

}  // namespace

void put_heights(StateWriter& file, const std::string& model, const TileGrid& grid,
                 double blank_mm3) {
  const Box& b = grid.bounds_mm();
  const std::string head = fmt::format(
      "{}model {}\nbounds_mm {} {} {} {} {} {}\ncells {} {}\nblank_mm3 {}\ndata\n", kStateMagic,
      model, b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z, grid.nx(), grid.ny(), blank_mm3);
  file.put(head.data(), head.size());
  std::vector<float> row(static_cast<std::size_t>(grid.nx()));
  for (int j = 0; j < grid.ny(); ++j) {
    grid.copy_row(j, row.data());
    file.put(row.data(), row.size() * sizeof(float));
  }
}

Result<SavedHeights> parse_heights(const std::string& bytes, const std::string& name,
                                   const std::string& model, bool goes_on) {
  Head head;
  const Result<StateHead> reader = head_of_state(
      bytes, name, model, [&head](StateHead& lines) { return read_head(lines, head); });
  if (!reader) return Error{reader.error()};
  const std::size_t count =
      static_cast<std::size_t>(head.cells[0]) * static_cast<std::size_t>(head.cells[1]);
  const std::size_t expected = reader->position() + count * sizeof(float) + kStateHashBytes;
  if (goes_on ? bytes.size() < expected : bytes.size() != expected) {
    return Error{fmt::format("{}: {} bytes long, but {} x {} cells need {}{}: the file is {}", name,
                             bytes.size(), head.cells[0], head.cells[1], goes_on ? "at least " : "",
                             expected, bytes.size() < expected ? "cut short" : "too long")};
  }
  const Result<std::string_view> data = data_of_state(*reader, name);
  if (!data) return Error{data.error()};

  const Box box{Vec3(head.bounds[0], head.bounds[1], head.bounds[2]),
                Vec3(head.bounds[3], head.bounds[4], head.bounds[5])};
  TileGrid grid(box, static_cast<int>(head.cells[0]), static_cast<int>(head.cells[1]));
  std::vector<float> row(static_cast<std::size_t>(grid.nx()));
  const std::size_t row_bytes = row.size() * sizeof(float);
  std::string_view rest = *data;
  for (int j = 0; j < grid.ny(); ++j, rest.remove_prefix(row_bytes)) {
    std::memcpy(row.data(), rest.data(), row_bytes);
    for (const float height : row)
      if (!std::isfinite(height))
        return Error{fmt::format("{}: row {} holds a height that is not a number", name, j)};
    grid.set_row(j, row.data());
  }
  return SavedHeights{{std::move(grid), head.blank_mm3}, rest};
}

Done write_state(const std::string& path, const TileGrid& grid, const WallMarks& marks,
                 double blank_mm3) {
  Result<StateWriter> file = StateWriter::create(path);
  if (!file) return Error{file.error()};
  put_heights(*file, "zmap", grid, blank_mm3);
  put_marks(*file, grid, marks);
  return file->commit();
}

Result<SavedState> parse_state(const std::string& bytes, const std::string& name) {
  Result<SavedHeights> heights = parse_heights(bytes, name, "zmap", true);
  if (!heights) return Error{heights.error()};
  if (!take_marks(heights->rest, heights->state))
    return Error{fmt::format("{}: the walls behind its heights are damaged", name)};
  return std::move(heights->state);
}

Result<SavedState> read_state(const std::string& path) {
  const Result<std::string> bytes = read_state_bytes(path);
  if (!bytes) return Error{bytes.error()};
  return parse_state(*bytes, path);
}

}  // namespace kerf
