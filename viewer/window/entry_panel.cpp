// What a start in the middle of the program would miss and meet: a right click on its line.
#include <fmt/format.h>
#include <imgui.h>

#include "viewer/window/panels.h"

namespace kerf {
namespace {

constexpr ImU32 kClearWay = IM_COL32(40, 170, 90, 255);
constexpr ImU32 kBlockedWay = IM_COL32(225, 40, 60, 255);
constexpr ImU32 kWayShade = IM_COL32(255, 255, 255, 170);
constexpr float kTextWidth_px = 560.0f;

void draw_starts(const PanelContext& context, const EntryAnswer& entry) {
  for (const EntryStartShown& start : entry.earlier) {
    const std::string label =
        fmt::format("{} {}: {}, +{}", context.word(Text::kLine), start.line,
                    context.word(start.changes_tool ? Text::kToolChange : Text::kAboveWorkpiece),
                    clock_text(start.costs_s));
    if (!ImGui::Button(label.c_str())) continue;
    context.state->code.follows = true;
    context.commands->push(SeekLineCommand{"", start.line});
    context.commands->push(EntryCommand{start.line});
  }
}

}  // namespace

void draw_entry(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room) {
  const EntryAnswer& entry = *context.shown.entry;
  ImGui::SetNextWindowPos({room.left + 12.0f * context.scale, 60.0f * context.scale},
                          ImGuiCond_Appearing);
  ImGui::SetNextWindowSizeConstraints({240.0f * context.scale, 0.0f},
                                      {window_px.x, window_px.y - room.bottom});
  const std::string title =
      fmt::format("{} {}###entry", context.word(Text::kBeginAtLine), entry.line);
  if (ImGui::Begin(title.c_str(), &context.state->shows_entry,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                       ImGuiWindowFlags_NoCollapse)) {
    ImGui::PushTextWrapPos(kTextWidth_px * context.scale);
    if (entry.is_busy) {
      ImGui::TextColored(theme::kNote, "%s", context.word(Text::kWorkingItOut));
    } else if (!entry.trouble.empty()) {
      ImGui::TextColored(theme::kWarning, "%s", entry.trouble.c_str());
    }
    for (const std::string& line : entry.text) ImGui::TextWrapped("%s", line.c_str());
    ImGui::PopTextWrapPos();
    draw_starts(context, entry);
  }
  ImGui::End();
}

void draw_entry_way(const PanelContext& context, const Projection& projection,
                    glm::vec2 corner_px) {
  const EntryAnswer& entry = *context.shown.entry;
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const glm::vec2 end = corner_px + glm::vec2(projection.size_px);
  list->PushClipRect({corner_px.x, corner_px.y}, {end.x, end.y});
  for (const EntryWayShown* way : {&entry.safe, &entry.drive}) {
    const ImU32 color = way->is_clear ? kClearWay : kBlockedWay;
    for (const float width : {5.0f * context.scale, 2.0f * context.scale}) {
      const ImU32 shade = width > 3.0f * context.scale ? kWayShade : color;
      for (std::size_t i = 1; i < way->points_mm.size(); ++i) {
        const auto from = picture_px(way->points_mm[i - 1], projection);
        const auto to = picture_px(way->points_mm[i], projection);
        if (!from || !to) continue;
        list->AddLine({corner_px.x + from->x, corner_px.y + from->y},
                      {corner_px.x + to->x, corner_px.y + to->y}, shade, width);
      }
    }
    if (way->points_mm.empty()) continue;
    if (const auto at = picture_px(way->points_mm.back(), projection)) {
      list->AddCircle({corner_px.x + at->x, corner_px.y + at->y}, 6.0f * context.scale, color, 0,
                      2.0f * context.scale);
    }
  }
  list->PopClipRect();
}

}  // namespace kerf
