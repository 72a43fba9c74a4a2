#include "stock/zmap/tile_grid.h"

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <mutex>
#include <new>

#include "base/mesh_patch.h"
#include "stock/zmap/packed_tile.h"

namespace kerf {
namespace {

float* allocate(std::size_t bytes, std::size_t alignment) {
  const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
  void* memory = std::aligned_alloc(alignment, rounded);
  if (memory == nullptr) throw std::bad_alloc();
  return static_cast<float*>(memory);
}

/// Never the same twice: one count for all grids, so that versions can be compared whatever copy
/// they come from.
std::uint64_t next_version() {
  static std::atomic<std::uint64_t> last{0};
  return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

using BlockFloats = std::array<float, kBlockFloats>;

void lower_to(const float* heights, BlockFloats* low) {
  for (std::size_t k = 0; k < kBlockFloats; ++k)
    (*low)[k] = heights[k] < (*low)[k] ? heights[k] : (*low)[k];
}

/// Of cells [x0, x1) x [y0, y1) of a tile.
float lowest_in_tile(const float* heights, int x0, int y0, int x1, int y1) {
  BlockFloats low;
  low.fill(std::numeric_limits<float>::infinity());
  const bool is_of_blocks = (x0 | x1) % kBlockX == 0 && (y0 | y1) % kBlockY == 0;
  for (int y = y0; y < y1; y += is_of_blocks ? kBlockY : 1) {
    for (int x = x0; x < x1; x += is_of_blocks ? kBlockX : 1) {
      const float* const at = heights + TileGrid::offset(x, y);
      if (is_of_blocks) {
        lower_to(at, &low);
      } else {
        low[0] = std::min(low[0], *at);
      }
    }
  }
  return *std::min_element(low.begin(), low.end());
}

}  // namespace

/// Memory of tiles. Those of a fresh grid lie in one piece, which cannot be given back before all
/// of them are; so a tile of it that nobody keeps any more serves the next copy that is made.
class TileArena {
 public:
  TileArena(std::size_t count, std::size_t tile_bytes)
      : tile_bytes_(tile_bytes),
        slab_(allocate_slab(count * tile_bytes)),
        slab_end_(at(slab_, count * tile_bytes)) {}
  ~TileArena() {
    for (float* const tile : free_) {
      if (!is_of_slab(tile)) std::free(tile);
    }
    for (float* const tile : common_) std::free(tile);
    std::free(slab_);
  }
  TileArena(const TileArena&) = delete;
  TileArena& operator=(const TileArena&) = delete;

  /// Of the fresh grid.
  float* first(std::size_t tile) const { return at(slab_, tile * tile_bytes_); }
  float* take() {
    {
      const std::lock_guard lock(mutex_);
      if (!free_.empty()) {
        float* const tile = free_.back();
        free_.pop_back();
        return tile;
      }
    }
    return allocate(tile_bytes_, 64);
  }
  void give_back(float* tile) {
    if (is_common(tile)) return;
    {
      const std::lock_guard lock(mutex_);
      if (is_of_slab(tile) || free_.size() < kSpareTiles) return free_.push_back(tile);
    }
    std::free(tile);
  }
  /// A control block of its own for each tile: it counts the grids that share it.
  static std::shared_ptr<float> share(const std::shared_ptr<TileArena>& arena, float* tile) {
    return {tile, [arena](float* unused) { arena->give_back(unused); }};
  }
  /// Beside the fresh grid's piece, so that all of that can be given back.
  float* take_apart() {
    common_.push_back(allocate(tile_bytes_, 64));
    return common_.back();
  }
  /// Shared by tiles of a fresh grid.
  bool is_common(const float* tile) const {
    return std::find(common_.begin(), common_.end(), tile) != common_.end();
  }
  /// What nobody keeps in the fresh grid's piece takes no memory until it is taken again; where it
  /// is a large page or more at a time, since smaller pages cost time.
  void drop_free_memory() {
    const std::lock_guard lock(mutex_);
    // What is taken next lies where the piece begins.
    std::sort(free_.begin(), free_.end(), std::greater<>());
    for (std::size_t first = 0; first < free_.size();) {
      std::size_t end = first + 1;
      while (end < free_.size() && at(free_[end], tile_bytes_) == free_[end - 1]) ++end;
      const std::size_t bytes = (end - first) * tile_bytes_;
      if (bytes >= kLargePage) madvise(free_[end - 1], bytes, MADV_DONTNEED);
      first = end;
    }
  }

 private:
  /// Tiles come and go with every copy that is cut on: so many do not go through the allocator,
  /// where others would settle between them.
  static constexpr std::size_t kSpareTiles = 128;
  bool is_of_slab(const float* tile) const {
    return !std::less<>()(tile, slab_) && std::less<>()(tile, slab_end_);
  }
  static constexpr std::size_t kLargePage = std::size_t{1} << 21;
  /// Large pages save most address translations of the kernel.
  static float* allocate_slab(std::size_t bytes) {
    if (bytes < kLargePage) return allocate(bytes, 64);
    float* const slab = allocate(bytes, kLargePage);
    madvise(slab, bytes, MADV_HUGEPAGE);
    return slab;
  }

  static float* at(float* slab, std::size_t bytes) { return slab + bytes / sizeof(float); }

  std::size_t tile_bytes_;
  float* slab_;
  float* slab_end_;
  std::mutex mutex_;
  std::vector<float*> free_;
  std::vector<float*> common_;  ///< never given back before all is
};

TileGrid::TileGrid(const Box& bounds_mm, int nx, int ny, bool keeps_cut_ids)
    : bounds_(bounds_mm),
      nx_(nx),
      ny_(ny),
      tiles_x_((nx + kTileCells - 1) / kTileCells),
      tiles_y_((ny + kTileCells - 1) / kTileCells),
      keeps_cut_ids_(keeps_cut_ids),
      meetings_(std::make_shared<std::atomic<unsigned>>(0)) {
  const std::size_t count = static_cast<std::size_t>(tiles_x_) * static_cast<std::size_t>(tiles_y_);
  arena_ = std::make_shared<TileArena>(count, tile_bytes());
  tiles_.reserve(count);
  cells_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    float* const cells = arena_->first(i);
    const auto tiles_x = static_cast<std::size_t>(tiles_x_);
    const bool is_whole = static_cast<int>(i % tiles_x + 1) * kTileCells <= nx &&
                          static_cast<int>(i / tiles_x + 1) * kTileCells <= ny;
    std::fill_n(cells, kTileFloats, is_whole ? floor_mm() : std::numeric_limits<float>::lowest());
    if (keeps_cut_ids) std::fill_n(cut_ids_of(cells), kTileFloats, MeshPatch::kNotCut);
    tiles_.push_back(TileArena::share(arena_, cells));
    cells_.push_back(cells);
  }
  begin_change();
  versions_.assign(count, change_);
  for (std::size_t i = 0; i < count; ++i) fill_part_of_tile(i);
}

/// With the floor, what of a tile at the grid's far sides is in the grid.
void TileGrid::fill_part_of_tile(std::size_t tile_index) {
  const int i0 = static_cast<int>(tile_index) % tiles_x_ * kTileCells;
  const int j0 = static_cast<int>(tile_index) / tiles_x_ * kTileCells;
  const int i1 = std::min(nx_, i0 + kTileCells), j1 = std::min(ny_, j0 + kTileCells);
  if (i1 - i0 == kTileCells && j1 - j0 == kTileCells) return;
  float* const cells = tiles_[tile_index].get();
  for (int j = j0; j < j1; ++j) {
    for (int i = i0; i < i1; ++i) cells[offset(i, j)] = floor_mm();
  }
}

TileGrid::~TileGrid() { meet_other_grids(); }

/// use_count() alone does not order the last reads of a grid that lets go of a tile before the
/// writes of the one that then owns it. So each grid steps this counter before it lets go, and
/// after it has found a tile to be its own. In the counter's order of steps, the owner's cannot be
/// the earlier one: it would have been seen, and the count read before it too, before the tile was
/// let go. (A fence would do as well, but ThreadSanitizer does not know fences.)
void TileGrid::meet_other_grids() const { meetings_->fetch_add(1, std::memory_order_acq_rel); }

float TileGrid::lowest_mm(int x0, int y0, int x1, int y1) const {
  x0 = std::max(x0, 0), y0 = std::max(y0, 0), x1 = std::min(x1, nx_), y1 = std::min(y1, ny_);
  float lowest = std::numeric_limits<float>::infinity();
  for (int y = y0; y < y1; y = (y / kTileCells + 1) * kTileCells) {
    for (int x = x0; x < x1; x = (x / kTileCells + 1) * kTileCells) {
      const int left = x / kTileCells * kTileCells, low = y / kTileCells * kTileCells;
      lowest = std::min(
          lowest, lowest_in_tile(tile(x / kTileCells, y / kTileCells), x - left, y - low,
                                 std::min(kTileCells, x1 - left), std::min(kTileCells, y1 - low)));
    }
  }
  return std::max(lowest, floor_mm());
}

Box TileGrid::tile_box(std::size_t tile_index) const {
  const int i = static_cast<int>(tile_index) % tiles_x_ * kTileCells;
  const int j = static_cast<int>(tile_index) / tiles_x_ * kTileCells;
  Box box = bounds_;
  box.min.x = bounds_.min.x + i * cell_x_mm();
  box.min.y = bounds_.min.y + j * cell_y_mm();
  if (i + kTileCells < nx_) box.max.x = bounds_.min.x + (i + kTileCells) * cell_x_mm();
  if (j + kTileCells < ny_) box.max.y = bounds_.min.y + (j + kTileCells) * cell_y_mm();
  return box;
}

std::array<std::uint32_t, 4> TileGrid::cut_ids_of_four(int i, int j) const {
  std::array<std::uint32_t, 4> ids;
  ids.fill(MeshPatch::kNotCut);
  if (!keeps_cut_ids_) return ids;
  constexpr unsigned kSide = kTileCells;
  const auto x = static_cast<unsigned>(i), y = static_cast<unsigned>(j);
  if (x % kSide + 1 < kSide && y % kSide + 1 < kSide) {
    const std::uint32_t* const ids_of_tile =
        cut_ids(y / kSide * static_cast<std::size_t>(tiles_x_) + x / kSide);
    return {ids_of_tile[offset(i, j)], ids_of_tile[offset(i + 1, j)], ids_of_tile[offset(i, j + 1)],
            ids_of_tile[offset(i + 1, j + 1)]};
  }
  return {cut_id(i, j), cut_id(i + 1, j), cut_id(i, j + 1), cut_id(i + 1, j + 1)};
}

void TileGrid::read_cut_ids(int i, int j, bool along_x, std::span<std::uint32_t> out) const {
  if (!keeps_cut_ids_) return std::fill(out.begin(), out.end(), MeshPatch::kNotCut);
  // Tile by tile. Down a column each block is in memory of its own, which is asked for in time.
  int& along = along_x ? i : j;
  for (std::size_t n = 0; n < out.size();) {
    const std::uint32_t* const ids = cut_ids(index(i / kTileCells, j / kTileCells));
    const auto rest = static_cast<std::size_t>(kTileCells - along % kTileCells);
    if (!along_x && j / kTileCells * kTileCells + kTileCells < ny_) {
      const std::uint32_t* const next = cut_ids(index(i / kTileCells, j / kTileCells + 1));
      for (int y = 0; y < kTileCells; y += kBlockY) __builtin_prefetch(next + offset(i, y));
    }
    for (const std::size_t end = std::min(out.size(), n + rest); n < end; ++n, ++along)
      out[n] = ids[offset(i, j)];
  }
}

void TileGrid::keep_cut_ids(bool keep) {
  if (keep == keeps_cut_ids_) return;
  keeps_cut_ids_ = keep;
  begin_change();
  const auto arena = std::make_shared<TileArena>(tiles_.size(), tile_bytes());
  const auto fill = [&](float* cells, const std::shared_ptr<float>& tile) {
    std::copy_n(tile.get(), kTileFloats, cells);
    if (keep) std::fill_n(cut_ids_of(cells), kTileFloats, MeshPatch::kNotCut);
    return TileArena::share(arena, cells);
  };
  // What a fresh grid shares stays shared.
  std::vector<std::pair<const float*, std::shared_ptr<float>>> kinds;
  const auto kind_of = [&](const std::shared_ptr<float>& tile) {
    const auto known = std::find_if(kinds.begin(), kinds.end(),
                                    [&](const auto& kind) { return kind.first == tile.get(); });
    if (known != kinds.end()) return known->second;
    kinds.emplace_back(tile.get(), fill(arena->take_apart(), tile));
    return kinds.back().second;
  };
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const bool is_common = arena_->is_common(tiles_[i].get());
    std::shared_ptr<float> now = is_common ? kind_of(tiles_[i]) : fill(arena->first(i), tiles_[i]);
    if (is_common) arena->give_back(arena->first(i));
    meet_other_grids();
    set_tile(i, std::move(now));
    versions_[i] = change_;
  }
  arena_ = arena;
  if (kinds.empty()) return share_equal_tiles();
  arena_->drop_free_memory();
}

void TileGrid::share_equal_tiles() {
  /// Of a box: inside, and along two of its sides. Where there are bodies, holes, the floor.
  constexpr std::size_t kMostKinds = 8;
  std::vector<std::shared_ptr<float>> kinds;
  const auto is_like = [&](std::size_t i, const float* cells) {
    return std::memcmp(tiles_[i].get(), cells, tile_bytes()) == 0;
  };
  const auto take = [&](std::size_t i, const std::shared_ptr<float>& kind) {
    meet_other_grids();
    set_tile(i, kind);
  };
  const auto width = static_cast<std::size_t>(tiles_x_);
  for (std::size_t i = 1; i < tiles_.size(); ++i) {
    const auto kind = std::find_if(kinds.begin(), kinds.end(),
                                   [&](const auto& known) { return is_like(i, known.get()); });
    if (kind != kinds.end()) {
      take(i, *kind);
      continue;
    }
    if (kinds.size() == kMostKinds) continue;
    for (const std::size_t back : {std::size_t{1}, width}) {
      if (i < back || !is_like(i, tiles_[i - back].get())) continue;
      kinds.push_back(TileArena::share(arena_, arena_->take_apart()));
      std::memcpy(kinds.back().get(), tiles_[i].get(), tile_bytes());
      take(i, kinds.back());
      take(i - back, kinds.back());
      break;
    }
  }
  arena_->drop_free_memory();
}

void TileGrid::copy_row(int j, float* out) const {
  for (int tx = 0; tx < tiles_x_; ++tx) {
    const int begin = tx * kTileCells, end = std::min(nx_, begin + kTileCells);
    const float* from = tile(tx, j / kTileCells) + offset(begin, j);
    int i = begin;
    for (; i + kBlockX <= end; i += kBlockX, from += kBlockFloats)
      std::copy_n(from, kBlockX, out + i);
    if (i < end) std::copy_n(from, end - i, out + i);
  }
}

void TileGrid::copy_rows(int j, float* out) const {
  const auto width = static_cast<std::size_t>(nx_);
  const int rows = std::min(kBlockY, ny_ - j);
  for (int tx = 0; tx < tiles_x_; ++tx) {
    const int begin = tx * kTileCells, end = std::min(nx_, begin + kTileCells);
    const float* from = tile(tx, j / kTileCells) + offset(begin, j);
    for (int i = begin; i < end; i += kBlockX, from += kBlockFloats) {
      const int wide = std::min(kBlockX, end - i);
      for (int y = 0; y < rows; ++y) {
        float* const to = out + static_cast<std::size_t>(y) * width + i;
        to[0] = from[y * kBlockX];
        if (wide > 1) to[1] = from[y * kBlockX + 1];
      }
    }
  }
}

void TileGrid::set_row(int j, const float* in) {
  begin_change();
  for (int tx = 0; tx < tiles_x_; ++tx) {
    float* const to = make_writable(index(tx, j / kTileCells));
    const int begin = tx * kTileCells, end = std::min(nx_, begin + kTileCells);
    float* at = to + offset(begin, j);
    int i = begin;
    for (; i + kBlockX <= end; i += kBlockX, at += kBlockFloats) std::copy_n(in + i, kBlockX, at);
    if (i < end) std::copy_n(in + i, end - i, at);
  }
}

void TileGrid::begin_change() { change_ = next_version(); }

float* TileGrid::make_writable(std::size_t tile_index) {
  std::shared_ptr<float>& tile = tiles_[tile_index];
  versions_[tile_index] = change_;
  if (tile.use_count() == 1) {
    meet_other_grids();
    return tile.get();
  }
  std::shared_ptr<float> own = TileArena::share(arena_, arena_->take());
  std::memcpy(own.get(), tile.get(), tile_bytes());
  meet_other_grids();
  set_tile(tile_index, std::move(own));
  return tile.get();
}

void TileGrid::set_packed(std::size_t tile, const std::shared_ptr<const PackedTile>& packed) {
  packed_.resize(tiles_.size());
  packed_[tile] = packed;
  meet_other_grids();
  set_tile(tile, nullptr);
}

void TileGrid::share_with(const TileGrid& other, std::size_t tile) {
  if (!other.tiles_[tile]) {
    if (tiles_[tile]) set_packed(tile, other.packed_[tile]);
  } else if (tiles_[tile] && tiles_[tile] != other.tiles_[tile]) {
    meet_other_grids();
    set_tile(tile, other.tiles_[tile]);
  }
}

bool TileGrid::pack(std::span<TileGrid* const> copies, std::size_t at) {
  TileGrid& grid = *copies[at];
  const TileGrid* const after = at + 1 < copies.size() ? copies[at + 1] : nullptr;
  bool is_all = after != nullptr;
  for (std::size_t i = 0; i < grid.tiles_.size(); ++i) {
    const std::uint64_t version = grid.versions_[i];
    const auto is_alike = [&](std::size_t n) {
      return copies[n]->versions_[i] == version && copies[n]->keeps_cut_ids_ == grid.keeps_cut_ids_;
    };
    if (at > 0 && is_alike(at - 1)) grid.share_with(*copies[at - 1], i);
    if (at + 1 < copies.size() && is_alike(at + 1)) grid.share_with(*copies[at + 1], i);
    const std::shared_ptr<float>& tile = grid.tiles_[i];
    if (!tile || grid.arena_->is_common(tile.get())) continue;
    const auto is_shared = [&](std::size_t n) { return copies[n]->tiles_[i] == tile; };
    std::size_t first = at, end = at + 1;
    while (first > 0 && is_shared(first - 1)) --first;
    while (end < copies.size() && is_shared(end)) ++end;
    if (tile.use_count() != static_cast<std::ptrdiff_t>(end - first)) {
      is_all = is_all && after->versions_[i] == version;
      continue;
    }
    grid.meet_other_grids();
    const auto packed = std::make_shared<const PackedTile>(tile.get(), grid.keeps_cut_ids_);
    for (std::size_t n = first; n < end; ++n) copies[n]->set_packed(i, packed);
  }
  return is_all;
}

std::size_t TileGrid::kept_bytes(const TileGrid& before, const TileGrid* after) const {
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const TileGrid& other = after != nullptr ? *after : before;
    if (versions_[i] == other.versions_[i]) continue;
    if (!tiles_[i]) {
      bytes += packed_[i]->bytes();
    } else if (!arena_->is_common(tiles_[i].get())) {
      bytes += tile_bytes();
    }
  }
  return bytes;
}

void TileGrid::unpack() {
  for (std::size_t i = 0; i < packed_.size(); ++i) {
    if (tiles_[i]) continue;
    set_tile(i, TileArena::share(arena_, arena_->take()));
    packed_[i]->unpack(tiles_[i].get());
  }
  packed_.clear();
}

std::size_t TileGrid::unique_bytes() const {
  const auto own =
      std::count_if(tiles_.begin(), tiles_.end(), [](const auto& t) { return t.use_count() == 1; });
  return static_cast<std::size_t>(own) * tile_bytes();
}

}  // namespace kerf
