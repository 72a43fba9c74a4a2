// stock/present_heights.h - the heights of a model, for a look between two cuts.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "base/mesh_patch.h"
#include "surface/height_grid.h"

namespace kerf {

/// A model of heights that lets others look at them as they are now, without a copy: good until the
/// model is changed or asked for anything else. Moves held back do not count yet. Costs about a
/// nanosecond a tile.
class PresentHeights {
 public:
  virtual ~PresentHeights() = default;
  /// None where heights do not say all (gaps below them).
  virtual std::optional<HeightGrid> present_heights() const = 0;
  /// The move that lowered a cell of these last (StockModel::keep_cut_ids()); MeshPatch::kNotCut:
  /// none, or nobody keeps them.
  virtual std::uint32_t present_cut_id(int i, int j) const = 0;
  /// The same of cells i .. i + 1 of row j, then of row j + 1.
  virtual std::array<std::uint32_t, 4> present_cut_ids_of_four(int i, int j) const = 0;
  /// .. of as many as there is room for from (i, j) on, along X or along Y.
  virtual void read_present_cut_ids(int i, int j, bool along_x,
                                    std::span<std::uint32_t> out) const = 0;
};

}  // namespace kerf
