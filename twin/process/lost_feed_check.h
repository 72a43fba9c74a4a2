// twin/process/lost_feed_check.h - feeds that LinuxCNC forgets.
#pragma once

#include "interp_bridge/motion.h"
#include "twin/findings/finding.h"
#include "twin/machine/timeline.h"

namespace kerf {

/// Watches one program in its order. One thread.
class LostFeedCheck {
 public:
  explicit LostFeedCheck(FindingLog& log) : log_(log) {}

  /// feed-lost, of every motion: the straight feed before M61 or G10 L0, or in the block of M61.
  /// LinuxCNC (2.8 to 2.10) holds a feed back until it knows whether the next one can be merged
  /// with it (G64 Q), and M61, with which the program is read on from where the machine stands,
  /// forgets it. What ends the chain in between (ChainEnd, another feed, a dwell) sends it. G10 L0
  /// does the same.
  void watch(const Motion& motion, const TimedStep& step);

 private:
  /// A step, as far as watch() needs it of the next one.
  struct Held {
    bool feed = false;    ///< LinuxCNC may hold it back
    bool merges = false;  ///< with those before it
    bool by_number = false;
    SourceRef source;
    Vec3 from_mm{0};
    double start_s = 0;
  };
  void tell_lost(const Held& feed, const char* word, SourceRef place, int tool);

  FindingLog& log_;
  Held last_;
};

}  // namespace kerf
