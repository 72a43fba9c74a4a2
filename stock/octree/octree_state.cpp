#include "stock/octree/octree_state.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "base/translate.h"
#include "stock/state_bytes.h"

namespace kerf::octree {
namespace {

enum : std::uint8_t { kEmptyByte = 0, kSolidByte = 1, kStoredByte = 2 };

template <class T>
std::uint8_t byte_of(const SparseRef<T>& ref) {
  return ref.get() ? kStoredByte : ref.is_solid() ? kSolidByte : kEmptyByte;
}

struct Head {
  std::int64_t beside = 0;
  double bounds[6] = {};
  std::int64_t cells[3] = {};
  std::int64_t additive = 0;
  double blank_mm3 = 0;
  std::int64_t removed = 0;

  double node_count() const {
    return static_cast<double>(cells[0]) * static_cast<double>(cells[1]) *
           static_cast<double>(cells[2]);
  }
};

bool sane(const Head& h) {
  constexpr std::int64_t kMostCells = 1'000'000;
  for (const double value : h.bounds)
    if (!std::isfinite(value) || std::abs(value) > 1e6) return false;
  for (int a = 0; a < 3; ++a)
    if (!(h.bounds[a] < h.bounds[a + 3]) || h.cells[a] < 1 || h.cells[a] > kMostCells) return false;
  // Sums of volume stay within 64 bits.
  return (h.additive == 0 || h.additive == 1) && std::isfinite(h.blank_mm3) &&
         h.node_count() * kNodeVolume < 1e18 &&
         std::abs(static_cast<double>(h.removed)) <= 2 * h.node_count() * kNodeVolume;
}

bool read_head(StateHead& reader, Head& h) {
  StateHead before = reader;
  if (before.line("beside") && (!reader.numbers("beside", &h.beside, 1) || h.beside < 1))
    return false;
  return reader.numbers("bounds_mm", h.bounds, 6) && reader.numbers("cells", h.cells, 3) &&
         reader.numbers("additive", &h.additive, 1) &&
         reader.numbers("blank_mm3", &h.blank_mm3, 1) && reader.numbers("removed", &h.removed, 1) &&
         reader.line("data") && sane(h);
}

Lattice lattice_of(const Head& h) {
  const Box box{Vec3(h.bounds[0], h.bounds[1], h.bounds[2]),
                Vec3(h.bounds[3], h.bounds[4], h.bounds[5])};
  return Lattice::of_cells(box, {static_cast<int>(h.cells[0]), static_cast<int>(h.cells[1]),
                                 static_cast<int>(h.cells[2])});
}

/// Takes tiles off the bytes behind the head.
class TileReader {
 public:
  explicit TileReader(std::string_view bytes) : bytes_(bytes) {}
  bool is_at_end() const { return bytes_.empty(); }

  bool read_tile(std::uint64_t version, TileRef& tile) {
    std::uint8_t state = 0;
    if (!take(&state, 1) || state > kStoredByte) return false;
    if (state == kSolidByte) tile = TileRef::solid();
    if (state != kStoredByte) return true;
    Tile* stored = new Tile;
    tile = TileRef::adopt(stored);
    stored->version = version;
    for (BrickRef& brick : stored->bricks)
      if (!read_brick(brick)) return false;
    return true;
  }

 private:
  bool take(void* out, std::size_t bytes) {
    if (bytes_.size() < bytes) return false;
    std::memcpy(out, bytes_.data(), bytes);
    bytes_.remove_prefix(bytes);
    return true;
  }

  bool read_brick(BrickRef& brick) {
    std::uint8_t state = 0;
    if (!take(&state, 1) || state > kStoredByte) return false;
    if (state == kSolidByte) brick = BrickRef::solid();
    if (state != kStoredByte) return true;
    std::uint16_t columns[kSide * kSide];
    if (!take(columns, sizeof columns)) return false;
    for (const std::uint16_t column : columns)
      if (column > kFullColumn) return false;
    int count = 0;
    for_each_crossed(columns, [&](int, int, int, int) { ++count; });
    Brick* stored = Brick::allocate(count, false);
    brick = BrickRef::adopt(stored);
    std::memcpy(stored->columns, columns, sizeof columns);
    const std::size_t crossings = static_cast<std::size_t>(count);
    if (!take(const_cast<std::uint32_t*>(stored->directions()), crossings * sizeof(std::uint32_t)))
      return false;
    if (!take(const_cast<std::uint16_t*>(stored->places()), crossings * sizeof(std::uint16_t)))
      return false;
    open_->open(brick);
    stored->volume = open_->volume;
    return true;
  }

  std::string_view bytes_;
  std::unique_ptr<OpenBrick> open_ = std::make_unique<OpenBrick>();
};

/// What cutting and meshing rely on.
class TreeCheck {
 public:
  TreeCheck(const BrickTree& tree, bool additive) : tree_(tree), additive_(additive) {}

  bool is_sound() const {
    const std::array<int, 3>& tiles = tree_.lattice().tiles;
    for (int bz = 0; bz < tiles[2] * kTileBricks; ++bz)
      for (int by = 0; by < tiles[1] * kTileBricks; ++by)
        for (int bx = 0; bx < tiles[0] * kTileBricks; ++bx)
          if (!is_sound(bx, by, bz)) return false;
    return true;
  }

 private:
  static bool is_solid(const BrickRef& brick, int i, int j, int k) {
    return brick.get() ? (brick->columns[j * kSide + i] >> k & 1u) != 0 : brick.is_solid();
  }
  /// Also of nodes beyond the ends.
  bool outside() const { return additive_; }
  bool is_end(int axis, int node) const {
    return node < 1 || node > tree_.lattice().cells[static_cast<std::size_t>(axis)];
  }
  /// As the brick that owns the node has it.
  bool owned(int bx, int by, int bz, int i, int j, int k) const {
    if (is_end(0, bx * kBrick + i) || is_end(1, by * kBrick + j) || is_end(2, bz * kBrick + k))
      return outside();
    const BrickRef& owner = tree_.brick(bx + i / kBrick, by + j / kBrick, bz + k / kBrick);
    return is_solid(owner, i % kBrick, j % kBrick, k % kBrick);
  }

  bool is_sound(int bx, int by, int bz) const {
    const BrickRef& brick = tree_.brick(bx, by, bz);
    if (is_uniform_around(brick, bx, by, bz)) return true;
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i)
        for (int k = 0; k < kSide; ++k)
          if (is_solid(brick, i, j, k) != owned(bx, by, bz, i, j, k)) return false;
    return true;
  }

  /// Nothing to look at: by far most bricks of a large part.
  bool is_uniform_around(const BrickRef& brick, int bx, int by, int bz) const {
    if (brick.get()) return false;
    const int at[3] = {bx, by, bz};
    for (int axis = 0; axis < 3; ++axis) {
      if (brick.is_solid() == outside()) break;
      if (is_end(axis, at[axis] * kBrick) || is_end(axis, at[axis] * kBrick + kBrick)) return false;
    }
    for (int n = 1; n < 8; ++n) {
      const int x = bx + (n & 1), y = by + (n >> 1 & 1), z = bz + (n >> 2);
      const std::array<int, 3>& tiles = tree_.lattice().tiles;
      if (x >= tiles[0] * kTileBricks || y >= tiles[1] * kTileBricks || z >= tiles[2] * kTileBricks)
        continue;  // beyond the ends, which has been looked at
      if (!(tree_.brick(x, y, z) == brick)) return false;
    }
    return true;
  }

  const BrickTree& tree_;
  bool additive_;
};

}  // namespace

Done write_tree(const std::string& path, const SavedTree& saved) {
  Result<StateWriter> file = StateWriter::create(path);
  if (!file) return Error{file.error()};
  const Lattice& lattice = saved.tree.lattice();
  const Box& b = lattice.bounds_mm;
  const std::string head = fmt::format(
      "{}model octree\n{}bounds_mm {} {} {} {} {} {}\ncells {} {} {}\nadditive {}\nblank_mm3 {}\n"
      "removed {}\ndata\n",
      kStateMagic, saved.beside.empty() ? "" : fmt::format("beside {}\n", saved.beside.size()),
      b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z, lattice.cells[0], lattice.cells[1],
      lattice.cells[2], saved.additive ? 1 : 0, saved.blank_mm3, saved.removed);
  file->put(head.data(), head.size());
  for (std::uint32_t number = 0; number < saved.tree.tile_count(); ++number) {
    const TileRef& tile = saved.tree.tile(number);
    const std::uint8_t tile_state = byte_of(tile);
    file->put(&tile_state, 1);
    if (!tile.get()) continue;
    for (const BrickRef& brick : tile->bricks) {
      const std::uint8_t state = byte_of(brick);
      file->put(&state, 1);
      if (!brick.get()) continue;
      const std::size_t crossings = brick->crossings;
      file->put(brick->columns, sizeof brick->columns);
      file->put(brick->directions(), crossings * sizeof(std::uint32_t));
      file->put(brick->places(), crossings * sizeof(std::uint16_t));
    }
  }
  file->put(saved.beside.data(), saved.beside.size());
  return file->commit();
}

Result<SavedTree> parse_tree(const std::string& bytes, const std::string& name) {
  Head head;
  const Result<StateHead> reader = head_of_state(
      bytes, name, "octree", [&head](StateHead& lines) { return read_head(lines, head); });
  if (!reader) return Error{reader.error()};
  Result<std::string_view> data = data_of_state(*reader, name);
  if (!data) return Error{data.error()};
  const std::string damaged = trf("{}: the tiles are damaged", name);
  const auto beside = static_cast<std::uint64_t>(head.beside);
  if (beside > data->size()) return Error{damaged};
  const std::string_view behind = data->substr(data->size() - beside);
  *data = data->substr(0, data->size() - beside);
  const Lattice lattice = lattice_of(head);
  const double tiles = static_cast<double>(lattice.tiles[0]) * lattice.tiles[1] * lattice.tiles[2];
  if (tiles > static_cast<double>(data->size())) return Error{damaged};

  SavedTree saved{BrickTree(lattice), head.additive == 1, head.blank_mm3, head.removed,
                  std::string(behind)};
  TileReader tile_reader(*data);
  const std::uint64_t version = next_version();
  const int columns = lattice.column_count();
  for (std::uint32_t number = 0; number < saved.tree.tile_count(); ++number) {
    TileRef tile;
    if (!tile_reader.read_tile(version, tile)) return Error{damaged};
    const int n = static_cast<int>(number);
    saved.tree.set_tile(n % columns, n / columns, std::move(tile));
    saved.tree.settle_tile(n % columns, n / columns);
  }
  if (!tile_reader.is_at_end() || !TreeCheck(saved.tree, saved.additive).is_sound())
    return Error{damaged};
  return saved;
}

}  // namespace kerf::octree
