#include "stock/zmap/mmap/column_sweeper.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>

#include "stock/move_reach.h"
#include "stock/zmap/mmap/column_editor.h"

namespace kerf {
namespace {

/// Slack of the cells that are looked at about a sweep, mm.
constexpr double kSlack_mm = 1e-3;

struct Bounds {
  double min_x = std::numeric_limits<double>::infinity(), min_y = min_x;
  double max_x = -min_x, max_y = -min_x;
  void extend(const SweepOp& op, double radius) {
    min_x = std::min(min_x, op.min_x - radius - kSlack_mm);
    max_x = std::max(max_x, op.max_x + radius + kSlack_mm);
    min_y = std::min(min_y, op.min_y - radius - kSlack_mm);
    max_y = std::max(max_y, op.max_y + radius + kSlack_mm);
  }
  /// In X and Y.
  bool meets(const Box& box) const {
    return max_x >= box.min.x && min_x <= box.max.x && max_y >= box.min.y && min_y <= box.max.y;
  }
};

/// Of the tip on its way.
double lowest_mm(const SweepOp& op) {
  switch (op.kind) {
    case SweepOp::Kind::kStrip:
      return std::min(op.z, op.z + op.slope * op.length);
    case SweepOp::Kind::kHelix:
      return op.z - op.slope * op.length;
    case SweepOp::Kind::kCap:
    case SweepOp::Kind::kArc:
      break;
  }
  return op.z;
}

double radius_of(const SweepBatch& batch) {
  double radius = 0;
  for (const ConvexTool& tool : batch.tools) radius = std::max(radius, tool.radius);
  return radius;
}

class ScratchTiles;

/// Tiles into which one side of a tool is swept. All their heights are `clear` between sweeps.
struct Layer {
  ScratchTiles* owner = nullptr;
  float clear = 0;
  std::vector<float*> pointers;
  std::vector<std::size_t> touched;
  GridView view;
};

/// The scratch memory of one thread.
class ScratchTiles {
 public:
  explicit ScratchTiles(const HeightSweeper& heights) : heights_(heights) {
    const float floor = heights.grid.floor_mm();
    const float top = static_cast<float>(heights.grid.bounds_mm().max.z);
    // Above what any sweep can have to do with the material, and not much: the kernels add up what
    // they lower.
    start(lower, floor, top + 1);
    start(upper, -top, 1 - floor);
    start(ray, floor, top + 1);
  }
  ScratchTiles(const ScratchTiles&) = delete;
  ScratchTiles& operator=(const ScratchTiles&) = delete;

  Layer lower, upper, ray;

  void sweep(Layer& layer, std::span<const ConvexTool> tools, std::span<const SweepOp> ops,
             int thread, int threads) {
    for (const ConvexTool& tool : tools) {
      scaled_.assign(ops.begin(), ops.end());
      for (SweepOp& op : scaled_) {
        op.report = 0;
        op.use_double |= tool.needs_double;
      }
      SweepTotals unused;
      heights_.kernels.plain(layer.view, tool, scaled_.data(), scaled_.size(), thread, threads,
                             &unused);
    }
  }

  /// Forgets the tiles of all layers, whose heights must be clear again.
  void release() {
    for (Layer* layer : {&lower, &upper, &ray}) {
      for (const std::size_t tile : layer->touched) {
        free_.push_back({layer->pointers[tile], layer->clear});
        layer->pointers[tile] = nullptr;
      }
      layer->touched.clear();
    }
  }

 private:
  struct Free {
    float* heights;
    float clear;
  };
  void start(Layer& layer, float floor, float clear) {
    layer.owner = this;
    layer.clear = clear;
    layer.pointers.assign(heights_.grid.tile_count(), nullptr);
    layer.view = heights_.view_without_tiles();
    layer.view.floor = floor;
    layer.view.tiles = layer.pointers.data();
    layer.view.owner = &layer;
    layer.view.make_writable = [](void* owner, int tile) {
      Layer& self = *static_cast<Layer*>(owner);
      return self.owner->give(self, static_cast<std::size_t>(tile));
    };
  }
  float* give(Layer& layer, std::size_t tile) {
    layer.touched.push_back(tile);
    for (auto free = free_.rbegin(); free != free_.rend(); ++free) {
      if (free->clear != layer.clear) continue;
      float* const heights = free->heights;
      free_.erase(std::next(free).base());
      return layer.pointers[tile] = heights;
    }
    all_.push_back(std::make_unique<Tile>());
    std::fill_n(all_.back()->heights, kTileFloats, layer.clear);
    return layer.pointers[tile] = all_.back()->heights;
  }

  struct alignas(64) Tile {
    float heights[kTileFloats];
  };
  const HeightSweeper& heights_;
  std::vector<std::unique_ptr<Tile>> all_;
  std::vector<Free> free_;
  std::vector<SweepOp> scaled_;
};

/// Takes from the columns what the layers hold, and clears them.
class Merger {
 public:
  Merger(HeightSweeper& heights, GapGrid& gaps, ScratchTiles& scratch)
      : grid_(heights.grid), gaps_(gaps), scratch_(scratch) {}

  void merge(const Bounds& bounds, std::uint32_t id, SweepTotals& totals) {
    tiles_ = scratch_.lower.touched;
    for (const Layer* layer : {&scratch_.upper, &scratch_.ray}) {
      for (const std::size_t tile : layer->touched)
        if (std::find(tiles_.begin(), tiles_.end(), tile) == tiles_.end()) tiles_.push_back(tile);
    }
    for (const std::size_t tile : tiles_) merge_tile(tile, bounds, id, totals);
    scratch_.release();
  }

 private:
  static bool below(const float* heights, float clear) {
    bool any = false;
    for (int k = 0; k < kBlockFloats; ++k) any |= heights[k] < clear;
    return any;
  }
  void merge_tile(std::size_t tile, const Bounds& bounds, std::uint32_t id, SweepTotals& totals);

  TileGrid& grid_;
  GapGrid& gaps_;
  ScratchTiles& scratch_;
  std::vector<std::size_t> tiles_;
  std::vector<Gap> column_;
};

void Merger::merge_tile(std::size_t tile, const Bounds& bounds, std::uint32_t id,
                        SweepTotals& totals) {
  const int tiles_x = grid_.tiles_x();
  const Vec3 corner = grid_.bounds_mm().min;
  const auto block = [](double at, double origin, double cell, int block_cells, int tile_number,
                        int count) {
    const double n = std::floor((at - origin) / (cell * block_cells)) - tile_number * count;
    return static_cast<int>(std::clamp(n, -1.0, static_cast<double>(count)));
  };
  const auto column = [&](double x) {
    return block(x, corner.x, grid_.cell_x_mm(), kBlockX, static_cast<int>(tile) % tiles_x,
                 kTileBlocksX);
  };
  const auto row = [&](double y) {
    return block(y, corner.y, grid_.cell_y_mm(), kBlockY, static_cast<int>(tile) / tiles_x,
                 kTileBlocksY);
  };
  const int first_column = std::max(0, column(bounds.min_x));
  const int last_column = std::min(kTileBlocksX - 1, column(bounds.max_x));
  const int first_row = std::max(0, row(bounds.min_y));
  const int last_row = std::min(kTileBlocksY - 1, row(bounds.max_y));
  float* const lower = scratch_.lower.pointers[tile];
  float* const upper = scratch_.upper.pointers[tile];
  float* const ray = scratch_.ray.pointers[tile];
  const float no_lower = scratch_.lower.clear, no_upper = scratch_.upper.clear;
  const float no_ray = scratch_.ray.clear;
  const float per_unit = static_cast<float>(1 / kRemovedUnit_mm);
  ColumnEditor editor(grid_, gaps_, tile, column_);
  for (int j = first_row; j <= last_row; ++j) {
    for (int i = first_column; i <= last_column; ++i) {
      const std::size_t first = static_cast<std::size_t>((j * kTileBlocksX + i) * kBlockFloats);
      const bool has_head = lower != nullptr && below(lower + first, no_lower);
      const bool has_ray = ray != nullptr && below(ray + first, no_ray);
      for (std::size_t cell = first; cell < first + kBlockFloats && (has_head || has_ray); ++cell) {
        float gone = 0;
        if (has_head && upper != nullptr && lower[cell] < no_lower && upper[cell] < no_upper)
          gone += editor.remove(cell, lower[cell], -upper[cell], id);
        if (has_ray && ray[cell] < no_ray)
          gone += editor.remove(cell, ray[cell], ColumnEditor::kNoEnd, id);
        totals.removed += static_cast<std::int64_t>(std::rint(gone * per_unit));
        totals.depth = std::max(totals.depth, gone);
      }
      if (has_head) std::fill_n(lower + first, kBlockFloats, no_lower);
      if (has_ray) std::fill_n(ray + first, kBlockFloats, no_ray);
      if (upper != nullptr) std::fill_n(upper + first, kBlockFloats, no_upper);
    }
  }
}

}  // namespace

/// Has work(thread, threads, totals) done by every thread, as HeightSweeper does.
template <class Work>
void ColumnSweeper::share_out(std::span<SweepTotals> totals, const Work& work) {
  const int threads = heights_.pool->threads();
  if (threads == 1) return work(0, 1, totals);
  std::vector<std::vector<SweepTotals>> parts(static_cast<std::size_t>(threads));
  heights_.pool->run([&](int thread) {
    std::vector<SweepTotals>& part = parts[static_cast<std::size_t>(thread)];
    part.resize(totals.size());
    work(thread, threads, std::span(part));
  });
  for (const std::vector<SweepTotals>& part : parts) {
    for (std::size_t i = 0; i < totals.size(); ++i) {
      totals[i].removed += part[i].removed;
      totals[i].depth = std::max(totals[i].depth, part[i].depth);
    }
  }
}

/// Whether one of its sweeps may come as low as the gaps of a tile that it passes.
bool ColumnSweeper::comes_near_gaps(const SweepBatch& batch) const {
  const double radius = radius_of(batch);
  Bounds all;
  double lowest = std::numeric_limits<double>::infinity();
  for (const SweepOp& op : batch.ops) {
    all.extend(op, radius);
    lowest = std::min(lowest, lowest_mm(op));
  }
  for (std::size_t i = 0; i < heights_.grid.tile_count(); ++i) {
    const GapTile* const tile = gaps_.tile(i);
    if (tile == nullptr) continue;
    const double top = static_cast<double>(tile->below_mm()) + kSlack_mm;
    const Box box = heights_.grid.tile_box(i);
    if (lowest > top || !all.meets(box)) continue;
    const bool near = std::any_of(batch.ops.begin(), batch.ops.end(), [&](const SweepOp& op) {
      Bounds bounds;
      bounds.extend(op, radius);
      return lowest_mm(op) <= top && bounds.meets(box);
    });
    if (near) return true;
  }
  return false;
}

std::optional<GapView> ColumnSweeper::begin(const SweepBatch& batch) {
  if (!gaps_.any() || !comes_near_gaps(batch)) return std::nullopt;
  tops_.assign(heights_.grid.tile_count(), nullptr);
  for (std::size_t i = 0; i < tops_.size(); ++i) {
    if (const GapTile* const tile = gaps_.tile(i)) tops_[i] = tile->tops();
  }
  cut_ids_ = heights_.grid.keeps_cut_ids() ? batch.cut_ids : nullptr;
  GapView view;
  view.tops = tops_.data();
  view.thinnest = kThinnest_mm;
  view.owner = this;
  view.open = [](void* owner, int tile, int first, unsigned lanes, float* heights,
                 const float* before, float* gone, std::uint32_t report) {
    ColumnSweeper& self = *static_cast<ColumnSweeper*>(owner);
    GapTile& gaps = self.writable_gaps(static_cast<std::size_t>(tile));
    for (; lanes != 0; lanes &= lanes - 1) {
      const int n = std::countr_zero(lanes);
      gone[n] =
          self.open(gaps, static_cast<std::size_t>(first + n), heights + n, before[n], report);
    }
  };
  return view;
}

GapTile& ColumnSweeper::writable_gaps(std::size_t tile) {
  GapTile& gaps = gaps_.make_writable(tile);
  tops_[tile] = gaps.tops();
  return gaps;
}

/// What lies over a gap that the new height reaches is gone, and the gap is open: as
/// ColumnEditor::remove() has it.
float ColumnSweeper::open(GapTile& gaps, std::size_t cell, float* height, float before,
                          std::uint32_t report) {
  std::uint32_t id = cut_ids_ != nullptr ? cut_ids_[report] : MeshPatch::kNotCut;
  float low = *height;
  double hollow = 0;
  while (gaps.has(cell) && gaps.tops()[cell] >= low - kThinnest_mm) {
    const Gap gap = gaps.pop(cell);
    hollow += static_cast<double>(gap.high) - static_cast<double>(gap.low);
    if (gap.low > low) continue;
    low = gap.low;
    id = gap.low_id;
  }
  const float floor = heights_.grid.floor_mm();
  if (low - floor <= kThinnest_mm) low = floor;
  *height = low;
  if (cut_ids_ != nullptr) cut_ids_of(height)[0] = id;
  return static_cast<float>((static_cast<double>(before) - hollow) - static_cast<double>(low));
}

void ColumnSweeper::end() {
  for (std::size_t i = 0; i < tops_.size(); ++i)
    if (tops_[i] != nullptr) gaps_.drop_if_empty(i);
}

void ColumnSweeper::cut_headed(const HeadedTool& tool, std::span<const CutMove> moves,
                               std::span<SweepTotals> totals) {
  heights_.grid.begin_change();
  share_out(totals, [&](int thread, int threads, std::span<SweepTotals> sums) {
    ScratchTiles scratch(heights_);
    Merger merger(heights_, gaps_, scratch);
    std::vector<SweepOp> ops;
    const auto sweep = [&](Layer& layer, std::span<const ConvexTool> tools, const CutMove& part) {
      ops.clear();
      PathBuilder path;
      path.add(part, 0, ops);
      path.finish(ops);
      scratch.sweep(layer, tools, ops, thread, threads);
    };
    for (std::size_t i = 0; i < moves.size(); ++i) {
      const std::optional<CutMove> near = within_reach(moves[i], heights_.grid.bounds_mm());
      if (!near) continue;
      for (const CutMove& part : head_sweeps(*near, tool.radius_mm)) {
        sweep(scratch.upper, tool.upper, turned_over(part));
        sweep(scratch.lower, tool.lower, part);
        Bounds bounds;
        for (const SweepOp& op : ops) bounds.extend(op, tool.radius_mm);
        sweep(scratch.ray, tool.rays, part);
        const bool keeps = heights_.grid.keeps_cut_ids();
        merger.merge(bounds, keeps ? cut_id_of(moves[i].id) : MeshPatch::kNotCut, sums[i]);
      }
    }
  });
}

}  // namespace kerf
