// viewer/window/theme.h - fonts, colours and sizes of the panels. For the sources of viewer/ only.
#pragma once

#include <imgui.h>

#include "base/diagnostic.h"

namespace kerf {

/// Never null after load_fonts().
struct Fonts {
  ImFont* text = nullptr;
  ImFont* mono = nullptr;     ///< program, figures
  ImFont* readout = nullptr;  ///< positions: to be read from two steps away
};

/// DejaVu where it is installed (Debian package fonts-dejavu-core), else the font that is built
/// into Dear ImGui. Replaces what was loaded before. Latin letters alone.
Fonts load_fonts(float scale);

/// Colours and distances, for this scale.
void set_style(float scale);

namespace theme {
inline const ImVec4 kText{0.87f, 0.88f, 0.90f, 1.0f};
inline const ImVec4 kDim{0.58f, 0.61f, 0.66f, 1.0f};
inline const ImVec4 kGood{0.47f, 0.80f, 0.52f, 1.0f};
inline const ImVec4 kWarning{0.95f, 0.72f, 0.32f, 1.0f};
inline const ImVec4 kError{0.96f, 0.45f, 0.40f, 1.0f};
inline const ImVec4 kNote{0.53f, 0.73f, 0.95f, 1.0f};
inline const ImVec4 kReadout{0.76f, 0.93f, 0.80f, 1.0f};
// Words of a program.
inline const ImVec4 kMotionWord{0.60f, 0.78f, 0.98f, 1.0f};
inline const ImVec4 kMachineWord{0.90f, 0.66f, 0.86f, 1.0f};
inline const ImVec4 kFeedWord{0.95f, 0.78f, 0.50f, 1.0f};
inline const ImVec4 kControlWord{0.62f, 0.86f, 0.78f, 1.0f};
inline const ImVec4 kComment{0.50f, 0.62f, 0.50f, 1.0f};
inline constexpr ImU32 kFoundLine = IM_COL32(96, 82, 30, 255);
inline constexpr ImU32 kAccent = IM_COL32(78, 128, 188, 255);
inline constexpr ImU32 kTrack = IM_COL32(56, 60, 68, 255);
inline constexpr ImU32 kCurrentLine = IM_COL32(52, 84, 62, 255);
inline constexpr ImU32 kHoveredLine = IM_COL32(50, 54, 62, 255);
inline constexpr ImU32 kGutter = IM_COL32(30, 32, 36, 255);
inline constexpr ImU32 kBreakpoint = IM_COL32(214, 72, 62, 255);
inline constexpr ImU32 kToolMark = IM_COL32(226, 196, 104, 255);
inline constexpr ImU32 kHead = IM_COL32(240, 242, 245, 255);

const ImVec4& of(Severity severity);
}  // namespace theme

}  // namespace kerf
