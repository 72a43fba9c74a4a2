// twin/process/axis_limits.h - does the program keep within the soft limits of the machine?
#pragma once

#include <array>
#include <optional>

#include "interp_bridge/machine_limits.h"
#include "interp_bridge/motion.h"
#include "twin/findings/finding.h"
#include "twin/machine/timeline.h"

namespace kerf {

/// Finds motions that leave the soft limits of an axis (axis-limit), machine coordinates with the
/// offsets in force: one finding an axis and event, from the first motion beyond to the last one in
/// a row. Straight moves and level arcs exactly; arcs in a frame that is turned against the machine
/// at steps of 2 degrees. Motions whose start is not known count with their end.
class AxisLimitCheck {
 public:
  /// Takes its limits from `limits`: of the axes that are present.
  AxisLimitCheck(const MachineLimits& limits, FindingLog& log);

  /// Before the first motion: where the workpiece lies.
  void set_frame(const WorkpieceFrame& frame);
  void check(const Motion& motion, const TimedStep& step);
  void forget_events() { events_ = {}; }

 private:
  struct Event {
    FindingLog::Handle finding = 0;
    double beyond = 0;  ///< mm or degrees
  };
  /// Least and greatest machine position of each axis during a motion.
  struct Reach {
    std::array<double, kAxisCount> min{};
    std::array<double, kAxisCount> max{};
  };
  Reach reach_of(const Motion& motion) const;
  void extend(Reach& reach, const Vec3& tip_mm, const Motion& motion, bool first) const;
  void check_axis(std::size_t axis, const Reach& reach, const Motion& motion,
                  const TimedStep& step);

  std::array<AxisLimits, kAxisCount> limits_;
  bool any_ = false;
  FindingLog& log_;
  WorkpieceFrame frame_;
  double cos_ = 1;
  double sin_ = 0;
  std::array<std::optional<Event>, kAxisCount> events_;
};

}  // namespace kerf
