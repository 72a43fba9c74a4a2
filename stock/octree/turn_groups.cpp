#include "stock/octree/turn_groups.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace kerf::octree {
namespace {

/// A group's whole may bend away from its pieces by this part of a cell, over the blank's size:
/// longer ones leave too many nodes in doubt, shorter ones save too little.
constexpr double kGroupBend = 0.25;
/// Fewer pieces are as well looked at one by one.
constexpr std::size_t kLeastPieces = 3;

}  // namespace

/// The pieces of one body, so far.
struct TurnGroups::Run {
  const ToolBody* body = nullptr;
  std::vector<std::size_t> pieces;
};

TurnGroups::TurnGroups(std::span<const Sweep> sweeps, const Lattice& lattice)
    : sweeps_(sweeps), group_of_(sweeps.size(), -1) {
  const double size = glm::length(lattice.bounds_mm.size());
  const double cell = std::min({lattice.cell_mm.x, lattice.cell_mm.y, lattice.cell_mm.z});
  std::vector<Run> runs;
  const auto run_of = [&](const ToolBody* body) -> Run& {
    for (Run& run : runs)
      if (run.body == body) return run;
    runs.push_back({body, {}});
    return runs.back();
  };
  for (std::size_t n = 0; n < sweeps.size(); ++n) {
    const Sweep& sweep = sweeps[n];
    Run& run = run_of(sweep.body);
    if (sweep.kind != Sweep::Kind::kTurn) {
      close(run);
      continue;
    }
    if (!run.pieces.empty()) {
      const Sweep &first = sweeps[run.pieces.front()], &last = sweeps[run.pieces.back()];
      const bool follows = glm::length(last.origin_mm + last.step - sweep.origin_mm) < 1e-9 &&
                           glm::length(last.w + last.turn - sweep.w) < 1e-9;
      const double turn = glm::length(sweep.w + sweep.turn - first.w);
      const double way = glm::length(sweep.origin_mm + sweep.step - first.origin_mm);
      if (!follows || bend_mm(size, way, turn) > kGroupBend * cell) close(run);
    }
    run.pieces.push_back(n);
  }
  for (Run& run : runs) close(run);
}

void TurnGroups::close(Run& run) {
  if (run.pieces.size() < kLeastPieces) {
    run.pieces.clear();
    return;
  }
  const Sweep &first = sweeps_[run.pieces.front()], &last = sweeps_[run.pieces.back()];
  TurnGroup group;
  group.whole = first;
  group.whole.step = last.origin_mm + last.step - first.origin_mm;
  group.whole.turn = last.w + last.turn - first.w;
  group.turn_rad = glm::length(group.whole.turn);
  group.way_mm = glm::length(group.whole.step);
  group.middle_mm = first.origin_mm + 0.5 * group.whole.step;
  double all = 0, before = 0;
  for (const std::size_t n : run.pieces) all += glm::length(sweeps_[n].turn);
  // Between the ends of pieces both go straight, and so does what they are apart.
  for (const std::size_t n : run.pieces) {
    const Sweep& piece = sweeps_[n];
    const double part = before / all;
    const Vec3 axis = group.whole.w + part * group.whole.turn;
    group.off_mm = std::max(group.off_mm, glm::length(piece.origin_mm - group.whole.origin_mm -
                                                      part * group.whole.step));
    group.off_rad = std::max(group.off_rad, glm::length(piece.w - axis / glm::length(axis)));
    group.tips_mm = std::max({group.tips_mm, glm::length(piece.origin_mm - group.middle_mm),
                              glm::length(piece.origin_mm + piece.step - group.middle_mm)});
    before += glm::length(piece.turn);
    group_of_[n] = static_cast<std::int32_t>(groups_.size());
  }
  groups_.push_back(group);
  run.pieces.clear();
}

}  // namespace kerf::octree
