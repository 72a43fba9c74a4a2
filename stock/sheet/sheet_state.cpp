#include "stock/sheet/sheet_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include "stock/state_bytes.h"

namespace kerf::sheet {
namespace {

struct Head {
  std::int64_t bounds[4] = {};
  std::int64_t tiles[2] = {};
  double z_mm[2] = {};
  double arc_tolerance_mm = 0;
  std::int64_t blank_area2 = 0;

  Rect rect() const { return {bounds[0], bounds[1], bounds[2], bounds[3]}; }
};

bool sane(const Head& h) {
  constexpr auto kMost = static_cast<Unit>(kMaxCoordinate_mm * kUnitsPerMm);
  for (const std::int64_t value : h.bounds) {
    if (value < -kMost || value > kMost) return false;
  }
  for (const std::int64_t count : h.tiles) {
    if (count < 1 || count > SheetGrid::kMaxTilesEachWay) return false;
  }
  for (const double z : h.z_mm) {
    if (!(std::abs(z) <= kMaxCoordinate_mm + kMaxThickness_mm)) return false;
  }
  const double thickness = h.z_mm[1] - h.z_mm[0];
  return h.bounds[0] < h.bounds[2] && h.bounds[1] < h.bounds[3] &&
         h.bounds[2] - h.bounds[0] >= h.tiles[0] && h.bounds[3] - h.bounds[1] >= h.tiles[1] &&
         thickness >= kMinThickness_mm && thickness <= kMaxThickness_mm &&
         h.arc_tolerance_mm >= kMinTolerance_mm && h.arc_tolerance_mm <= kMaxTolerance_mm &&
         h.blank_area2 > 0 && h.blank_area2 <= twice_area_of(h.rect());
}

bool read_head(StateHead& reader, Head& h) {
  return reader.numbers("bounds", h.bounds, 4) && reader.numbers("tiles", h.tiles, 2) &&
         reader.numbers("z_mm", h.z_mm, 2) &&
         reader.numbers("arc_tolerance_mm", &h.arc_tolerance_mm, 1) &&
         reader.numbers("blank_area2", &h.blank_area2, 1) && reader.line("data") && sane(h);
}

/// Takes tiles off the bytes behind the head.
class TileReader {
 public:
  explicit TileReader(std::string_view bytes) : bytes_(bytes) {}
  bool is_at_end() const { return bytes_.empty(); }

  bool read_tile(const Rect& rect, std::vector<Ring>& rings) {
    std::uint32_t count = 0;
    if (!take(&count, sizeof count) || count > bytes_.size() / sizeof(std::uint32_t)) return false;
    rings.resize(count);
    std::int64_t area2 = 0;
    for (Ring& ring : rings) {
      if (!read_ring(rect, ring)) return false;
      area2 += twice_area(ring);
    }
    return area2 >= 0 && holes_have_owners(rings);
  }

 private:
  bool take(void* out, std::size_t bytes) {
    if (bytes_.size() < bytes) return false;
    std::memcpy(out, bytes_.data(), bytes);
    bytes_.remove_prefix(bytes);
    return true;
  }

  bool read_ring(const Rect& rect, Ring& ring) {
    std::uint32_t count = 0;
    if (!take(&count, sizeof count) || count < 3) return false;
    if (count > bytes_.size() / (2 * sizeof(std::int32_t))) return false;
    ring.resize(count);
    for (Point& p : ring) {
      std::int32_t xy[2];
      if (!take(xy, sizeof xy)) return false;
      p = {xy[0], xy[1]};
      if (!rect.holds(p)) return false;
    }
    return twice_area(ring) != 0;
  }

  static bool holes_have_owners(const std::vector<Ring>& rings) {
    std::vector<Rect> outer;
    for (const Ring& ring : rings) {
      if (twice_area(ring) > 0) outer.push_back(bounds_of(ring));
    }
    for (const Ring& ring : rings) {
      if (twice_area(ring) > 0) continue;
      const Rect box = bounds_of(ring);
      const auto is_round = [&](const Rect& other) {
        return other.holds({box.min_x, box.min_y}) && other.holds({box.max_x, box.max_y});
      };
      if (std::none_of(outer.begin(), outer.end(), is_round)) return false;
    }
    return true;
  }

  std::string_view bytes_;
};

void put_ring(const Ring& ring, StateWriter& file) {
  const auto count = static_cast<std::uint32_t>(ring.size());
  file.put(&count, sizeof count);
  std::vector<std::int32_t> numbers;
  numbers.reserve(2 * ring.size());
  for (const Point& p : ring) {
    numbers.push_back(static_cast<std::int32_t>(p.X));
    numbers.push_back(static_cast<std::int32_t>(p.Y));
  }
  file.put(numbers.data(), numbers.size() * sizeof(std::int32_t));
}

}  // namespace

Done write_sheet(const std::string& path, const SavedSheet& saved) {
  Result<StateWriter> file = StateWriter::create(path);
  if (!file) return Error{file.error()};
  const Rect& b = saved.grid.bounds();
  const std::string head = fmt::format(
      "{}model sheet\nbounds {} {} {} {}\ntiles {} {}\nz_mm {} {}\narc_tolerance_mm {}\n"
      "blank_area2 {}\ndata\n",
      kStateMagic, b.min_x, b.min_y, b.max_x, b.max_y, saved.grid.columns(), saved.grid.rows(),
      saved.bottom_mm, saved.top_mm, saved.arc_tolerance_mm, saved.blank_area2);
  file->put(head.data(), head.size());
  for (std::size_t i = 0; i < saved.grid.tile_count(); ++i) {
    const Tile& tile = saved.grid.tile(i);
    const auto count = static_cast<std::uint32_t>(tile.rings.size());
    file->put(&count, sizeof count);
    for (const TileRingPointer& ring : tile.rings) put_ring(ring->points, *file);
  }
  return file->commit();
}

Result<SavedSheet> parse_sheet(const std::string& bytes, const std::string& name) {
  Result<StateHead> reader = head_of_state(bytes, name, "sheet");
  if (!reader) return Error{reader.error()};
  Head head;
  if (!read_head(*reader, head))
    return Error{fmt::format("{}: the head is damaged near byte {}", name, reader->position())};
  if (!has_right_checksum(bytes))
    return Error{
        fmt::format("{}: the checksum does not match: the file is damaged or cut short", name)};
  const std::string damaged = fmt::format("{}: the tiles are damaged", name);
  // The checksum may overlap the head of a file that is made up.
  const std::size_t end = bytes.size() - kStateHashBytes;
  if (end < reader->position()) return Error{damaged};
  const std::size_t data = end - reader->position();
  const auto count = static_cast<std::size_t>(head.tiles[0] * head.tiles[1]);
  if (count > data / sizeof(std::uint32_t)) return Error{damaged};

  SavedSheet saved{
      SheetGrid(head.rect(), static_cast<int>(head.tiles[0]), static_cast<int>(head.tiles[1])),
      head.z_mm[0], head.z_mm[1], head.arc_tolerance_mm, head.blank_area2};
  TileReader tiles(std::string_view(bytes).substr(reader->position(), data));
  std::vector<Ring> rings;
  for (std::size_t i = 0; i < count; ++i) {
    if (!tiles.read_tile(saved.grid.tile_rect(i), rings)) return Error{damaged};
    saved.grid.set_rings(i, std::move(rings));
    rings.clear();
  }
  if (!tiles.is_at_end() || saved.grid.area2() > saved.blank_area2) return Error{damaged};
  return saved;
}

}  // namespace kerf::sheet
