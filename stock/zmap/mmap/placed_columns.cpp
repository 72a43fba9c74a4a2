#include "stock/zmap/mmap/placed_columns.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "base/mesh_patch.h"
#include "base/translate.h"
#include "stock/zmap/mmap/mmap.h"
#include "stock/zmap/mmap/mmap_state.h"
#include "stock/zmap/state_file.h"
#include "stock/zmap/zmap.h"

namespace kerf {
namespace {

/// What is solid in a column, from above downward.
struct Solid {
  float low = 0, high = 0;
};

/// The columns of either model.
class Columns {
 public:
  explicit Columns(const StockModel& stock)
      : heights_(dynamic_cast<const ZMap*>(&stock)),
        gapped_(dynamic_cast<const MMap*>(&stock)),
        floor_(static_cast<float>(stock.bounds_mm().min.z)) {
    assert(heights_ || gapped_);
  }
  std::array<int, 2> cells() const {
    if (heights_) return {heights_->nx(), heights_->ny()};
    return {gapped_->nx(), gapped_->ny()};
  }
  void read(int i, int j, std::vector<Solid>& out) const {
    out.clear();
    float top = heights_ ? heights_->height_mm(i, j) : gapped_->height_mm(i, j);
    if (gapped_) {
      for (const Gap& gap : gapped_->gaps(i, j)) {
        out.push_back({gap.high, top});
        top = gap.low;
      }
    }
    if (top > floor_) out.push_back({floor_, top});
  }

 private:
  const ZMap* heights_;
  const MMap* gapped_;
  float floor_;
};

class Placer {
 public:
  Placer(const StockModel& stock, const AxisTurn& turn, const Vec3& at_mm)
      : columns_(stock), turn_(turn), at_mm_(at_mm), was_(columns_.cells()) {
    for (std::size_t axis = 0; axis < 2; ++axis)
      cells_[axis] = was_[static_cast<std::size_t>(turn.from[axis])];
  }

  const std::array<int, 2>& cells() const { return cells_; }

  /// Of cell (i, j) of what is placed.
  void read(int i, int j, std::vector<Solid>& out) const {
    const std::array<int, 2> at{i, j};
    std::array<int, 2> was{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto from = static_cast<std::size_t>(turn_.from[axis]);
      was[from] = turn_.sign[axis] > 0 ? at[axis] : was_[from] - 1 - at[axis];
    }
    columns_.read(was[0], was[1], out);
    for (Solid& solid : out) solid = placed(solid);
    if (turn_.sign[2] < 0) std::reverse(out.begin(), out.end());
  }

  float height(float z) const {
    return static_cast<float>(turn_.sign[2] * static_cast<double>(z) + at_mm_.z);
  }

 private:
  Solid placed(const Solid& solid) const {
    const float a = height(solid.low), b = height(solid.high);
    return {std::min(a, b), std::max(a, b)};
  }

  Columns columns_;
  AxisTurn turn_;
  Vec3 at_mm_;
  std::array<int, 2> was_;
  std::array<int, 2> cells_{};
};

Box placed_box(const Box& box, const AxisTurn& turn, const Vec3& at_mm) {
  Box out;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double low = turn.sign[a] * box.min[turn.from[a]] + at_mm[axis];
    const double high = turn.sign[a] * box.max[turn.from[a]] + at_mm[axis];
    out.min[axis] = std::min(low, high);
    out.max[axis] = std::max(low, high);
  }
  return out;
}

/// The gaps between what is solid and below it, the topmost first.
void gaps_of(std::span<const Solid> solids, float floor, std::vector<Gap>& out) {
  out.clear();
  for (std::size_t n = 0; n < solids.size(); ++n) {
    const float low = n + 1 < solids.size() ? solids[n + 1].high : floor;
    if (solids[n].low - low > kThinnest_mm)
      out.push_back({low, solids[n].low, MeshPatch::kNotCut, MeshPatch::kNotCut});
  }
}

}  // namespace

Result<PlacedColumns> placed_columns(const StockModel& heights, const AxisTurn& turn,
                                     const Vec3& at_mm, int threads, ZMapKernel kernel) {
  assert(turn.keeps_z());
  const Placer placer(heights, turn, at_mm);
  const auto [nx, ny] = placer.cells();
  Box bounds = placed_box(heights.bounds_mm(), turn, at_mm);
  std::vector<Solid> solids;
  float lowest = std::numeric_limits<float>::infinity(), highest = -lowest;
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      placer.read(i, j, solids);
      if (solids.empty()) continue;
      lowest = std::min(lowest, solids.back().low);
      highest = std::max(highest, solids.front().high);
    }
  }
  if (!(lowest < highest)) return Error{tr("nothing of the workpiece is left")};
  // Floors are heights: the box has the very float.
  bounds.min.z =
      turn.sign[2] < 0 ? lowest : placer.height(static_cast<float>(heights.bounds_mm().min.z));
  bounds.max.z = std::max<double>(bounds.max.z, highest);

  TileGrid grid(bounds, nx, ny);
  GapGrid gap_grid(grid.tile_count());
  std::vector<float> row(static_cast<std::size_t>(nx));
  std::vector<Gap> gaps;
  grid.begin_change();
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      placer.read(i, j, solids);
      row[static_cast<std::size_t>(i)] = solids.empty() ? grid.floor_mm() : solids.front().high;
      gaps_of(solids, grid.floor_mm(), gaps);
      if (gaps.empty()) continue;
      const int tile = j / kTileCells * grid.tiles_x() + i / kTileCells;
      gap_grid.make_writable(static_cast<std::size_t>(tile)).write(TileGrid::offset(i, j), gaps);
    }
    grid.set_row(j, row.data());
  }

  PlacedColumns out;
  if (at_mm.z != 0) {
    const double far_mm = std::max(std::abs(bounds.min.z), std::abs(bounds.max.z));
    out.bound_mm = far_mm * std::numeric_limits<float>::epsilon() / 2;
  }
  if (gap_grid.any()) {
    out.stock = MMap::of_columns({std::move(grid), std::move(gap_grid), heights.blank_mm3()},
                                 threads, kernel);
  } else {
    out.stock = ZMap::of_heights({std::move(grid), heights.blank_mm3()}, threads, kernel);
  }
  return out;
}

}  // namespace kerf
