// twin/app/exit_code.h - what kerf tells the shell. Part of the outside of the program: scripts
// depend on it.
#pragma once

namespace kerf {

enum ExitCode : int {
  kExitGood = 0,      ///< finished, no findings of severity error
  kExitFindings = 1,  ///< finished, findings of severity error
  kExitUsage = 2,     ///< usage or configuration error
  kExitLossy = 3,     ///< finished, but data was lost or stale
  kExitFailure = 4,  ///< file, interpreter or device failure, or interrupted: the report is partial
};

}  // namespace kerf
