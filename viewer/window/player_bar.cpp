#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "viewer/window/icons.h"
#include "viewer/window/panels.h"

namespace kerf {
namespace {

constexpr float kBarHeight_px = 84.0f;
constexpr float kToolbarHeight_px = 36.0f;
constexpr float kTrackHeight_px = 20.0f;

const char* words(const PanelContext& context) {
  switch (context.shown.moment->state) {
    case PlayState::kPaused:
      return context.word(Text::kPaused);
    case PlayState::kPlaying:
      return context.word(Text::kPlaying);
    case PlayState::kHurrying:
      return context.word(Text::kHurrying);
    case PlayState::kFollowing:
      return context.word(Text::kFollowing);
    case PlayState::kEnded:
      break;
  }
  return context.word(Text::kEnded);
}

bool is_playing(PlayState state) {
  return state == PlayState::kPlaying || state == PlayState::kHurrying;
}

/// What the button does, and the key that does the same.
void tip(const PanelContext& context, Action action, Text what) {
  if (!ImGui::IsItemHovered()) return;
  for (const Shortcut& shortcut : shortcuts()) {
    if (shortcut.action != action) continue;
    ImGui::SetTooltip("%s  [%s]", context.word(what), shortcut.label);
  }
}

struct PlayerButton {
  Icon icon;
  Action action;
  Text text;
  bool begins_group;
};
constexpr std::array kButtons{
    PlayerButton{Icon::kToStart, Action::kToStart, Text::kToStart, false},
    PlayerButton{Icon::kStepBack, Action::kStepBack, Text::kStepBack, false},
    PlayerButton{Icon::kPlay, Action::kPlayPause, Text::kPlay, false},
    PlayerButton{Icon::kStop, Action::kStop, Text::kStop, false},
    PlayerButton{Icon::kStepForward, Action::kStepForward, Text::kStepForward, false},
    PlayerButton{Icon::kToEnd, Action::kToEnd, Text::kToEnd, false},
    PlayerButton{Icon::kPreviousTool, Action::kPreviousTool, Text::kPreviousTool, true},
    PlayerButton{Icon::kNextTool, Action::kNextTool, Text::kNextTool, false},
    PlayerButton{Icon::kPreviousFinding, Action::kPreviousFinding, Text::kPreviousFinding, true},
    PlayerButton{Icon::kNextFinding, Action::kNextFinding, Text::kNextFinding, false},
};

void draw_buttons(const PanelContext& context) {
  const bool playing = is_playing(context.shown.moment->state);
  for (const PlayerButton& button : kButtons) {
    const bool is_play = button.action == Action::kPlayPause;
    if (&button != &kButtons.front()) {
      ImGui::SameLine(0.0f, (button.begins_group ? 12.0f : 3.0f) * context.scale);
    }
    ImGui::PushID(static_cast<int>(button.action));
    if (icon_button("player", is_play && playing ? Icon::kPause : button.icon)) {
      context.state->action = button.action;
    }
    tip(context, button.action, is_play && playing ? Text::kPause : button.text);
    ImGui::PopID();
  }
}

/// Tools above and findings below, each a line at its time.
void draw_marks(const PanelContext& context, ImVec2 low, ImVec2 high, double duration_s) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const float width = std::max(1.0f, std::round(2.0f * context.scale));
  const auto x_of = [&](double time_s) {
    const double share = std::clamp(time_s / duration_s, 0.0, 1.0);
    return std::round(low.x + static_cast<float>(share) * (high.x - low.x - width));
  };
  const float middle = std::round(0.5f * (low.y + high.y));
  for (const ToolMark& mark : context.shown.timeline->tools) {
    const float x = x_of(mark.time_s);
    list->AddRectFilled({x, low.y}, {x + width, middle}, theme::kToolMark);
  }
  // Findings that fall on the same pixel are drawn once: there may be thousands.
  float last_x = -1.0f;
  for (const SceneFinding& finding : context.shown.findings->findings) {
    const float x = x_of(finding.time_s);
    if (x == last_x) continue;
    last_x = x;
    list->AddRectFilled({x, middle}, {x + width, high.y},
                        ImGui::GetColorU32(theme::of(finding.severity)));
  }
}

/// The time, and the marks near the mouse.
void draw_time_tip(const PanelContext& context, double time_s, double near_s) {
  std::string tip = clock_text(time_s);
  for (const ToolMark& mark : context.shown.timeline->tools) {
    if (std::abs(mark.time_s - time_s) > near_s) continue;
    tip += fmt::format("\nT{} {}", mark.tool, mark.name);
  }
  int shown = 0;
  constexpr int kMostFindings = 4;
  for (const SceneFinding& finding : context.shown.findings->findings) {
    if (std::abs(finding.time_s - time_s) > near_s || ++shown > kMostFindings) continue;
    tip += fmt::format("\n{}: {}", finding.line, finding.text_in(context.measures.unit()));
  }
  ImGui::SetTooltip("%s", tip.c_str());
}

void draw_time_slider(const PanelContext& context) {
  constexpr float kNear_px = 4.0f;
  const double duration_s = context.shown.timeline->duration_s;
  const float height = std::round(kTrackHeight_px * context.scale);
  const float width = std::max(20.0f, ImGui::GetContentRegionAvail().x);
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const ImVec2 high(low.x + width, low.y + height);
  ImGui::InvisibleButton("time", {width, height});
  ImDrawList* list = ImGui::GetWindowDrawList();
  const float inset = std::round(3.0f * context.scale);
  list->AddRectFilled({low.x, low.y + inset}, {high.x, high.y - inset}, theme::kTrack, inset);
  if (!(duration_s > 0.0)) return;  // a machine is watched: there is nothing to seek in
  const double shown = std::clamp(context.shown.moment->time_s / duration_s, 0.0, 1.0);
  const float head_x = std::round(low.x + static_cast<float>(shown) * width);
  list->AddRectFilled({low.x, low.y + inset}, {head_x, high.y - inset}, theme::kAccent, inset);
  draw_marks(context, low, high, duration_s);
  const float half = std::round(2.0f * context.scale);
  list->AddRectFilled({head_x - half, low.y}, {head_x + half, high.y}, theme::kHead, 1.0f);
  const double under_mouse = time_under_mouse(low.x, high.x, duration_s);
  seek_with_mouse(context, under_mouse);
  if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
    draw_time_tip(context, under_mouse, static_cast<double>(kNear_px / width) * duration_s);
  }
}

void draw_speed(const PanelContext& context) {
  const double shown = context.shown.moment->speed;
  const bool is_max = !std::isfinite(shown);
  auto speed = static_cast<float>(is_max ? kMaxSpeed : shown);
  ImGui::SameLine(0.0f, 14.0f * context.scale);
  ImGui::SetNextItemWidth(130.0f * context.scale);
  const char* format = is_max ? "-" : speed < 10.0f ? "%.1f x" : "%.0f x";
  if (ImGui::SliderFloat("##speed", &speed, static_cast<float>(kMinSpeed),
                         static_cast<float>(kMaxSpeed), format,
                         ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp)) {
    context.commands->push(SpeedCommand{static_cast<double>(speed)});
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s  [-] [+]", context.word(Text::kSpeed));
  ImGui::SameLine(0.0f, 3.0f * context.scale);
  if (is_max) {
    ImGui::PushStyleColor(ImGuiCol_Button, ImGui::ColorConvertU32ToFloat4(theme::kAccent));
  }
  if (ImGui::Button(fmt::format("{}###max", context.word(Text::kFullSpeed)).c_str())) {
    context.state->action = Action::kFullSpeed;
  }
  if (is_max) ImGui::PopStyleColor();
  tip(context, Action::kFullSpeed, Text::kFullSpeedWhat);
}

void draw_go_to(const PanelContext& context) {
  ImGui::SameLine(0.0f, 12.0f * context.scale);
  const std::string label =
      fmt::format("{} {}", context.word(Text::kLine), context.shown.moment->line);
  // Of fixed width: what stands to its right must not move while it plays.
  if (ImGui::Button(fmt::format("{}###line", label).c_str(), {112.0f * context.scale, 0.0f})) {
    context.state->action = Action::kGoToLine;
  }
  tip(context, Action::kGoToLine, Text::kGoToLine);
}

void draw_times(const PanelContext& context) {
  const Moment& moment = *context.shown.moment;
  const double duration_s = context.shown.timeline->duration_s;
  std::string times = clock_text(moment.time_s);
  if (duration_s > 0.0) {
    const std::string nothing = clock_text(0.0);
    const std::string left = clock_text(std::max(0.0, duration_s - moment.time_s));
    times += fmt::format("   {}{}", left == nothing ? "" : "-", left);
  }
  ImGui::PushFont(context.fonts.mono);
  const float width = ImGui::CalcTextSize(times.c_str()).x;
  const float right = ImGui::GetWindowWidth() - ImGui::GetStyle().WindowPadding.x - width;
  if (moment.state != PlayState::kFollowing) ImGui::SameLine();
  if (ImGui::GetCursorPosX() < right) ImGui::SetCursorPosX(right);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(times.c_str());
  ImGui::PopFont();
  if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip("%s   -%s", context.word(Text::kElapsed), context.word(Text::kRemaining));
  }
}

void draw_status(const PanelContext& context) {
  const Moment& moment = *context.shown.moment;
  const ImVec4& color = is_playing(moment.state) || moment.state == PlayState::kFollowing
                            ? theme::kGood
                            : theme::kDim;
  ImGui::TextColored(color, "%s", words(context));
  std::string notice = context.state->notice.shown();
  if (notice.empty()) notice = moment.notice;
  if (notice.empty()) notice = draw_note(context);
  if (!notice.empty()) {
    ImGui::SameLine(0.0f, 14.0f * context.scale);
    ImGui::TextColored(theme::kWarning, "%s", notice.c_str());
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", notice.c_str());
  }
  if (!context.settings->shows_counters) return;
  constexpr double kMegabyte = 1024.0 * 1024.0;
  const std::string figures = fmt::format(
      "{:.0f} {}   {} {:.0f} MB   {} {:.1f} MB", context.state->frames_per_s,
      context.word(Text::kFramesPerSecond), context.word(Text::kGpuMemory),
      static_cast<double>(context.counters.gpu_bytes) / kMegabyte, context.word(Text::kWaiting),
      static_cast<double>(context.counters.waiting_bytes) / kMegabyte);
  ImGui::SameLine();
  const float right = ImGui::GetWindowWidth() - ImGui::GetStyle().WindowPadding.x -
                      ImGui::CalcTextSize(figures.c_str()).x;
  if (ImGui::GetCursorPosX() < right) ImGui::SetCursorPosX(right);
  ImGui::TextColored(theme::kDim, "%s", figures.c_str());
}

struct ToolButton {
  Text label;
  Action action;
  Text what;
  bool is_lit = false;
  bool is_disabled = false;
  bool begins_group = false;
};

constexpr float kInfoWidth_px = 300.0f;
constexpr float kSmallestPicture_px = 160.0f;
constexpr glm::vec2 kToolPadding_px{4.0f, 3.0f};
constexpr float kToolGap_px = 3.0f;
constexpr float kGroupGap_px = 15.0f;

std::vector<ToolButton> tool_buttons(const ViewSettings& settings, bool measures, bool is_narrow) {
  std::vector<ToolButton> buttons;
  // Who has no keys, in a screen of LinuxCNC, gets to the panel by it.
  if (is_narrow) {
    buttons.push_back(
        {Text::kInfo, Action::kInfoPanel, Text::kInfoPanel, settings.shows_info_alone});
  }
  const bool is_flat = settings.flat != FlatView::kNone;
  constexpr std::array kViews{
      std::pair{Text::kFit, Action::kFit},     std::pair{Text::kIsometric, Action::kIsometric},
      std::pair{Text::kTop, Action::kTop},     std::pair{Text::kFront, Action::kFront},
      std::pair{Text::kRight, Action::kRight}, std::pair{Text::kBack, Action::kBack},
      std::pair{Text::kLeft, Action::kLeft},   std::pair{Text::kBottom, Action::kBottom}};
  for (const auto& [label, action] : kViews) {
    buttons.push_back({label, action, label, false, is_flat && action != Action::kFit});
  }
  constexpr std::array kFlatNames{Text::kFlatOff, Text::kFlatXy, Text::kFlatXz};
  buttons.push_back({kFlatNames[static_cast<std::size_t>(settings.flat)], Action::kFlat,
                     Text::kFlat, is_flat, false, true});
  buttons.push_back({Text::kPerspective, Action::kPerspective, Text::kPerspectiveWhat,
                     settings.is_perspective && !is_flat, is_flat});
  buttons.push_back(
      {Text::kSection, Action::kSection, Text::kSection, settings.section.is_on, false, true});
  buttons.push_back({Text::kMeasure, Action::kMeasure, Text::kMeasure, measures});
  buttons.push_back({Text::kPicture, Action::kScreenshot, Text::kScreenshot});
  buttons.push_back({Text::kQuestionMark, Action::kHelp, Text::kShortcuts});
  return buttons;
}

/// Where the buttons stand, in rows of `width` pixels; from the upper left.
std::vector<ImVec2> tool_places(const std::vector<ToolButton>& buttons, float width, float scale) {
  const float row_height =
      std::round(ImGui::GetFontSize() + 2.0f * (kToolPadding_px.y + kToolGap_px) * scale);
  std::vector<ImVec2> places;
  ImVec2 next(0.0f, 0.0f);
  for (const ToolButton& button : buttons) {
    const float button_width =
        ImGui::CalcTextSize(text(button.label)).x + 2.0f * std::round(kToolPadding_px.x * scale);
    if (button.begins_group && next.x > 0.0f) next.x += (kGroupGap_px - kToolGap_px) * scale;
    if (next.x > 0.0f && next.x + button_width > width) next = {0.0f, next.y + row_height};
    places.push_back(next);
    next.x += std::round(button_width + kToolGap_px * scale);
  }
  return places;
}

float toolbar_room(const ViewSettings& settings, float width, bool is_narrow, float scale) {
  const float inside = width - 2.0f * ImGui::GetStyle().WindowPadding.x;
  const std::vector<ImVec2> places =
      tool_places(tool_buttons(settings, false, is_narrow), inside, scale);
  return std::round(kToolbarHeight_px * scale + places.back().y);
}

void draw_tool_button(const PanelContext& context, const ToolButton& button) {
  ImGui::BeginDisabled(button.is_disabled);
  if (button.is_lit) {
    ImGui::PushStyleColor(ImGuiCol_Button, ImGui::ColorConvertU32ToFloat4(theme::kAccent));
  }
  if (ImGui::Button(
          fmt::format("{}###{}", context.word(button.label), static_cast<int>(button.action))
              .c_str())) {
    context.state->action = button.action;
  }
  if (button.is_lit) ImGui::PopStyleColor();
  tip(context, button.action, button.what);
  ImGui::EndDisabled();
}

}  // namespace

std::string clock_text(double seconds) {
  if (!(seconds >= 0.0) || seconds > 1e9) return "-";
  const auto tenths = static_cast<long long>(std::floor(seconds * 10.0));
  const long long whole = tenths / 10;
  if (whole >= 3600) {
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  }
  return fmt::format("{}:{:02}.{}", whole / 60, whole % 60, tenths % 10);
}

double time_under_mouse(float left, float right, double duration_s) {
  const float share = (ImGui::GetIO().MousePos.x - left) / (right - left);
  return std::clamp(static_cast<double>(share), 0.0, 1.0) * duration_s;
}

void seek_with_mouse(const PanelContext& context, double time_s) {
  if (ImGui::IsItemActive() && (ImGui::IsItemActivated() || ImGui::GetIO().MouseDelta.x != 0.0f)) {
    context.commands->push(SeekTimeCommand{time_s});
  }
}

bool is_narrow_for_info(float window_px, float scale) {
  return window_px < scale * (kInfoWidth_px + kSmallestPicture_px);
}

PanelRoom panel_room(glm::vec2 window_px, const ViewSettings& settings, float scale,
                     bool has_curve) {
  constexpr float kCodeWidth_px = 290.0f;
  /// Of the toolbar, beside a panel that stands alone: the button by which it goes.
  constexpr float kOneButton_px = 64.0f;
  PanelRoom room;
  const bool shows_curve = has_curve && settings.curve != CurveChoice::kNone;
  const float bar_px = kBarHeight_px + (shows_curve ? kCurveHeight_px : 0.0f);
  if (window_px.y >= scale * (bar_px + kSmallestPicture_px)) {
    room.bottom = std::round(scale * bar_px);
  }
  float left_over = window_px.x - scale * kSmallestPicture_px;
  // A panel that was made wide shrinks before it goes.
  const auto width_px = [&](double chosen_px, float usual_px) {
    const float wanted = std::round(scale * static_cast<float>(chosen_px));
    if (left_over < std::min(wanted, scale * usual_px)) return 0.0f;
    return std::min(wanted, std::floor(left_over));
  };
  const bool is_narrow = is_narrow_for_info(window_px.x, scale);
  if (is_narrow && settings.shows_info_alone) {
    const float most = std::max(0.0f, window_px.x - scale * kOneButton_px);
    room.right = std::floor(std::min(scale * kInfoWidth_px, most));
    left_over = 0.0f;
  } else if (settings.shows_info) {
    room.right = width_px(settings.info_width_px, kInfoWidth_px);
    left_over -= room.right;
  }
  if (settings.shows_code) room.left = width_px(settings.code_width_px, kCodeWidth_px);
  if (room.bottom > 0.0f) {
    room.top = toolbar_room(settings, window_px.x - room.left - room.right, is_narrow, scale);
    // A picture that finds no room below several rows is worth more than all of the buttons.
    if (window_px.y - room.bottom - room.top < scale * kSmallestPicture_px) {
      room.top = std::round(scale * kToolbarHeight_px);
    }
  }
  return room;
}

void draw_edges(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room) {
  constexpr float kGrip_px = 6.0f;
  const auto edge = [&](const char* name, float x, double* width_px, float sign) {
    const float grip = kGrip_px * context.scale, height = window_px.y - room.bottom;
    ImGui::SetNextWindowPos({x - 0.5f * grip, 0.0f});
    ImGui::SetNextWindowSize({grip, height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1.0f, 1.0f});
    ImGui::Begin(name, nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBackground |
                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::InvisibleButton("grip", {grip, height});
    if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
      ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    }
    if (ImGui::IsItemActive()) {
      const double to = sign > 0.0f ? static_cast<double>(ImGui::GetIO().MousePos.x)
                                    : static_cast<double>(window_px.x - ImGui::GetIO().MousePos.x);
      *width_px = std::clamp(to / static_cast<double>(context.scale), kMinPanel_px, kMaxPanel_px);
    }
    ImGui::End();
    ImGui::PopStyleVar(2);
  };
  ViewSettings& settings = *context.settings;
  if (room.left > 0.0f) edge("code edge", room.left, &settings.code_width_px, 1.0f);
  if (room.right > 0.0f) {
    edge("info edge", window_px.x - room.right, &settings.info_width_px, -1.0f);
  }
}

void draw_player_bar(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room) {
  if (room.bottom <= 0.0f) return;
  ImGui::SetNextWindowPos({0.0f, window_px.y - room.bottom});
  ImGui::SetNextWindowSize({window_px.x, room.bottom});
  ImGui::Begin("player", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNavInputs |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollWithMouse);
  draw_time_slider(context);
  draw_curve(context);
  if (context.shown.moment->state != PlayState::kFollowing) {
    draw_buttons(context);
    draw_speed(context);
    draw_go_to(context);
  }
  draw_times(context);
  draw_status(context);
  ImGui::End();
}

void draw_toolbar(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room) {
  if (room.top <= 0.0f) return;
  ImGui::SetNextWindowPos({room.left, 0.0f});
  ImGui::SetNextWindowSize({window_px.x - room.left - room.right, room.top});
  ImGui::Begin("toolbar", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNavInputs |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollWithMouse);
  // Narrow, so that one row of it fits beside both panels at a width of 1280.
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {std::round(kToolPadding_px.x * context.scale),
                                                   std::round(kToolPadding_px.y * context.scale)});
  const std::vector<ToolButton> buttons =
      tool_buttons(*context.settings, context.state->inspection.measures,
                   is_narrow_for_info(window_px.x, context.scale));
  const ImVec2 corner = ImGui::GetCursorPos();
  const std::vector<ImVec2> places =
      tool_places(buttons, ImGui::GetContentRegionAvail().x, context.scale);
  for (std::size_t i = 0; i < buttons.size(); ++i) {
    ImGui::SetCursorPos({corner.x + places[i].x, corner.y + places[i].y});
    draw_tool_button(context, buttons[i]);
  }
  ImGui::PopStyleVar();
  ImGui::End();
}

}  // namespace kerf
