// viewer/window/settings.h - what the window remembers from one use to the next.
#pragma once

#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "base/result.h"
#include "viewer/window/scene_renderer.h"
#include "viewer/window/texts.h"

namespace kerf {

/// Stored as lines `name = value`:
///
///     width = 1280
///     language = de
///     show.holder = off
///     opacity.workpiece = 0.5
struct ViewSettings {
  int width_px = 1280;  ///< of the window, 320 to 16384
  int height_px = 800;
  Language language = Language::kEnglish;
  bool is_perspective = true;
  bool shows_code = true;
  bool shows_info = true;
  bool shows_counters = false;
  DrawOptions drawing;
};

/// $XDG_CONFIG_HOME/kerf/view.conf, else $HOME/.config/kerf/view.conf; empty if neither is set.
std::string settings_path();

/// Faulty lines are reported with line and column, and leave the default; the rest counts. A file
/// that is not there is no fault.
ViewSettings load_settings(const std::string& path, Diagnostics* faults);

/// Makes the folder if need be; the file appears whole or not at all.
Done save_settings(const std::string& path, const ViewSettings& settings);

}  // namespace kerf
