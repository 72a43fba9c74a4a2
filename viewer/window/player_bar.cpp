#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "viewer/window/panels.h"

namespace kerf {
namespace {

constexpr float kBarHeight_px = 76.0f;
constexpr float kTrackHeight_px = 20.0f;
constexpr ImU32 kTrack = IM_COL32(60, 66, 76, 255);
constexpr ImU32 kPastTrack = IM_COL32(70, 120, 185, 255);
constexpr ImU32 kToolMark = IM_COL32(235, 200, 90, 255);
constexpr ImU32 kErrorMark = IM_COL32(235, 70, 60, 255);
constexpr ImU32 kWarningMark = IM_COL32(250, 165, 40, 255);
constexpr ImU32 kNoteMark = IM_COL32(120, 180, 240, 255);
constexpr ImU32 kHead = IM_COL32(255, 255, 255, 255);

ImU32 mark_color(Severity severity) {
  switch (severity) {
    case Severity::kError:
      return kErrorMark;
    case Severity::kWarning:
      return kWarningMark;
    case Severity::kNote:
      break;
  }
  return kNoteMark;
}

const char* words(PlayState state, Language language) {
  switch (state) {
    case PlayState::kPaused:
      return text(Text::kPaused, language);
    case PlayState::kPlaying:
      return text(Text::kPlaying, language);
    case PlayState::kHurrying:
      return text(Text::kHurrying, language);
    case PlayState::kFollowing:
      return text(Text::kFollowing, language);
    case PlayState::kEnded:
      break;
  }
  return text(Text::kEnded, language);
}

bool is_playing(PlayState state) {
  return state == PlayState::kPlaying || state == PlayState::kHurrying;
}

/// A button that asks for an action of the shortcut table; its key is in the tooltip.
void action_button(const PanelContext& context, const char* face, Action action, Text tip) {
  if (ImGui::Button(face)) {
    *context.action = action;
    *context.has_action = true;
  }
  if (ImGui::IsItemHovered()) {
    for (const Shortcut& shortcut : shortcuts()) {
      if (shortcut.action != action) continue;
      ImGui::SetTooltip("%s  [%s]", text(tip, context.settings->language), shortcut.label);
    }
  }
  ImGui::SameLine();
}

/// Tools and findings above the track, each by a line at its time.
void draw_marks(const PanelContext& context, ImVec2 low, ImVec2 high, double duration_s) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const auto x_of = [&](double time_s) {
    const double share = std::clamp(time_s / duration_s, 0.0, 1.0);
    return low.x + static_cast<float>(share) * (high.x - low.x);
  };
  const float middle = 0.5f * (low.y + high.y);
  for (const ToolMark& mark : context.shown.timeline->tools) {
    const float x = x_of(mark.time_s);
    list->AddLine({x, low.y}, {x, middle}, kToolMark, 2.0f);
  }
  // Findings that fall on the same pixel are drawn once: there may be thousands.
  float last_x = -1.0f;
  for (const SceneFinding& finding : context.shown.findings->findings) {
    const float x = std::round(x_of(finding.time_s));
    if (x == last_x) continue;
    last_x = x;
    list->AddLine({x, middle}, {x, high.y}, mark_color(finding.severity), 2.0f);
  }
}

void draw_time_slider(const PanelContext& context) {
  const double duration_s = context.shown.timeline->duration_s;
  const float height = kTrackHeight_px * context.scale;
  const float width = std::max(20.0f, ImGui::GetContentRegionAvail().x);
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const ImVec2 high(low.x + width, low.y + height);
  ImGui::InvisibleButton("time", {width, height});
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(low, high, kTrack, 3.0f);
  if (!(duration_s > 0.0)) return;  // a machine is watched: there is nothing to seek in
  const double shown = std::clamp(context.shown.moment->time_s / duration_s, 0.0, 1.0);
  const float head_x = low.x + static_cast<float>(shown) * width;
  list->AddRectFilled(low, {head_x, high.y}, kPastTrack, 3.0f);
  draw_marks(context, low, high, duration_s);
  list->AddRectFilled({head_x - 2.0f, low.y}, {head_x + 2.0f, high.y}, kHead);
  const double under_mouse =
      std::clamp(static_cast<double>((ImGui::GetIO().MousePos.x - low.x) / width), 0.0, 1.0) *
      duration_s;
  if (ImGui::IsItemActive() && (ImGui::IsItemActivated() || ImGui::GetIO().MouseDelta.x != 0.0f)) {
    context.commands->push(SeekTimeCommand{under_mouse});
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", clock_text(under_mouse).c_str());
}

void draw_speed(const PanelContext& context) {
  auto speed = static_cast<float>(context.shown.moment->speed);
  ImGui::SetNextItemWidth(150.0f * context.scale);
  if (ImGui::SliderFloat(text(Text::kSpeed, context.settings->language), &speed,
                         static_cast<float>(kMinSpeed), static_cast<float>(kMaxSpeed), "%.1f x",
                         ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp)) {
    context.commands->push(SpeedCommand{static_cast<double>(speed)});
  }
}

void draw_buttons(const PanelContext& context) {
  const Moment& moment = *context.shown.moment;
  if (moment.state != PlayState::kFollowing) {
    action_button(context, "|<", Action::kStop, Text::kStop);
    action_button(context, "< F", Action::kPreviousFinding, Text::kPreviousFinding);
    action_button(context, "< T", Action::kPreviousTool, Text::kPreviousTool);
    action_button(context, "<", Action::kStepBack, Text::kStepBack);
    const bool playing = is_playing(moment.state);
    action_button(context, playing ? " || ##play" : " > ##play", Action::kPlayPause,
                  playing ? Text::kPause : Text::kPlay);
    action_button(context, ">##step", Action::kStepForward, Text::kStepForward);
    action_button(context, "T >", Action::kNextTool, Text::kNextTool);
    action_button(context, "F >", Action::kNextFinding, Text::kNextFinding);
    action_button(context, ">|", Action::kToEnd, Text::kToEnd);
    draw_speed(context);
    ImGui::SameLine();
  }
  action_button(context, "?", Action::kHelp, Text::kShortcuts);
}

void draw_status(const PanelContext& context) {
  const Language language = context.settings->language;
  const Moment& moment = *context.shown.moment;
  const double duration_s = context.shown.timeline->duration_s;
  std::string line = fmt::format("{}  {} {}", words(moment.state, language),
                                 text(Text::kElapsed, language), clock_text(moment.time_s));
  if (duration_s > 0.0) {
    line += fmt::format("  {} {}", text(Text::kRemaining, language),
                        clock_text(std::max(0.0, duration_s - moment.time_s)));
  }
  ImGui::TextUnformatted(line.c_str());
  const std::string& notice = context.notice->empty() ? moment.notice : *context.notice;
  if (notice.empty()) return;
  ImGui::SameLine();
  ImGui::TextColored({1.0f, 0.85f, 0.4f, 1.0f}, " %s", notice.c_str());
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

PanelRoom panel_room(glm::vec2 window_px, const ViewSettings& settings, float scale) {
  constexpr float kCodeWidth_px = 300.0f;
  constexpr float kInfoWidth_px = 290.0f;
  constexpr float kSmallestPicture_px = 160.0f;
  PanelRoom room;
  if (window_px.y >= scale * (kBarHeight_px + kSmallestPicture_px)) {
    room.bottom = scale * kBarHeight_px;
  }
  float left_over = window_px.x - scale * kSmallestPicture_px;
  if (settings.shows_info && left_over >= scale * kInfoWidth_px) {
    room.right = scale * kInfoWidth_px;
    left_over -= room.right;
  }
  if (settings.shows_code && left_over >= scale * kCodeWidth_px) {
    room.left = scale * kCodeWidth_px;
  }
  return room;
}

void draw_player_bar(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room) {
  if (room.bottom <= 0.0f) return;
  ImGui::SetNextWindowPos({0.0f, window_px.y - room.bottom});
  ImGui::SetNextWindowSize({window_px.x, room.bottom});
  ImGui::Begin("player", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNavInputs);
  draw_time_slider(context);
  draw_buttons(context);
  draw_status(context);
  ImGui::End();
}

}  // namespace kerf
