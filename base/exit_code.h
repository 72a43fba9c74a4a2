// base/exit_code.h - what kerf and kerf-machine tell the shell. Part of their outside: scripts
// depend on it.
#pragma once

#include "base/translate.h"

namespace kerf {

enum ExitCode : int {
  kExitGood = 0,      ///< finished, no findings of severity error
  kExitFindings = 1,  ///< finished, findings of severity error
  kExitUsage = 2,     ///< usage or configuration error
  kExitLossy = 3,     ///< finished, but data was lost or stale
  kExitFailure = 4,  ///< file, interpreter or device failure, or interrupted: the report is partial
};

/// The same for people; tr() shows it.
inline constexpr const char* kExitCodes = tr_noop(
    "Exit codes:\n"
    "  0  finished, no findings\n"
    "  1  finished, findings of severity error\n"
    "  2  usage or configuration error\n"
    "  3  finished, but data was lost or stale\n"
    "  4  file, interpreter or device failure, or interrupted (the report is partial)\n");

}  // namespace kerf
