// viewer/window/shortcuts.h - the keys of the window, in one table.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "viewer/window/texts.h"

namespace kerf {

enum class Action {
  kPlayPause,  // from here to kGoToLine: the player's
  kStop,
  kToStart,
  kToEnd,
  kStepForward,
  kStepBack,
  kFaster,
  kSlower,
  kFullSpeed,
  kNextFinding,
  kPreviousFinding,
  kNextTool,
  kPreviousTool,
  kBreakpoint,
  kNextSetup,
  kPreviousSetup,
  kGoToLine,
  kFit,
  kFront,
  kBack,
  kLeft,
  kRight,
  kTop,
  kBottom,
  kIsometric,
  kPerspective,
  kFlat,
  kMeasure,
  kSection,
  kNextColors,
  kNextColorOn,
  kWorkpiece,
  kHolder,
  kFixtures,
  kFeeds,
  kTraverses,
  kPathTail,
  kCodePanel,
  kInfoPanel,
  kCounters,
  kNextCurve,
  kLocalDrawing,
  kUnits,
  kNextDrawMode,
  kScreenshot,
  kWindowPicture,
  kFilm,
  kHelp,
  kFirstKeys,
  kOpen,
  kSearch,
  kClose,
};

/// Printable keys are known by the character that they write, so that they are where the keyboard's
/// labels say in every layout; others by their code.
struct Shortcut {
  const char* label;   ///< As the help shows it.
  char32_t character;  ///< 0: `key` counts.
  int key;             ///< GLFW_KEY_..., or 0
  Action action;
  Text text;
  bool with_control = false;  ///< `key` counts while Ctrl is held.
};

std::span<const Shortcut> shortcuts();
/// The ten that a beginner needs first; beside a machine that leads, without the player's.
std::vector<const Shortcut*> first_shortcuts(bool has_player);
/// It changes what is played, not how it is looked at.
constexpr bool is_for_player(Action action) { return action <= Action::kGoToLine; }
std::optional<Action> action_of_character(char32_t character);
std::optional<Action> action_of_key(int key, bool with_control);

}  // namespace kerf
