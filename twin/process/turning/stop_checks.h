// twin/process/turning/stop_checks.h - stop-in-part, drill-sideways of tools that stand still.
#pragma once

#include <optional>

#include "stock/turning/turning_stock.h"
#include "twin/findings/finding.h"
#include "twin/process/turning/turning_checks.h"

namespace kerf {

/// Of a workpiece that turns, in its plane. A tool that rubs along what it has cut has material on
/// one side alone: it is in the cut where some stands before it along Z and along X, as at the end
/// of a pass that has not run out, in a groove, or in a hole.
class StopChecks {
 public:
  StopChecks(const TurningStock& stock, FindingLog& log) : stock_(stock), log_(log) {}

  /// stop-in-part: the motion stops the program or changes the tool, which is `cutter`.
  void check_stop(const Motion& motion, const TimedStep& step, const Cutter& cutter, int tool);
  /// drill-sideways: a tool that stands on the axis is fed across it through material. Before the
  /// move is cut; once from tool change to tool change. A warning of mills, with which small
  /// lathes bore, and of pointed drills, which people chamfer with.
  void check_drill(const TurnedMove& move);
  void end_tool() { drill_told_ = false; }

  /// So far the tool is moved to feel what stands there.
  static constexpr double kFeel_mm = 0.03;
  /// Sideways by less is rounding.
  static constexpr double kSideways_mm = 0.01;

 private:
  bool is_before(const Cutter& cutter, const Vec3& tip, const Vec3& way) const;

  const TurningStock& stock_;
  FindingLog& log_;
  bool drill_told_ = false;
};

}  // namespace kerf
