#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "viewer/window/panels.h"

namespace kerf {
namespace {

constexpr ImGuiWindowFlags kDialogFlags = ImGuiWindowFlags_AlwaysAutoResize |
                                          ImGuiWindowFlags_NoSavedSettings |
                                          ImGuiWindowFlags_NoCollapse;
constexpr int kHelpColumns = 3;

}  // namespace

void draw_help(const PanelContext& context, glm::vec2 window_px) {
  ImGui::SetNextWindowPos({0.5f * window_px.x, 0.5f * window_px.y}, ImGuiCond_Always, {0.5f, 0.5f});
  const std::string title = fmt::format("{}###help", context.word(Text::kShortcuts));
  if (ImGui::Begin(title.c_str(), &context.state->shows_help, kDialogFlags)) {
    const auto keys = shortcuts();
    const auto rows = (static_cast<int>(keys.size()) + kHelpColumns - 1) / kHelpColumns;
    if (ImGui::BeginTable("keys", 2 * kHelpColumns, ImGuiTableFlags_SizingFixedFit)) {
      for (int cell = 0; cell < rows * kHelpColumns; ++cell) {
        // Down the columns, as the table is ordered.
        const auto i = static_cast<std::size_t>(cell % kHelpColumns * rows + cell / kHelpColumns);
        ImGui::TableNextColumn();
        if (i < keys.size()) ImGui::TextColored(theme::kWarning, "%s", keys[i].label);
        ImGui::TableNextColumn();
        if (i < keys.size()) {
          ImGui::Text("%s    ", context.word(keys[i].text));
        }
      }
      ImGui::EndTable();
    }
    ImGui::Separator();
    for (const Text line : {Text::kMouseOrbit, Text::kMousePan, Text::kMouseZoom, Text::kMousePick,
                            Text::kMouseCode, Text::kMouseGutter}) {
      ImGui::BulletText("%s", context.word(line));
    }
  }
  ImGui::End();
}

void draw_first_keys(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room) {
  // Below the middle, where a window without a program says how to get one.
  const glm::vec2 at{0.5f * (room.left + window_px.x - room.right),
                     window_px.y - room.bottom - 12.0f * context.scale};
  ImGui::SetNextWindowPos({at.x, at.y}, ImGuiCond_Always, {0.5f, 1.0f});
  ImGui::Begin("first keys", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoInputs |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::TextColored(theme::kGood, "%s", context.word(Text::kFirstKeys));
  const bool has_player = context.shown.moment->state != PlayState::kFollowing;
  const std::vector<const Shortcut*> keys = first_shortcuts(has_player);
  constexpr std::size_t kColumns = 2;
  if (ImGui::BeginTable("first keys", 2 * kColumns, ImGuiTableFlags_SizingFixedFit)) {
    const std::size_t rows = (keys.size() + kColumns - 1) / kColumns;
    for (std::size_t cell = 0; cell < rows * kColumns; ++cell) {
      const std::size_t i = cell % kColumns * rows + cell / kColumns;
      ImGui::TableNextColumn();
      if (i < keys.size()) ImGui::TextColored(theme::kWarning, "%s", keys[i]->label);
      ImGui::TableNextColumn();
      if (i < keys.size()) ImGui::Text("%s    ", context.word(keys[i]->text));
    }
    ImGui::EndTable();
  }
  ImGui::TextColored(theme::kDim, "%s", context.word(Text::kFirstKeysHow));
  ImGui::End();
}

void draw_line_question(const PanelContext& context, glm::vec2 window_px) {
  ImGui::SetNextWindowPos({0.5f * window_px.x, 0.4f * window_px.y}, ImGuiCond_Always, {0.5f, 0.5f});
  const std::string title = fmt::format("{}###line", context.word(Text::kGoToLine));
  PanelState& state = *context.state;
  if (ImGui::Begin(title.c_str(), &state.asks_for_line, kDialogFlags)) {
    if (ImGui::IsWindowAppearing()) {
      state.asked_line = std::max(1, context.shown.moment->line);
      ImGui::SetKeyboardFocusHere();
    }
    ImGui::SetNextItemWidth(170.0f * context.scale);
    const bool is_entered =
        ImGui::InputInt("##number", &state.asked_line, 1, 100,
                        ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    const auto& files = context.shown.program->files;
    const int most = files.empty() ? 1 : files.front().line_count();
    state.asked_line = std::clamp(state.asked_line, 1, std::max(1, most));
    const bool jumps = ImGui::Button(context.word(Text::kJumpToHere)) || is_entered;
    const bool runs = ImGui::Button(context.word(Text::kRunToHere));
    if (jumps) context.commands->push(SeekLineCommand{"", state.asked_line});
    if (runs) context.commands->push(RunToLineCommand{"", state.asked_line});
    if (jumps || runs) {
      state.code.follows = true;
      state.asks_for_line = false;
    }
  }
  ImGui::End();
}

}  // namespace kerf
