// Fields for texts, and keys to be clicked where there is no keyboard: in a tab it is LinuxCNC's.
#include <imgui.h>
#include <imgui_stdlib.h>

#include <array>
#include <cctype>
#include <string_view>

#include "viewer/window/panels.h"

namespace kerf {
namespace {

/// What shapes, blanks and paths are made of.
constexpr std::array<std::string_view, 5> kRows{"1234567890", "qwertyuiop", "asdfghjkl_",
                                                "zxcvbnm/+@", ":,.-=()[]~"};
constexpr float kKeyHeight_px = 24.0f;

/// True when what was typed is to count.
bool draw_keys(const PanelContext& context, std::string* value) {
  JobEdit& edit = context.state->job;
  const float gap = 2.0f * context.scale, height = kKeyHeight_px * context.scale;
  const auto count = static_cast<float>(kRows[0].size());
  const float width = (ImGui::GetContentRegionAvail().x - (count - 1) * gap) / count;
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {gap, gap});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0.0f, 0.0f});
  for (const std::string_view row : kRows) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      const auto letter = static_cast<unsigned char>(row[k]);
      const char typed = static_cast<char>(edit.is_upper ? std::toupper(letter) : letter);
      if (k > 0) ImGui::SameLine();
      if (ImGui::Button(std::string(1, typed).c_str(), {width, height})) value->push_back(typed);
    }
  }
  const float wide = 0.25f * (ImGui::GetContentRegionAvail().x - 3 * gap);
  if (ImGui::Button(edit.is_upper ? "abc" : "ABC", {wide, height})) edit.is_upper = !edit.is_upper;
  ImGui::SameLine();
  if (ImGui::Button("<-", {wide, height}) && !value->empty()) value->pop_back();
  ImGui::SameLine();
  if (ImGui::Button(context.word(Text::kClearField), {wide, height})) value->clear();
  ImGui::SameLine();
  const bool is_done = ImGui::Button("OK", {wide, height});
  ImGui::PopStyleVar(2);
  return is_done;
}

}  // namespace

bool draw_text_field(const PanelContext& context, const std::string& id, const std::string& hint,
                     std::string* value) {
  if (context.has_keyboard) {
    ImGui::SetNextItemWidth(-1.0f);
    return ImGui::InputTextWithHint(id.c_str(), hint.c_str(), value,
                                    ImGuiInputTextFlags_EnterReturnsTrue);
  }
  JobEdit& edit = context.state->job;
  const bool is_typed = edit.typed_id == id;
  ImGui::PushStyleVar(ImGuiStyleVar_ButtonTextAlign, {0.0f, 0.5f});
  if (value->empty()) ImGui::PushStyleColor(ImGuiCol_Text, theme::kDim);
  const std::string shown = (value->empty() ? hint : *value) + "###" + id;
  if (ImGui::Button(shown.c_str(), {-1.0f, 0.0f})) edit.typed_id = is_typed ? std::string() : id;
  if (value->empty()) ImGui::PopStyleColor();
  ImGui::PopStyleVar();
  if (!is_typed || !draw_keys(context, value)) return false;
  edit.typed_id.clear();
  return true;
}

}  // namespace kerf
