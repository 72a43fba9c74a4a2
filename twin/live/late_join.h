// twin/live/late_join.h - a watched machine that is found on its program's path for the first time,
// perhaps in the middle of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "twin/live/live_cut_options.h"
#include "twin/live/path_matcher.h"
#include "twin/live/punch_follower.h"
#include "twin/live/way_cutter.h"

namespace kerf {

/// Looks for the machine at the program's beginning and, where it names a line of the program and
/// has not been seen for a while, in all of it: that reads the program once more
/// (LiveCutOptions::reopen), at a multiple of the time before. One thread.
class LateJoin {
 public:
  /// The references must outlive it. `punch`: of a sheet that is punched.
  LateJoin(const LiveCutOptions& options, PathMatcher& matcher, WayCutter& cutter,
           std::optional<PunchFollower>& punch);

  struct Found {
    PathMatch point;
    /// It cannot have come there from the program's beginning while it was watched. What lies
    /// before is cut, if LiveCutOptions say so; nothing of it is in PathMatcher::driven().
    bool late = false;
  };
  /// Where on the path the machine is, that has not been on it yet. `lost_sight_s`: so long it has
  /// said that it runs.
  Found find(const MatchQuery& query, double lost_sight_s, double t_s);

 private:
  void take_before(double t_s);
  std::optional<std::uint64_t> motion_at(const MatchQuery& place) const;
  void pass(std::uint64_t motion, double t_s);
  void pass_planned(std::size_t count, double t_s);

  const LiveCutOptions& options_;
  PathMatcher& matcher_;
  WayCutter& cutter_;
  std::optional<PunchFollower>& punch_;
  double watched_s_ = 0;  ///< since the first sample, while the path has not been found
  double join_after_s_;   ///< lost sight for so long, the whole program is searched
};

}  // namespace kerf
