// viewer/window/settings.h - what the window remembers from one use to the next.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "base/result.h"
#include "base/translate.h"
#include "viewer/window/scene_renderer.h"
#include "viewer/window/texts.h"
#include "viewer/window/units.h"

namespace kerf {

/// What the section plane is set to; whether it cuts is not remembered.
struct SectionChoice {
  bool is_on = false;
  bool is_quarter = false;  ///< only what lies beyond a second plane, too, is hidden
  int axis = 1;             ///< 0 X, 1 Y, 2 Z
  /// False: what lies on the negative side of the plane is hidden; across Y of a workpiece that
  /// turns, which is seen from there, on the positive one.
  bool is_flipped = false;
  double offset_mm = 0.0;  ///< along the axis
};

/// Which of ProgramCurves stands below the time slider.
enum class CurveChoice {
  kNone,
  kRate,
  kFeed,
  kFeedPerTooth,
  kAngle,  ///< from here on CutLoadKind
  kChip,
  kForce,
  kTorque,
  kPower,
  kBend
};
inline constexpr int kCurveChoices = 10;
/// Nothing where it is no load.
inline constexpr std::optional<CutLoadKind> load_of(CurveChoice curve) {
  if (curve < CurveChoice::kAngle) return std::nullopt;
  return static_cast<CutLoadKind>(static_cast<int>(curve) - static_cast<int>(CurveChoice::kAngle));
}

/// Of panels and background. kSystem: as the desktop asks for; dark where it does not say.
enum class ThemeChoice { kDark, kLight, kSystem };

/// Stored as lines `name = value`:
///
///     width = 1280
///     language = de
///     show.holder = off
///     opacity.workpiece = 0.5
struct ViewSettings {
  int width_px = 1280;  ///< of the window, on a display of scale 1; 320 to 16384
  int height_px = 800;
  std::string language = kerf::language();  ///< one of languages()
  LengthUnit units = LengthUnit::kMm;
  ThemeChoice theme = ThemeChoice::kDark;
  bool knows_keys = false;  ///< Has seen the first keys.
  bool is_perspective = true;
  bool shows_code = true;
  bool shows_info = true;
  /// Where it is too narrow for both, the panel stands in the place of the picture. Not kept.
  bool shows_info_alone = false;
  bool shows_counters = false;
  CurveChoice curve = CurveChoice::kRate;
  FlatView flat = FlatView::kNone;
  double text_scale = 1.0;  ///< Of all of the panels, times the scale of the display; 0.75 to 3.
  double code_width_px = 290.0;  ///< of the panels, on a display of scale 1
  double info_width_px = 300.0;
  /// Programs that were shown, the newest first; at most kMostRecent. Absolute.
  std::vector<std::string> recent;
  std::string picture_folder;  ///< Where a picture or a film was saved last; absolute, or empty.
  SectionChoice section;
  DrawOptions drawing;
};
/// DrawOptions::path_tail where only the last moves are wanted.
inline constexpr std::size_t kTailMoves = 200;
inline constexpr std::size_t kMostRecent = 8;
inline constexpr double kMinPanel_px = 180.0;
inline constexpr double kMaxPanel_px = 1200.0;

/// Puts a program to the front. Names that a line of the file cannot hold are not remembered.
void remember_program(const std::string& path, ViewSettings* settings);
/// Likewise, where pictures go.
void remember_picture_folder(const std::string& folder, ViewSettings* settings);

inline constexpr double kMinTextScale = 0.75;
inline constexpr double kMaxTextScale = 3.0;
inline constexpr double kMinTolerance_mm = 1e-4;
inline constexpr double kMaxTolerance_mm = 100.0;

/// $XDG_CONFIG_HOME/kerf/view.conf, else $HOME/.config/kerf/view.conf; empty if neither is set.
std::string settings_path();

/// Faulty lines are reported with line and column, and leave the default; the rest counts.
/// Their hint says what becomes of the file. A file
/// that is not there is no fault.
ViewSettings load_settings(const std::string& path, Diagnostics* faults);

/// Makes the folder if need be; the file appears whole or not at all.
Done save_settings(const std::string& path, const ViewSettings& settings);

/// Renames a file with faults, so that save_settings() does not destroy what somebody wrote there:
/// to PATH.damaged, or PATH.damaged-2 .. -9 where that is taken. The new name. Error: all are
/// taken, or the folder cannot be written to.
Result<std::string> set_aside(const std::string& path);

}  // namespace kerf
