// twin/guess/turned_tool_guess.h - a turning tool for one of which nothing is known, by what the
// program does with it.
#pragma once

#include "interp_bridge/motion.h"
#include "twin/guess/tool_guess.h"

namespace kerf {

/// What a lathe's program does with one tool. One thread.
class TurnedTrace {
 public:
  /// Motions of this tool that move, in program order.
  void add(const Motion& motion);

  /// The tool, with `top_mm` the end of the bar:
  ///   on the axis alone           a drill, by how deep it goes
  ///   follows the spindle         a thread's insert, of that pitch
  ///   straight in, below the end  a blade: to part off where it reaches the axis, else for grooves
  ///   else an insert of 80 degrees, of 35 where the contour falls by more than 4 degrees
  /// Where it leaves the material towards the axis it works in a bore. Any program gets an answer.
  ShapeGuess guess(double top_mm) const;

 private:
  bool feeds_ = false, last_fed_ = false;
  double widest_mm_ = 0;  ///< from the axis, of feeds
  double least_mm_ = 0;   ///< how near the axis they come, with the side's sign
  double lowest_mm_ = 0;
  double pitch_mm_ = 0;
  double along_mm_ = 0;       ///< length of feeds with Z in them, below the ends
  double steepest_ = 0;       ///< fall of a feed towards -z, of its way along z
  double highest_in_mm_ = 0;  ///< of feeds straight towards the axis
  bool goes_in_ = false;
  int outward_ = 0;         ///< traverses behind feeds: away from the axis, less those towards it
  double side_sum_mm_ = 0;  ///< of x
  double chuckward_mm_ = 0, outward_z_mm_ = 0;  ///< ways of feeds along z
};

}  // namespace kerf
