// stock/zmap/height_sweeper.h - moves cut into the heights of a grid: what models with heights
// share.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/worker_pool.h"
#include "stock/stock_model.h"
#include "stock/zmap/path_builder.h"
#include "stock/zmap/sweep_ops.h"
#include "stock/zmap/tile_grid.h"
#include "stock/zmap/tip_traces.h"
#include "stock/zmap/wall_marks.h"
#include "stock/zmap/wall_rims.h"
#include "stock/zmap/zmap.h"

namespace kerf {

struct SweepKernels {
  SweepKernel* plain = nullptr;
  SweepKernel* with_ids = nullptr;
  SweepKernel* with_gaps = nullptr;  ///< and with ids, where the grid keeps them
};
SweepKernels pick_kernels(ZMapKernel kernel);

/// As cells keep it: nothing that cuts may look like kNotCut.
std::uint32_t cut_id_of(std::uint64_t move_id);

/// Sweeps of several moves of one cutter that are worked off together.
struct SweepBatch {
  std::span<const SweepOp> ops;       ///< in order; those of one move (SweepOp::report) in a row
  std::span<const ConvexTool> tools;  ///< the cutter is their union
  const std::uint32_t* cut_ids = nullptr;  ///< by report; only where the grid keeps them
};

/// What is hollow below the heights of the grid.
class HollowColumns {
 public:
  virtual ~HollowColumns() = default;
  /// Null: the batch comes near to nothing hollow. Else how the kernels are to see it, until end().
  virtual std::optional<GapView> begin(const SweepBatch& batch) = 0;
  virtual void end() = 0;
  /// Anything is hollow, anywhere.
  virtual bool any() const = 0;
};

/// Lowers the heights of a grid by moves of cutters without undercut: StockModel::cut() and
/// finish() of a Z-map. Holds back the last segment of a path. Copyable: a copy cuts on by itself,
/// with the same worker pool.
class HeightSweeper {
 public:
  HeightSweeper(TileGrid heights, ZMapKernel kernel, int threads)
      : grid(std::move(heights)),
        kernels(pick_kernels(kernel)),
        pool(std::make_shared<WorkerPool>(threads < 1 ? 1 : threads)),
        traces_(grid) {}

  /// `hollows` may be null. The cutter must be one of convex_components() without undercut.
  void cut(const Cutter& cutter, std::span<const CutMove> moves, HollowColumns* hollows,
           std::vector<CutReport>& reports);
  void finish(HollowColumns* hollows, std::vector<CutReport>& reports);
  bool holds_back() const { return path_.holds_back(); }
  /// Finishes, and lets the next move begin with the tool's own shape.
  void end_path(HollowColumns* hollows, std::vector<CutReport>& reports);

  CutReport report(std::uint64_t id, const SweepTotals& sum) const;

  /// Of all that was cut, moves held back included.
  const TipTraces& traces() const { return traces_; }
  /// Of a blank that is in the grid, before anything is cut.
  void follow_sides(const Blank& blank) {
    if (blank.mesh && blank.mesh->body)
      traces_.follow_mesh(grid, *blank.mesh->body);
    else
      traces_.follow_sides(blank.bodies);
  }
  /// From now on walls() has where upright sides stand. Round sides of `bodies`, which are in the
  /// grid, may be told.
  void keep_walls(std::span<const BlankBody> bodies = {});
  /// Of the grid as it is; empty where nobody keeps them. Works off what has been put off: the
  /// owner's thread asks first, then others may.
  WallMarks& walls() {
    mark_walls();
    walls_.settle(grid);
    return walls_;
  }
  /// Of a workpiece that was cut before by nobody knows what.
  void forget_traces() { traces_.forget(); }
  /// Moves of another cutter, the union of `tools`, that the caller cuts himself.
  void trace(std::span<const ConvexTool> tools, std::span<const CutMove> moves);
  /// The grid as kernels see it, without tiles: no tile may be written before its first sweep has
  /// asked for it. This is how tiles come to be unshared and to have a new version, without a look
  /// at either in the kernels' loops.
  GridView view_without_tiles() const;

  TileGrid grid;
  SweepKernels kernels;
  std::shared_ptr<WorkerPool> pool;

 private:
  void use_cutter(const Cutter& cutter, HollowColumns* hollows, std::vector<CutReport>& reports);
  void cut_some(std::span<const CutMove> moves, HollowColumns* hollows,
                std::vector<CutReport>& reports);
  void run(HollowColumns* hollows, std::size_t report_count);
  double radius_mm() const;
  bool may_be_deepest(const CutMove& move) const;
  double tip_depth_mm(const CutMove& move, HollowColumns* hollows);
  void put_off_walls();
  void mark_walls();
  void sweep(const GridView& whole, SweepKernel* kernel, std::size_t report_count);
  void sweep_by_moves(const GridView& whole, SweepKernel* kernel, std::size_t report_count);
  GridView view();
  template <class Work>
  void share_out(std::size_t report_count, const GridView& view, const Work& work);

  PathBuilder path_;
  TipTraces traces_;
  std::string cutter_spec_;
  std::vector<ConvexTool> tools_;
  TipTraces::Tip tip_;            ///< of tools_
  double deepest_mm_ = 0;         ///< greatest of tip_depth_mm() since the cutter came
  std::uint64_t pending_id_ = 0;  ///< move whose last segment is held back
  SweepTotals pending_totals_;

  std::vector<SweepOp> ops_;  // kept between calls to save allocations
  std::vector<SweepTotals> totals_;
  std::vector<float*> pointers_;
  WallMarks walls_;
  std::vector<SweepOp> unmarked_;               ///< of tools_; their walls have not been looked for
  std::vector<std::vector<PlacedMark>> marks_;  ///< by thread
  std::vector<std::uint32_t> cut_ids_;          ///< by report; unused where they are not kept
};

}  // namespace kerf
