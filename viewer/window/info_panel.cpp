#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "viewer/window/panels.h"

namespace kerf {
namespace {

/// Right-aligned in the rest of the table cell.
void figure(const std::string& text, const ImVec4& color) {
  const float free = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
  if (free > 0.0f) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + free);
  ImGui::TextColored(color, "%s", text.c_str());
}

/// With as many digits as the rest of the table cell has room for: a long travel loses its
/// thousandths, not its end.
std::string fitting(const PanelContext& context, const AxisReadout& axis, double value) {
  const float room = ImGui::GetContentRegionAvail().x;
  std::string text;
  for (int digits = axis.is_rotary ? 2 : context.measures.digits(); digits >= 0; --digits) {
    text = axis.is_rotary ? fmt::format("{:.{}f}", value, digits)
                          : context.measures.length(value, digits);
    text.resize(text.find_last_of("0123456789") + 1);  // the column's unit is known
    if (ImGui::CalcTextSize(text.c_str()).x <= room) break;
  }
  return text;
}

void draw_positions(const PanelContext& context) {
  const Moment& moment = *context.shown.moment;
  if (moment.axes.empty() || !ImGui::BeginTable("positions", 4)) return;
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, 14.0f * context.scale);
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch, 1.42f);
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch, 1.0f);
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch, 0.92f);
  ImGui::TableNextColumn();
  ImGui::TableNextColumn();
  figure(moment.work_offset.empty()
             ? std::string(context.word(Text::kWork))
             : fmt::format("{} {}", context.word(Text::kWork), moment.work_offset),
         theme::kDim);
  for (const Text column : {Text::kMachine, Text::kToGo}) {
    ImGui::TableNextColumn();
    figure(context.word(column), theme::kDim);
  }
  for (const AxisReadout& axis : moment.axes) {
    const auto figure_of = [&](double value) { return fitting(context, axis, value); };
    ImGui::PushFont(context.fonts.readout);
    ImGui::TableNextColumn();
    const char name[] = {axis.name, '\0'};
    ImGui::TextColored(theme::kText, "%s", axis.is_diameter ? kDiameterSign : name);
    ImGui::TableNextColumn();
    figure(figure_of(axis.work), theme::kReadout);
    const float drop = height_px(*context.fonts.readout) - height_px(*context.fonts.mono);
    ImGui::PopFont();
    ImGui::PushFont(context.fonts.mono);
    ImGui::TableNextColumn();
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() + 0.7f * drop);
    figure(figure_of(axis.machine), theme::kDim);
    ImGui::TableNextColumn();
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() + 0.7f * drop);
    figure(axis.to_go ? figure_of(*axis.to_go) : "-", theme::kDim);
    ImGui::PopFont();
  }
  ImGui::EndTable();
}

std::string tool_text(const PanelContext& context) {
  const Moment& moment = *context.shown.moment;
  if (moment.tool == 0 && moment.tool_name.empty()) return context.word(Text::kNoTool);
  return fmt::format("T{} {}", moment.tool, moment.tool_name);
}

/// As programmed; of a machine what it really does goes first.
std::string feed_text(const PanelContext& context) {
  const Moment& moment = *context.shown.moment;
  const Measures& measures = context.measures;
  const std::optional<double>& measured = moment.measured_mm_per_min;
  if (moment.is_traverse) {
    const char* const traverse = context.word(Text::kTraverse);
    return measured ? fmt::format("{} ({})", measures.feed(*measured), traverse) : traverse;
  }
  if (!measured) return measures.feed(moment.feed_mm_per_min);
  const bool is_programmed = moment.feed_mm_per_min > 0.0;
  return is_programmed ? measures.feeds(*measured, moment.feed_mm_per_min)
                       : measures.feed(*measured);
}

/// "3.21 mm holder - vise"
std::string clearance_text(const PanelContext& context) {
  const SceneClearance& clearance = *context.shown.moment->clearance;
  const int digits = context.measures.digits() - 1;  // it is good to some micrometres
  if (clearance.is_beyond) {
    return fmt::format(fmt::runtime(context.word(Text::kClearanceBeyond)),
                       context.measures.length(clearance.mm, digits));
  }
  return fmt::format("{} {} - {}", context.measures.length(clearance.mm, digits), clearance.piece,
                     clearance.fixture);
}

void draw_machine_values(const PanelContext& context) {
  const Moment& moment = *context.shown.moment;
  if (!ImGui::BeginTable("values", 2)) return;
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, 92.0f * context.scale);
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch);
  const auto line = [&](Text label, const std::string& value, const ImVec4& color = theme::kText) {
    ImGui::TableNextColumn();
    ImGui::TextColored(theme::kDim, "%s", context.word(label));
    ImGui::TableNextColumn();
    const bool is_cut_off = ImGui::CalcTextSize(value.c_str()).x > ImGui::GetContentRegionAvail().x;
    ImGui::TextColored(color, "%s", value.c_str());
    if (is_cut_off && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", value.c_str());
  };
  line(Text::kTool, tool_text(context));
  const char* turn = moment.spindle_rpm > 0.0 ? " M3" : moment.spindle_rpm < 0.0 ? " M4" : "";
  line(Text::kSpindle, fmt::format("{:.0f} /min{}", std::abs(moment.spindle_rpm), turn));
  if (!moment.spindle_load.empty()) line(Text::kLoad, moment.spindle_load);
  line(Text::kFeed, feed_text(context));
  line(Text::kCoolant, moment.coolant.empty() ? "-" : moment.coolant);
  line(Text::kRemoved, context.measures.volume(moment.removed_mm3));
  if (const auto& clearance = moment.clearance) {
    line(Text::kClearance, clearance_text(context),
         clearance->mm > 0 ? theme::kText : theme::kError);
  }
  ImGui::EndTable();
}

void draw_source(const PanelContext& context) {
  const Moment& moment = *context.shown.moment;
  if (moment.source == SourceFreshness::kNone) return;
  const bool is_live = moment.source == SourceFreshness::kLive;
  const bool is_stale = moment.source == SourceFreshness::kStale;
  const Text word = is_live ? Text::kLive : is_stale ? Text::kStale : Text::kLost;
  const ImVec4& color = is_live ? theme::kGood : is_stale ? theme::kWarning : theme::kError;
  ImGui::Separator();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = ImGui::GetTextLineHeight();
  ImGui::GetWindowDrawList()->AddCircleFilled({at.x + 0.35f * height, at.y + 0.55f * height},
                                              0.30f * height, ImGui::GetColorU32(color));
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + height);
  ImGui::TextColored(color, "%s, %s %s", context.word(word),
                     age_text(context.shown.source_age_s()).c_str(), context.word(Text::kAgo));
  ImGui::SameLine();
  ImGui::TextColored(theme::kDim, "%s", moment.source_name.c_str());
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", moment.source_name.c_str());
}

void draw_findings(const PanelContext& context) {
  const auto& findings = context.shown.findings->findings;
  if (findings.empty()) {
    ImGui::TextColored(theme::kDim, "%s", context.word(Text::kNoFindings));
    return;
  }
  ImGui::BeginChild("finding list", {0.0f, 0.0f});
  // Each as high as its text is long: at most some hundred, and what is out of sight is not drawn.
  const float text_x = 58.0f * context.scale;
  const float wrap_px = ImGui::GetContentRegionAvail().x - text_x;
  for (std::size_t i = 0; i < findings.size(); ++i) {
    const SceneFinding& finding = findings[i];
    ImGui::PushID(static_cast<int>(i));
    ImGui::PushStyleColor(ImGuiCol_Text, theme::of(finding.severity));
    const std::string& text = finding.text_in(context.measures.unit());
    const std::string line = finding.line > 0 ? fmt::format("{}", finding.line) : "-";
    const float height =
        ImGui::CalcTextSize(text.c_str(), nullptr, false, std::max(wrap_px, 1.0f)).y;
    if (ImGui::Selectable(line.c_str(), false, 0, {0.0f, height})) {
      context.commands->push(SeekFindingCommand{static_cast<int>(i)});
    }
    ImGui::PopStyleColor();
    const bool is_hovered = ImGui::IsItemHovered();
    ImGui::SameLine(text_x);
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    if (is_hovered) {
      ImGui::SetTooltip("%s:%d  %s", finding.file.c_str(), finding.line,
                        clock_text(finding.time_s).c_str());
    }
    ImGui::PopID();
  }
  ImGui::EndChild();
}

void draw_tabs(const PanelContext& context) {
  if (!ImGui::BeginTabBar("tabs")) return;
  const std::string findings = fmt::format("{} {}###findings", context.word(Text::kFindings),
                                           context.shown.findings->findings.size());
  if (ImGui::BeginTabItem(findings.c_str())) {
    draw_findings(context);
    ImGui::EndTabItem();
  }
  const std::string view = fmt::format("{}###view", context.word(Text::kView));
  if (ImGui::BeginTabItem(view.c_str())) {
    ImGui::BeginChild("view tab", {0.0f, 0.0f});
    draw_view_tab(context);
    ImGui::EndChild();
    ImGui::EndTabItem();
  }
  if (context.shown.job) {
    const std::string job = fmt::format("{}###job", context.word(Text::kJob));
    if (ImGui::BeginTabItem(job.c_str())) {
      ImGui::BeginChild("job tab", {0.0f, 0.0f});
      draw_job_tab(context);
      ImGui::EndChild();
      ImGui::EndTabItem();
    }
  }
  bool& to_front = context.state->inspection.comes_to_front;
  const std::string point = fmt::format("{}###point", context.word(Text::kPoint));
  if (ImGui::BeginTabItem(point.c_str(), nullptr, to_front ? ImGuiTabItemFlags_SetSelected : 0)) {
    draw_point_tab(context);
    ImGui::EndTabItem();
  }
  to_front = false;
  ImGui::EndTabBar();
}

}  // namespace

double ShownValues::source_age_s() const {
  const std::chrono::duration<double> since = std::chrono::steady_clock::now() - moment_came;
  return moment->source_age_s + std::max(0.0, since.count());
}

std::string age_text(double seconds) {
  if (seconds < 10.0) return fmt::format("{:.1f} s", seconds);
  if (seconds < 120.0) return fmt::format("{:.0f} s", std::floor(seconds));
  if (seconds < 7200.0) return fmt::format("{:.0f} min", std::floor(seconds / 60.0));
  return fmt::format("{:.0f} h", std::floor(seconds / 3600.0));
}

void draw_info_panel(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room) {
  if (room.right <= 0.0f) return;
  ImGui::SetNextWindowPos({window_px.x - room.right, 0.0f});
  ImGui::SetNextWindowSize({room.right, window_px.y - room.bottom});
  ImGui::Begin("info", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNavInputs |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  draw_positions(context);
  ImGui::Separator();
  draw_machine_values(context);
  draw_source(context);
  ImGui::Dummy({0.0f, 2.0f * context.scale});
  draw_tabs(context);
  ImGui::End();
}

}  // namespace kerf
