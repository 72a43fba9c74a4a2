#include "stock/zmap/state_file.h"

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>
#include <vector>

#include "base/atomic_file.h"

namespace kerf {
namespace {

static_assert(std::endian::native == std::endian::little,
              "heights are written as they lie in memory");

constexpr std::string_view kMagic = "kerf-state/1\n";
constexpr std::size_t kHashBytes = sizeof(XXH128_canonical_t);

/// Takes lines of the head off the front of `text`.
class HeadReader {
 public:
  explicit HeadReader(std::string_view text) : text_(text) {}
  std::size_t position() const { return position_; }

  /// The rest of a line that begins with `key`; nullopt if the next line is another one.
  std::optional<std::string_view> line(std::string_view key) {
    const std::string_view rest = text_.substr(position_);
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos || rest.substr(0, key.size()) != key) return std::nullopt;
    std::string_view value = rest.substr(key.size(), end - key.size());
    position_ += end + 1;
    if (!value.empty() && value.front() == ' ') value.remove_prefix(1);
    return value;
  }

  template <class T>
  static bool numbers(std::string_view value, T* out, int count) {
    for (int i = 0; i < count; ++i) {
      while (!value.empty() && value.front() == ' ') value.remove_prefix(1);
      const auto [end, fault] = std::from_chars(value.data(), value.data() + value.size(), out[i]);
      if (fault != std::errc()) return false;
      value.remove_prefix(static_cast<std::size_t>(end - value.data()));
    }
    return value.empty();
  }

 private:
  std::string_view text_;
  std::size_t position_ = 0;
};

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

bool read_head(HeadReader& reader, Head& head) {
  const auto model = reader.line("model");
  if (!model || *model != "zmap") return false;
  const auto bounds = reader.line("bounds_mm");
  if (!bounds || !HeadReader::numbers(*bounds, head.bounds, 6)) return false;
  const auto cells = reader.line("cells");
  if (!cells || !HeadReader::numbers(*cells, head.cells, 2)) return false;
  const auto blank = reader.line("blank_mm3");
  if (!blank || !HeadReader::numbers(*blank, &head.blank_mm3, 1)) return false;
  return reader.line("data").has_value() && sane(head);
}

}  // namespace

Done write_state(const std::string& path, const TileGrid& grid, double blank_mm3) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return Error{file.error()};
  XXH3_state_t hash;
  XXH3_128bits_reset(&hash);
  const auto put = [&](const void* data, std::size_t bytes) {
    XXH3_128bits_update(&hash, data, bytes);
    file->write(data, bytes);
  };
  const Box& b = grid.bounds_mm();
  const std::string head = fmt::format(
      "{}model zmap\nbounds_mm {} {} {} {} {} {}\ncells {} {}\nblank_mm3 {}\ndata\n", kMagic,
      b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z, grid.nx(), grid.ny(), blank_mm3);
  put(head.data(), head.size());
  std::vector<float> row(static_cast<std::size_t>(grid.nx()));
  for (int j = 0; j < grid.ny(); ++j) {
    grid.copy_row(j, row.data());
    put(row.data(), row.size() * sizeof(float));
  }
  XXH128_canonical_t sum;
  XXH128_canonicalFromHash(&sum, XXH3_128bits_digest(&hash));
  file->write(&sum, sizeof sum);
  return file->commit();
}

Result<SavedState> parse_state(const std::string& bytes, const std::string& name) {
  if (std::string_view(bytes).substr(0, kMagic.size()) != kMagic)
    return Error{
        fmt::format("{}: not a saved workpiece (it must begin with \"kerf-state/1\")", name)};
  HeadReader reader(bytes);
  reader.line("kerf-state/1");
  Head head;
  if (!read_head(reader, head))
    return Error{fmt::format("{}: the head is damaged near byte {}", name, reader.position())};
  const std::size_t count =
      static_cast<std::size_t>(head.cells[0]) * static_cast<std::size_t>(head.cells[1]);
  const std::size_t expected = reader.position() + count * sizeof(float) + kHashBytes;
  if (bytes.size() != expected) {
    return Error{fmt::format("{}: {} bytes long, but {} x {} cells need {}: the file is {}", name,
                             bytes.size(), head.cells[0], head.cells[1], expected,
                             bytes.size() < expected ? "cut short" : "too long")};
  }
  XXH128_canonical_t sum;
  std::memcpy(&sum, bytes.data() + expected - kHashBytes, kHashBytes);
  const XXH128_hash_t stored = XXH128_hashFromCanonical(&sum);
  if (!XXH128_isEqual(stored, XXH3_128bits(bytes.data(), expected - kHashBytes)))
    return Error{fmt::format("{}: the checksum does not match: the file is damaged", name)};

  const Box box{Vec3(head.bounds[0], head.bounds[1], head.bounds[2]),
                Vec3(head.bounds[3], head.bounds[4], head.bounds[5])};
  TileGrid grid(box, static_cast<int>(head.cells[0]), static_cast<int>(head.cells[1]));
  std::vector<float> row(static_cast<std::size_t>(grid.nx()));
  const char* data = bytes.data() + reader.position();
  for (int j = 0; j < grid.ny(); ++j, data += row.size() * sizeof(float)) {
    std::memcpy(row.data(), data, row.size() * sizeof(float));
    for (const float height : row)
      if (!std::isfinite(height))
        return Error{fmt::format("{}: row {} holds a height that is not a number", name, j)};
    grid.set_row(j, row.data());
  }
  return SavedState{std::move(grid), head.blank_mm3};
}

Result<SavedState> read_state(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return Error{fmt::format("{}: {}", path, std::strerror(errno))};
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (in.bad()) return Error{fmt::format("{}: cannot be read", path)};
  return parse_state(bytes, path);
}

}  // namespace kerf
