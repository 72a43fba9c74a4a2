#include "viewer/window/theme.h"

#include <unistd.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "viewer/window/letters.h"

namespace kerf {
namespace {

constexpr float kTextHeight_px = 15.0f;
constexpr float kMonoHeight_px = 15.0f;
constexpr float kReadoutHeight_px = 21.0f;
constexpr float kBuiltInHeight_px = 13.0f;

/// The path of a font file; empty if it is not installed.
std::string font_file(const char* name) {
  // Debian, Fedora, Arch.
  constexpr std::array kFolders{"/usr/share/fonts/truetype/dejavu/",
                                "/usr/share/fonts/dejavu-sans-fonts/", "/usr/share/fonts/TTF/"};
  for (const char* folder : kFolders) {
    std::string path = std::string(folder) + name;
    if (access(path.c_str(), R_OK) == 0) return path;
  }
  return "";
}

/// Pairs of first and last letter, ended by 0, as Dear ImGui has them.
using LetterRanges = ImVector<ImWchar>;

/// Letters are drawn for all of the texts at once; from Dear ImGui 1.92 on one by one, out of files
/// that it keeps for it.
#if IMGUI_VERSION_NUM >= 19200
void build(ImFontAtlas&) {}
#else
void build(ImFontAtlas& atlas) {
  atlas.Build();
  // Here, while their ranges live, and since a Chinese font has 17 MB.
  atlas.ClearInputData();
}
#endif

ImFontConfig font_config(float height_px, const LetterRanges& letters) {
  ImFontConfig config;
  // Whole pixels: letters stay sharp, and a column of figures stays a column.
  config.OversampleH = 1;
  config.OversampleV = 1;
  config.PixelSnapH = true;
  config.SizePixels = std::round(height_px);
  if (IMGUI_VERSION_NUM < 19200) config.GlyphRanges = letters.Data;
  return config;
}

ImFont* add_font(const char* name, float height_px, const LetterRanges& letters) {
  ImFontAtlas* atlas = ImGui::GetIO().Fonts;
  ImFontConfig config = font_config(height_px, letters);
  if (const std::string path = font_file(name); !path.empty()) {
    if (ImFont* font = atlas->AddFontFromFileTTF(path.c_str(), config.SizePixels, &config)) {
      return font;
    }
  }
  config.SizePixels = std::round(height_px * kBuiltInHeight_px / kTextHeight_px);
  config.GlyphRanges = nullptr;
  return atlas->AddFontDefault(&config);
}

/// To the font that was added last; letters that this one has keep its shape.
void merge_font(const FontFace& font, float height_px, const LetterRanges& letters) {
  ImFontConfig config = font_config(height_px, letters);
  config.MergeMode = true;
  config.FontNo = font.face;
  ImGui::GetIO().Fonts->AddFontFromFileTTF(font.path.c_str(), config.SizePixels, &config);
}

/// Western Europe's, and these.
LetterRanges ranges_of(const std::vector<char16_t>& letters) {
  ImFontGlyphRangesBuilder builder;
  builder.AddRanges(ImGui::GetIO().Fonts->GetGlyphRangesDefault());
  for (const char16_t letter : letters) builder.AddChar(letter);
  LetterRanges ranges;
  builder.BuildRanges(&ranges);
  return ranges;
}

/// Of a dark panel; of a light one what differs as much from its ground.
ImVec4 shade(bool is_light, float value, float alpha = 1.0f) {
  if (is_light) value = 1.04f - 0.75f * value;
  return {value, value + 0.008f, value + (is_light ? 0.014f : 0.024f), alpha};
}

}  // namespace

const theme::Palette theme::kDarkPalette{
    .text = {0.87f, 0.88f, 0.90f, 1.0f},
    .dim = {0.58f, 0.61f, 0.66f, 1.0f},
    .good = {0.47f, 0.80f, 0.52f, 1.0f},
    .warning = {0.95f, 0.72f, 0.32f, 1.0f},
    .error = {0.96f, 0.45f, 0.40f, 1.0f},
    .note = {0.53f, 0.73f, 0.95f, 1.0f},
    .readout = {0.76f, 0.93f, 0.80f, 1.0f},
    .motion_word = {0.60f, 0.78f, 0.98f, 1.0f},
    .machine_word = {0.90f, 0.66f, 0.86f, 1.0f},
    .feed_word = {0.95f, 0.78f, 0.50f, 1.0f},
    .control_word = {0.62f, 0.86f, 0.78f, 1.0f},
    .comment = {0.50f, 0.62f, 0.50f, 1.0f},
    .found_line = IM_COL32(96, 82, 30, 255),
    .accent = IM_COL32(78, 128, 188, 255),
    .track = IM_COL32(56, 60, 68, 255),
    .current_line = IM_COL32(52, 84, 62, 255),
    .hovered_line = IM_COL32(50, 54, 62, 255),
    .gutter = IM_COL32(30, 32, 36, 255),
    .breakpoint = IM_COL32(214, 72, 62, 255),
    .tool_mark = IM_COL32(226, 196, 104, 255),
    .head = IM_COL32(240, 242, 245, 255),
};

// Each word at 4.5 : 1 or more on the panels, as the dark ones are.
const theme::Palette theme::kLightPalette{
    .text = {0.11f, 0.13f, 0.15f, 1.0f},
    .dim = {0.36f, 0.39f, 0.43f, 1.0f},
    .good = {0.10f, 0.45f, 0.18f, 1.0f},
    .warning = {0.62f, 0.36f, 0.00f, 1.0f},
    .error = {0.72f, 0.13f, 0.11f, 1.0f},
    .note = {0.09f, 0.36f, 0.68f, 1.0f},
    .readout = {0.04f, 0.33f, 0.16f, 1.0f},
    .motion_word = {0.05f, 0.31f, 0.64f, 1.0f},
    .machine_word = {0.53f, 0.13f, 0.48f, 1.0f},
    .feed_word = {0.58f, 0.32f, 0.00f, 1.0f},
    .control_word = {0.03f, 0.41f, 0.34f, 1.0f},
    .comment = {0.31f, 0.44f, 0.31f, 1.0f},
    .found_line = IM_COL32(255, 232, 140, 255),
    .accent = IM_COL32(132, 178, 232, 255),
    .track = IM_COL32(206, 210, 217, 255),
    .current_line = IM_COL32(200, 232, 208, 255),
    .hovered_line = IM_COL32(222, 226, 232, 255),
    .gutter = IM_COL32(230, 232, 236, 255),
    .breakpoint = IM_COL32(204, 52, 44, 255),
    .tool_mark = IM_COL32(176, 128, 16, 255),
    .head = IM_COL32(44, 48, 54, 255),
};

Fonts load_fonts(float scale, const std::string& language) {
  ImFontAtlas* atlas = ImGui::GetIO().Fonts;
  atlas->Clear();
  const std::vector<char16_t> letters = letters_of(language);
  const LetterRanges ranges = ranges_of(letters);
  std::optional<FontFace> other;
  if (has_east_asian(letters)) other = east_asian_font();
  Fonts fonts;
  fonts.text = add_font("DejaVuSans.ttf", kTextHeight_px * scale, ranges);
  if (other) merge_font(*other, kTextHeight_px * scale, ranges);
  fonts.mono = add_font("DejaVuSansMono.ttf", kMonoHeight_px * scale, ranges);
  if (other) merge_font(*other, kMonoHeight_px * scale, ranges);
  // Figures and names of axes.
  fonts.readout = add_font("DejaVuSansMono.ttf", kReadoutHeight_px * scale, ranges);
  ImGui::GetIO().FontDefault = fonts.text;
  build(*atlas);
  return fonts;
}

float height_px(const ImFont& font) {
#if IMGUI_VERSION_NUM >= 19200
  return font.LegacySize;
#else
  return font.FontSize;
#endif
}

void set_style(float scale, bool is_light) {
  theme::detail::shown = is_light ? theme::kLightPalette : theme::kDarkPalette;
  ImGui::GetStyle() = ImGuiStyle();
  if (is_light) {
    ImGui::StyleColorsLight();
  } else {
    ImGui::StyleColorsDark();
  }
  const auto gray = [is_light](float value, float alpha = 1.0f) {
    return shade(is_light, value, alpha);
  };
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowPadding = {8.0f, 7.0f};
  style.FramePadding = {6.0f, 3.0f};
  style.ItemSpacing = {6.0f, 5.0f};
  style.ItemInnerSpacing = {5.0f, 4.0f};
  style.CellPadding = {4.0f, 2.0f};
  style.ScrollbarSize = 12.0f;
  style.GrabMinSize = 10.0f;
  style.WindowRounding = 0.0f;
  style.FrameRounding = 3.0f;
  style.PopupRounding = 4.0f;
  style.TabRounding = 3.0f;
  style.WindowBorderSize = 1.0f;
  style.ScaleAllSizes(scale);
  ImVec4* colors = style.Colors;
  colors[ImGuiCol_Text] = theme::kText;
  colors[ImGuiCol_TextDisabled] = theme::kDim;
  colors[ImGuiCol_WindowBg] = gray(0.135f);
  colors[ImGuiCol_ChildBg] = gray(0.135f);
  colors[ImGuiCol_PopupBg] = gray(is_light ? 0.08f : 0.165f, 0.98f);
  colors[ImGuiCol_Border] = gray(is_light ? 0.36f : 0.235f);
  colors[ImGuiCol_FrameBg] = gray(0.205f);
  colors[ImGuiCol_FrameBgHovered] = gray(0.26f);
  colors[ImGuiCol_FrameBgActive] = gray(0.30f);
  colors[ImGuiCol_TitleBg] = gray(0.165f);
  colors[ImGuiCol_TitleBgActive] = gray(0.20f);
  colors[ImGuiCol_Button] = gray(0.225f);
  colors[ImGuiCol_ButtonHovered] = gray(0.30f);
  colors[ImGuiCol_ButtonActive] = ImGui::ColorConvertU32ToFloat4(theme::kAccent);
  colors[ImGuiCol_Header] = gray(0.225f);
  colors[ImGuiCol_HeaderHovered] = gray(0.28f);
  colors[ImGuiCol_HeaderActive] = gray(0.33f);
  colors[ImGuiCol_Tab] = gray(0.175f);
  colors[ImGuiCol_TabHovered] = gray(0.32f);
  colors[ImGuiCol_TabActive] = gray(0.27f);
  // On light ground what words can stand on is too pale for a mark.
  const ImVec4 mark = is_light ? theme::kNote : ImGui::ColorConvertU32ToFloat4(theme::kAccent);
  colors[ImGuiCol_CheckMark] = mark;
  colors[ImGuiCol_SliderGrab] = mark;
  colors[ImGuiCol_SliderGrabActive] = theme::kNote;
  colors[ImGuiCol_Separator] = gray(is_light ? 0.36f : 0.235f);
  colors[ImGuiCol_TableHeaderBg] = gray(0.135f);
}

const ImVec4& theme::of(Severity severity) {
  switch (severity) {
    case Severity::kError:
      return kError;
    case Severity::kWarning:
      return kWarning;
    case Severity::kNote:
      break;
  }
  return kNote;
}

}  // namespace kerf
