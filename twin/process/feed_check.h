// twin/process/feed_check.h - feed rates: none at all, more than the axes can do.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "interp_bridge/motion.h"
#include "twin/findings/finding.h"
#include "twin/machine/timeline.h"

namespace kerf {

/// feed-missing, over-feed and, of threads, thread-speed. One thread.
class FeedCheck {
 public:
  /// `limits_known`, `origin`: those of the user's machine, and where they come from.
  FeedCheck(bool limits_known, std::string origin, FindingLog& log)
      : limits_known_(limits_known), origin_(std::move(origin)), log_(log) {}

  /// Of a feed move that goes somewhere.
  void note(const Motion& motion, const TimedStep& step);
  /// At the end: one finding for the whole program. Where one move is too fast, most are.
  void report();
  void forget() {
    missing_told_ = false;
    thread_told_ = {};
    over_ = {};
  }

 private:
  /// Feed moves that ask for more than the axes can do.
  struct OverFeed {
    std::uint64_t count = 0;
    SourceRef source;  ///< the first
    double time_s = 0;
    double programmed_mm_per_min = 0;
    double allowed_mm_per_min = 0;
  };
  void tell_missing(const Motion& motion, const TimedStep& step);
  void check_thread(const Motion& motion, const TimedStep& step);

  bool limits_known_;
  std::string origin_;
  FindingLog& log_;
  bool missing_told_ = false;
  SourceRef thread_told_;
  OverFeed over_;
};

}  // namespace kerf
