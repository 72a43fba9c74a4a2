// twin/live/punch_follower.h - the strokes of a punch that is watched.
#pragma once

#include <cstdint>

#include "twin/findings/finding.h"
#include "twin/live/live_cut_options.h"
#include "twin/live/machine_watch.h"
#include "twin/live/path_matcher.h"
#include "twin/live/reading.h"
#include "twin/live/seen_strokes.h"
#include "twin/process/cut_stage.h"

namespace kerf {

/// On the path of a program the strokes are the program's, at its places; elsewhere they are what
/// the source shows (LiveCutOptions::process). Forgets motions of the program as they are punched.
/// One thread.
class PunchFollower {
 public:
  /// The references must outlive it. The process of the options has a turret.
  PunchFollower(const LiveCutOptions& options, PathMatcher& matcher, CutStage& stage,
                MachineWatch& watch, FindingLog& log);

  /// The way from the sample before.
  enum class Way : std::uint8_t {
    kFirst,     ///< there is none
    kUnseen,    ///< positions are missing
    kStraight,  ///< beside the path, or to it or from it
    kAlongPath,
  };
  /// The next reading. True: it has struck what no program tells.
  bool take(const Reading& now, const PathMatch& point, Way way);
  /// What the program strikes before the next reading has been struck.
  void strike_before() { struck_before_ = true; }
  /// All motions before this one, which is the first that is planned, are passed over.
  void skip_to(std::uint64_t motion) { punched_ = motion; }
  /// No other reading comes. `was_on_path`: the last one.
  void finish(bool was_on_path, double t_s);

 private:
  std::uint64_t seen_from(const PathMatch& point) const;
  void punch_program(const PathMatch& point, int real_tool, bool along);
  void punch_seen_part();
  void punch_motion(Motion motion, double share, bool seen);

  const LiveCutOptions& options_;
  PathMatcher& matcher_;
  CutStage& stage_;
  MachineWatch& watch_;
  FindingLog& log_;
  SeenStrokes strokes_;
  double t_s_ = 0;              ///< of the newest reading
  std::uint64_t punched_ = 0;   ///< motions of the program that have been; the next is under way
  bool struck_before_ = false;  ///< what the program strikes before this sample has been struck
  double seen_share_ = 0;       ///< of that one, since strokes of it were last cut
  int real_tool_ = -1;          ///< in the spindle, when the machine was last between two places ..
  int real_program_tool_ = -1;  ///< .. where the program has this one
};

}  // namespace kerf
