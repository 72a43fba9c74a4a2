// twin/live/driven_run.h - short ways, one after the other, that are cut as one.
#pragma once

#include <optional>
#include <vector>

#include "twin/live/path_follower.h"

namespace kerf {

/// Positions that come a thousand times a second are a few micrometres apart, and in space a move
/// costs by the tool's surface, however short it is. So what lies in a row is cut together: parts
/// of one piece of a program's path, which are a part of it, and straight ways that are one within
/// a bound. What becomes one depends on the samples and their times alone.
///
/// Values. Allocates only until it has held the most that it will hold.
class DrivenRun {
 public:
  /// A run is cut when it has lasted for this long, or later ones would be seen late. s.
  static constexpr double kLongest_s = 0.05;

  /// `bound_mm`: places that straight ways met lie so near to the way that they become; what turns
  /// counts by `lever_mm` (FollowOptions).
  DrivenRun(double bound_mm, double lever_mm) : bound_mm_(bound_mm), lever_mm_(lever_mm) {}

  /// Adds a way that begins at `t_s`, or, if it does not go on as the run goes, leaves the run as
  /// it is and returns false.
  enum class Way {
    kStraight,  ///< from one position to the next
    kPart,      ///< of a piece of the program's path
    kNextPart,  ///< the same, of the piece of which the way before was a part
  };
  bool add(const Motion& motion, Way way, double duration_s, double t_s);
  bool empty() const { return !run_; }
  bool is_long(double t_s) const { return run_ && t_s - run_->t_s >= kLongest_s; }

  struct Run {
    Motion motion;
    double duration_s = 0;
    double t_s = 0;  ///< its beginning
  };
  /// What it has become; then it is empty.
  std::optional<Run> take();

 private:
  bool goes_on(const Motion& motion, Way way) const;
  bool add_part(const Motion& part);
  bool add_straight(const Motion& motion);
  bool is_straight(const Motion& whole) const;

  double bound_mm_, lever_mm_;
  std::optional<Run> run_;
  bool straight_ = false;         ///< positions alone have made it
  std::vector<ProgramPose> met_;  ///< by straight ways, between their first and last place
};

}  // namespace kerf
