// stock/octree/turn_groups.h - runs of turning pieces, seen as one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stock/octree/brick_tree.h"
#include "stock/octree/sweep.h"

namespace kerf::octree {

/// Pieces of a turning path that follow each other, by one body, and one coarse piece from the
/// start of the first to the end of the last: what that misses by more than it is off they all
/// miss.
struct TurnGroup {
  Sweep whole;          ///< as Sweep::Kind::kTurn; its report and box mean nothing
  double turn_rad = 0;  ///< between its ends
  double way_mm = 0;    ///< of the tip
  double off_mm = 0;    ///< of a piece's tip from that of `whole`, at most
  double off_rad = 0;   ///< of its spindle
  Vec3 middle_mm{0};    ///< all tips are within ..
  double tips_mm = 0;   ///< .. this of it
};

/// Groups of what append_sweeps() gives for moves in a row.
class TurnGroups {
 public:
  /// Looked at until all sweeps are worked off.
  TurnGroups(std::span<const Sweep> sweeps, const Lattice& lattice);
  /// Of a sweep of that span; null: it is by itself.
  const TurnGroup* of(const Sweep& sweep) const {
    const std::int32_t group = group_of_[static_cast<std::size_t>(&sweep - sweeps_.data())];
    return group < 0 ? nullptr : &groups_[static_cast<std::size_t>(group)];
  }

 private:
  struct Run;
  void close(Run& run);
  std::span<const Sweep> sweeps_;
  std::vector<std::int32_t> group_of_;
  std::vector<TurnGroup> groups_;
};

}  // namespace kerf::octree
