#include "stock/sheet/sheet_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include "base/translate.h"
#include "stock/state_bytes.h"

namespace kerf::sheet {
namespace {

constexpr std::int64_t kLayout = 2;

struct Head {
  std::int64_t layout = 1;
  std::int64_t bounds[4] = {};
  std::int64_t tiles[2] = {};
  double z_mm[2] = {};
  double arc_tolerance_mm = 0;
  std::int64_t blank_area2 = 0;

  Rect rect() const { return {bounds[0], bounds[1], bounds[2], bounds[3]}; }
  bool is_known() const { return layout == 1 || layout == kLayout; }
};

/// As it lies in the file.
struct PieceEntry {
  std::uint64_t freed_by = 0;
  std::uint32_t tile = 0, ring = 0;
  std::int32_t box[4] = {};
  std::uint32_t name = 0, line = 0;
};
static_assert(sizeof(PieceEntry) == 40);

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
  StateHead ahead = reader;
  if (ahead.line("layout") && !reader.numbers("layout", &h.layout, 1)) return false;
  if (!h.is_known()) return h.layout > 0;  // what follows is not known either
  return reader.numbers("bounds", h.bounds, 4) && reader.numbers("tiles", h.tiles, 2) &&
         reader.numbers("z_mm", h.z_mm, 2) &&
         reader.numbers("arc_tolerance_mm", &h.arc_tolerance_mm, 1) &&
         reader.numbers("blank_area2", &h.blank_area2, 1) && reader.line("data") && sane(h);
}

/// Takes tiles and pieces off the bytes behind the head.
class DataReader {
 public:
  explicit DataReader(std::string_view bytes) : bytes_(bytes) {}
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

  bool read_pieces(SavedSheet& saved) {
    std::vector<std::string> names;
    std::uint32_t blank_pieces = 0, count = 0;
    if (!read_names(names) || !take(&blank_pieces, sizeof blank_pieces) ||
        !take(&count, sizeof count) || count > bytes_.size() / sizeof(PieceEntry))
      return false;
    std::vector<PieceSeat> seats;
    for (std::uint32_t number = 0; number < count; ++number) {
      PieceEntry e;
      if (!take(&e, sizeof e) || e.name > names.size()) return false;
      seats.push_back({e.tile, e.ring, {e.box[0], e.box[1], e.box[2], e.box[3]}, e.freed_by});
      if (number >= blank_pieces && (e.name > 0 || e.line > 0))
        saved.origins[number] = {e.name > 0 ? names[e.name - 1] : std::string(), e.line};
    }
    return saved.labels.restore(saved.grid, seats, blank_pieces);
  }

 private:
  bool read_names(std::vector<std::string>& names) {
    std::uint32_t count = 0;
    if (!take(&count, sizeof count) || count > bytes_.size() / sizeof count) return false;
    names.resize(count);
    for (std::string& name : names) {
      std::uint32_t length = 0;
      if (!take(&length, sizeof length) || length > bytes_.size()) return false;
      name = bytes_.substr(0, length);
      bytes_.remove_prefix(length);
    }
    return true;
  }

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

void put_number(std::size_t number, StateWriter& file) {
  const auto bits = static_cast<std::uint32_t>(number);
  file.put(&bits, sizeof bits);
}

void put_pieces(const SavedSheet& saved, StateWriter& file) {
  std::map<std::string_view, std::uint32_t> names;  // from 1 on, in the order of the map
  for (const auto& [number, origin] : saved.origins) {
    if (!origin.file.empty()) names[origin.file] = 0;
  }
  put_number(names.size(), file);
  std::uint32_t last = 0;
  for (auto& [name, place] : names) {
    place = ++last;
    put_number(name.size(), file);
    file.put(name.data(), name.size());
  }
  const std::vector<PieceSeat> seats = saved.labels.seats(saved.grid);
  put_number(saved.labels.blank_pieces(), file);
  put_number(seats.size(), file);
  for (std::uint32_t number = 0; number < seats.size(); ++number) {
    const PieceSeat& seat = seats[number];
    PieceEntry entry{seat.freed_by, seat.tile, seat.ring, {}, 0, 0};
    if (seat.tile != kNoPiece) {
      const Unit box[4] = {seat.box.min_x, seat.box.min_y, seat.box.max_x, seat.box.max_y};
      std::copy(box, box + 4, entry.box);
    }
    if (const auto origin = saved.origins.find(number); origin != saved.origins.end()) {
      entry.line = origin->second.line;
      if (!origin->second.file.empty()) entry.name = names[origin->second.file];
    }
    file.put(&entry, sizeof entry);
  }
}

}  // namespace

Done write_sheet(const std::string& path, const SavedSheet& saved) {
  Result<StateWriter> file = StateWriter::create(path);
  if (!file) return Error{file.error()};
  const Rect& b = saved.grid.bounds();
  const std::string head = fmt::format(
      "{}model sheet\nlayout {}\nbounds {} {} {} {}\ntiles {} {}\nz_mm {} {}\narc_tolerance_mm {}\n"
      "blank_area2 {}\ndata\n",
      kStateMagic, kLayout, b.min_x, b.min_y, b.max_x, b.max_y, saved.grid.columns(),
      saved.grid.rows(), saved.bottom_mm, saved.top_mm, saved.arc_tolerance_mm, saved.blank_area2);
  file->put(head.data(), head.size());
  for (std::size_t i = 0; i < saved.grid.tile_count(); ++i) {
    const Tile& tile = saved.grid.tile(i);
    const auto count = static_cast<std::uint32_t>(tile.rings.size());
    file->put(&count, sizeof count);
    for (const TileRingPointer& ring : tile.rings) put_ring(ring->points, *file);
  }
  put_pieces(saved, *file);
  return file->commit();
}

Result<SavedSheet> parse_sheet(const std::string& bytes, const std::string& name) {
  Head head;
  const Result<StateHead> reader = head_of_state(
      bytes, name, "sheet", [&head](StateHead& lines) { return read_head(lines, head); });
  if (!reader) return Error{reader.error()};
  if (!head.is_known()) {
    return Error{
        trf("{}: a sheet of layout {}; layouts 1 to {} can be read", name, head.layout, kLayout)};
  }
  const Result<std::string_view> data = data_of_state(*reader, name);
  if (!data) return Error{data.error()};
  const std::string damaged = trf("{}: the tiles are damaged", name);
  const auto count = static_cast<std::size_t>(head.tiles[0] * head.tiles[1]);
  if (count > data->size() / sizeof(std::uint32_t)) return Error{damaged};

  SheetGrid grid(head.rect(), static_cast<int>(head.tiles[0]), static_cast<int>(head.tiles[1]));
  DataReader rest(*data);
  std::vector<Ring> rings;
  for (std::size_t i = 0; i < count; ++i) {
    if (!rest.read_tile(grid.tile_rect(i), rings)) return Error{damaged};
    grid.set_rings(i, std::move(rings));
    rings.clear();
  }
  if (grid.area2() > head.blank_area2) return Error{damaged};
  PieceLabels labels(grid);
  SavedSheet saved{std::move(grid),       std::move(labels), {}, head.z_mm[0], head.z_mm[1],
                   head.arc_tolerance_mm, head.blank_area2};
  const bool has_pieces = head.layout > 1;
  if ((has_pieces && !rest.read_pieces(saved)) || !rest.is_at_end())
    return Error{has_pieces ? trf("{}: the pieces are damaged", name) : damaged};
  return saved;
}

}  // namespace kerf::sheet
