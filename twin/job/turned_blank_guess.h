// twin/job/turned_blank_guess.h - the bar that a lathe's program works on, when nobody gave one.
#pragma once

#include "base/geometry.h"
#include "interp_bridge/motion.h"
#include "stock/blank.h"

namespace kerf {

/// Gathers where a program works, in one pass over its motions, and makes a bar of it.
class TurnedBlankGuess {
 public:
  explicit TurnedBlankGuess(double margin_mm) : margin_mm_(margin_mm) {}

  void add(const Motion& motion);
  /// A cylinder about Z, to a thousandth of a mm:
  ///   diameter   twice the farthest that a feed along Z, or a slanted one, is from the axis; where
  ///              there are none, of all feeds
  ///   top        the highest place where a feed goes straight towards the axis, to within half of
  ///              the bar; Z0 where there is none and the feeds go below it
  ///   floor      the lowest feed less the margin, in whole mm, and never above the top
  Blank blank() const;
  bool has_moves() const { return moves_; }

 private:
  double margin_mm_;
  bool moves_ = false, feeds_ = false;
  double widest_mm_ = 0, along_mm_ = 0;  ///< of all feeds, of those along Z
  double lowest_mm_ = 0, highest_mm_ = 0;
  Box faces_mm_;  ///< x: how near the axis, how far from it; z: where
};

}  // namespace kerf
