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
  kToStart,
  kStepBack,
  kStepForward,
  kPreviousFinding,
  kNextFinding,
  kPreviousTool,
  kNextTool,
  kToEnd,
  kSpeed,
  kFullSpeed,
  kFullSpeedWhat,
  kGoToLine,
  kLine,
  kRunToHere,
  kJumpToHere,
  kSetBreakpoint,
  kClearBreakpoint,
  kFollowLine,
  kElapsed,
  kRemaining,
  kPaused,
  kPlaying,
  kHurrying,
  kFollowing,
  kMachineLeads,
  kEnded,
  // panels
  kMachine,
  kWork,
  kToGo,
  kTool,
  kNoTool,
  kSpindle,
  kFeed,
  kTraverse,
  kCoolant,
  kRemoved,
  kLive,
  kStale,
  kLost,
  kAgo,
  kFindings,
  kNoFindings,
  kProgram,
  kNoProgram,
  kBreakpoint,
  kWorkpiece,
  kCutter,
  kHolder,
  kTraverses,
  kFeeds,
  kPlanned,
  kBlank,
  kFrames,
  kMachineParts,
  kLocalDrawing,
  kPerspective,
  kPerspectiveWhat,
  kDrawing,
  kFull,
  kLocal,
  kStill,
  kUploaded,
  kWaiting,
  kGpuMemory,
  kFramesPerSecond,
  kTextSize,
  kDarkBackground,
  kView,
  kObjects,
  kOpacity,
  // colours
  kColors,
  kNextColors,
  kColorPlain,
  kColorHeight,
  kColorTool,
  kColorRemovalRate,
  kColorLineRange,
  kColorDeviation,
  kFirstLine,
  kLastLine,
  kTolerance,
  kNoColorsYet,
  // section
  kSection,
  kSectionFlip,
  // point and measure
  kPoint,
  kPickHint,
  kHeight,
  kCutBy,
  kNotCut,
  kAsking,
  kDeviation,
  kMeasure,
  kMeasureFirst,
  kMeasureSecond,
  kDistance,
  kClear,
  // views
  kFit,
  kFront,
  kBack,
  kLeft,
  kRight,
  kTop,
  kBottom,
  kIsometric,
  kFlatOff,
  kFlatXy,
  kFlatXz,
  kFlat,
  kPicture,
  kQuestionMark,
  // help
  kShortcuts,
  kCodePanel,
  kInfoPanel,
  kToggleWorkpiece,
  kScreenshot,
  kWindowPicture,
  kClose,
  kFaster,
  kSlower,
  kMouseOrbit,
  kMousePan,
  kMouseZoom,
  kMousePick,
  kMouseCode,
  kMouseGutter,
  kSaving,
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
