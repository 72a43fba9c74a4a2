// twin/machine/planned_pieces.h - the path that the machine runs for a motion, as motions of their
// own.
#pragma once

#include <span>
#include <utility>

#include "twin/machine/timeline.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {

/// Calls `take(motion, step)` for each piece of the path: with the motion's line, tool and feed,
/// and with the part of the step's time in which that share of the way is run, by length. Without a
/// path, once for the motion as it is.
template <class Take>
void for_each_piece(const Motion& motion, const TimedStep& timed, std::span<const PathPiece> path,
                    Take&& take) {
  if (path.empty()) return take(motion, timed);
  double whole_mm = 0;
  for (const PathPiece& piece : path) whole_mm += path_length_mm(motion_of(motion, piece));
  TimedStep part = timed;
  double done_mm = 0;
  for (const PathPiece& piece : path) {
    const Motion moved = motion_of(motion, piece);
    part.length_mm = path_length_mm(moved);
    if (whole_mm > 0) {
      const bool last = &piece == &path.back();
      const double end = last ? 1 : (done_mm + part.length_mm) / whole_mm;
      const WayInTime::Part run = timed.way.between(done_mm / whole_mm, end);
      part.start_s = timed.start_s + run.from_time * timed.duration_s;
      part.duration_s = (run.to_time - run.from_time) * timed.duration_s;
      part.way = run.way;
      done_mm += part.length_mm;
      take(moved, std::as_const(part));
    } else {
      part.duration_s = timed.duration_s / static_cast<double>(path.size());
      part.way = {};
      take(moved, std::as_const(part));
      part.start_s += part.duration_s;
    }
    part.held_before_s = 0;
    // A programmed feed that the axes cannot do is told once.
    part.allowed_mm_per_min = part.programmed_mm_per_min;
  }
}

}  // namespace kerf
