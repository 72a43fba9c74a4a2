// stock/octree/tree_cut.h - sweeps against the whole tree.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/worker_pool.h"
#include "stock/blank.h"
#include "stock/octree/brick_tree.h"
#include "stock/octree/sweep_kernel.h"

namespace kerf::octree {

/// What one move has removed.
struct MoveTotals {
  std::int64_t volume = 0;  ///< in kNodeVolume
  std::int32_t height = 0;  ///< greatest of any column of nodes, in kEdgeParts an edge
};

/// What one move has left in one brick of a film that no node holds (thin_films.h).
struct FilmSpot {
  std::uint32_t report = 0;
  std::uint64_t brick = 0;  ///< its place as one number
  double faces = 0;         ///< area, in faces of a cell
  double thickness_mm = 0;
  Vec3 at_mm{0};
};

/// Takes the sweeps away, in order, and adds to totals[sweep.report]. Columns of tiles are dealt
/// out to the pool's threads; each brick sees its sweeps in order, so the result and the sums do
/// not depend on threads. From column to tile to brick to block, F in the middle tells what a sweep
/// misses or takes as a whole (F changes by at most 1 mm a mm), so a feature thinner than these is
/// not missed; what is empty is never looked at. `additive`: nodes outside of the blank stay.
/// `films` may be null: they are not looked for. They come in order of reports, then bricks, one
/// for each pair; what a brick has of them does not depend on the division into calls. None where
/// material is added.
void cut_tree(BrickTree& tree, std::span<const Sweep> sweeps, const SweepKernel& kernel,
              bool additive, WorkerPool& pool, std::span<MoveTotals> totals,
              std::vector<FilmSpot>* films);

/// Would any of the sweeps take something? Stops at the first that would. `blank`: what the tree
/// was made of; where it is untouched nodes and crossings are not all that counts (BlankContact).
bool touches_tree(const BrickTree& tree, std::span<const BlankBody> blank,
                  std::span<const Sweep> sweeps, const SweepKernel& kernel);

/// Greatest height of material above any one point that `before` has and `after`, cut from it, has
/// not; in kEdgeParts an edge, of columns of nodes. `after` is cut by a tool that is drawn in by
/// `slack` (in the same unit), and `exact` by the tool itself: where the former has lost something
/// the latter says how much, but no more than `slack` more. `exact` may be null: it is that more.
std::int32_t greatest_loss(const BrickTree& before, const BrickTree& after, const BrickTree* exact,
                           std::int32_t slack);

}  // namespace kerf::octree
