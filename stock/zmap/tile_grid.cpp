#include "stock/zmap/tile_grid.h"

#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

namespace kerf {
namespace {

constexpr std::size_t kTileBytes = kTileFloats * sizeof(float);

std::shared_ptr<float> allocate(std::size_t bytes, std::size_t alignment) {
  const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
  float* memory = static_cast<float*>(std::aligned_alloc(alignment, rounded));
  if (memory == nullptr) throw std::bad_alloc();
  return {memory, [](float* p) { std::free(p); }};
}

/// One piece of memory for all tiles of a fresh grid: large pages save most address translations of
/// the kernel.
std::shared_ptr<float> allocate_slab(std::size_t bytes) {
  constexpr std::size_t kLargePage = std::size_t{1} << 21;
  if (bytes < kLargePage) return allocate(bytes, 64);
  std::shared_ptr<float> slab = allocate(bytes, kLargePage);
  madvise(slab.get(), bytes, MADV_HUGEPAGE);
  return slab;
}

}  // namespace

TileGrid::TileGrid(const Box& bounds_mm, int nx, int ny)
    : bounds_(bounds_mm),
      nx_(nx),
      ny_(ny),
      tiles_x_((nx + kTileCells - 1) / kTileCells),
      tiles_y_((ny + kTileCells - 1) / kTileCells),
      meetings_(std::make_shared<std::atomic<unsigned>>(0)) {
  const std::size_t count = static_cast<std::size_t>(tiles_x_) * static_cast<std::size_t>(tiles_y_);
  const std::shared_ptr<float> slab = allocate_slab(count * kTileBytes);
  std::fill_n(slab.get(), count * kTileFloats, std::numeric_limits<float>::lowest());
  tiles_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    // A control block of its own for each tile (it counts the snapshots that share it); the slab
    // lives as long as one does.
    tiles_.emplace_back(slab.get() + i * kTileFloats, [slab](float*) {});
  }
  const std::vector<float> row(static_cast<std::size_t>(nx), floor_mm());
  for (int j = 0; j < ny; ++j) set_row(j, row.data());
}

TileGrid::~TileGrid() { meet_other_grids(); }

/// use_count() alone does not order the last reads of a grid that lets go of a tile before the
/// writes of the one that then owns it. So each grid steps this counter before it lets go, and
/// after it has found a tile to be its own. In the counter's order of steps, the owner's cannot be
/// the earlier one: it would have been seen, and the count read before it too, before the tile was
/// let go. (A fence would do as well, but ThreadSanitizer does not know fences.)
void TileGrid::meet_other_grids() const { meetings_->fetch_add(1, std::memory_order_acq_rel); }

void TileGrid::copy_row(int j, float* out) const {
  for (int i = 0; i < nx_; i += kBlockX) {
    const float* from = tile(i / kTileCells, j / kTileCells) + offset(i, j);
    out[i] = from[0];
    if (i + 1 < nx_) out[i + 1] = from[1];
  }
}

void TileGrid::set_row(int j, const float* in) {
  const int ty = j / kTileCells;
  for (int tx = 0; tx < tiles_x_; ++tx) {
    if (tiles_[index(tx, ty)].use_count() != 1) make_writable(static_cast<int>(index(tx, ty)));
  }
  meet_other_grids();
  for (int i = 0; i < nx_; i += kBlockX) {
    float* to = tiles_[index(i / kTileCells, ty)].get();
    std::copy_n(in + i, std::min(kBlockX, nx_ - i), to + offset(i, j));
  }
}

std::vector<float*> TileGrid::writable_pointers() {
  std::vector<float*> pointers;
  pointers.reserve(tiles_.size());
  for (const std::shared_ptr<float>& tile : tiles_)
    pointers.push_back(tile.use_count() == 1 ? tile.get() : nullptr);
  meet_other_grids();
  return pointers;
}

float* TileGrid::make_writable(int tile_index) {
  std::shared_ptr<float>& shared = tiles_[static_cast<std::size_t>(tile_index)];
  std::shared_ptr<float> own = allocate(kTileBytes, 64);
  std::copy_n(shared.get(), kTileFloats, own.get());
  meet_other_grids();
  shared = std::move(own);
  return shared.get();
}

}  // namespace kerf
