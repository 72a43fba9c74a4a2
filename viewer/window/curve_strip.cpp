// The curve below the time slider: what the program does when.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "viewer/window/panels.h"

namespace kerf {
namespace {

struct Curve {
  const std::vector<float>* values = nullptr;
  Text name = Text::kCurveRate;
};

Curve chosen_curve(const ProgramCurves& curves, CurveChoice choice) {
  switch (choice) {
    case CurveChoice::kNone:
      break;
    case CurveChoice::kRate:
      return {&curves.mm3_per_s, Text::kCurveRate};
    case CurveChoice::kFeed:
      return {&curves.feed_mm_per_min, Text::kFeed};
    case CurveChoice::kFeedPerTooth:
      return {&curves.feed_per_tooth_mm, Text::kFeedPerTooth};
  }
  return {};
}

std::string figure(const PanelContext& context, float value) {
  const auto number = static_cast<double>(value);
  switch (context.settings->curve) {
    case CurveChoice::kRate:
      return context.measures.rate(number);
    case CurveChoice::kFeed:
      return context.measures.feed(number);
    case CurveChoice::kFeedPerTooth:
      return context.measures.length(number, context.measures.digits() + 1);
    case CurveChoice::kNone:
      break;
  }
  return {};
}

/// The greatest of the columns that share a pixel stands for them, in its colour.
void draw_columns(const ProgramCurves& curves, const std::vector<float>& values, float top,
                  double duration_s, ImVec2 low, ImVec2 high) {
  ImDrawList* const list = ImGui::GetWindowDrawList();
  const double seconds_a_pixel = duration_s / static_cast<double>(high.x - low.x);
  const auto columns = static_cast<double>(values.size());
  for (float x = low.x; x < high.x; x += 1.0f) {
    const double begin_s = static_cast<double>(x - low.x) * seconds_a_pixel;
    const auto first = static_cast<std::size_t>(std::min(columns, begin_s / curves.step_s));
    const auto last = static_cast<std::size_t>(
        std::min(columns - 1, (begin_s + seconds_a_pixel) / curves.step_s));
    std::size_t at = first;
    for (std::size_t i = first; i <= last && i < values.size(); ++i) {
      if (values[i] > values[at]) at = i;
    }
    if (at >= values.size() || !(values[at] > 0.0f)) continue;
    const float height = std::max(1.0f, std::round(values[at] / top * (high.y - low.y)));
    list->AddRectFilled({x, high.y - height}, {x + 1.0f, high.y}, curves.color[at] | 0xff000000u);
  }
}

void draw_tip(const PanelContext& context, const Curve& curve, double time_s) {
  const ProgramCurves& curves = *context.shown.curves;
  std::string tip = clock_text(time_s);
  const auto column = static_cast<std::size_t>(time_s / curves.step_s);
  if (column < curve.values->size()) {
    tip +=
        fmt::format("\n{} {}", context.word(curve.name), figure(context, (*curve.values)[column]));
  }
  ImGui::SetTooltip("%s", tip.c_str());
}

}  // namespace

void draw_curve(const PanelContext& context) {
  const double duration_s = context.shown.timeline->duration_s;
  if (context.settings->curve == CurveChoice::kNone || !context.shown.timeline->has_curves) return;
  const float gap = ImGui::GetStyle().ItemSpacing.y;
  const float height = std::round(kCurveHeight_px * context.scale - gap);
  const float width = std::max(20.0f, ImGui::GetContentRegionAvail().x);
  const ImVec2 low = ImGui::GetCursorScreenPos(), high(low.x + width, low.y + height);
  ImGui::InvisibleButton("curve", {width, height});
  ImDrawList* const list = ImGui::GetWindowDrawList();
  list->AddRectFilled({low.x, high.y}, {high.x, high.y + 1.0f}, theme::kTrack);
  const double time_s = time_under_mouse(low.x, high.x, duration_s);
  seek_with_mouse(context, time_s);
  if (context.shown.curves == nullptr) return;
  const ProgramCurves& curves = *context.shown.curves;
  const Curve curve = chosen_curve(curves, context.settings->curve);
  std::string label = context.word(curve.name);
  if (curve.values->empty()) {
    label += fmt::format(": {}", context.word(Text::kNoTeeth));
  } else {
    const float top = *std::max_element(curve.values->begin(), curve.values->end());
    if (top > 0.0f) {
      draw_columns(curves, *curve.values, top, duration_s, low, high);
      label += fmt::format("  <= {}", figure(context, top));
    }
    const double shown = std::clamp(context.shown.moment->time_s / duration_s, 0.0, 1.0);
    const float head_x = std::round(low.x + static_cast<float>(shown) * width);
    list->AddRectFilled({head_x, low.y}, {head_x + 1.0f, high.y}, theme::kHead);
    if (ImGui::IsItemHovered() || ImGui::IsItemActive()) draw_tip(context, curve, time_s);
  }
  const ImVec2 at(low.x + 2.0f * context.scale, low.y - 1.0f),
      size = ImGui::CalcTextSize(label.c_str());
  list->AddRectFilled(at, {at.x + size.x, at.y + size.y},
                      ImGui::GetColorU32(ImGuiCol_WindowBg, 0.75f));
  list->AddText(at, ImGui::ColorConvertFloat4ToU32(theme::kDim), label.c_str());
}

}  // namespace kerf
