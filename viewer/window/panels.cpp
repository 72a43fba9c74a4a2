#include "viewer/window/panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace kerf {
namespace {

constexpr ImGuiWindowFlags kPanelFlags =
    ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNavInputs;
const ImVec4 kLiveColor{0.35f, 0.85f, 0.40f, 1.0f};
const ImVec4 kStaleColor{1.00f, 0.72f, 0.20f, 1.0f};
const ImVec4 kLostColor{1.00f, 0.35f, 0.30f, 1.0f};
const ImVec4 kNoteColor{0.55f, 0.75f, 0.95f, 1.0f};
const ImVec4 kDimColor{0.60f, 0.63f, 0.68f, 1.0f};
constexpr ImU32 kCurrentLine = IM_COL32(70, 105, 60, 255);
constexpr ImU32 kBreakpoint = IM_COL32(225, 60, 50, 255);
constexpr double kMegabyte = 1024.0 * 1024.0;

const ImVec4& color_of(Severity severity) {
  switch (severity) {
    case Severity::kError:
      return kLostColor;
    case Severity::kWarning:
      return kStaleColor;
    case Severity::kNote:
      break;
  }
  return kNoteColor;
}

void show(const std::string& line) { ImGui::TextUnformatted(line.c_str()); }

void draw_positions(const PanelContext& context) {
  const Language language = context.settings->language;
  const Moment& moment = *context.shown.moment;
  if (moment.axes.empty() ||
      !ImGui::BeginTable("positions", 4, ImGuiTableFlags_SizingStretchProp)) {
    return;
  }
  ImGui::TableSetupColumn("");
  for (const Text column : {Text::kWork, Text::kMachine, Text::kToGo}) {
    ImGui::TableSetupColumn(text(column, language));
  }
  ImGui::TableHeadersRow();
  for (const AxisReadout& axis : moment.axes) {
    const int digits = axis.is_rotary ? 2 : 3;
    ImGui::TableNextColumn();
    show(std::string(1, axis.name));
    ImGui::TableNextColumn();
    show(fmt::format("{:.{}f}", axis.work, digits));
    ImGui::TableNextColumn();
    show(fmt::format("{:.{}f}", axis.machine, digits));
    ImGui::TableNextColumn();
    show(axis.to_go ? fmt::format("{:.{}f}", *axis.to_go, digits) : "-");
  }
  ImGui::EndTable();
}

void draw_machine_values(const PanelContext& context) {
  const Language language = context.settings->language;
  const Moment& moment = *context.shown.moment;
  const auto line = [language](Text label, const std::string& value) {
    ImGui::TextColored(kDimColor, "%s", text(label, language));
    ImGui::SameLine();
    show(value);
  };
  if (!moment.work_offset.empty()) line(Text::kOffset, moment.work_offset);
  line(Text::kTool, moment.tool_name.empty() && moment.tool == 0
                        ? std::string(text(Text::kNoTool, language))
                        : fmt::format("T{} {}", moment.tool, moment.tool_name));
  line(Text::kSpindle, fmt::format("{:.0f} /min", moment.spindle_rpm));
  line(Text::kFeed, moment.is_traverse ? std::string(text(Text::kTraverse, language))
                                       : fmt::format("{:.0f} mm/min", moment.feed_mm_per_min));
  if (!moment.coolant.empty()) line(Text::kCoolant, moment.coolant);
  line(Text::kRemoved, fmt::format("{:.1f} cm3", moment.removed_mm3 / 1000.0));
}

void draw_source(const PanelContext& context) {
  const Moment& moment = *context.shown.moment;
  if (moment.source == SourceFreshness::kNone) return;
  const Language language = context.settings->language;
  const bool is_live = moment.source == SourceFreshness::kLive;
  const bool is_stale = moment.source == SourceFreshness::kStale;
  const Text word = is_live ? Text::kLive : is_stale ? Text::kStale : Text::kLost;
  ImGui::Separator();
  ImGui::TextColored(kDimColor, "%s", text(Text::kSource, language));
  ImGui::SameLine();
  show(moment.source_name);
  ImGui::TextColored(is_live    ? kLiveColor
                     : is_stale ? kStaleColor
                                : kLostColor,
                     "%s, %s %s", text(word, language),
                     age_text(context.shown.source_age_s()).c_str(), text(Text::kAgo, language));
}

void draw_findings(const PanelContext& context) {
  const Language language = context.settings->language;
  const auto& findings = context.shown.findings->findings;
  const std::string title =
      fmt::format("{} ({})###findings", text(Text::kFindings, language), findings.size());
  if (!ImGui::CollapsingHeader(title.c_str(), ImGuiTreeNodeFlags_DefaultOpen)) return;
  if (findings.empty()) {
    ImGui::TextColored(kDimColor, "%s", text(Text::kNoFindings, language));
    return;
  }
  const float height = std::min(8.0f, static_cast<float>(findings.size()) + 0.5f) *
                       ImGui::GetTextLineHeightWithSpacing();
  ImGui::BeginChild("finding list", {0.0f, height});
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(findings.size()));
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const SceneFinding& finding = findings[static_cast<std::size_t>(i)];
      ImGui::PushStyleColor(ImGuiCol_Text, color_of(finding.severity));
      const std::string line = fmt::format("{}: {}##{}", finding.line, finding.text, i);
      if (ImGui::Selectable(line.c_str())) context.commands->push(SeekFindingCommand{i});
      ImGui::PopStyleColor();
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", finding.text.c_str());
    }
  }
  ImGui::EndChild();
}

void draw_scene_switches(const PanelContext& context) {
  constexpr std::array kNames{Text::kWorkpiece, Text::kCutter, Text::kHolder,
                              Text::kTraverses, Text::kFeeds,  Text::kPlanned,
                              Text::kBlank,     Text::kFrames, Text::kFindings};
  static_assert(kNames.size() == kSceneObjectCount);
  ViewSettings* settings = context.settings;
  const Language language = settings->language;
  if (!ImGui::CollapsingHeader(fmt::format("{}###scene", text(Text::kScene, language)).c_str())) {
    return;
  }
  for (std::size_t object = 0; object < kSceneObjectCount; ++object) {
    ObjectLook& look = settings->drawing.looks[object];
    ImGui::PushID(static_cast<int>(object));
    ImGui::Checkbox("##shown", &look.is_visible);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(80.0f * context.scale);
    ImGui::SliderFloat(text(kNames[object], language), &look.opacity, 0.05f, 1.0f, "%.2f",
                       ImGuiSliderFlags_AlwaysClamp);
    ImGui::PopID();
  }
  ImGui::Checkbox(text(Text::kPerspective, language), &settings->is_perspective);
  ImGui::Checkbox(text(Text::kLocalDrawing, language), &settings->drawing.is_local);
  for (int i = 0; i < kLanguageCount; ++i) {
    const auto candidate = static_cast<Language>(i);
    if (i > 0) ImGui::SameLine();
    if (ImGui::RadioButton(std::string(code(candidate)).c_str(), candidate == language)) {
      settings->language = candidate;
    }
  }
}

void draw_views(const PanelContext& context) {
  constexpr std::array kViews{
      std::pair{Text::kFit, Action::kFit},     std::pair{Text::kIsometric, Action::kIsometric},
      std::pair{Text::kTop, Action::kTop},     std::pair{Text::kFront, Action::kFront},
      std::pair{Text::kBack, Action::kBack},   std::pair{Text::kLeft, Action::kLeft},
      std::pair{Text::kRight, Action::kRight}, std::pair{Text::kBottom, Action::kBottom}};
  constexpr std::size_t kAcross = 4;
  const Language language = context.settings->language;
  for (std::size_t i = 0; i < kViews.size(); ++i) {
    if (i % kAcross != 0) ImGui::SameLine();
    if (ImGui::SmallButton(text(kViews[i].first, language))) {
      *context.action = kViews[i].second;
      *context.has_action = true;
    }
  }
}

void draw_counters(const PanelContext& context) {
  const Language language = context.settings->language;
  if (!context.settings->shows_counters) return;
  ImGui::Separator();
  ImGui::TextColored(kDimColor, "%s", text(Text::kDrawing, language));
  const auto line = [&](Text name, const DrawCounters::Kind& kind) {
    const auto frames = static_cast<double>(std::max<std::uint64_t>(1, kind.frames));
    show(fmt::format("{} {}: {:.0f} px  {:.2f} ms", text(name, language), kind.frames,
                     static_cast<double>(kind.pixels) / frames, kind.ms / frames));
  };
  const DrawCounters& counters = context.counters;
  line(Text::kFull, counters.full);
  line(Text::kLocal, counters.local);
  line(Text::kStill, counters.still);
  show(fmt::format("{} {:.1f} MB, {} {:.1f} MB", text(Text::kUploaded, language),
                   static_cast<double>(counters.uploaded_bytes) / kMegabyte,
                   text(Text::kWaiting, language),
                   static_cast<double>(counters.waiting_bytes) / kMegabyte));
  show(fmt::format("{} {:.1f} MB", text(Text::kGpuMemory, language),
                   static_cast<double>(counters.gpu_bytes) / kMegabyte));
}

void draw_line(const PanelContext& context, const SourceFile& file, bool is_main, int number,
               bool is_current) {
  const Moment& moment = *context.shown.moment;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = ImGui::GetTextLineHeight();
  const bool has_breakpoint =
      is_main && std::binary_search(moment.breakpoints.begin(), moment.breakpoints.end(), number);
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (is_current) {
    list->AddRectFilled(at, {at.x + 4096.0f, at.y + height}, kCurrentLine);
  }
  if (has_breakpoint) {
    list->AddCircleFilled({at.x + 0.3f * height, at.y + 0.5f * height}, 0.28f * height,
                          kBreakpoint);
  }
  const std::string line = fmt::format("  {:>6}  {}##{}", number, file.line(number), number);
  if (ImGui::Selectable(line.c_str())) {
    context.commands->push(SeekLineCommand{is_main ? "" : file.path(), number});
  }
  if (is_main && ImGui::IsItemClicked(ImGuiMouseButton_Right)) {
    context.commands->push(BreakpointCommand{file.path(), number, !has_breakpoint});
  }
}

void draw_file(const PanelContext& context, const SourceFile& file, int index) {
  const Moment& moment = *context.shown.moment;
  const int current = index == moment.file ? moment.line : 0;
  ImGui::BeginChild("lines", {0.0f, 0.0f}, false, ImGuiWindowFlags_HorizontalScrollbar);
  if (current != *context.followed_line || index != *context.followed_file) {
    *context.followed_line = current;
    *context.followed_file = index;
    if (current > 0) {
      const float line_px = ImGui::GetTextLineHeightWithSpacing();
      ImGui::SetScrollY(std::max(
          0.0f, (static_cast<float>(current) - 0.5f) * line_px - 0.5f * ImGui::GetWindowHeight()));
    }
  }
  ImGuiListClipper clipper;
  clipper.Begin(file.line_count(), ImGui::GetTextLineHeightWithSpacing());
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      draw_line(context, file, index == 0, i + 1, i + 1 == current);
    }
  }
  ImGui::EndChild();
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
  ImGui::Begin(fmt::format("{}###info", text(Text::kPosition, context.settings->language)).c_str(),
               nullptr, kPanelFlags);
  draw_positions(context);
  draw_machine_values(context);
  draw_source(context);
  ImGui::Separator();
  draw_findings(context);
  draw_scene_switches(context);
  ImGui::Separator();
  draw_views(context);
  draw_counters(context);
  ImGui::End();
}

void draw_code_panel(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room) {
  if (room.left <= 0.0f) return;
  const Language language = context.settings->language;
  ImGui::SetNextWindowPos({0.0f, 0.0f});
  ImGui::SetNextWindowSize({room.left, window_px.y - room.bottom});
  ImGui::Begin(fmt::format("{}###code", text(Text::kProgram, language)).c_str(), nullptr,
               kPanelFlags);
  const auto& files = context.shown.program->files;
  if (files.empty()) {
    ImGui::TextColored(kDimColor, "%s", text(Text::kNoProgram, language));
  } else if (files.size() == 1) {
    draw_file(context, files.front(), 0);
  } else if (ImGui::BeginTabBar("files", ImGuiTabBarFlags_FittingPolicyScroll)) {
    // The file that runs comes to the front when it begins to run.
    const int running = context.shown.moment->file;
    const bool enters = running != *context.running_file;
    *context.running_file = running;
    for (std::size_t i = 0; i < files.size(); ++i) {
      const auto index = static_cast<int>(i);
      const std::size_t slash = files[i].path().rfind('/');
      const std::string name = fmt::format(
          "{}##{}", files[i].path().substr(slash == std::string::npos ? 0 : slash + 1), index);
      const bool to_front = enters && index == running;
      if (ImGui::BeginTabItem(name.c_str(), nullptr,
                              to_front ? ImGuiTabItemFlags_SetSelected : 0)) {
        draw_file(context, files[i], index);
        ImGui::EndTabItem();
      }
    }
    ImGui::EndTabBar();
  }
  ImGui::End();
}

void draw_help(const PanelContext& context, glm::vec2 window_px) {
  const Language language = context.settings->language;
  ImGui::SetNextWindowPos({0.5f * window_px.x, 0.5f * window_px.y}, ImGuiCond_Always, {0.5f, 0.5f});
  if (ImGui::Begin(fmt::format("{}###help", text(Text::kShortcuts, language)).c_str(),
                   context.shows_help,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                       ImGuiWindowFlags_NoCollapse)) {
    if (ImGui::BeginTable("keys", 4, ImGuiTableFlags_SizingFixedFit)) {
      for (const Shortcut& shortcut : shortcuts()) {
        ImGui::TableNextColumn();
        ImGui::TextColored(kStaleColor, "%s", shortcut.label);
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(text(shortcut.text, language));
      }
      ImGui::EndTable();
    }
    ImGui::Separator();
    ImGui::TextColored(kStaleColor, "%s", text(Text::kMouse, language));
    for (const Text line : {Text::kMouseOrbit, Text::kMousePan, Text::kMouseZoom}) {
      ImGui::BulletText("%s", text(line, language));
    }
  }
  ImGui::End();
}

void draw_line_question(const PanelContext& context, glm::vec2 window_px) {
  const Language language = context.settings->language;
  ImGui::SetNextWindowPos({0.5f * window_px.x, 0.4f * window_px.y}, ImGuiCond_Always, {0.5f, 0.5f});
  if (ImGui::Begin(fmt::format("{}###line", text(Text::kGoToLine, language)).c_str(),
                   context.asks_for_line,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                       ImGuiWindowFlags_NoCollapse)) {
    static int number = 1;
    if (ImGui::IsWindowAppearing()) {
      number = std::max(1, context.shown.moment->line);
      ImGui::SetKeyboardFocusHere();
    }
    if (ImGui::InputInt("##number", &number, 1, 100,
                        ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll)) {
      if (number >= 1) context.commands->push(SeekLineCommand{"", number});
      *context.asks_for_line = false;
    }
  }
  ImGui::End();
}

}  // namespace kerf
