// twin/timeline.h - when each motion starts and how long it takes, and the sums of a program.
#pragma once

#include <cstdint>
#include <string>

#include "interp_bridge/motion.h"

namespace kerf {

struct TimelineOptions {
  double traverse_mm_per_min = 5000;  ///< speed of every traverse
};

/// Sums over the motions of a program.
struct MotionTotals {
  std::uint64_t moves = 0;       ///< motions that move: traverses, feeds, arcs, threads, probes
  std::uint64_t feed_moves = 0;  ///< feeds, arcs, threads, probes
  std::uint64_t traverse_moves = 0;
  std::uint64_t arcs = 0;
  std::uint64_t moves_without_feed =
      0;  ///< feed moves with no feed rate in force: counted with no time
  double feed_mm = 0;
  double traverse_mm = 0;
  double duration_s = 0;
};

/// One motion in time.
struct TimedStep {
  double start_s = 0;
  double duration_s = 0;
  double length_mm = 0;
};

/// Adds up motions at constant speed: length / feed, feed per revolution times spindle speed for
/// G95, traverses at one stated rate, dwells as written. Accelerations are NOT modelled: a real
/// machine takes longer, by a few per cent on long moves and several times as long on dense
/// zigzags. Stops and tool changes take no time. Moves of rotary axes alone take their F as degrees
/// a minute.
class Timeline {
 public:
  explicit Timeline(const TimelineOptions& options) : options_(options) {}

  TimedStep add(const Motion& motion);
  /// Sums begin anew, the clock goes on.
  void begin_totals() { totals_ = {}; }

  const MotionTotals& totals() const { return totals_; }
  double clock_s() const { return clock_s_; }  ///< program time after the last motion
  /// For the report: "length / feed; traverses at 5000 mm/min; no accelerations, tool changes and
  /// stops take no time".
  std::string time_model() const;

 private:
  TimelineOptions options_;
  MotionTotals totals_;
  double clock_s_ = 0;
};

}  // namespace kerf
