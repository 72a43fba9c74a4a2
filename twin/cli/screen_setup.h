// twin/cli/screen_setup.h - the lines of an INI that give LinuxCNC's screen a tab with kerf.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"

namespace kerf {

/// Where lines of a text are put in or taken out.
struct IniChange {
  int line = 0;                     ///< 1-based: the first that is put in, or taken out
  std::vector<std::string> before;  ///< taken out
  std::vector<std::string> after;   ///< put in
  std::string text;                 ///< the whole INI, changed
  bool changes() const { return before != after; }
};

/// The tab for the screen that [DISPLAY]DISPLAY names, between two marks, at the end of that
/// section; lines of an older kerf there are replaced. `path` names the INI, whose name the tab's
/// command has, too: the screen runs in its folder. `kerf`: the command, a name or a path. Nothing,
/// with diagnostics: the screen is none of AXIS, Gmoccapy and QtDragon, or its tabs are not as
/// they must be.
std::optional<IniChange> with_tab(const std::string& text, const std::string& path,
                                  const std::string& kerf, Diagnostics& diagnostics);

/// Without what is between the marks; with nothing there, nothing changes.
std::optional<IniChange> without_tab(const std::string& text, const std::string& path,
                                     Diagnostics& diagnostics);

/// As `diff -u` shows it, with three lines around; empty where nothing changes.
std::string unified_diff(const std::string& text, const IniChange& change, const std::string& path);

}  // namespace kerf
