#include "viewer/window/shortcuts.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <array>

namespace kerf {
namespace {

constexpr std::array kShortcuts{
    Shortcut{"Space", U' ', 0, Action::kPlayPause, Text::kPlay},
    Shortcut{"x", U'x', 0, Action::kStop, Text::kStop},
    Shortcut{"Home", 0, GLFW_KEY_HOME, Action::kToStart, Text::kToStart},
    Shortcut{"End", 0, GLFW_KEY_END, Action::kToEnd, Text::kToEnd},
    Shortcut{"Right", 0, GLFW_KEY_RIGHT, Action::kStepForward, Text::kStepForward},
    Shortcut{"Left", 0, GLFW_KEY_LEFT, Action::kStepBack, Text::kStepBack},
    Shortcut{"+", U'+', 0, Action::kFaster, Text::kFaster},
    Shortcut{"-", U'-', 0, Action::kSlower, Text::kSlower},
    Shortcut{"*", U'*', 0, Action::kFullSpeed, Text::kFullSpeedWhat},
    Shortcut{"n", U'n', 0, Action::kNextFinding, Text::kNextFinding},
    Shortcut{"N", U'N', 0, Action::kPreviousFinding, Text::kPreviousFinding},
    Shortcut{"t", U't', 0, Action::kNextTool, Text::kNextTool},
    Shortcut{"T", U'T', 0, Action::kPreviousTool, Text::kPreviousTool},
    Shortcut{"b", U'b', 0, Action::kBreakpoint, Text::kBreakpoint},
    Shortcut{"g", U'g', 0, Action::kGoToLine, Text::kGoToLine},
    Shortcut{"Page Down", 0, GLFW_KEY_PAGE_DOWN, Action::kNextSetup, Text::kNextSetup},
    Shortcut{"Page Up", 0, GLFW_KEY_PAGE_UP, Action::kPreviousSetup, Text::kPreviousSetup},
    Shortcut{"f", U'f', 0, Action::kFit, Text::kFit},
    Shortcut{"1", U'1', 0, Action::kFront, Text::kFront},
    Shortcut{"2", U'2', 0, Action::kBack, Text::kBack},
    Shortcut{"3", U'3', 0, Action::kLeft, Text::kLeft},
    Shortcut{"4", U'4', 0, Action::kRight, Text::kRight},
    Shortcut{"5", U'5', 0, Action::kTop, Text::kTop},
    Shortcut{"6", U'6', 0, Action::kBottom, Text::kBottom},
    Shortcut{"7", U'7', 0, Action::kIsometric, Text::kIsometric},
    Shortcut{"p", U'p', 0, Action::kPerspective, Text::kPerspectiveWhat},
    Shortcut{"o", U'o', 0, Action::kFlat, Text::kFlat},
    Shortcut{"m", U'm', 0, Action::kMeasure, Text::kMeasure},
    Shortcut{"z", U'z', 0, Action::kSection, Text::kSection},
    Shortcut{"v", U'v', 0, Action::kNextColors, Text::kNextColors},
    Shortcut{"V", U'V', 0, Action::kNextColorOn, Text::kNextColorOn},
    Shortcut{"w", U'w', 0, Action::kWorkpiece, Text::kToggleWorkpiece},
    Shortcut{"h", U'h', 0, Action::kHolder, Text::kHolder},
    Shortcut{"e", U'e', 0, Action::kFixtures, Text::kFixtures},
    Shortcut{"k", U'k', 0, Action::kFeeds, Text::kFeeds},
    Shortcut{"j", U'j', 0, Action::kTraverses, Text::kTraverses},
    Shortcut{"u", U'u', 0, Action::kPathTail, Text::kPathTail},
    Shortcut{"c", U'c', 0, Action::kCodePanel, Text::kCodePanel},
    Shortcut{"i", U'i', 0, Action::kInfoPanel, Text::kInfoPanel},
    Shortcut{"d", U'd', 0, Action::kCounters, Text::kDrawing},
    Shortcut{"y", U'y', 0, Action::kNextCurve, Text::kNextCurve},
    Shortcut{"l", U'l', 0, Action::kLocalDrawing, Text::kLocalDrawing},
    Shortcut{"U", U'U', 0, Action::kUnits, Text::kUnits},
    Shortcut{"r", U'r', 0, Action::kNextDrawMode, Text::kNextDrawMode},
    Shortcut{"s", U's', 0, Action::kScreenshot, Text::kScreenshot},
    Shortcut{"S", U'S', 0, Action::kWindowPicture, Text::kWindowPicture},
    Shortcut{"F", U'F', 0, Action::kFilm, Text::kFilmWhat},
    Shortcut{"?", U'?', 0, Action::kHelp, Text::kShortcuts},
    Shortcut{"F1", 0, GLFW_KEY_F1, Action::kFirstKeys, Text::kFirstKeys},
    Shortcut{"Ctrl+O", 0, GLFW_KEY_O, Action::kOpen, Text::kOpenWhat, true},
    Shortcut{"Ctrl+F", 0, GLFW_KEY_F, Action::kSearch, Text::kSearch, true},
    Shortcut{"Q", U'Q', 0, Action::kClose, Text::kClose},
};

/// The most useful first; the last ones are for where there is no player.
constexpr std::array kFirst{Action::kPlayPause,   Action::kStepForward, Action::kFaster,
                            Action::kNextFinding, Action::kGoToLine,    Action::kFit,
                            Action::kIsometric,   Action::kTop,         Action::kMeasure,
                            Action::kSection,     Action::kNextColors,  Action::kWorkpiece,
                            Action::kCodePanel,   Action::kInfoPanel,   Action::kScreenshot};
constexpr std::size_t kFirstCount = 10;

}  // namespace

std::span<const Shortcut> shortcuts() { return kShortcuts; }

std::vector<const Shortcut*> first_shortcuts(bool has_player) {
  std::vector<const Shortcut*> first;
  for (const Action action : kFirst) {
    if (first.size() == kFirstCount || (!has_player && is_for_player(action))) continue;
    for (const Shortcut& shortcut : kShortcuts) {
      if (shortcut.action == action) first.push_back(&shortcut);
    }
  }
  return first;
}

std::optional<Action> action_of_character(char32_t character) {
  for (const Shortcut& shortcut : kShortcuts) {
    if (shortcut.character != 0 && shortcut.character == character) return shortcut.action;
  }
  return std::nullopt;
}

std::optional<Action> action_of_key(int key, bool with_control) {
  for (const Shortcut& shortcut : kShortcuts) {
    if (shortcut.key == 0 || shortcut.key != key) continue;
    if (shortcut.with_control == with_control) return shortcut.action;
  }
  return std::nullopt;
}

}  // namespace kerf
