// viewer/window/theme.h - fonts, colours and sizes of the panels. For the sources of viewer/ only.
#pragma once

#include <imgui.h>

#include <string>

#include "base/diagnostic.h"

namespace kerf {

/// Never null after load_fonts().
struct Fonts {
  ImFont* text = nullptr;
  ImFont* mono = nullptr;     ///< program, figures
  ImFont* readout = nullptr;  ///< positions: to be read from two steps away
};

/// DejaVu where it is installed (Debian package fonts-dejavu-core), else the font that is built
/// into Dear ImGui; Chinese from another one (letters.h). Replaces what was loaded before. Of the
/// letters those of Western Europe, and what the texts of the language hold: others, as in comments
/// of a program, are shown as `?`. Takes 10 to 100 ms.
Fonts load_fonts(float scale, const std::string& language);

/// As it was loaded.
float height_px(const ImFont& font);

/// Colours and distances, for this scale.
void set_style(float scale, bool is_light);

namespace theme {
/// All colours of the panels, but those of Dear ImGui's own parts, which set_style() derives.
struct Palette {
  ImVec4 text, dim, good, warning, error, note, readout;
  ImVec4 motion_word, machine_word, feed_word, control_word, comment;  ///< of a program
  ImU32 found_line, accent, track, current_line, hovered_line, gutter, breakpoint, tool_mark, head;
};
extern const Palette kDarkPalette, kLightPalette;
namespace detail {
inline Palette shown;  ///< One window, one thread. set_style() chooses.
}

// By name, as they are now.
inline const ImVec4& kText = detail::shown.text;
inline const ImVec4& kDim = detail::shown.dim;
inline const ImVec4& kGood = detail::shown.good;
inline const ImVec4& kWarning = detail::shown.warning;
inline const ImVec4& kError = detail::shown.error;
inline const ImVec4& kNote = detail::shown.note;
inline const ImVec4& kReadout = detail::shown.readout;
inline const ImVec4& kMotionWord = detail::shown.motion_word;
inline const ImVec4& kMachineWord = detail::shown.machine_word;
inline const ImVec4& kFeedWord = detail::shown.feed_word;
inline const ImVec4& kControlWord = detail::shown.control_word;
inline const ImVec4& kComment = detail::shown.comment;
inline const ImU32& kFoundLine = detail::shown.found_line;
inline const ImU32& kAccent = detail::shown.accent;
inline const ImU32& kTrack = detail::shown.track;
inline const ImU32& kCurrentLine = detail::shown.current_line;
inline const ImU32& kHoveredLine = detail::shown.hovered_line;
inline const ImU32& kGutter = detail::shown.gutter;
inline const ImU32& kBreakpoint = detail::shown.breakpoint;
inline const ImU32& kToolMark = detail::shown.tool_mark;
inline const ImU32& kHead = detail::shown.head;

const ImVec4& of(Severity severity);
}  // namespace theme

}  // namespace kerf
