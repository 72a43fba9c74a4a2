// viewer/window/texts.h - every word that the window shows, in every language it speaks.
#pragma once

#include <optional>
#include <string_view>

namespace kerf {

enum class Language { kEnglish, kGerman };
inline constexpr int kLanguageCount = 2;

enum class Text {
  // player
  kPlay,
  kPause,
  kStop,
  kStepBack,
  kStepForward,
  kPreviousFinding,
  kNextFinding,
  kPreviousTool,
  kNextTool,
  kToEnd,
  kSpeed,
  kGoToLine,
  kElapsed,
  kRemaining,
  kPaused,
  kPlaying,
  kHurrying,
  kFollowing,
  kEnded,
  // panels
  kPosition,
  kMachine,
  kWork,
  kToGo,
  kTool,
  kNoTool,
  kSpindle,
  kFeed,
  kTraverse,
  kCoolant,
  kOffset,
  kRemoved,
  kSource,
  kLive,
  kStale,
  kLost,
  kAgo,
  kFindings,
  kNoFindings,
  kProgram,
  kNoProgram,
  kBreakpoint,
  kScene,
  kWorkpiece,
  kCutter,
  kHolder,
  kTraverses,
  kFeeds,
  kPlanned,
  kBlank,
  kFrames,
  kLocalDrawing,
  kPerspective,
  kDrawing,
  kFull,
  kLocal,
  kStill,
  kUploaded,
  kWaiting,
  kGpuMemory,
  kLanguage,
  kMore,
  // views
  kViews,
  kFit,
  kFront,
  kBack,
  kLeft,
  kRight,
  kTop,
  kBottom,
  kIsometric,
  // help
  kShortcuts,
  kCodePanel,
  kInfoPanel,
  kToggleWorkpiece,
  kScreenshot,
  kClose,
  kFaster,
  kSlower,
  kMouse,
  kMouseOrbit,
  kMousePan,
  kMouseZoom,
  kSaved,
  kCount_
};

/// UTF-8; never empty.
const char* text(Text which, Language language);

/// "en", "de"
std::string_view code(Language language);
std::optional<Language> language_of(std::string_view code);
/// From LC_ALL, LC_MESSAGES or LANG: German for "de...", else English.
Language language_of_environment();

}  // namespace kerf
