#include "stock/octree/brick_tree.h"

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>

namespace kerf::octree {

std::uint64_t next_version() {
  // 0 and 1 are those of empty and solid tiles.
  static std::atomic<std::uint64_t> last{1};
  return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

Lattice Lattice::over(const Box& blank, double cell_mm) {
  std::array<int, 3> cells{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double size = blank.size()[static_cast<int>(a)];
    // The slack keeps 100 mm / 0.1 mm at 1000 cells.
    cells[a] = std::max(1, static_cast<int>(std::ceil(size / cell_mm - 1e-6)));
  }
  return of_cells(blank, cells);
}

Lattice Lattice::of_cells(const Box& blank, const std::array<int, 3>& cells) {
  Lattice lattice;
  lattice.bounds_mm = blank;
  lattice.cells = cells;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t a = static_cast<std::size_t>(axis);
    lattice.cell_mm[axis] = blank.size()[axis] / cells[a];
    lattice.origin_mm[axis] = blank.min[axis] - lattice.cell_mm[axis] / 2;
    lattice.tiles[a] = (cells[a] + 2 + kTileNodes - 1) / kTileNodes;
  }
  return lattice;
}

BrickTree::BrickTree(const Lattice& lattice) : lattice_(lattice) {
  columns_.resize(static_cast<std::size_t>(lattice.column_count()));
  for (ColumnRef& column : columns_) {
    column = ColumnRef::adopt(new Column);
    column->tiles.resize(static_cast<std::size_t>(lattice.tiles[2]));
  }
}

const BrickRef& BrickTree::brick(int bx, int by, int bz) const {
  static const BrickRef empty;
  static const BrickRef solid = BrickRef::solid();
  const int tx = bx / kTileBricks, ty = by / kTileBricks, tz = bz / kTileBricks;
  if (bx < 0 || by < 0 || bz < 0 || tx >= lattice_.tiles[0] || ty >= lattice_.tiles[1] ||
      tz >= lattice_.tiles[2])
    return empty;
  const TileRef& t = tile(ty * lattice_.tiles[0] + tx, tz);
  if (!t.get()) return t.is_solid() ? solid : empty;
  return t->bricks[(bz % kTileBricks * kTileBricks + by % kTileBricks) * kTileBricks +
                   bx % kTileBricks];
}

Column& BrickTree::own_column(int number) {
  ColumnRef& column = columns_[static_cast<std::size_t>(number)];
  if (!column.is_sole()) column = ColumnRef::adopt(new Column(*column.get()));
  return *column.get();
}

Tile& BrickTree::own_tile(int column, int level, std::uint64_t version) {
  TileRef& tile = own_column(column).tiles[static_cast<std::size_t>(level)];
  if (!tile.get()) {
    Tile* fresh = new Tile;
    if (tile.is_solid())
      std::fill(std::begin(fresh->bricks), std::end(fresh->bricks), BrickRef::solid());
    tile = TileRef::adopt(fresh);
  } else if (!tile.is_sole()) {
    tile = TileRef::adopt(new Tile(*tile.get()));
  }
  tile->version = version;
  return *tile.get();
}

void BrickTree::settle_tile(int column, int level) {
  TileRef& tile = own_column(column).tiles[static_cast<std::size_t>(level)];
  if (!tile.get()) return;
  const BrickRef& first = tile->bricks[0];
  if (first.get()) return;
  for (const BrickRef& brick : tile->bricks)
    if (!(brick == first)) return;
  tile = first.is_solid() ? TileRef::solid() : TileRef();
}

void BrickTree::set_tile(int column, int level, TileRef tile) {
  own_column(column).tiles[static_cast<std::size_t>(level)] = std::move(tile);
}

namespace {

BrickRef with_ids(const Brick& brick, bool keep) {
  Brick* copy = Brick::allocate(brick.crossings, keep);
  std::memcpy(copy->columns, brick.columns, sizeof copy->columns);
  copy->volume = brick.volume;
  std::memcpy(const_cast<std::uint32_t*>(copy->directions()), brick.directions(),
              brick.crossings * sizeof(std::uint32_t));
  std::memcpy(const_cast<std::uint16_t*>(copy->places()), brick.places(),
              brick.crossings * sizeof(std::uint16_t));
  if (keep)
    std::fill_n(const_cast<std::uint32_t*>(copy->ids()), brick.crossings, MeshPatch::kNotCut);
  return BrickRef::adopt(copy);
}

}  // namespace

void BrickTree::keep_ids(bool keep) {
  if (keep == keeps_ids_) return;
  keeps_ids_ = keep;
  const std::uint64_t version = next_version();
  // Bricks that were shared (the sides of a blank) are so afterwards.
  std::vector<std::pair<const Brick*, BrickRef>> done;
  for (int column = 0; column < lattice_.column_count(); ++column) {
    for (int level = 0; level < lattice_.tiles[2]; ++level) {
      if (!tile(column, level).get()) continue;
      for (BrickRef& brick : own_tile(column, level, version).bricks) {
        if (!brick.get()) continue;
        if (brick.is_sole()) {
          brick = with_ids(*brick.get(), keep);
          continue;
        }
        const auto known = std::find_if(done.begin(), done.end(),
                                        [&](const auto& d) { return d.first == brick.get(); });
        if (known != done.end()) {
          brick = known->second;
          continue;
        }
        const BrickRef made = with_ids(*brick.get(), keep);
        done.insert(done.begin(), {brick.get(), made});
        if (done.size() > 64) done.pop_back();
        brick = made;
      }
    }
  }
}

std::size_t BrickTree::unique_bytes() const {
  std::size_t bytes = 0;
  for (const ColumnRef& column : columns_) {
    if (!column.is_sole()) continue;
    bytes += sizeof(Column) + column->tiles.size() * sizeof(TileRef);
    for (const TileRef& tile : column->tiles) {
      if (!tile.is_sole()) continue;
      bytes += sizeof(Tile);
      for (const BrickRef& brick : tile->bricks)
        if (brick.is_sole()) bytes += brick->bytes();
    }
  }
  return bytes;
}

std::size_t BrickTree::brick_count() const {
  std::size_t count = 0;
  for (const ColumnRef& column : columns_)
    for (const TileRef& tile : column->tiles)
      if (tile.get())
        count +=
            static_cast<std::size_t>(std::count_if(std::begin(tile->bricks), std::end(tile->bricks),
                                                   [](const BrickRef& b) { return b.get(); }));
  return count;
}

std::string BrickTree::digest() const {
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  const Box& box = lattice_.bounds_mm;
  const double frame[6] = {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
  XXH3_128bits_update(&state, frame, sizeof frame);
  XXH3_128bits_update(&state, lattice_.cells.data(), sizeof lattice_.cells);
  const auto word = [&](std::uint32_t value) { XXH3_128bits_update(&state, &value, sizeof value); };
  for (std::uint32_t number = 0; number < tile_count(); ++number) {
    const TileRef& t = tile(number);
    word(t.get() ? 2 : t.is_solid());
    if (!t.get()) continue;
    for (const BrickRef& b : t->bricks) {
      word(b.get() ? 2 : b.is_solid());
      if (!b.get()) continue;
      XXH3_128bits_update(&state, b->columns, sizeof b->columns);
      XXH3_128bits_update(&state, b->directions(), b->crossings * sizeof(std::uint32_t));
      XXH3_128bits_update(&state, b->places(), b->crossings * sizeof(std::uint16_t));
    }
  }
  const XXH128_hash_t hash = XXH3_128bits_digest(&state);
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

namespace {

bool same(const BrickRef& a, const BrickRef& b) {
  if (a == b) return true;
  if (!a.get() || !b.get() || !a->same_surface(*b.get())) return false;
  return !a->has_ids || !b->has_ids ||
         std::memcmp(a->ids(), b->ids(), a->crossings * sizeof(std::uint32_t)) == 0;
}

}  // namespace

std::vector<std::uint32_t> BrickTree::differing(const BrickTree& other) const {
  std::vector<std::uint32_t> tiles;
  const bool alike =
      lattice_.bounds_mm == other.lattice_.bounds_mm && lattice_.cells == other.lattice_.cells;
  for (std::uint32_t number = 0; number < tile_count(); ++number) {
    if (alike) {
      const TileRef &a = tile(number), &b = other.tile(number);
      if (a == b) continue;
      if (a.get() && b.get() &&
          std::equal(std::begin(a->bricks), std::end(a->bricks), std::begin(b->bricks), same))
        continue;
    }
    tiles.push_back(number);
  }
  return tiles;
}

std::uint64_t BrickTree::version(std::uint32_t number) const {
  const TileRef& t = tile(number);
  return t.get() ? t->version : t.is_solid();
}

void BrickTree::follow_reach() {
  const std::array<int, 3>& n = lattice_.tiles;
  reached_ = std::make_shared<std::vector<std::uint8_t>>(brick_index(0, 0, n[2] * kTileBricks),
                                                         std::uint8_t{0});
}

void BrickTree::own_reach() {
  if (!reached_) return;
  if (reached_.use_count() > 1) {
    reached_ = std::make_shared<std::vector<std::uint8_t>>(*reached_);
  } else {
    // Who let go of it has read before: its count orders that. use_count() does not, and fences
    // are unknown to ThreadSanitizer.
    const std::shared_ptr<std::vector<std::uint8_t>> seen = reached_;
  }
}

}  // namespace kerf::octree
