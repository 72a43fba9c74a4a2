// interp_bridge/wild_motion.h - motions with numbers that no machine has.
#pragma once

#include <string>

#include "interp_bridge/motion.h"

namespace kerf {

/// Bounds of what a program may ask for. Far beyond any machine, near enough that everything that
/// is computed from a position stays exact, and that a motion is cut in bounded time and memory.
inline constexpr double kFarthest_mm = 100e3;          ///< X Y Z U V W, either way
inline constexpr double kFarthest_deg = 10'000 * 360;  ///< A B C, either way
inline constexpr double kMostArcTurns = 1000;
inline constexpr double kLongestArc_mm = 2e6;         ///< along its path in the plane
inline constexpr double kFarthestArcCenter_mm = 1e9;  ///< a circle so wide is a straight line
inline constexpr double kLongestDwell_s = 1e9;

/// What is found and what is allowed: "X is at -100000000000 mm; a program reaches 100000 mm at
/// most"; empty where every number is within the bounds. Costs some comparisons.
std::string wild_number_of(const Motion& motion);

}  // namespace kerf
