// stock/turning/covered_passes.h - turns of a thread beside a tool, and which of them take nothing
// from it that others do not.
#pragma once

#include <vector>

#include "stock/turning/thread_pass.h"

namespace kerf::turning {

/// Another turn, of the tool's own pass or of one before, as it lies beside the tool on its way.
struct PassBeside {
  const ThreadPass* pass = nullptr;
  Vec2 offset{0};   ///< of its controlled point from the tool's, (z, r), at some way of the tool
  Vec2 per_way{0};  ///< by which that grows with the way
  double low_way = 0, high_way = 0;  ///< of the tool, as long as it is there
};

/// Outlines that move by less beside each other stand still, mm.
inline constexpr double kStill_mm = 1e-9;

/// Drops those of which all that lies between the radii of the tool of `pass` is within another one
/// of them, as long as they are there between two ways of the tool: of the passes of a thread
/// hardly more than the deepest is left. Of equal ones the last stays. `offset` is that at the way
/// `at_way`. All go straight, so what holds at both ends holds between them. What is covered only
/// by several others together stays.
void drop_covered(const ThreadPass& pass, double at_way, double low_way, double high_way,
                  std::vector<PassBeside>& beside);

}  // namespace kerf::turning
