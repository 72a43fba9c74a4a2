#include "viewer/window/theme.h"

#include <unistd.h>

#include <array>
#include <cmath>
#include <string>

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

ImFont* add_font(const char* name, float height_px) {
  ImFontAtlas* atlas = ImGui::GetIO().Fonts;
  ImFontConfig config;
  // Whole pixels: letters stay sharp, and a column of figures stays a column.
  config.OversampleH = 1;
  config.OversampleV = 1;
  config.PixelSnapH = true;
  config.SizePixels = std::round(height_px);
  if (const std::string path = font_file(name); !path.empty()) {
    if (ImFont* font = atlas->AddFontFromFileTTF(path.c_str(), config.SizePixels, &config)) {
      return font;
    }
  }
  config.SizePixels = std::round(height_px * kBuiltInHeight_px / kTextHeight_px);
  return atlas->AddFontDefault(&config);
}

ImVec4 gray(float value, float alpha = 1.0f) {
  return {value, value + 0.008f, value + 0.024f, alpha};
}

}  // namespace

Fonts load_fonts(float scale) {
  ImGui::GetIO().Fonts->Clear();
  Fonts fonts;
  fonts.text = add_font("DejaVuSans.ttf", kTextHeight_px * scale);
  fonts.mono = add_font("DejaVuSansMono.ttf", kMonoHeight_px * scale);
  fonts.readout = add_font("DejaVuSansMono.ttf", kReadoutHeight_px * scale);
  ImGui::GetIO().FontDefault = fonts.text;
  return fonts;
}

void set_style(float scale) {
  ImGui::GetStyle() = ImGuiStyle();
  ImGui::StyleColorsDark();
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
  colors[ImGuiCol_PopupBg] = gray(0.165f, 0.98f);
  colors[ImGuiCol_Border] = gray(0.235f);
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
  colors[ImGuiCol_CheckMark] = ImGui::ColorConvertU32ToFloat4(theme::kAccent);
  colors[ImGuiCol_SliderGrab] = ImGui::ColorConvertU32ToFloat4(theme::kAccent);
  colors[ImGuiCol_SliderGrabActive] = theme::kNote;
  colors[ImGuiCol_Separator] = gray(0.235f);
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
