// tests/interp_bridge/timing/run_support.h - programs through rs274 and the planner, timed as a log
// of a real run is.
#pragma once

#include "tests/interp_bridge/program_test_support.h"
#include "tests/interp_bridge/timing/planner_test_support.h"

namespace kerf {

inline bool is_move(const Motion& m) { return m.kind <= MotionKind::kProbe; }

/// What rs274 cannot know of the machine that a program was run on: it starts at 0,0,0.
struct RecordedStart {
  Vec3 tip_mm{0};
  /// Height that the program's G53 Z100 has for the tip of tool 1 and 2; 0: has none.
  double top_mm_tool1 = 0;
  double top_mm_tool2 = 0;
};

/// Puts the tip where the recorded machine had it. Z is the start's until the program sets it.
inline void place_start(std::vector<Motion>& motions, const RecordedStart& start, bool z_given) {
  bool placed = false;
  bool z_known = z_given;
  for (Motion& m : motions) {
    if (!placed) {
      m.start_known = true;
      m.from_mm = start.tip_mm;
      if (!is_move(m)) m.to_mm = start.tip_mm;
    }
    if (!z_known) {
      if (placed) m.from_mm.z = start.tip_mm.z;
      if (m.to_mm.z == 0) {
        m.to_mm.z = start.tip_mm.z;
      } else if (is_move(m)) {
        z_known = true;
      }
    }
    placed = placed || is_move(m);
    const double top = m.tool == 2 ? start.top_mm_tool2 : start.top_mm_tool1;
    if (top == 0) continue;
    if (m.from_mm.z == 100) m.from_mm.z = top;
    if (m.to_mm.z == 100) m.to_mm.z = top;
  }
}

/// Seconds from the end of the tool change before the first move (or that move's start) to the end
/// of the last move: what a log of positions and tool numbers shows.
inline double moving_s(const std::vector<Motion>& motions, const Plan& plan) {
  double begin = -1;
  double end = 0;
  double ready = -1;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const MotionTiming& t = plan.timings[i];
    if (motions[i].kind == MotionKind::kToolChange && begin < 0) ready = t.start_s + t.duration_s;
    if (!is_move(motions[i]) || t.duration_s == 0) continue;
    if (begin < 0) begin = ready >= 0 ? ready : t.start_s;
    end = t.start_s + t.duration_s;
  }
  return end - begin;
}

}  // namespace kerf
