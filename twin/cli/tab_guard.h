// twin/cli/tab_guard.h - a tab in LinuxCNC's screen stays, whatever becomes of what is shown in it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "viewer/window/screen_tab.h"

namespace kerf {

/// Where the window is to be: `--embed ID`, `--xid`.
struct TabWish {
  std::optional<std::uint32_t> parent;  ///< none: the tab's id is said to who takes it
};

/// How often a crash is answered by a new start.
struct GuardPatience {
  int restarts = 3;  ///< at most, within `window_s`
  double window_s = 60;
  double pause_s = 1;  ///< before each
};

/// Forks. The child does `work`, and returns what it returns; this process stays, holds the tab's
/// window, and returns the child's exit code when it is over. A child that crashes (SEGV, ABRT,
/// BUS, ILL, FPE) is started again, and stderr told so; too many crashes end it with kExitFailure.
/// SIGTERM, SIGINT and SIGHUP go on to the child; the tab's end is a SIGTERM, too. A child never
/// outlives its guard. To be called before any thread is started.
int guard_tab(ScreenTab tab, const std::function<int()>& work, const GuardPatience& patience = {});

}  // namespace kerf
