// twin/process/milling/program_checks.h - troubles that lie in the order of a program's words
// rather than in one move: a stop inside the part, a drill fed sideways, nothing cut at all.
#pragma once

#include <cstdint>
#include <optional>

#include "interp_bridge/motion.h"
#include "stock/stock_model.h"
#include "twin/findings/finding.h"
#include "twin/machine/timeline.h"
#include "twin/process/check_options.h"
#include "twin/process/drill_shape.h"
#include "twin/process/milling/checks.h"

namespace kerf {

/// Watches one program in its order. The caller flushes the model (StockModel::finish) before it
/// asks for stops or drills.
class ProgramChecks {
 public:
  ProgramChecks(const StockModel& stock, FindingLog& log)
      : stock_(stock),
        bounds_mm_(stock.bounds_mm()),
        is_empty_(stock.blank_mm3() <= 0),
        log_(log) {}

  /// The tool is changed.
  void end_tool() { drill_told_ = false; }

  /// Each motion of the program in turn, of which what follows may be asked.
  void follow(const Motion& motion);
  /// stop-in-part is to be looked for: the motion stops, and the tip is below the top of the blank,
  /// inside its outline.
  bool may_stop_in_part(const Motion& motion) const;
  /// stop-in-part: there is material on two opposite sides of the tool (a slot, a pocket, a hole),
  /// however far. Beside the blank and on a shoulder the tool stands free.
  void check_stop(const Motion& motion, const TimedStep& step, const Cutter& cutter, int tool);

  /// drill-sideways is to be looked for, of a drill (is_drill()): it is a feed move that goes
  /// across its own direction.
  static bool goes_sideways(const CheckedMove& move);
  bool drill_told() const { return drill_told_; }
  /// drill-sideways: once from tool change to tool change. An error; a warning of a pointed drill
  /// (drill_shape.h), with which people mill chamfers and letters.
  void check_drill(const CheckedMove& move);
  /// What went on before is not reported on.
  void forget_events();

 private:
  bool touches(const Cutter& cutter, const Vec3& tip, const Vec3& to) const;
  const char* words_of(const Motion& motion) const;

  const StockModel& stock_;
  Box bounds_mm_;
  bool is_empty_;  ///< material is added
  FindingLog& log_;
  bool drill_told_ = false;
  SourceRef turning_feed_at_;  ///< the last motion but dwells: a feed, with the spindle on
};

/// nothing-cut: what a whole program has done, for the finding. Nothing if it has cut, or if it is
/// sound that it has not.
struct CutFacts {
  BlankKind blank = BlankKind::kUnjudged;
  std::uint64_t moves = 0;       ///< motions that move
  std::uint64_t feed_moves = 0;  ///< of them, those that are no traverses, probing ones included
  bool probes = false;           ///< it measures
  bool undefined = false;        ///< there are tools of which nothing is known, which is told
  bool came_near = false;        ///< a feed move, to the blank, in boxes
  bool touched = false;          ///< a feed move has met material, be it less than the cells show
  double removed_mm3 = 0;
  Box feed_mm;  ///< of the feed moves, while none has come near
  Box blank_mm;
};
std::optional<Finding> nothing_cut(const CutFacts& facts);
/// Blanks that are a guess give no errors.
Severity blank_severity(BlankKind blank);

}  // namespace kerf
