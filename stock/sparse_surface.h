// stock/sparse_surface.h - the surface of a model with fewer triangles where it is plain.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "base/mesh_patch.h"

namespace kerf {

struct SparseOptions {
  double most_mm = 0.002;  ///< nowhere farther from the patches of level 0, measured up and down
  /// Of the move with this number (CutMove::id), or MeshPatch::kNotCut; triangles join no cells of
  /// several groups. Empty: it does not matter who cut. Called by several threads.
  std::function<std::uint32_t(std::uint32_t move)> group_of;
  int threads = 1;  ///< >= 1
};

/// Patches of all tiles, as of level 0 but with large triangles. Over all tiles they are closed in
/// the same way. Good as long as its model lives and is not changed.
class SparseSurface {
 public:
  virtual ~SparseSurface() = default;
  /// Without skirts. Any thread.
  virtual MeshPatch patch(std::uint32_t tile) const = 0;
};

/// A model that can do it. Moves held back do not count yet.
class SparseSource {
 public:
  virtual ~SparseSource() = default;
  virtual std::unique_ptr<SparseSurface> sparse_surface(const SparseOptions& options) const = 0;
};

}  // namespace kerf
