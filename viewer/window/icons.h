// viewer/window/icons.h - the signs on the buttons of the player, drawn, so that no font has to
// have them. For the sources of viewer/ only.
#pragma once

#include <imgui.h>

namespace kerf {

enum class Icon {
  kPlay,
  kPause,
  kStop,
  kToStart,
  kToEnd,
  kStepBack,
  kStepForward,
  kPreviousTool,
  kNextTool,
  kPreviousFinding,
  kNextFinding,
};

/// A square button with the sign on it, as high as a line of text with its frame. True when
/// clicked. `id`: unique in the panel.
bool icon_button(const char* id, Icon icon);

}  // namespace kerf
