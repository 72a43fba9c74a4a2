// interp_bridge/active_modes.h - what is in force in LinuxCNC's interpreter, group by group, as its
// own lists have it. Shared with kerf-interp, so no header of LinuxCNC.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kerf {

/// G codes count ten times (G91.1 is 911), M codes as they are, numbers in the units of the
/// program. -1: none of the group is in force.
enum class ModeGroup : std::uint8_t {
  kPlane,           ///< G17 to G19.1
  kUnits,           ///< G20, G21
  kDistance,        ///< G90, G91
  kArcDistance,     ///< G90.1, G91.1
  kDiameter,        ///< G7, G8
  kFeedMode,        ///< G93, G94, G95
  kFeed,            ///< F
  kPath,            ///< G61, G61.1, G64
  kPathTolerance,   ///< P of G64
  kMergeTolerance,  ///< Q of G64
  kCompensation,    ///< G40, G41, G42
  kReturn,          ///< G98, G99
  kWorkOffset,      ///< G54 to G59.3
  kShift,           ///< G92.2: no shift of G92 is in force; G92.3: one is
  kRotation,        ///< of the work offset about Z, degrees
  kLengthOffset,    ///< G43, G49
  kLengthTool,      ///< the tool whose length that is; -1: no tool's
  kTool,            ///< number in the spindle
  kSpindleMode,     ///< G96, G97
  kSpeed,           ///< S
  kSpindle,         ///< M3, M4, M5
  kMist,            ///< M7
  kFlood,           ///< M8
  kOverrides,       ///< M48, M49, M50, M51
  kAdaptiveFeed,    ///< M52
  kFeedHold,        ///< M53
};
inline constexpr std::size_t kModeGroups = 26;

struct ActiveMode {
  double begun = -1;       ///< what LinuxCNC begins the program with, its startup code included
  double now = -1;         ///< what is in force
  std::uint32_t line = 0;  ///< of the program, where it came to be so; 0: it began so
};

/// By ModeGroup; empty: not known.
using ActiveModes = std::vector<ActiveMode>;

}  // namespace kerf
