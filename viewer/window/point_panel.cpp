#include <fmt/format.h>
#include <imgui.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "viewer/window/panels.h"

namespace kerf {
namespace {

constexpr ImU32 kMark = IM_COL32(196, 74, 30, 255);
constexpr ImU32 kMeasured = IM_COL32(30, 92, 170, 255);
constexpr ImU32 kLabel = IM_COL32(20, 24, 30, 225);
/// An answer belongs to the point that was asked for if it is as near as this: it is echoed.
constexpr double kSamePoint_mm = 1e-6;

void row(const char* label, const std::string& value) {
  ImGui::TableNextColumn();
  ImGui::TextColored(theme::kDim, "%s", label);
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(value.c_str());
}

bool begin_rows(const PanelContext& context, const char* id) {
  if (!ImGui::BeginTable(id, 2)) return false;
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, 92.0f * context.scale);
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch);
  return true;
}

/// Who cut there; a click jumps to the line.
void draw_answer(const PanelContext& context, const PickedPoint& picked) {
  ImGui::TableNextColumn();
  ImGui::TextColored(theme::kDim, "%s", context.word(Text::kCutBy));
  ImGui::TableNextColumn();
  if (!picked.is_known) {
    ImGui::TextUnformatted("-");
  } else if (!picked.tool) {
    ImGui::TextUnformatted(context.word(Text::kNotCut));
  } else {
    ImGui::TextUnformatted(fmt::format("T{} {}", *picked.tool, picked.tool_name).c_str());
  }
  const auto& files = context.shown.program->files;
  const auto file = static_cast<std::size_t>(std::max(0, picked.file));
  // A machine may say its line where nobody has given the program.
  if (picked.line > 0 && file >= files.size()) {
    row(context.word(Text::kLine), std::to_string(picked.line));
  } else if (picked.line > 0) {
    ImGui::TableNextColumn();
    ImGui::TextColored(theme::kDim, "%s", context.word(Text::kLine));
    ImGui::TableNextColumn();
    const std::string label = fmt::format("{}  {}", picked.line, clock_text(picked.time_s));
    if (ImGui::Button(label.c_str())) {
      context.state->code.follows = true;
      context.commands->push(SeekLineCommand{file == 0 ? "" : files[file].path(), picked.line});
    }
    if (ImGui::IsItemHovered()) {
      ImGui::SetTooltip("%s: %s", context.word(Text::kJumpToHere),
                        files[file].line(picked.line).c_str());
    }
  }
  if (picked.deviation_mm) {
    row(context.word(Text::kDeviation), context.measures.signed_length(*picked.deviation_mm));
  }
}

void draw_picked(const PanelContext& context) {
  const Inspection& inspection = context.state->inspection;
  if (!inspection.asked_mm) {
    ImGui::TextColored(theme::kDim, "%s", context.word(Text::kPickHint));
    return;
  }
  if (!begin_rows(context, "picked")) return;
  const Vec3& at = *inspection.asked_mm;
  const bool turns = context.shown.setup->turns;
  if (turns) row(kDiameterSign, context.measures.length(2 * glm::length(Vec2(at))));
  row("X", context.measures.position(at.x));
  row("Y", context.measures.position(at.y));
  row("Z", context.measures.position(at.z));
  const Box& bounds = context.bounds_mm;
  if (!bounds.empty() && !turns) {
    row(context.word(Text::kHeight), context.measures.length(at.z - bounds.min.z));
  }
  const PickedPoint* picked = context.shown.picked.get();
  if (picked != nullptr && glm::distance(picked->point_mm, at) <= kSamePoint_mm) {
    draw_answer(context, *picked);
  } else {
    row(context.word(Text::kCutBy), context.word(Text::kAsking));
  }
  ImGui::EndTable();
}

void draw_measured(const PanelContext& context) {
  Inspection& inspection = context.state->inspection;
  if (ImGui::Checkbox(context.word(Text::kMeasure), &inspection.measures)) {
    inspection.ends_mm.clear();
  }
  if (!inspection.measures) return;
  if (inspection.ends_mm.size() < 2) {
    ImGui::TextColored(
        theme::kNote, "%s",
        context.word(inspection.ends_mm.empty() ? Text::kMeasureFirst : Text::kMeasureSecond));
    return;
  }
  if (begin_rows(context, "measured")) {
    const Vec3 between = inspection.ends_mm[1] - inspection.ends_mm[0];
    if (context.shown.setup->turns) {
      const auto diameter = [&](std::size_t end) {
        return 2 * glm::length(Vec2(inspection.ends_mm[end]));
      };
      const std::string label = std::string("d") + kDiameterSign;
      row(kDiameterSign, context.measures.length(diameter(0)));
      row(kDiameterSign, context.measures.length(diameter(1)));
      row(label.c_str(), context.measures.length(diameter(1) - diameter(0)));
    }
    row("dX", context.measures.length(between.x));
    row("dY", context.measures.length(between.y));
    row("dZ", context.measures.length(between.z));
    row(context.word(Text::kDistance), context.measures.length(glm::length(between)));
    ImGui::EndTable();
  }
  if (ImGui::Button(context.word(Text::kClear))) inspection.ends_mm.clear();
}

void draw_cross(ImDrawList* list, ImVec2 at, ImU32 color, float scale) {
  const float arm = 7.0f * scale;
  for (const float width : {3.0f * scale, 1.0f * scale}) {
    const ImU32 shade = width > 1.5f * scale ? IM_COL32(255, 255, 255, 190) : color;
    list->AddLine({at.x - arm, at.y}, {at.x + arm, at.y}, shade, width);
    list->AddLine({at.x, at.y - arm}, {at.x, at.y + arm}, shade, width);
  }
}

}  // namespace

void draw_point_tab(const PanelContext& context) {
  draw_picked(context);
  ImGui::Separator();
  draw_measured(context);
}

void draw_inspection(const PanelContext& context, const Projection& projection,
                     glm::vec2 corner_px) {
  const Inspection& inspection = context.state->inspection;
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const glm::vec2 end = corner_px + glm::vec2(projection.size_px);
  list->PushClipRect({corner_px.x, corner_px.y}, {end.x, end.y});
  const auto place = [&](const Vec3& point) -> std::optional<ImVec2> {
    const std::optional<glm::vec2> px = picture_px(point, projection);
    if (!px) return std::nullopt;
    return ImVec2(corner_px.x + px->x, corner_px.y + px->y);
  };
  if (inspection.asked_mm && !inspection.measures) {
    if (const auto at = place(*inspection.asked_mm)) draw_cross(list, *at, kMark, context.scale);
  }
  std::vector<ImVec2> ends;
  for (const Vec3& end_mm : inspection.ends_mm) {
    if (const auto at = place(end_mm)) ends.push_back(*at);
  }
  if (ends.size() == 2) {
    list->AddLine(ends[0], ends[1], kMeasured, 2.0f * context.scale);
    const std::string label =
        context.measures.length(glm::distance(inspection.ends_mm[0], inspection.ends_mm[1]));
    const ImVec2 size = ImGui::CalcTextSize(label.c_str());
    const ImVec2 at(std::round(0.5f * (ends[0].x + ends[1].x - size.x)),
                    std::round(0.5f * (ends[0].y + ends[1].y) - 1.6f * size.y));
    const float border = 4.0f * context.scale;
    list->AddRectFilled({at.x - border, at.y - 0.5f * border},
                        {at.x + size.x + border, at.y + size.y + 0.5f * border}, kLabel, border);
    list->AddText(at, IM_COL32(255, 255, 255, 255), label.c_str());
  }
  for (const ImVec2& at : ends) draw_cross(list, at, kMeasured, context.scale);
  list->PopClipRect();
}

}  // namespace kerf
