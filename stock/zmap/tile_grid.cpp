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
      tiles_y_((ny + kTileCells - 1) / kTileCells) {
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

void TileGrid::copy_row(int j, float* out) const {
  for (int i = 0; i < nx_; i += kBlockX) {
    const float* from = tile(i / kTileCells, j / kTileCells) + offset(i, j);
    out[i] = from[0];
    if (i + 1 < nx_) out[i + 1] = from[1];
  }
}

void TileGrid::set_row(int j, const float* in) {
  for (int i = 0; i < nx_; i += kBlockX) {
    const int tx = i / kTileCells, ty = j / kTileCells;
    std::shared_ptr<float>& shared = tiles_[index(tx, ty)];
    float* to =
        shared.use_count() == 1 ? shared.get() : make_writable(static_cast<int>(index(tx, ty)));
    std::copy_n(in + i, std::min(kBlockX, nx_ - i), to + offset(i, j));
  }
}

std::vector<float*> TileGrid::writable_pointers() {
  std::vector<float*> pointers;
  pointers.reserve(tiles_.size());
  for (const std::shared_ptr<float>& tile : tiles_)
    pointers.push_back(tile.use_count() == 1 ? tile.get() : nullptr);
  // A snapshot dropped by another thread has read its last: use_count alone does not order that
  // before our writes.
  std::atomic_thread_fence(std::memory_order_acquire);
  return pointers;
}

float* TileGrid::make_writable(int tile_index) {
  std::shared_ptr<float>& shared = tiles_[static_cast<std::size_t>(tile_index)];
  std::shared_ptr<float> own = allocate(kTileBytes, 64);
  std::copy_n(shared.get(), kTileFloats, own.get());
  shared = std::move(own);
  return shared.get();
}

}  // namespace kerf
