// twin/process/turning/edge_checks.h - what the edges of an insert are asked for: over-depth.
#pragma once

#include <optional>
#include <vector>

#include "stock/turning/turned_part.h"
#include "twin/findings/finding.h"
#include "twin/process/turning/turning_checks.h"

namespace kerf {

/// A straight cut is too deep where material stands before the whole length of a flank, as far as
/// to its end, behind which nothing cuts. A plunge of a blade, whose front is always all in
/// material, is none. Of arcs nothing is told.
class EdgeChecks {
 public:
  explicit EdgeChecks(FindingLog& log) : log_(log) {}

  void mount(const Cutter& cutter);
  void unmount() {
    edges_.clear();
    event_.reset();
  }
  /// A feed move that has been cut. An event ends with the first that cuts, and less deep.
  void check(const TurnedMove& move, const TurnCut& cut, bool blank_guessed);

  /// Of an edge's length across the way: corners are rounded. A shorter edge leads, and cuts
  /// nothing.
  static constexpr double kSlack_mm = 0.01, kShortest_mm = 0.05;

 private:
  /// A straight flank with a free end.
  struct Edge {
    Vec2 along_mm{0};  ///< (z, x), counter-clockwise about the insert
    InsertSide side = InsertSide::kFront;
  };

  FindingLog& log_;
  std::vector<Edge> edges_;
  std::optional<FindingLog::Handle> event_;
};

}  // namespace kerf
