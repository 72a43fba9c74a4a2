#include "twin/timeline.h"

#include <fmt/format.h>

#include <cmath>

#include "twin/motion_geometry.h"

namespace kerf {
namespace {

double rotary_deg(const Motion& m) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double d = m.to_abc_deg[i] - m.from_abc_deg[i];
    sum += d * d;
  }
  return std::sqrt(sum);
}

double feed_per_minute(const Motion& m) {
  return m.feed_per_rev ? m.feed_mm_per_min * m.spindle_rpm : m.feed_mm_per_min;
}

}  // namespace

TimedStep Timeline::add(const Motion& m) {
  TimedStep step;
  step.start_s = clock_s_;
  switch (m.kind) {
    case MotionKind::kToolChange:
    case MotionKind::kStop:
    case MotionKind::kProgramEnd:
      return step;
    case MotionKind::kDwell:
      step.duration_s = m.duration_s;
      break;
    case MotionKind::kTraverse:
      ++totals_.moves;
      ++totals_.traverse_moves;
      if (!m.start_known) return step;  // no true length: the real start is not in the program
      step.length_mm = path_length_mm(m);
      totals_.traverse_mm += step.length_mm;
      step.duration_s = step.length_mm * 60.0 / options_.traverse_mm_per_min;
      break;
    case MotionKind::kArc:
    case MotionKind::kFeed:
    case MotionKind::kThread:
    case MotionKind::kProbe: {
      ++totals_.moves;
      ++totals_.feed_moves;
      if (m.kind == MotionKind::kArc) ++totals_.arcs;
      if (!m.start_known) return step;
      step.length_mm = path_length_mm(m);
      totals_.feed_mm += step.length_mm;
      const double feed = feed_per_minute(m);
      const double way = step.length_mm > 0 ? step.length_mm : rotary_deg(m);
      if (feed > 0) {
        step.duration_s = way * 60.0 / feed;
      } else {
        ++totals_.moves_without_feed;
      }
      break;
    }
  }
  totals_.duration_s += step.duration_s;
  clock_s_ += step.duration_s;
  return step;
}

std::string Timeline::time_model() const {
  return fmt::format(
      "length / feed; traverses at {:g} mm/min; no accelerations; tool changes and stops take no "
      "time",
      options_.traverse_mm_per_min);
}

}  // namespace kerf
