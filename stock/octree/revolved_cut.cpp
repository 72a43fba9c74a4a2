#include "stock/octree/revolved_cut.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <numeric>

#include "stock/octree/profile_slices.h"

namespace kerf::octree {
namespace {

/// Cuts one column of tiles after the other. One for each thread.
class RevolvedCutter {
 public:
  RevolvedCutter(BrickTree& tree, const ProfileSlices& slices, std::uint64_t version)
      : tree_(tree), lattice_(tree.lattice()), slices_(slices), version_(version) {
    // So that a second cut changes nothing: a crossing's place is good for that.
    place_slack_mm_ =
        std::max({lattice_.cell_mm.x, lattice_.cell_mm.y, lattice_.cell_mm.z}) / kEdgeParts;
  }

  /// Layers of bricks first .. last.
  void cut(int column, int first, int last) {
    for (int level = first / kTileBricks; level <= last / kTileBricks; ++level) {
      if (tree_.tile(column, level).is_empty()) continue;
      bool changed = false;
      for (int b = 0; b < kBricksInTile; ++b) {
        const int bz = level * kTileBricks + b / (kTileBricks * kTileBricks);
        if (bz >= first && bz <= last) changed = cut_brick(column, level, b) || changed;
      }
      if (changed) tree_.settle_tile(column, level);
    }
  }
  std::int64_t gone() const { return gone_; }

 private:
  BrickRef state(int column, int level, int brick) const {
    const TileRef& tile = tree_.tile(column, level);
    if (tile.get()) return tile->bricks[brick];
    return tile.is_solid() ? BrickRef::solid() : BrickRef();
  }

  bool cut_brick(int column, int level, int number) {
    const BrickRef brick = state(column, level, number);
    if (brick.is_empty()) return false;
    const int tiles_x = lattice_.tiles[0];
    const int at[3] = {column % tiles_x * kTileBricks + number % kTileBricks,
                       column / tiles_x * kTileBricks + number / kTileBricks % kTileBricks,
                       level * kTileBricks + number / (kTileBricks * kTileBricks)};
    for (int axis = 0; axis < 3; ++axis) first_[axis] = at[axis] * kBrick;
    const Vec2 low(place(0, 0), place(1, 0)), high(place(0, kBrick), place(1, kBrick));
    const ProfileSlices::Sight sight = slices_.sight_of(first_[2], kBrick, low, high);
    if (sight == ProfileSlices::Sight::kInside) return false;
    BrickRef after;
    open_.open(brick);
    const std::int64_t before = open_.volume;
    if (sight == ProfileSlices::Sight::kMixed) {
      if (!cut_nodes()) return false;
      open_.measure();
      after = open_.close(tree_.keeps_ids());
    }
    gone_ += before - (after.is_empty() ? 0 : open_.volume);
    tree_.note_reach(at[0], at[1], at[2], 0xff);
    tree_.own_tile(column, level, version_).bricks[number] = after;
    return true;
  }

  double place(int axis, int node) const { return lattice_.place_mm(axis, first_[axis] + node); }

  /// Of the open brick. False if nothing changes.
  bool cut_nodes() {
    std::copy(std::begin(open_.columns), std::end(open_.columns), std::begin(before_));
    bool changed = false;
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        std::uint16_t& column = open_.columns[j * kSide + i];
        const Vec2 at(place(0, i), place(1, j));
        for (unsigned bits = column; bits != 0; bits &= bits - 1) {
          const int k = std::countr_zero(bits);
          if (slices_.holds(first_[2] + k, at)) continue;
          column = static_cast<std::uint16_t>(column & ~(1u << k));
          changed = true;
        }
      }
    }
    for_each_crossed(open_.columns, [&](int axis, int i, int j, int k) {
      changed = cut_edge(axis, i, j, k) || changed;
    });
    return changed;
  }

  /// Of a crossed edge, from its solid end on.
  bool cut_edge(int axis, int i, int j, int k) {
    const std::size_t e =
        static_cast<std::size_t>(axis * kBrickNodes + (j * kBrick + i) * kBrick + k);
    const int step[3] = {axis == 0 ? 1 : 0, axis == 1 ? 1 : 0, axis == 2 ? 1 : 0};
    const int upper_column = (j + step[1]) * kSide + i + step[0];
    const bool lower_is_solid = (open_.columns[j * kSide + i] >> k & 1u) != 0;
    const bool was_crossed =
        ((before_[j * kSide + i] >> k ^ before_[upper_column] >> (k + step[2])) & 1u) != 0;
    const double length = lattice_.cell_mm[axis];
    const double sign = lower_is_solid ? 1 : -1;
    const int up = lower_is_solid ? 0 : 1;
    const Vec2 at(place(0, i + up * step[0]), place(1, j + up * step[1]));
    const int layer = first_[2] + k + up * step[2];
    std::optional<BodyExit> exit = axis == 2 ? slices_.exit_upright(layer, at, sign)
                                             : slices_.exit_level(layer, at, axis, sign, length);
    if (was_crossed) {
      const int lower = open_.place[e];
      const double reach = length * (lower_is_solid ? lower : kEdgeParts - lower) / kEdgeParts;
      if (!exit || exit->way_mm >= reach - place_slack_mm_) return false;
    } else if (!exit) {
      // The surface passes the empty end itself, within rounding.
      exit = BodyExit{length, Vec3(0)};
      exit->normal[axis] = sign;
    }
    const double part = exit->way_mm / length;
    open_.place[e] = static_cast<std::uint16_t>(
        std::clamp(std::lround((lower_is_solid ? part : 1 - part) * kEdgeParts), 0L,
                   static_cast<long>(kEdgeParts - 1)));
    open_.direction[e] = pack_direction(glm::vec3(exit->normal));
    open_.id[e] = MeshPatch::kNotCut;
    return true;
  }

  BrickTree& tree_;
  const Lattice& lattice_;
  const ProfileSlices& slices_;
  std::uint64_t version_;
  double place_slack_mm_ = 0;
  OpenBrick open_;
  std::uint16_t before_[kSide * kSide] = {};
  int first_[3] = {0, 0, 0};
  std::int64_t gone_ = 0;
};

}  // namespace

std::int64_t cut_to_revolved(BrickTree& tree, const RevolvedBody& body, const ZRange& range,
                             WorkerPool& pool) {
  const Lattice& lattice = tree.lattice();
  const int bricks = lattice.tiles[2] * kTileBricks;
  // A node's edges reach one cell beyond it, and a brick holds a layer of the next one.
  const auto brick_at = [&](double z_mm) {
    const double node = (z_mm - lattice.origin_mm.z) / lattice.cell_mm.z;
    return static_cast<int>(std::clamp(std::floor(node / kBrick), 0.0, bricks - 1.0));
  };
  const int first = brick_at(range.low_mm - 2 * lattice.cell_mm.z);
  const int last = brick_at(range.high_mm + 2 * lattice.cell_mm.z);
  const ProfileSlices slices(body, lattice, first * kBrick, (last + 1) * kBrick);
  tree.own_reach();
  const std::uint64_t version = next_version();
  std::atomic<int> next{0};
  std::vector<std::int64_t> gone(static_cast<std::size_t>(pool.threads()), 0);
  pool.run([&](int thread) {
    RevolvedCutter cutter(tree, slices, version);
    for (int column = next++; column < lattice.column_count(); column = next++)
      cutter.cut(column, first, last);
    gone[static_cast<std::size_t>(thread)] = cutter.gone();
  });
  return std::accumulate(gone.begin(), gone.end(), std::int64_t{0});
}

}  // namespace kerf::octree
