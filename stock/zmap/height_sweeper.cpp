#include "stock/zmap/height_sweeper.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "stock/move_reach.h"
#include "stock/zmap/cutter_components.h"

namespace kerf {
namespace {

/// Moves whose sweeps are worked off together: as many as keep the list of sweeps within the
/// second-level cache.
constexpr std::size_t kMovesAtOnce = 1024;
/// An arc may become many sweeps: they are not all kept at once.
constexpr std::size_t kSweepsAtOnce = std::size_t{1} << 16;
/// The kernels count blocks of cells from where a sweep begins, in single precision: exact up to
/// 2^24.
constexpr double kMostBlocks = 1 << 22;
/// Some rows of a program's finishing, four megabytes.
constexpr std::size_t kUnmarkedOps = 16384;
/// A depth is greater than another one if it is by more than this.
constexpr double kDeeper_mm = 1e-4;

}  // namespace

SweepKernels pick_kernels(ZMapKernel kernel) {
  if (kernel == ZMapKernel::kAuto || !zmap_can_run(kernel)) kernel = zmap_kernels().front();
#if defined(__x86_64__)
  if (kernel == ZMapKernel::kAvx2)
    return {zmap_avx2::run_sweeps, zmap_avx2_ids::run_sweeps, zmap_avx2_gaps::run_sweeps};
#endif
#if defined(__x86_64__) || defined(__aarch64__)
  if (kernel != ZMapKernel::kScalar)
    return {zmap_vector::run_sweeps, zmap_vector_ids::run_sweeps, zmap_vector_gaps::run_sweeps};
#endif
  return {zmap_scalar::run_sweeps, zmap_scalar_ids::run_sweeps, zmap_scalar_gaps::run_sweeps};
}

std::uint32_t cut_id_of(std::uint64_t move_id) {
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(move_id, MeshPatch::kNotCut - 1));
}

CutReport HeightSweeper::report(std::uint64_t id, const SweepTotals& sum) const {
  return {id,
          static_cast<double>(sum.removed) * kRemovedUnit_mm * grid.cell_x_mm() * grid.cell_y_mm(),
          static_cast<double>(sum.depth)};
}

GridView HeightSweeper::view_without_tiles() const {
  GridView view;
  view.nx = grid.nx();
  view.ny = grid.ny();
  view.tiles_x = grid.tiles_x();
  view.tiles_y = grid.tiles_y();
  view.x0 = grid.bounds_mm().min.x;
  view.y0 = grid.bounds_mm().min.y;
  view.cell_x = grid.cell_x_mm();
  view.cell_y = grid.cell_y_mm();
  view.per_block_x = 1 / (kBlockX * view.cell_x);
  view.per_block_y = 1 / (kBlockY * view.cell_y);
  view.floor = grid.floor_mm();
  return view;
}

GridView HeightSweeper::view() {
  pointers_.assign(grid.tile_count(), nullptr);
  GridView view = view_without_tiles();
  view.tiles = pointers_.data();
  view.owner = this;
  view.make_writable = [](void* owner, int tile) {
    HeightSweeper& self = *static_cast<HeightSweeper*>(owner);
    const std::size_t index = static_cast<std::size_t>(tile);
    return self.pointers_[index] = self.grid.make_writable(index);
  };
  if (grid.keeps_cut_ids()) view.cut_ids = cut_ids_.data();
  return view;
}

/// Has work(view, thread, threads, totals) done by every thread. Bands of tile rows are dealt out;
/// the sums of a move's bands are integers, so their order does not matter.
template <class Work>
void HeightSweeper::share_out(std::size_t report_count, const GridView& view, const Work& work) {
  const int threads = pool->threads();
  if (threads == 1) {
    GridView mine = view;
    return work(mine, 0, 1, totals_.data());
  }
  std::vector<std::vector<SweepTotals>> parts(static_cast<std::size_t>(threads));
  pool->run([&](int thread) {
    std::vector<SweepTotals>& part = parts[static_cast<std::size_t>(thread)];
    part.resize(report_count);
    GridView mine = view;
    work(mine, thread, threads, part.data());
  });
  for (const std::vector<SweepTotals>& part : parts) {
    for (std::size_t i = 0; i < report_count; ++i) {
      totals_[i].removed += part[i].removed;
      totals_[i].depth = std::max(totals_[i].depth, part[i].depth);
    }
  }
}

/// Works off `ops_`; totals_[0 .. report_count) receive the sums.
void HeightSweeper::run(HollowColumns* hollows, std::size_t report_count) {
  if (ops_.empty()) return;
  grid.begin_change();
  const std::optional<GapView> gaps =
      hollows != nullptr ? hollows->begin({ops_, tools_, cut_ids_.data()}) : std::nullopt;
  GridView whole = view();
  SweepKernel* kernel = grid.keeps_cut_ids() ? kernels.with_ids : kernels.plain;
  if (gaps) {
    whole.gaps = *gaps;
    kernel = kernels.with_gaps;
  }
  // Of two moves that cut equally deep with different parts of the cutter, the earlier would be
  // found by how they are divided into calls; and whose the material is that they share.
  if (tools_.size() > 1 && (grid.keeps_cut_ids() || gaps)) {
    sweep_by_moves(whole, kernel, report_count);
  } else {
    sweep(whole, kernel, report_count);
  }
  if (gaps) hollows->end();
  if (walls_.is_kept()) put_off_walls();
  ops_.clear();
}

/// Most sides of a path are cut away by what follows: of them nothing is found where many sweeps
/// are looked at together, after the last of them.
void HeightSweeper::put_off_walls() {
  double highest = -HUGE_VAL;
  for (const ConvexTool& tool : tools_)
    highest = std::max(highest, highest_wall_tip_mm(grid, tool));
  for (const SweepOp& op : ops_)
    if (lowest_tip_mm(op) < highest) unmarked_.push_back(op);
  if (unmarked_.size() >= kUnmarkedOps) mark_walls();
}

void HeightSweeper::mark_walls() {
  if (unmarked_.empty()) return;
  const auto threads = static_cast<std::size_t>(pool->threads());
  marks_.resize(threads);
  const auto work = [&](int number) {
    const auto n = static_cast<std::size_t>(number);
    const std::size_t begin = unmarked_.size() * n / threads,
                      end = unmarked_.size() * (n + 1) / threads;
    const std::span<const SweepOp> part = std::span(unmarked_).subspan(begin, end - begin);
    for (const ConvexTool& tool : tools_) find_wall_marks(grid, tool, part, marks_[n]);
  };
  if (threads == 1)
    work(0);
  else
    pool->run(work);
  for (std::vector<PlacedMark>& part : marks_) {
    for (const PlacedMark& placed : part) walls_.add(placed.tile, placed.mark, grid);
    part.clear();  // snapshots copy it
  }
  unmarked_.clear();
}

void HeightSweeper::keep_walls(std::span<const BlankBody> bodies) {
  walls_ = WallMarks(grid);
  std::vector<PlacedMark> marks;
  for (const BlankBody& body : bodies) {
    const bool is_tube = body.kind == BlankBody::Kind::kTube;
    if (body.axis != 'z' || !(is_tube || body.kind == BlankBody::Kind::kCylinder)) continue;
    const Vec2 center(body.center_mm);
    find_side_marks(grid, center, 0.5 * body.diameter_mm, false, marks);
    if (is_tube) find_side_marks(grid, center, 0.5 * body.inner_diameter_mm, true, marks);
  }
  for (const PlacedMark& placed : marks) walls_.add(placed.tile, placed.mark, grid);
}

void HeightSweeper::sweep(const GridView& whole, SweepKernel* kernel, std::size_t report_count) {
  for (const ConvexTool& tool : tools_) {
    if (tool.needs_double)
      for (SweepOp& op : ops_) op.use_double = true;
    share_out(report_count, whole, [&](GridView& mine, int thread, int threads, SweepTotals* sums) {
      kernel(mine, tool, ops_.data(), ops_.size(), thread, threads, sums);
    });
  }
}

void HeightSweeper::sweep_by_moves(const GridView& whole, SweepKernel* kernel,
                                   std::size_t report_count) {
  share_out(report_count, whole, [&](GridView& mine, int thread, int threads, SweepTotals* sums) {
    for (SweepOp op : ops_) {
      for (const ConvexTool& tool : tools_) {
        op.use_double |= tool.needs_double;
        kernel(mine, tool, &op, 1, thread, threads, sums);
      }
    }
  });
}

void HeightSweeper::finish(HollowColumns* hollows, std::vector<CutReport>& reports) {
  if (!path_.holds_back()) return;
  totals_.assign(1, pending_totals_);
  cut_ids_.assign(1, cut_id_of(pending_id_));
  path_.set_pending_report(0);
  path_.finish(ops_);
  run(hollows, 1);
  reports.push_back(report(pending_id_, totals_[0]));
}

void HeightSweeper::end_path(HollowColumns* hollows, std::vector<CutReport>& reports) {
  finish(hollows, reports);
  path_.restart();
}

void HeightSweeper::use_cutter(const Cutter& cutter, HollowColumns* hollows,
                               std::vector<CutReport>& reports) {
  if (cutter.spec() == cutter_spec_ && !tools_.empty()) return;
  end_path(hollows, reports);
  mark_walls();
  cutter_spec_ = cutter.spec();
  tools_ = convex_components(cutter.profile());
  tip_ = traces_.tip_of(tools_);
  deepest_mm_ = 0;
}

void HeightSweeper::trace(std::span<const ConvexTool> tools, std::span<const CutMove> moves) {
  const TipTraces::Tip tip = traces_.tip_of(tools);
  for (const CutMove& move : moves) traces_.add(tip, move);
}

void HeightSweeper::cut(const Cutter& cutter, std::span<const CutMove> moves,
                        HollowColumns* hollows, std::vector<CutReport>& reports) {
  use_cutter(cutter, hollows, reports);
  for (std::size_t first = 0; first < moves.size(); first += kMovesAtOnce) {
    cut_some(moves.subspan(first, std::min(kMovesAtOnce, moves.size() - first)), hollows, reports);
  }
}

double HeightSweeper::radius_mm() const {
  double radius = 0;
  for (const ConvexTool& tool : tools_) radius = std::max(radius, tool.radius);
  return radius;
}

/// The middles of cells tell less than the tip's depth, and no move of this cutter was as deep. Of
/// the others (most) the middles tell enough: nobody wants but the greatest depth of a tool. Short
/// moves are left out, which are all near to what is held back, and come by the million.
bool HeightSweeper::may_be_deepest(const CutMove& move) const {
  if (!tip_.is_finer_than_cells() || move.arc || !traces_.knows()) return false;
  if (!PathBuilder::is_vertical(move)) {
    const double dx = move.to_mm.x - move.from_mm.x, dy = move.to_mm.y - move.from_mm.y;
    if (!tip_.pointed || dx * dx + dy * dy < 4 * radius_mm() * radius_mm()) return false;
  }
  const double tip_z = std::min(move.from_mm.z, move.to_mm.z) + tip_.low_mm;
  return grid.bounds_mm().max.z - std::max(tip_z, grid.bounds_mm().min.z) >
         deepest_mm_ + kDeeper_mm;
}

/// How deep the tip of a move goes that is about to be cut. All that came before is cut first, as
/// far as it is not held back: what is near to that is left out. The same however moves are divided
/// into calls.
double HeightSweeper::tip_depth_mm(const CutMove& move, HollowColumns* hollows) {
  run(hollows, totals_.size());
  if (hollows != nullptr && hollows->any()) return 0;
  std::optional<TipTraces::Way> held;
  if (path_.holds_back()) held = path_.held_back();
  const double depth = traces_.depth_mm(grid, tip_, move, held, radius_mm());
  deepest_mm_ = std::max(deepest_mm_, depth);
  return depth;
}

void HeightSweeper::cut_some(std::span<const CutMove> moves, HollowColumns* hollows,
                             std::vector<CutReport>& reports) {
  // totals_[0] is the move held back before, if any; the others follow in order.
  const bool carried = path_.holds_back();
  const std::size_t first = carried ? 1 : 0;
  totals_.assign(moves.size() + first, SweepTotals{});
  if (carried) {
    totals_[0] = pending_totals_;
    path_.set_pending_report(0);
  }
  if (grid.keeps_cut_ids()) {
    cut_ids_.clear();
    if (carried) cut_ids_.push_back(cut_id_of(pending_id_));
    for (const CutMove& move : moves) cut_ids_.push_back(cut_id_of(move.id));
  }
  const Box blank = grid.bounds_mm();
  const double block_mm = std::min(kBlockX * grid.cell_x_mm(), kBlockY * grid.cell_y_mm());
  const double reach_mm = std::min(kMoveReach_mm, kMostBlocks * block_mm);
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const std::optional<CutMove> move = within_reach(moves[i], blank, reach_mm);
    if (!move) {
      // Nothing is held back across it: reports come in order.
      path_.finish(ops_);
      path_.restart();
      continue;
    }
    if (may_be_deepest(*move)) {
      // Straight down the path ends what is held back in any case.
      if (path_.is_vertical(*move)) path_.finish(ops_);
      const double depth = tip_depth_mm(*move, hollows);
      SweepTotals& sum = totals_[i + first];
      sum.depth = std::max(sum.depth, static_cast<float>(depth));
    }
    traces_.add(tip_, *move);
    path_.add(*move, static_cast<std::uint32_t>(i + first), ops_);
    if (ops_.size() > kSweepsAtOnce) run(hollows, totals_.size());
  }
  run(hollows, totals_.size());

  const bool holding = path_.holds_back();
  if (carried) reports.push_back(report(pending_id_, totals_[0]));
  for (std::size_t i = 0; i < moves.size(); ++i) {
    if (holding && i + 1 == moves.size()) break;
    reports.push_back(report(moves[i].id, totals_[i + first]));
  }
  if (holding) {
    pending_id_ = moves.back().id;
    pending_totals_ = totals_.back();
  }
}

}  // namespace kerf
