// twin/job/feed_links.h - ways to the next cut that a program makes at feed, as posts without
// rapids write them.
#pragma once

#include <map>
#include <optional>

#include "base/geometry.h"
#include "interp_bridge/motion.h"

namespace kerf {

/// Finds level feeds between a way straight up and one straight down: most of them go through the
/// air, some over what stands in the middle of a part. The height tells which (BlankGuess).
class FeedLinks {
 public:
  /// The ways at one height.
  struct Level {
    double length_mm = 0;
    Box way;  ///< of the tip, grown by the tool's radius in X and Y
  };
  using Levels = std::map<double, Level>;

  /// What has become of the level feeds before a motion.
  struct Ended {
    double z_mm = 0;
    Level level;
    bool is_link = false;
  };
  /// True: it is a level feed that is kept back; add_level() is to follow.
  bool keeps_back(const Motion& motion);
  void add_level(const Motion& motion, double length_mm, const Box& way);
  /// Before a motion that is not kept back: what was, if anything.
  std::optional<Ended> end_before(const Motion& motion);
  /// What is kept back now; a program that ends so has gone home.
  std::optional<Ended> kept_back() const;

  /// Ways up and down are at least as long, mm.
  static constexpr double kLeastLift_mm = 1;

 private:
  double lift_mm_ = 0;  ///< straight up until now
  bool is_kept_ = false;
  double z_mm_ = 0;
  Level level_;
};

}  // namespace kerf
