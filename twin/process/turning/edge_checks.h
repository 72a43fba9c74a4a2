// twin/process/turning/edge_checks.h - what the edges of an insert are asked for: over-depth.
#pragma once

#include <optional>
#include <vector>

#include "stock/turning/turning_stock.h"
#include "twin/findings/finding.h"
#include "twin/process/turning/turning_checks.h"

namespace kerf {

/// A cut is too deep where material stands before the whole length of a flank, as far as to its
/// end, behind which nothing cuts. A plunge of a blade, whose front is always all in material, is
/// none. Arcs are looked at in steps of kStep_rad, over each of which the way counts as straight.
/// Too deep is, too, what is deeper than the tool says it takes (max_ap= of its SHAPE); of
/// threads that is not looked at.
class EdgeChecks {
 public:
  EdgeChecks(const TurningStock& stock, FindingLog& log) : stock_(stock), log_(log) {}

  void mount(const Cutter& cutter);
  void unmount() {
    edges_.clear();
    before_.reset();
    most_mm_.reset();
    event_.reset();
    deep_.reset();
  }
  /// Before a feed is cut.
  void note(const TurnedMove& move);
  /// A feed move that has been cut. An event ends with the first that cuts, and less deep.
  void check(const TurnedMove& move, const TurnCut& cut, bool blank_guessed);

  /// Of an edge's length across the way: corners are rounded. A shorter edge leads, and cuts
  /// nothing.
  static constexpr double kSlack_mm = 0.01, kShortest_mm = 0.05;
  static constexpr double kStep_rad = 0.01;
  static constexpr int kMostSteps = 256;

 private:
  /// A straight flank with a free end.
  struct Edge {
    Vec2 along_mm{0};  ///< (z, x), counter-clockwise about the insert
    InsertSide side = InsertSide::kFront;
  };

  /// Material before all of an edge.
  struct Full {
    double reach_mm = 0;  ///< of the edge across the way; 0: none is
    double met_mm = 0;
    double share = 0;  ///< of the motion, where it first is
  };
  void look_straight(const Vec2& way, const TurnCut& cut, double share, Full& full) const;
  Full look_along(const TurnedMove& move);
  void tell_full(const TurnedMove& move, const TurnCut& cut, const Full& full, bool blank_guessed);
  void check_most(const TurnedMove& move, const TurnCut& cut, bool blank_guessed);

  const TurningStock& stock_;
  FindingLog& log_;
  std::vector<Edge> edges_;
  std::optional<double> most_mm_;     ///< max_depth_mm
  std::optional<TurnedPart> before_;  ///< as it is before an arc
  std::optional<TurningTool> tool_;   ///< that cuts it
  std::optional<FindingLog::Handle> event_, deep_;
};

}  // namespace kerf
