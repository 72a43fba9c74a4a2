// twin/live/path_watch.h - findings about a watched machine and its program: off its path, another
// program, another tool, begun before it was seen.
#pragma once

#include <optional>

#include "twin/findings/finding.h"
#include "twin/live/live_cut_options.h"
#include "twin/live/path_matcher.h"
#include "twin/live/reading.h"
#include "twin/report/live_facts.h"

namespace kerf {

/// Takes readings in their order, each with the place that PathMatcher found, and adds to the log
/// what follows. One thread.
class PathWatch {
 public:
  /// Driven with another tool than the program's: it goes on without having changed it.
  static constexpr double kMismatch_mm = 1.0;

  /// The references must outlive it. `facts` gets off_path; its path_mm is read.
  PathWatch(const LiveCutOptions& options, const PathMatcher& matcher, FindingLog& log,
            LiveFacts& facts);

  /// The machine was out of sight: it may have stood, and may be moved by hand.
  void note_out_of_sight();
  /// The machine has another tool than the program has where it is, having driven so far since the
  /// sample before. True: that is told now.
  bool note_tool(const Reading& now, const PathMatch& point, double driven_mm);
  /// `doubtful`: it is not known whether the machine still runs the program, and nothing is told.
  void note_off_path(const Reading& now, const PathMatch& point, double elapsed_s, bool doubtful);
  /// Once: the machine has worked in the blank for `duration_s` more, and not by this program.
  void note_foreign_program(const Reading& now, double duration_s);
  /// The machine was found in the middle of its program.
  void note_late_start(const MatchQuery& place, double t_s);

  bool is_off_path() const { return off_path_event_.has_value(); }
  bool is_foreign() const { return foreign_told_; }
  /// It has stood in no line, and has not gone on from there.
  bool has_stood() const { return stood_mm_.has_value(); }
  double mismatch_mm() const { return mismatch_mm_; }
  /// A program runs, and its path has not been found, for so long.
  double lost_sight_s() const { return lost_sight_s_; }

 private:
  bool is_by_hand(const AxisSample& sample, const PathMatch& point);

  const LiveCutOptions& options_;
  const PathMatcher& matcher_;
  FindingLog& log_;
  LiveFacts& facts_;
  std::optional<FindingLog::Handle> off_path_event_;
  std::optional<double> stood_mm_;  ///< having gone so far along its path
  double lost_sight_s_ = 0;
  double foreign_s_ = 0;  ///< the machine has cut, and never been on the path, for so long
  double in_corner_s_ = 0;
  bool foreign_told_ = false;
  bool mismatch_told_ = false;
  double mismatch_mm_ = 0;  ///< driven along the path with another tool than the program's
};

}  // namespace kerf
